// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LandmarkPanel.h"

#include <QString>
#include <QVector>

#include <nlohmann/json.hpp>

namespace handeye
{

/// Landmarks (mm, frames in the keys) and what was touched of them, as a session keeps them.
nlohmann::json landmarksJson(const QVector<LandmarkPanel::Landmark>& landmarks, const QString& model);

/// The same back; a landmark that is damaged makes all of them nothing.
QVector<LandmarkPanel::Landmark> landmarksOf(const nlohmann::json& document);
/// The mesh that they were touched for; empty if that is not known.
QString landmarksModelOf(const nlohmann::json& document);

}  // namespace handeye
