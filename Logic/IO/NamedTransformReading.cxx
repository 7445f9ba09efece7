// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraFile.h"
#include "FileError.h"
#include "NamedTransform.h"
#include "NumberText.h"
#include "RigidTransform.h"
#include "TextFile.h"
#include "TextTables.h"

#include <pugixml.hpp>

namespace handeye::io
{

namespace
{

using Path = std::filesystem::path;

constexpr std::size_t LargestTransformFile = std::size_t(64) << 20;

Eigen::Isometry3d rigidFromText(const Path& path, std::string_view text, const std::string& what)
{
  const std::vector<std::string_view> words = splitWords(text);
  Eigen::Matrix4d matrix;
  bool isMatrix = words.size() == 16;
  for (std::size_t i = 0; isMatrix && i < 16; ++i)
  {
    const std::optional<double> number = parseDouble(words[i]);
    isMatrix = number.has_value();
    matrix(Eigen::Index(i / 4), Eigen::Index(i % 4)) = number.value_or(0);
  }
  const std::optional<Eigen::Isometry3d> rigid = isMatrix ? toRigid(matrix) : std::nullopt;
  if (!rigid)
  {
    throw FileError(
      path, "the matrix of " + what + " is not rigid; 16 numbers row by row were expected, a rotation and a translation");
  }
  return *rigid;
}

/// Frames from a name like "MarkerToCamera"; none where it is not one.
NamedTransform named(const std::string& name, const Eigen::Isometry3d& transform)
{
  NamedTransform result;
  if (const auto frames = splitTransformName(name))
  {
    result.from = frames->first;
    result.to = frames->second;
  }
  result.transform = transform;
  return result;
}

std::vector<NamedTransform> readPlus(const Path& path, const pugi::xml_node& definitions)
{
  std::vector<NamedTransform> transforms;
  for (const pugi::xml_node& node : definitions.children("Transform"))
  {
    NamedTransform transform;
    transform.from = node.attribute("From").value();
    transform.to = node.attribute("To").value();
    const std::string what = "the Transform from " + inQuotes(transform.from) + " to " + inQuotes(transform.to);
    if (transform.from.empty() || transform.to.empty())
    {
      throw FileError(path, what + " has no From or no To; both were expected");
    }
    transform.transform = rigidFromText(path, node.attribute("Matrix").value(), what);
    transform.errorMm = parseDouble(node.attribute("Error").value());
    transform.date = node.attribute("Date").value();
    transforms.push_back(std::move(transform));
  }
  return transforms;
}

std::vector<NamedTransform> readMrml(const Path& path, const pugi::xml_node& scene)
{
  std::vector<NamedTransform> transforms;
  for (const pugi::xml_node& node : scene.children())
  {
    const std::string matrix = node.attribute("matrixTransformToParent").value();
    if (!matrix.empty())
    {
      const std::string name = node.attribute("name").value();
      transforms.push_back(named(name, rigidFromText(path, matrix, "the node " + inQuotes(name))));
    }
  }
  return transforms;
}

std::vector<NamedTransform> readXml(const Path& path, const std::string& text)
{
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result)
  {
    throw FileError(path, std::string("the XML is cut short or damaged (") + result.description() + ")");
  }
  if (const pugi::xml_node plus = document.child("PlusConfiguration"))
  {
    return readPlus(path, plus.child("CoordinateDefinitions"));
  }
  if (const pugi::xml_node scene = document.child("MRML"))
  {
    return readMrml(path, scene);
  }
  const CameraFile camera = readCameraFile(path);
  return camera.markerToCamera ? std::vector<NamedTransform>{ { "Marker", "Camera", *camera.markerToCamera, {}, {} } }
                               : std::vector<NamedTransform>();
}

/// The numbers behind "Parameters:" or "FixedParameters:" at the beginning of a line.
std::vector<double> itkNumbers(const Path& path, const std::string& text, const std::string& key, std::size_t count)
{
  const std::size_t at = text.find("\n" + key + ":");
  const std::size_t begin = at == std::string::npos ? text.size() : at + key.size() + 2;
  std::vector<double> numbers;
  for (std::string_view word : splitWords(std::string_view(text).substr(begin, text.find('\n', begin) - begin)))
  {
    const std::optional<double> number = parseDouble(word);
    if (!number)
    {
      throw FileError(path, "'" + key + "' has " + inQuotes(word) + ", which is not a number");
    }
    numbers.push_back(*number);
  }
  if (numbers.size() != count)
  {
    throw FileError(
      path, "'" + key + "' has " + std::to_string(numbers.size()) + " numbers; " + std::to_string(count) + " were expected");
  }
  return numbers;
}

/// See writeItkTransform(). The centre (fixed parameters) c acts as x -> A (x - c) + t + c.
std::vector<NamedTransform> readItk(const Path& path, const std::string& text)
{
  const bool isKnown = text.find("AffineTransform_double_3_3") != std::string::npos ||
    text.find("MatrixOffsetTransformBase_double_3_3") != std::string::npos;
  if (!isKnown || text.find("#Transform 1") != std::string::npos)
  {
    throw FileError(path, "one AffineTransform_double_3_3 (or MatrixOffsetTransformBase_double_3_3) was expected");
  }
  const std::vector<double> parameters = itkNumbers(path, text, "Parameters", 12);
  const std::vector<double> center = itkNumbers(path, text, "FixedParameters", 3);
  Eigen::Matrix4d fromParent_Lps = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 9; ++i)
  {
    fromParent_Lps(i / 3, i % 3) = parameters[std::size_t(i)];
  }
  const Eigen::Vector3d center_Lps = Eigen::Vector3d::Map(center.data());
  const Eigen::Vector3d shift_Lps = Eigen::Vector3d::Map(parameters.data() + 9) + center_Lps;
  fromParent_Lps.topRightCorner<3, 1>() = shift_Lps - fromParent_Lps.topLeftCorner<3, 3>() * center_Lps;
  const Eigen::Matrix4d flip = Eigen::Vector4d(-1, -1, 1, 1).asDiagonal();
  const std::optional<Eigen::Isometry3d> fromParent = toRigid((flip * fromParent_Lps * flip).eval());
  if (!fromParent)
  {
    throw FileError(path, "the transform is not rigid; a rotation and a translation were expected");
  }
  return { named(path.stem().string(), fromParent->inverse()) };
}

std::string listOf(const std::vector<NamedTransform>& transforms)
{
  std::string names;
  for (const NamedTransform& transform : transforms)
  {
    names += (names.empty() ? "" : ", ") + (transform.from.empty() ? std::string("one without a name") : transform.name());
  }
  return names.empty() ? "none" : names;
}

}  // namespace

std::vector<NamedTransform> readTransforms(const Path& path)
{
  const std::string text = readWholeFile(path, LargestTransformFile);
  const std::string_view content = trimmed(text);
  if (content.substr(0, 24) == "#Insight Transform File ")
  {
    return readItk(path, text);
  }
  if (!content.empty() && content[0] == '<')
  {
    return readXml(path, text);
  }
  if (!content.empty() && (content[0] == '{' || content[0] == '%' || content.find(':') < content.find('\n')) && content[0] != '#')
  {
    const CameraFile camera = readCameraFile(path);
    return camera.markerToCamera ? std::vector<NamedTransform>{ { "Marker", "Camera", *camera.markerToCamera, {}, {} } }
                                 : std::vector<NamedTransform>();
  }
  return { named(path.stem().string(), readMatrix4x4(path)) };
}

Eigen::Isometry3d readTransform(const Path& path, const std::string& name)
{
  const std::vector<NamedTransform> transforms = readTransforms(path);
  if (transforms.size() == 1 && (name.empty() || transforms[0].from.empty()))
  {
    return transforms[0].transform;
  }
  const auto frames = splitTransformName(name);
  for (const NamedTransform& transform : transforms)
  {
    if (!name.empty() && transform.name() == name)
    {
      return transform.transform;
    }
  }
  for (const NamedTransform& transform : transforms)
  {
    if (frames && transform.from == frames->second && transform.to == frames->first)
    {
      return transform.transform.inverse();
    }
  }
  throw FileError(
    path, "the transform " + inQuotes(name.empty() ? "<From>To<To>" : name) + " was expected; there are: " + listOf(transforms));
}

}  // namespace handeye::io
