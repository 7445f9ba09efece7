// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SessionDocuments.h"

#include <cmath>
#include <utility>

namespace handeye
{

using nlohmann::json;

json entryOf(const std::map<std::string, json>& documents, const char* name)
{
  const auto found = documents.find(name);
  return found == documents.end() || !found->second.is_object() ? json() : found->second;
}

double numberOf(const json& document, const char* key, double otherwise)
{
  const json value = document.is_object() ? document.value(key, json()) : json();
  return value.is_number() ? value.get<double>() : otherwise;
}

QString textOf(const json& document, const char* key, const QString& otherwise)
{
  const json value = document.is_object() ? document.value(key, json()) : json();
  return value.is_string() ? QString::fromStdString(value.get<std::string>()) : otherwise;
}

json ballJson(const BallDocument& ball)
{
  const BallColor& color = ball.color;
  return { { "radiusMm", ball.radiusMm }, { "isColorLearnt", ball.isColorLearnt }, { "message", ball.message.toStdString() },
    { "hueDeg", color.hueDeg }, { "hueToleranceDeg", color.hueToleranceDeg }, { "minimumSaturation", color.minimumSaturation },
    { "minimumValue", color.minimumValue }, { "minimumChroma", color.minimumChroma },
    { "minimumMedianSaturation", color.minimumMedianSaturation }, { "nearestMm", ball.nearestMm },
    { "furthestMm", ball.furthestMm }, { "enoughPx", ball.enoughPx } };
}

BallDocument ballOf(const json& document, BallDocument otherwise)
{
  BallDocument ball = std::move(otherwise);
  const auto positive = [&document](const char* key, double before)
  {
    const double value = numberOf(document, key, before);
    return value > 0 && std::isfinite(value) ? value : before;
  };
  ball.radiusMm = positive("radiusMm", ball.radiusMm);
  ball.isColorLearnt = document.is_object() && document.value("isColorLearnt", json()) == json(true);
  ball.message = textOf(document, "message", {});
  BallColor& color = ball.color;
  color.hueDeg = numberOf(document, "hueDeg", color.hueDeg);
  color.hueToleranceDeg = numberOf(document, "hueToleranceDeg", color.hueToleranceDeg);
  color.minimumSaturation = numberOf(document, "minimumSaturation", color.minimumSaturation);
  color.minimumValue = numberOf(document, "minimumValue", color.minimumValue);
  color.minimumChroma = numberOf(document, "minimumChroma", color.minimumChroma);
  color.minimumMedianSaturation = numberOf(document, "minimumMedianSaturation", color.minimumMedianSaturation);
  const double nearestMm = positive("nearestMm", ball.nearestMm), furthestMm = positive("furthestMm", ball.furthestMm);
  if (nearestMm < furthestMm)
  {
    ball.nearestMm = nearestMm;
    ball.furthestMm = furthestMm;
  }
  ball.enoughPx = positive("enoughPx", ball.enoughPx);
  return ball;
}

json devicesJson(const DeviceSetup& setup)
{
  json servers = json::array();
  for (const QString& server : setup.servers)
  {
    servers.push_back(server.toStdString());
  }
  return { { "kind", int(setup.kind) }, { "servers", servers }, { "camera", setup.camera.toStdString() },
    { "recording", setup.recording.toStdString() }, { "stylusToTracker", setup.stylusToTracker.toStdString() },
    { "markerToTracker", setup.markerToTracker.toStdString() }, { "phantomToTracker", setup.phantomToTracker.toStdString() },
    { "image", setup.image.toStdString() }, { "rightImage", setup.rightImage.toStdString() }, { "latencySec", setup.latencySec } };
}

DeviceSetup devicesOf(const json& document, DeviceSetup otherwise)
{
  if (!document.is_object())
  {
    return otherwise;
  }
  DeviceSetup setup = std::move(otherwise);
  const int kind = int(numberOf(document, "kind", double(setup.kind)));
  setup.kind = kind >= 0 && kind <= int(DeviceSetup::Kind::Recording) ? DeviceSetup::Kind(kind) : setup.kind;
  const json servers = document.value("servers", json());
  setup.servers.clear();
  for (const json& server : servers.is_array() ? servers : json::array())
  {
    setup.servers << (server.is_string() ? QString::fromStdString(server.get<std::string>()) : QString());
  }
  setup.servers.removeAll({});
  setup.camera = textOf(document, "camera", {});
  setup.recording = textOf(document, "recording", {});
  setup.stylusToTracker = textOf(document, "stylusToTracker", setup.stylusToTracker);
  setup.markerToTracker = textOf(document, "markerToTracker", setup.markerToTracker);
  setup.phantomToTracker = textOf(document, "phantomToTracker", setup.phantomToTracker);
  setup.image = textOf(document, "image", setup.image);
  setup.rightImage = textOf(document, "rightImage", setup.rightImage);
  setup.latencySec = numberOf(document, "latencySec", setup.latencySec);
  return setup;
}

json exportJson(const ExportDocument& exported)
{
  return { { "folder", exported.folder.toStdString() }, { "numbers", exported.numbers } };
}

std::optional<ExportDocument> exportOf(const json& document)
{
  const json numbers = document.is_object() ? document.value("numbers", json()) : json();
  ExportDocument exported{ textOf(document, "folder", {}), {} };
  for (const json& each : numbers.is_array() ? numbers : json::array())
  {
    exported.numbers.push_back(each.is_number() ? each.get<double>() : std::nan(""));
  }
  return exported.numbers.empty() ? std::nullopt : std::optional(exported);
}

}  // namespace handeye
