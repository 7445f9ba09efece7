// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFileFormats.h"

#include "FileError.h"
#include "NumberText.h"

#include <algorithm>
#include <initializer_list>

namespace handeye::io
{

namespace
{

using Json = nlohmann::json;

/// The value of a key, null if there is none.
const Json& member(const Json& map, const std::string& key)
{
  static const Json nothing;
  const auto found = map.find(key);
  return found == map.end() ? nothing : *found;
}

/// The first of these keys that is there; the first of all if none is.
std::string firstKey(const Json& root, std::initializer_list<const char*> names)
{
  const auto found = std::find_if(names.begin(), names.end(), [&](const char* name) { return !member(root, name).is_null(); });
  return found == names.end() ? *names.begin() : *found;
}

void readImageSize(const std::filesystem::path& path, const Json& root, CameraNumbers& numbers)
{
  const std::string widthKey = firstKey(root, { "image_width", "image_Width", "Image_Width", "imageWidth", "width" });
  const std::string heightKey = firstKey(root, { "image_height", "image_Height", "Image_Height", "imageHeight", "height" });
  const Json& width = member(root, widthKey);
  const Json& height = member(root, heightKey);
  numbers.width = width.is_null() ? 0 : readCount(path, widthKey, width, 0, LargestImageSide);
  numbers.height = height.is_null() ? 0 : readCount(path, heightKey, height, 0, LargestImageSide);
  if ((numbers.width == 0) != (numbers.height == 0))
  {
    throw FileError(path, "only one of '" + widthKey + "' and '" + heightKey + "' is given; expected both sizes in pixels");
  }
}

/// The lens models that this program has.
void checkLensModel(const std::filesystem::path& path, const Json& root, const NumberTable& coefficients)
{
  const Json& fisheye = member(root, "fisheye_model");
  if (fisheye.is_number() && fisheye.get<double>() != 0)
  {
    throw FileError(path, "'fisheye_model' is set; expected a pinhole lens, fisheye lenses are not supported");
  }
  const Json& model = member(root, "distortion_model");
  if (model.is_null())
  {
    return;
  }
  const std::string name = model.is_string() ? model.get<std::string>() : model.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (name != "plumb_bob" && name != "rational_polynomial")
  {
    throw FileError(path, "'distortion_model' is " + inQuotes(name) + "; expected plumb_bob or rational_polynomial");
  }
  if (name == "plumb_bob" && coefficients.values.size() > 5)
  {
    throw FileError(path,
      "'" + coefficients.key + "' has " + std::to_string(coefficients.values.size()) +
        " numbers; expected at most 5 for the distortion_model plumb_bob");
  }
}

/// What SlicerPinholeCameras has beyond the lens.
void readMarker(const std::filesystem::path& path, const Json& root, CameraFile& file)
{
  if (!member(root, "MarkerToSensor").is_null())
  {
    file.markerToCamera = makeRigid(path, readTable(path, "MarkerToSensor", member(root, "MarkerToSensor")));
    if (file.markerToCamera->matrix().isIdentity(0))
    {
      file.warnings.push_back("'MarkerToSensor' is the identity, which SlicerPinholeCameras writes where nothing was calibrated");
    }
  }
  if (!member(root, "CameraPlaneOffset").is_null())
  {
    const NumberTable offset = readTable(path, "CameraPlaneOffset", member(root, "CameraPlaneOffset"));
    const bool isZero = std::all_of(offset.values.begin(), offset.values.end(), [](double value) { return value == 0; });
    if (!isZero)
    {
      file.warnings.push_back("'CameraPlaneOffset' is not zero; a pinhole camera has no such offset, and it is not used");
    }
  }
}

std::string formatOf(const Json& root, const std::string& matrixKey)
{
  if (matrixKey == "IntrinsicMatrix")
  {
    return "SlicerPinholeCameras";
  }
  if (matrixKey == "Intrinsics")
  {
    return "VASST";
  }
  const Json& matrix = member(root, matrixKey);
  const bool hasOpenCVType = matrix.is_object() && matrix.contains("dt");
  const bool isRos =
    matrixKey == "K" || matrixKey == "k" || !member(root, "distortion_model").is_null() || (matrix.is_object() && !hasOpenCVType);
  return isRos ? "ROS" : "OpenCV";
}

}  // namespace

CameraFile readOpenCVCamera(const std::filesystem::path& path, const Json& root)
{
  const std::string matrixKey = root.is_object()
    ? firstKey(root, { "camera_matrix", "Camera_Matrix", "IntrinsicMatrix", "Intrinsics", "K", "k" })
    : std::string();
  if (matrixKey.empty() || member(root, matrixKey).is_null())
  {
    throw FileError(path,
      "there is no 'camera_matrix' (nor 'Camera_Matrix', 'IntrinsicMatrix', 'Intrinsics' or 'K'); "
      "a camera file was expected");
  }
  const std::string coefficientsKey = firstKey(
    root, { "distortion_coefficients", "Distortion_Coefficients", "DistortionCoefficients", "Distortion_Parameters", "D", "d" });

  CameraNumbers numbers;
  readImageSize(path, root, numbers);
  numbers.cameraMatrix = readTable(path, matrixKey, member(root, matrixKey));
  numbers.coefficients = readTable(path, coefficientsKey, member(root, coefficientsKey));
  checkLensModel(path, root, numbers.coefficients);
  CameraFile file{ makeCamera(path, numbers), std::nullopt, formatOf(root, matrixKey), {} };
  readMarker(path, root, file);
  return file;
}

}  // namespace handeye::io
