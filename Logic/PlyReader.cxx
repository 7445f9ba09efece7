// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlyReader.h"

#include "FileError.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace handeye
{

namespace
{

using io::FileError;

enum class Encoding
{
  Text,
  LittleEndian,
  BigEndian
};

/// How a number is stored.
struct NumberType
{
  std::size_t size = 0;
  bool real = false;
  bool negative = false;  ///< a whole number that may be negative
};

struct Property
{
  std::string name;
  std::optional<NumberType> countType;  ///< of a list
  NumberType type;
};

struct Element
{
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header
{
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
};

NumberType parseType(const std::filesystem::path& path, const std::string& word)
{
  static const std::map<std::string, NumberType> types = { { "char", { 1, false, true } }, { "int8", { 1, false, true } },
    { "uchar", { 1, false, false } }, { "uint8", { 1, false, false } }, { "short", { 2, false, true } },
    { "int16", { 2, false, true } }, { "ushort", { 2, false, false } }, { "uint16", { 2, false, false } },
    { "int", { 4, false, true } }, { "int32", { 4, false, true } }, { "uint", { 4, false, false } },
    { "uint32", { 4, false, false } }, { "float", { 4, true, true } }, { "float32", { 4, true, true } },
    { "double", { 8, true, true } }, { "float64", { 8, true, true } } };
  const auto found = types.find(word);
  if (found == types.end())
  {
    throw FileError(path, "'" + word + "' is not a type of PLY, expected one such as 'float' or 'uchar'");
  }
  return found->second;
}

Encoding parseEncoding(const std::filesystem::path& path, const std::string& word)
{
  static const std::map<std::string, Encoding> encodings = { { "ascii", Encoding::Text },
    { "binary_little_endian", Encoding::LittleEndian }, { "binary_big_endian", Encoding::BigEndian } };
  const auto found = encodings.find(word);
  if (found == encodings.end())
  {
    throw FileError(path, "'" + word + "' is not a format of PLY, expected 'ascii' or 'binary_little_endian'");
  }
  return found->second;
}

Property parseProperty(const std::filesystem::path& path, std::istringstream& words)
{
  Property property;
  std::string type, countType;
  words >> type;
  if (type == "list")
  {
    words >> countType >> type;
    property.countType = parseType(path, countType);
  }
  property.type = parseType(path, type);
  words >> property.name;
  return property;
}

void parseLine(const std::filesystem::path& path, const std::string& line, Header& header)
{
  std::istringstream words(line);
  std::string keyword, word;
  words >> keyword;
  if (keyword == "format")
  {
    words >> word;
    header.encoding = parseEncoding(path, word);
  }
  else if (keyword == "element")
  {
    Element element;
    if (!(words >> element.name >> element.count))
    {
      throw FileError(path, "'" + line + "' does not say which element and how many of it");
    }
    header.elements.push_back(element);
  }
  else if (keyword == "property" && !header.elements.empty())
  {
    header.elements.back().properties.push_back(parseProperty(path, words));
  }
}

Header readHeader(const std::filesystem::path& path, std::istream& file)
{
  Header header;
  std::string line;
  std::getline(file, line);
  if (line != "ply" && line != "ply\r")
  {
    throw FileError(path, "this is not a PLY file: it does not begin with 'ply'");
  }
  while (std::getline(file, line))
  {
    if (line.rfind("end_header", 0) == 0)
    {
      return header;
    }
    parseLine(path, line, header);
  }
  throw FileError(path, "the PLY header is cut short: there is no 'end_header'");
}

/// The numbers behind the header, one after the other.
class NumberSource
{
public:
  NumberSource(std::istream& file, Encoding encoding)
    : File(file)
    , Encoded(encoding)
  {
  }

  /// @return nothing at the file's end, or where there is no number
  std::optional<double> next(const NumberType& type)
  {
    if (this->Encoded == Encoding::Text)
    {
      double number = 0;
      return this->File >> number ? std::optional(number) : std::nullopt;
    }
    std::array<unsigned char, 8> bytes{};
    if (!this->File.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(type.size)))
    {
      return {};
    }
    if (this->Encoded == Encoding::LittleEndian)
    {
      std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(type.size));
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.size; ++i)
    {
      bits = bits << 8 | bytes[i];
    }
    return decode(bits, type);
  }

private:
  static double decode(std::uint64_t bits, const NumberType& type)
  {
    if (type.real && type.size == 8)
    {
      double number;
      std::memcpy(&number, &bits, sizeof(number));
      return number;
    }
    if (type.real)
    {
      const auto low = static_cast<std::uint32_t>(bits);
      float number;
      std::memcpy(&number, &low, sizeof(number));
      return number;
    }
    const bool minus = type.negative && (bits >> (8 * type.size - 1));
    return minus ? double(bits) - std::ldexp(1.0, int(8 * type.size)) : double(bits);
  }

  std::istream& File;
  Encoding Encoded;
};

/// Puts what is read into a mesh.
class MeshBuilder
{
public:
  void addVertex(std::map<std::string, double>& values)
  {
    this->Points->InsertNextPoint(values["x"], values["y"], values["z"]);
    if (values.count("nx") && values.count("ny") && values.count("nz"))
    {
      this->Normals->InsertNextTuple3(values["nx"], values["ny"], values["nz"]);
    }
  }

  /// Point ids that cannot be ones become -1, which readMesh() refuses.
  void addFace(const std::vector<double>& pointIds)
  {
    this->Faces->InsertNextCell(vtkIdType(pointIds.size()));
    for (const double id : pointIds)
    {
      this->Faces->InsertCellPoint(id >= 0 && id < 4294967296.0 && id == std::floor(id) ? vtkIdType(id) : -1);
    }
  }

  vtkSmartPointer<vtkPolyData> mesh()
  {
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(this->Points);
    mesh->SetPolys(this->Faces);
    if (this->Normals->GetNumberOfTuples() == this->Points->GetNumberOfPoints())
    {
      mesh->GetPointData()->SetNormals(this->Normals);
    }
    return mesh;
  }

  MeshBuilder()
  {
    this->Normals->SetName("Normals");
    this->Normals->SetNumberOfComponents(3);
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Faces;
  vtkNew<vtkFloatArray> Normals;
};

/// One of an element. @return false if the file ends before, or holds something else than the header says
bool readOne(const Element& element, NumberSource& numbers, MeshBuilder& builder)
{
  std::map<std::string, double> scalars;
  std::vector<double> face;
  for (const Property& property : element.properties)
  {
    const std::optional<double> count = property.countType ? numbers.next(*property.countType) : 1.0;
    if (!count || !(*count >= 0) || *count != std::floor(*count))
    {
      return false;
    }
    std::vector<double> values;
    for (double i = 0; i < *count; ++i)
    {
      const std::optional<double> value = numbers.next(property.type);
      if (!value)
      {
        return false;
      }
      values.push_back(*value);
    }
    if (!property.countType)
    {
      scalars[property.name] = values.front();
    }
    else if (property.name == "vertex_indices" || property.name == "vertex_index")
    {
      face = values;
    }
  }
  if (element.name == "vertex")
  {
    builder.addVertex(scalars);
  }
  else if (element.name == "face")
  {
    builder.addFace(face);
  }
  return true;
}

void checkHasCoordinates(const std::filesystem::path& path, const Element& element)
{
  for (const std::string name : { "x", "y", "z" })
  {
    if (std::none_of(element.properties.begin(), element.properties.end(),
          [&name](const Property& property) { return property.name == name && !property.countType; }))
    {
      throw FileError(path, "the PLY file's element 'vertex' has no property '" + name + "'");
    }
  }
}

}  // namespace

vtkSmartPointer<vtkPolyData> readPly(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  const Header header = readHeader(path, file);
  NumberSource numbers(file, header.encoding);
  MeshBuilder builder;
  for (const Element& element : header.elements)
  {
    if (element.name == "vertex")
    {
      checkHasCoordinates(path, element);
    }
    for (std::uint64_t done = 0; done < element.count && !element.properties.empty(); ++done)
    {
      if (!readOne(element, numbers, builder))
      {
        throw FileError(path,
          "the PLY file is damaged or cut short: it announces " + std::to_string(element.count) + " of '" + element.name +
            "' and has " + std::to_string(done));
      }
    }
  }
  return builder.mesh();
}

}  // namespace handeye
