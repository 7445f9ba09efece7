// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace handeye::io
{

/// A rigid transform with the names of its two frames: p_To = transform * p_From, mm. Numbers are as we use them; what other
/// programs
/// call RAS is, for them, the frame that these numbers are in.
struct NamedTransform
{
  std::string from;
  std::string to;
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  std::optional<double> errorMm;  ///< what a PLUS configuration calls Error
  std::string date;               ///< as the file has it; may be empty

  /// "MarkerToCamera"
  std::string name() const { return from + "To" + to; }
};

/// A mesh that a scene shows, and the transform it hangs under.
struct SceneModel
{
  std::string name;
  std::filesystem::path file;  ///< relative to the scene's folder, or absolute; its coordinates are taken as they are
  std::string transformName;   ///< "ModelToPhantom"; empty for none
};

/// The two frames of "MarkerToCamera"; nothing unless "To" occurs exactly once with a name on both sides, since PLUS could not tell
/// the frames apart then.
std::optional<std::pair<std::string, std::string>> splitTransformName(const std::string& name);

/// Writes `<PlusConfiguration>` with `<CoordinateDefinitions>`; matrices row by row. A comment states the convention.
/// @throws FileError where it cannot be written; std::invalid_argument for a frame name that is empty or holds "To" or quotes
void writePlusConfiguration(const std::filesystem::path& path, const std::vector<NamedTransform>& transforms);

/// Writes an ITK transform file as 3D Slicer reads it: AffineTransform_double_3_3, which maps from the parent (To) in LPS, so that
/// Slicer's ToParent matrix is `transform`:  T_file = D inverse(transform) D, D = diag(-1, -1, 1, 1). The format has no comments.
/// @throws FileError where it cannot be written
void writeItkTransform(const std::filesystem::path& path, const NamedTransform& transform);

/// Writes a MRML scene with one linear transform node each, and models in place under theirs. Model files are taken as RAS, so that
/// their numbers stay as they are.
/// @throws FileError where it cannot be written; std::invalid_argument for a model under a transform that is not in the list
void writeMrmlScene(
  const std::filesystem::path& path, const std::vector<NamedTransform>& transforms, const std::vector<SceneModel>& models = {});

/// Writes four rows of four numbers, with the name and the convention as comments in front (`#`), which readMatrix4x4() skips, as
/// numpy.loadtxt does.
/// @throws FileError where it cannot be written
void writeMatrix4x4(const std::filesystem::path& path, const NamedTransform& transform);

/// Reads the transforms of a PLUS configuration, a MRML scene, an ITK transform file, rows of numbers, or a calibration.json or
/// camera file with the marker's place; told apart by what is in the file. Where a file does not name the frames (ITK, rows), the
/// file's own name is taken if it has the form <From>To<To>.
/// @throws FileError naming what was expected
[[nodiscard]] std::vector<NamedTransform> readTransforms(const std::filesystem::path& path);

/// The transform of this name ("MarkerToCamera") in such a file, its inverse if only that is there; the only one if the name is
/// empty, or if the file does not name its only one.
/// @throws FileError, listing what is there, otherwise
[[nodiscard]] Eigen::Isometry3d readTransform(const std::filesystem::path& path, const std::string& name);

}  // namespace handeye::io
