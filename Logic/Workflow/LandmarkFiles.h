// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TouchedLandmarks.h"

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace handeye
{

/// Lists of landmarks: text with "x y z" a line (mm), or what landmarksFromRecording() found, as JSON or as such a text whose
/// first line says so.

struct LandmarkList
{
  std::vector<Eigen::Vector3d> points;
  bool isTouched = false;  ///< the file says that its points were touched
};

/// Whether a text file holds points, one a line, and not a camera's numbers, which stand in rows of three, too.
[[nodiscard]] bool isLandmarkText(const std::filesystem::path& path);

/// @throws io::FileError naming the line or the key; also where a JSON file's status is not "ok"
[[nodiscard]] LandmarkList readLandmarks(const std::filesystem::path& path);

/// Reads the model's landmarks and the touched ones. Exchanged, they would give the inverse registration with the same
/// residuals, so that what can be known beforehand is looked at: a list that says of itself that it was touched is no model's;
/// nor are lists whose file names both say the contrary ("touched" for the model's, "model" for the touched).
/// @throws io::FileError
struct LandmarkLists
{
  std::vector<Eigen::Vector3d> points_Model, points_Phantom;
};
[[nodiscard]] LandmarkLists readLandmarkLists(const std::filesystem::path& model, const std::filesystem::path& touched);

/// The model's landmarks alone; see readLandmarkLists().
[[nodiscard]] std::vector<Eigen::Vector3d> readModelLandmarks(const std::filesystem::path& model);

/// The landmarks' names: where a text file has a comment beside or in front of every point, these comments; empty otherwise, and for
/// JSON. @throws io::FileError where the file cannot be read
[[nodiscard]] std::vector<std::string> readLandmarkNames(const std::filesystem::path& path);

/// Every rest with its place, its kind, its frames and its spread.
nlohmann::json touchedLandmarksJson(const TouchedLandmarksResult& result);

/// JSON for a name that ends in .json, text otherwise; atomically. @param recording named in the text @throws io::FileError
void writeTouchedLandmarks(const std::filesystem::path& path, const TouchedLandmarksResult& result, const std::string& recording);

}  // namespace handeye
