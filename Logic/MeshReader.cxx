// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshReader.h"

#include "FileError.h"
#include "OverlayMesh.h"
#include "PlyReader.h"

#include <vtkCellArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSTLReader.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

namespace handeye
{

namespace
{

using io::FileError;

/// Takes VTK's messages while it lives and keeps the first complaint.
class ComplaintCatcher
{
public:
  ComplaintCatcher()
    : Before(vtkOutputWindow::GetInstance())
    , VerbosityBefore(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkOutputWindow::SetInstance(this->Window);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~ComplaintCatcher()
  {
    vtkLogger::SetStderrVerbosity(this->VerbosityBefore);
    vtkOutputWindow::SetInstance(this->Before);
  }
  ComplaintCatcher(const ComplaintCatcher&) = delete;
  ComplaintCatcher& operator=(const ComplaintCatcher&) = delete;

  const std::string& first() const { return this->Window->First; }

private:
  class Catcher : public vtkOutputWindow
  {
  public:
    static Catcher* New();
    vtkTypeMacro(Catcher, vtkOutputWindow)
    void DisplayText(const char* text) override { this->keep(text); }
    void DisplayErrorText(const char* text) override { this->keep(text); }
    void DisplayWarningText(const char* text) override { this->keep(text); }
    void DisplayGenericWarningText(const char* text) override { this->keep(text); }
    void DisplayDebugText(const char*) override {}

    std::string First;

  private:
    void keep(const char* text)
    {
      if (this->First.empty())
      {
        this->First = withoutPlace(text);
      }
    }
    static std::string withoutPlace(std::string text);
  };

  vtkSmartPointer<vtkOutputWindow> Before;
  vtkLogger::Verbosity VerbosityBefore;
  vtkNew<Catcher> Window;
};

vtkStandardNewMacro(ComplaintCatcher::Catcher);

/// "ERROR: In file.cxx, line 1\nvtkClass (0x55): what is wrong\n\n" -> "what is wrong"
std::string ComplaintCatcher::Catcher::withoutPlace(std::string text)
{
  if (const std::size_t firstLine = text.find(", line "); firstLine != std::string::npos && text.find('\n') != std::string::npos)
  {
    text.erase(0, text.find('\n') + 1);
  }
  if (const std::size_t object = text.find("): "); object != std::string::npos && text.rfind("vtk", 0) == 0)
  {
    text.erase(0, object + 3);
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.'))
  {
    text.pop_back();
  }
  return text;
}

std::string lowerCaseEnding(const std::filesystem::path& path)
{
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return ending;
}

std::uintmax_t checkedFileSize(const std::filesystem::path& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error))
  {
    throw FileError(path, "there is no such file");
  }
  if (std::filesystem::is_directory(path, error))
  {
    throw FileError(path, "this is a folder, expected a mesh file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || !std::ifstream(path, std::ios::binary))
  {
    throw FileError(path, "the file cannot be opened");
  }
  if (size == 0)
  {
    throw FileError(path, "the file is empty");
  }
  return size;
}

template<typename Reader> vtkSmartPointer<vtkPolyData> readWith(const std::filesystem::path& path)
{
  ComplaintCatcher complaints;
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  if (!complaints.first().empty())
  {
    throw FileError(path, "the mesh is damaged or cut short (" + complaints.first() + ")");
  }
  return reader->GetOutput();
}

/// What a text file that was written to its end has near that end.
bool endsWith(const std::filesystem::path& path, std::uintmax_t size, const std::string& closing)
{
  const std::uintmax_t length = std::min<std::uintmax_t>(size, 4096);
  std::string tail(length, '\0');
  std::ifstream file(path, std::ios::binary);
  file.seekg(std::streamoff(size - length));
  file.read(tail.data(), std::streamsize(length));
  return tail.find(closing) != std::string::npos;
}

/// A binary STL file says how many triangles it holds: 50 bytes each after a header of 80 bytes and that number. VTK reads what is
/// there and says nothing.
void checkStlLength(const std::filesystem::path& path, std::uintmax_t size)
{
  std::ifstream file(path, std::ios::binary);
  std::string head(84, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + 80, sizeof(count));
  const std::uintmax_t expected = 84 + 50 * std::uintmax_t(count);
  if (file && size == expected)
  {
    return;
  }
  if (head.compare(0, 5, "solid") != 0)
  {
    throw FileError(path,
      size < 84 ? "the file is too short for STL"
                : "the STL file says it holds " + std::to_string(count) + " triangles, which are " + std::to_string(expected) +
          " bytes, but it has " + std::to_string(size) + " bytes");
  }
  if (!endsWith(path, size, "endsolid"))
  {
    throw FileError(path, "the STL file is cut short: it does not end with 'endsolid'");
  }
}

vtkSmartPointer<vtkPolyData> readLegacy(const std::filesystem::path& path)
{
  bool isPolyData = false;
  {
    ComplaintCatcher complaints;
    vtkNew<vtkPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    isPolyData = reader->IsFilePolyData() != 0;
  }
  if (!isPolyData)
  {
    throw FileError(path, "this is not a legacy VTK file with 'DATASET POLYDATA'");
  }
  return readWith<vtkPolyDataReader>(path);
}

vtkSmartPointer<vtkPolyData> readXml(const std::filesystem::path& path, std::uintmax_t size)
{
  bool isPolyData = false;
  {
    ComplaintCatcher complaints;
    vtkNew<vtkXMLPolyDataReader> reader;
    isPolyData = reader->CanReadFile(path.c_str()) != 0;
  }
  if (!isPolyData)
  {
    throw FileError(path, "this is not a VTK XML file of type 'PolyData'");
  }
  if (!endsWith(path, size, "</VTKFile>"))
  {
    throw FileError(path, "the VTK XML file is cut short: it does not end with '</VTKFile>'");
  }
  return readWith<vtkXMLPolyDataReader>(path);
}

vtkSmartPointer<vtkPolyData> readRaw(const std::filesystem::path& path)
{
  const std::uintmax_t size = checkedFileSize(path);
  const std::string ending = lowerCaseEnding(path);
  if (ending == ".stl")
  {
    checkStlLength(path, size);
    return readWith<vtkSTLReader>(path);
  }
  if (ending == ".ply")
  {
    return readPly(path);
  }
  if (ending == ".obj")
  {
    return readWith<vtkOBJReader>(path);
  }
  if (ending == ".vtp")
  {
    return readXml(path, size);
  }
  if (ending == ".vtk")
  {
    return readLegacy(path);
  }
  throw FileError(path, "'" + ending + "' is not a kind of mesh known here, expected .stl, .ply, .obj, .vtp or .vtk");
}

void checkPointIds(const std::filesystem::path& path, vtkCellArray* cells, vtkIdType pointCount)
{
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    vtkIdType count;
    const vtkIdType* ids;
    cells->GetCellAtId(cell, count, ids);
    if (std::any_of(ids, ids + count, [pointCount](vtkIdType id) { return id < 0 || id >= pointCount; }))
    {
      throw FileError(path,
        "the mesh is damaged: face " + std::to_string(cell + 1) + " names a point that is not among the " +
          std::to_string(pointCount) + " points");
    }
  }
}

void checkGeometry(const std::filesystem::path& path, vtkPolyData* mesh)
{
  const vtkIdType pointCount = mesh->GetNumberOfPoints();
  for (vtkIdType point = 0; point < pointCount; ++point)
  {
    double position[3];
    mesh->GetPoint(point, position);
    if (!std::isfinite(position[0]) || !std::isfinite(position[1]) || !std::isfinite(position[2]))
    {
      throw FileError(path, "coordinates of point " + std::to_string(point + 1) + " are not finite numbers");
    }
  }
  for (vtkCellArray* cells : { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() })
  {
    checkPointIds(path, cells, pointCount);
  }
}

}  // namespace

vtkSmartPointer<vtkPolyData> readMesh(const std::filesystem::path& path)
{
  vtkSmartPointer<vtkPolyData> raw;
  try
  {
    raw = readRaw(path);
  }
  catch (const std::bad_alloc&)
  {
    throw FileError(path, "the file announces more than fits into memory");
  }
  checkGeometry(path, raw);
  vtkSmartPointer<vtkPolyData> mesh;
  if (raw->GetNumberOfPoints() > 0)
  {
    mesh = triangulatedWithNormals(raw);
  }
  if (!mesh || mesh->GetNumberOfPolys() == 0)
  {
    throw FileError(path, "the file holds no triangles");
  }
  return mesh;
}

}  // namespace handeye
