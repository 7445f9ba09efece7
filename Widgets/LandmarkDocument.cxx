// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LandmarkDocument.h"

#include "JsonEigen.h"

#include <cmath>
#include <optional>

namespace handeye
{

namespace
{

using nlohmann::json;

std::optional<Eigen::Vector3d> pointOf(const json& numbers)
{
  Eigen::Vector3d point = Eigen::Vector3d::Constant(std::nan(""));
  for (std::size_t i = 0; numbers.is_array() && numbers.size() == 3 && i < 3; ++i)
  {
    point[Eigen::Index(i)] = numbers[i].is_number() ? numbers[i].get<double>() : std::nan("");
  }
  return point.allFinite() ? std::optional(point) : std::nullopt;
}

}  // namespace

json landmarksJson(const QVector<LandmarkPanel::Landmark>& landmarks, const QString& model)
{
  json list = json::array();
  for (const LandmarkPanel::Landmark& landmark : landmarks)
  {
    list.push_back({ { "name", landmark.name.toStdString() }, { "point_Model_Mm", toJson(landmark.point_Model) },
      { "touched_Phantom_Mm", landmark.touched_Phantom ? toJson(*landmark.touched_Phantom) : json() },
      { "isSkipped", landmark.skipped } });
  }
  return { { "schema", "handeye-landmarks/1" }, { "model", model.toStdString() }, { "landmarks", list } };
}

QVector<LandmarkPanel::Landmark> landmarksOf(const json& document)
{
  QVector<LandmarkPanel::Landmark> landmarks;
  const json list = document.is_object() ? document.value("landmarks", json()) : json();
  for (const json& each : list.is_array() ? list : json::array())
  {
    const std::optional<Eigen::Vector3d> point_Model =
      each.is_object() ? pointOf(each.value("point_Model_Mm", json())) : std::nullopt;
    if (!point_Model)
    {
      return {};
    }
    LandmarkPanel::Landmark landmark;
    const json name = each.value("name", json());
    landmark.name = name.is_string() ? QString::fromStdString(name.get<std::string>()) : QString();
    landmark.point_Model = *point_Model;
    landmark.touched_Phantom = pointOf(each.value("touched_Phantom_Mm", json()));
    landmark.skipped = each.value("isSkipped", json()) == json(true);
    landmarks.append(landmark);
  }
  return landmarks;
}

QString landmarksModelOf(const json& document)
{
  const json model = document.is_object() ? document.value("model", json()) : json();
  return model.is_string() ? QString::fromStdString(model.get<std::string>()) : QString();
}

}  // namespace handeye
