// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AtomicFile.h"
#include "NamedTransform.h"
#include "NumberText.h"

#include <pugixml.hpp>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace handeye::io
{

namespace
{

std::string matrixText(const Eigen::Matrix4d& matrix, const std::string& betweenRows)
{
  std::string text;
  for (int i = 0; i < 16; ++i)
  {
    text += (i == 0 ? "" : i % 4 == 0 ? betweenRows : " ") + formatDouble(matrix(i / 4, i % 4));
  }
  return text;
}

void saveXml(const std::filesystem::path& path, const pugi::xml_document& document)
{
  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  writeFileAtomically(path, text.str());
}

void checkFrameName(const std::string& name)
{
  if (name.empty() || name.find("To") != std::string::npos || name.find_first_of(" \t\r\n\"'<>&") != std::string::npos)
  {
    throw std::invalid_argument("'" + name + "' is no name for a frame: one without \"To\", blanks and quotes is expected");
  }
}

void appendTransformNode(pugi::xml_node scene, const NamedTransform& transform, std::size_t index)
{
  const std::string number = std::to_string(index + 1);
  pugi::xml_node node = scene.append_child("LinearTransform");
  node.append_attribute("id") = ("vtkMRMLLinearTransformNode" + number).c_str();
  node.append_attribute("name") = transform.name().c_str();
  node.append_attribute("hideFromEditors") = "false";
  node.append_attribute("selectable") = "true";
  node.append_attribute("matrixTransformToParent") = matrixText(transform.transform.matrix(), "  ").c_str();
}

void appendModelNodes(pugi::xml_node scene, const SceneModel& model, std::size_t index, const std::string& transformId)
{
  const std::string number = std::to_string(index + 1);
  const std::string displayId = "vtkMRMLModelDisplayNode" + number, storageId = "vtkMRMLModelStorageNode" + number;
  pugi::xml_node display = scene.append_child("ModelDisplay");
  display.append_attribute("id") = displayId.c_str();
  display.append_attribute("name") = (model.name + "Display").c_str();
  display.append_attribute("color") = "0.89 0.85 0.78";
  display.append_attribute("visibility") = "true";
  pugi::xml_node storage = scene.append_child("ModelStorage");
  storage.append_attribute("id") = storageId.c_str();
  storage.append_attribute("name") = (model.name + "Storage").c_str();
  storage.append_attribute("fileName") = model.file.generic_string().c_str();
  storage.append_attribute("coordinateSystem") = "RAS";
  pugi::xml_node node = scene.append_child("Model");
  node.append_attribute("id") = ("vtkMRMLModelNode" + number).c_str();
  node.append_attribute("name") = model.name.c_str();
  std::string references = "display:" + displayId + ";storage:" + storageId + ";";
  if (!transformId.empty())
  {
    references += "transform:" + transformId + ";";
    node.append_attribute("transformNodeRef") = transformId.c_str();
  }
  node.append_attribute("storageNodeRef") = storageId.c_str();
  node.append_attribute("displayNodeRef") = displayId.c_str();
  node.append_attribute("references") = references.c_str();
}

}  // namespace

std::optional<std::pair<std::string, std::string>> splitTransformName(const std::string& name)
{
  const std::size_t at = name.find("To");
  if (at == std::string::npos || at == 0 || at + 2 >= name.size() || name.find("To", at + 1) != std::string::npos)
  {
    return std::nullopt;
  }
  return std::make_pair(name.substr(0, at), name.substr(at + 2));
}

void writePlusConfiguration(const std::filesystem::path& path, const std::vector<NamedTransform>& transforms)
{
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("PlusConfiguration");
  root.append_attribute("version") = "2.1";
  pugi::xml_node definitions = root.append_child("CoordinateDefinitions");
  definitions.append_child(pugi::node_comment)
    .set_value(" p_To = Matrix * p_From, mm; 16 numbers row by row. Camera: OpenCV's frame (x right, y down, z forward). ");
  for (const NamedTransform& transform : transforms)
  {
    checkFrameName(transform.from);
    checkFrameName(transform.to);
    pugi::xml_node node = definitions.append_child("Transform");
    node.append_attribute("From") = transform.from.c_str();
    node.append_attribute("To") = transform.to.c_str();
    node.append_attribute("Matrix") = matrixText(transform.transform.matrix(), "  ").c_str();
    node.append_attribute("Error") = transform.errorMm ? formatDouble(*transform.errorMm).c_str() : "";
    node.append_attribute("Date") = transform.date.c_str();
  }
  saveXml(path, document);
}

void writeItkTransform(const std::filesystem::path& path, const NamedTransform& transform)
{
  const Eigen::Matrix4d flip = Eigen::Vector4d(-1, -1, 1, 1).asDiagonal();
  const Eigen::Matrix4d fromParent = transform.transform.inverse().matrix();
  const Eigen::Matrix4d fromParent_Lps = (flip * fromParent * flip).eval();
  std::string text = "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\nParameters:";
  for (int i = 0; i < 9; ++i)
  {
    text += " " + formatDouble(fromParent_Lps(i / 3, i % 3));
  }
  for (int i = 0; i < 3; ++i)
  {
    text += " " + formatDouble(fromParent_Lps(i, 3));
  }
  writeFileAtomically(path, text + "\nFixedParameters: 0 0 0\n");
}

void writeMrmlScene(
  const std::filesystem::path& path, const std::vector<NamedTransform>& transforms, const std::vector<SceneModel>& models)
{
  pugi::xml_document document;
  pugi::xml_node scene = document.append_child("MRML");
  scene.append_attribute("version") = "Slicer4.4.0";
  scene.append_attribute("userTags") = "";
  scene.append_child(pugi::node_comment)
    .set_value(
      " p_To = matrixTransformToParent * p_From, mm, 16 numbers row by row; the node <From>To<To> takes what is in the frame "
      "From. Camera: OpenCV's frame (x right, y down, z forward). ");
  for (std::size_t i = 0; i < transforms.size(); ++i)
  {
    appendTransformNode(scene, transforms[i], i);
  }
  for (std::size_t i = 0; i < models.size(); ++i)
  {
    const auto found = std::find_if(transforms.begin(), transforms.end(),
      [&](const NamedTransform& transform) { return transform.name() == models[i].transformName; });
    if (found == transforms.end() && !models[i].transformName.empty())
    {
      throw std::invalid_argument("there is no transform '" + models[i].transformName + "' for the model '" + models[i].name + "'");
    }
    const std::string transformId =
      found == transforms.end() ? "" : "vtkMRMLLinearTransformNode" + std::to_string(found - transforms.begin() + 1);
    appendModelNodes(scene, models[i], i, transformId);
  }
  saveXml(path, document);
}

void writeMatrix4x4(const std::filesystem::path& path, const NamedTransform& transform)
{
  writeFileAtomically(path,
    "# " + transform.name() + ": p_" + transform.to + " = M * p_" + transform.from + ", mm\n" +
      matrixText(transform.transform.matrix(), "\n") + "\n");
}

}  // namespace handeye::io
