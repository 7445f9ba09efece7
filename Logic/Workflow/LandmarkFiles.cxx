// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkFiles.h"

#include "AtomicFile.h"
#include "CameraFile.h"
#include "FileError.h"
#include "JsonEigen.h"
#include "TextFile.h"
#include "TextTables.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace handeye
{

namespace
{

using nlohmann::json;
using Path = std::filesystem::path;

constexpr std::size_t LargestFileBytes = std::size_t(64) << 20;
constexpr const char* TouchedSchema = "handeye-touched-landmarks/1";
constexpr const char* TouchedHeading = "# Touched landmarks";
constexpr const char* PointsKey = "points_Phantom_Mm";

LandmarkList readJsonLandmarks(const Path& path, const std::string& text)
{
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
  {
    throw io::FileError(path, "this is neither a JSON file nor lines of \"x y z\"");
  }
  const json status = object.value("status", json("ok"));
  if (status != "ok")
  {
    throw io::FileError(path, "the file holds no landmarks, its status is " + status.dump());
  }
  const json rows = object.value(PointsKey, json());
  LandmarkList list;
  list.isTouched = true;
  for (std::size_t i = 0; rows.is_array() && i < rows.size(); ++i)
  {
    Eigen::Vector3d point = Eigen::Vector3d::Constant(NAN);
    for (std::size_t axis = 0; axis < 3 && rows[i].is_array() && rows[i].size() == 3; ++axis)
    {
      point(Eigen::Index(axis)) = rows[i][axis].is_number() ? rows[i][axis].get<double>() : double(NAN);
    }
    if (!point.allFinite())
    {
      throw io::FileError(
        path, std::string("\"") + PointsKey + "\": three numbers are expected for landmark " + std::to_string(i + 1));
    }
    list.points.push_back(point);
  }
  if (list.points.empty())
  {
    throw io::FileError(path, std::string("the key \"") + PointsKey + "\" is missing: a list of points is expected");
  }
  return list;
}

bool nameSays(const Path& path, const char* word)
{
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char letter) { return char(std::tolower(letter)); });
  return name.find(word) != std::string::npos;
}

json row(const TouchedLandmark& landmark)
{
  const Rest& rest = landmark.rest;
  return { { "point_Phantom_Mm", toJson(landmark.point_Phantom) }, { "kind", toString(rest.kind) },
    { "firstFrame", rest.firstSample }, { "lastFrame", rest.lastSample }, { "beginSec", rest.beginSec }, { "endSec", rest.endSec },
    { "frames", rest.count }, { "leftOutFrames", rest.leftOut }, { "rmsMm", rest.rmsMm },
    { "covariance_Mm2", toJson(rest.tipCovariance) }, { "turn_Rad", rest.turn } };
}

std::string toText(const TouchedLandmarksResult& result, const std::string& recording)
{
  const std::string marker = result.phantomToTracker.substr(0, result.phantomToTracker.find("To"));
  std::ostringstream text;
  text << TouchedHeading << ", mm, in the frame of "
       << (marker.empty() ? result.stylusToTracker.substr(result.stylusToTracker.find("To") + 2) : marker) << "; from " << recording
       << '\n';
  for (const TouchedLandmark& landmark : result.landmarks)
  {
    char line[160];
    std::snprintf(line, sizeof(line), "%.4f %.4f %.4f  # %s, frames %lld to %lld, %.2f mm RMS\n", landmark.point_Phantom.x(),
      landmark.point_Phantom.y(), landmark.point_Phantom.z(), toString(landmark.rest.kind).c_str(), landmark.rest.firstSample,
      landmark.rest.lastSample, landmark.rest.rmsMm);
    text << line;
  }
  return text.str();
}

}  // namespace

bool isLandmarkText(const Path& path)
{
  try
  {
    (void)io::readCameraFile(path);
    return false;
  }
  catch (const io::FileError&)
  {
  }
  try
  {
    return !io::readPoints(path).empty();
  }
  catch (const io::FileError&)
  {
    return false;
  }
}

LandmarkList readLandmarks(const Path& path)
{
  const std::string text = io::readWholeFile(path, LargestFileBytes);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin != std::string::npos && text[begin] == '{')
  {
    return readJsonLandmarks(path, text);
  }
  return { io::readPoints(path), text.rfind(TouchedHeading, 0) == 0 };
}

std::vector<Eigen::Vector3d> readModelLandmarks(const Path& model)
{
  LandmarkList list = readLandmarks(model);
  if (list.isTouched)
  {
    throw io::FileError(model, "these landmarks were touched; the model's are expected here, the touched ones come second");
  }
  return std::move(list.points);
}

std::vector<std::string> readLandmarkNames(const Path& path)
{
  const auto trimmed = [](const std::string& text)
  {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
  };
  std::vector<std::string> names;
  std::string before, line;
  std::istringstream text(io::readWholeFile(path, LargestFileBytes));
  while (std::getline(text, line))
  {
    const std::size_t mark = line.find('#');
    const std::string comment = mark == std::string::npos ? std::string() : trimmed(line.substr(mark + 1));
    const std::string numbers = trimmed(line.substr(0, mark));
    if (!numbers.empty() && numbers[0] == '{')
    {
      return {};
    }
    if (!numbers.empty())
    {
      names.push_back(comment.empty() ? before : comment);
    }
    before = numbers.empty() ? comment : std::string();
  }
  const bool allNamed = std::none_of(names.begin(), names.end(), [](const std::string& name) { return name.empty(); });
  return allNamed ? names : std::vector<std::string>();
}

LandmarkLists readLandmarkLists(const Path& model, const Path& touched)
{
  LandmarkLists lists{ readModelLandmarks(model), readLandmarks(touched).points };
  if (nameSays(model, "touch") && !nameSays(model, "model") && nameSays(touched, "model") && !nameSays(touched, "touch"))
  {
    throw io::FileError(model,
      "by their names, this file and " + touched.filename().string() +
        " are exchanged: the model's landmarks come first, the touched ones second");
  }
  return lists;
}

json touchedLandmarksJson(const TouchedLandmarksResult& result)
{
  json object = { { "schema", TouchedSchema }, { "status", toString(result.status) }, { "message", result.message },
    { "stylusTransform", result.stylusToTracker }, { "phantomTransform", result.phantomToTracker } };
  if (result.tipInRecording_Stylus)
  {
    object["tipInRecording_Stylus_Mm"] = toJson(*result.tipInRecording_Stylus);
  }
  object["setAside"] = json::array();
  for (const TouchedLandmark& rest : result.setAside)
  {
    object["setAside"].push_back(row(rest));
  }
  if (result.isUsable())
  {
    object["tip_Stylus_Mm"] = toJson(result.tip_Stylus);
    object[PointsKey] = json::array();
    object["landmarks"] = json::array();
    for (const TouchedLandmark& landmark : result.landmarks)
    {
      object[PointsKey].push_back(toJson(landmark.point_Phantom));
      object["landmarks"].push_back(row(landmark));
    }
  }
  return object;
}

void writeTouchedLandmarks(const Path& path, const TouchedLandmarksResult& result, const std::string& recording)
{
  io::writeFileAtomically(
    path, path.extension() == ".json" ? touchedLandmarksJson(result).dump(2) + "\n" : toText(result, recording));
}

}  // namespace handeye
