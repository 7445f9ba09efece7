// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BallColor.h"
#include "DeviceHub.h"

#include <nlohmann/json.hpp>

#include <QString>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace handeye
{

/// The documents of a session that are the wizard's own, beside those that `handeye` writes, too. What is missing or damaged in one
/// stays what it was.

/// The document of this name; null if there is none.
nlohmann::json entryOf(const std::map<std::string, nlohmann::json>& documents, const char* name);
double numberOf(const nlohmann::json& document, const char* key, double otherwise);
QString textOf(const nlohmann::json& document, const char* key, const QString& otherwise);

/// "ball": what it looks like, where it is to be, and how exact its calibration is to be.
struct BallDocument
{
  double radiusMm = 0;
  bool isColorLearnt = false;
  QString message;  ///< of the click that taught it
  BallColor color;
  double nearestMm = 0, furthestMm = 0;  ///< the working distances
  double enoughPx = 0;                   ///< the largest predicted error that is enough
};
nlohmann::json ballJson(const BallDocument& ball);
BallDocument ballOf(const nlohmann::json& document, BallDocument otherwise);

/// "devices".
nlohmann::json devicesJson(const DeviceSetup& setup);
DeviceSetup devicesOf(const nlohmann::json& document, DeviceSetup otherwise);

/// "export": where to, and all numbers of which what was exported was made (calibration, lens, stylus, registration).
struct ExportDocument
{
  QString folder;
  std::vector<double> numbers;
};
nlohmann::json exportJson(const ExportDocument& exported);
/// Nothing where there was no export.
std::optional<ExportDocument> exportOf(const nlohmann::json& document);

}  // namespace handeye
