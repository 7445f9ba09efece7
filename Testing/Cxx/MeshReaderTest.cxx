// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshReader.h"

#include "FileError.h"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCubeSource.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkSphereSource.h>
#include <vtkStripper.h>
#include <vtkXMLPolyDataWriter.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

// With the address sanitizer, too, a request for more memory than there is shall fail and not end the program.
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options()
{
  return "allocator_may_return_null=1";
}

namespace
{

namespace fs = std::filesystem;
using handeye::readMesh;
using handeye::io::FileError;

fs::path outputPath(const std::string& name)
{
  const fs::path folder = fs::path(HANDEYE_TEST_OUTPUT_DIR) / "MeshReader";
  fs::create_directories(folder);
  return folder / name;
}

fs::path writeText(const std::string& name, const std::string& text)
{
  const fs::path path = outputPath(name);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string bytesOf(const fs::path& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

std::string complaintAbout(const fs::path& path)
{
  try
  {
    static_cast<void>(readMesh(path));
  }
  catch (const FileError& error)
  {
    return error.what();
  }
  return "";
}

vtkSmartPointer<vtkPolyData> sphere()
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(25);
  source->SetCenter(100, -40, 7);
  source->SetThetaResolution(24);
  source->SetPhiResolution(16);
  source->Update();
  return source->GetOutput();
}

template<typename Writer>
fs::path writeSphere(
  const std::string& name, const std::function<void(Writer*)>& set = [](Writer*) {})
{
  const fs::path path = outputPath(name);
  vtkNew<Writer> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(sphere());
  set(writer);
  writer->Write();
  return path;
}

struct Format
{
  std::string name;
  std::function<fs::path()> write;
};

std::ostream& operator<<(std::ostream& stream, const Format& format)
{
  return stream << format.name;
}

std::vector<Format> countedFormats()
{
  return {
    { "StlBinary", [] { return writeSphere<vtkSTLWriter>("binary.stl", [](auto* w) { w->SetFileTypeToBinary(); }); } },
    { "StlText", [] { return writeSphere<vtkSTLWriter>("text.stl", [](auto* w) { w->SetFileTypeToASCII(); }); } },
    { "PlyBinary", [] { return writeSphere<vtkPLYWriter>("binary.ply", [](auto* w) { w->SetFileTypeToBinary(); }); } },
    { "PlyText", [] { return writeSphere<vtkPLYWriter>("text.ply", [](auto* w) { w->SetFileTypeToASCII(); }); } },
    { "Vtp", [] { return writeSphere<vtkXMLPolyDataWriter>("mesh.vtp"); } },
    { "VtpText", [] { return writeSphere<vtkXMLPolyDataWriter>("text.vtp", [](auto* w) { w->SetDataModeToAscii(); }); } },
    { "VtkBinary", [] { return writeSphere<vtkPolyDataWriter>("binary.vtk", [](auto* w) { w->SetFileTypeToBinary(); }); } },
    { "VtkText", [] { return writeSphere<vtkPolyDataWriter>("text.vtk", [](auto* w) { w->SetFileTypeToASCII(); }); } },
  };
}

std::vector<Format> allFormats()
{
  std::vector<Format> formats = countedFormats();
  formats.push_back({ "Obj", [] { return writeSphere<vtkOBJWriter>("mesh.obj"); } });
  return formats;
}

class MeshReaderFormat : public testing::TestWithParam<Format>
{
};

/// Formats whose files say how much there is to come.
class MeshReaderCountedFormat : public testing::TestWithParam<Format>
{
};

}  // namespace

TEST_P(MeshReaderFormat, Sphere_IsReadWhole)
{
  const auto mesh = readMesh(GetParam().write());
  const auto expected = sphere();
  EXPECT_EQ(mesh->GetNumberOfPolys(), expected->GetNumberOfPolys());
  double bounds[6], expectedBounds[6];
  mesh->GetBounds(bounds);
  expected->GetBounds(expectedBounds);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_NEAR(bounds[i], expectedBounds[i], 1e-3);
  }
  ASSERT_NE(mesh->GetPointData()->GetNormals(), nullptr);
  EXPECT_EQ(mesh->GetPointData()->GetNormals()->GetNumberOfTuples(), mesh->GetNumberOfPoints());
}

TEST_P(MeshReaderCountedFormat, CutShort_IsRefused)
{
  const fs::path whole = GetParam().write();
  const std::string bytes = bytesOf(whole);
  for (const double part : { 0.999, 0.9, 0.5, 0.2, 0.05, 0.01 })
  {
    const fs::path cut = writeText("cut_" + whole.filename().string(), bytes.substr(0, std::size_t(double(bytes.size()) * part)));
    EXPECT_THROW(static_cast<void>(readMesh(cut)), FileError) << part << " of the file";
  }
}

TEST_P(MeshReaderFormat, OtherContents_AreRefused)
{
  const std::string ending = GetParam().write().extension().string();
  EXPECT_THROW(static_cast<void>(readMesh(writeText("prose" + ending, "This is a text and no mesh.\n"))), FileError);
  EXPECT_THROW(static_cast<void>(readMesh(writeText("zeros" + ending, std::string(5000, '\0')))), FileError);
  EXPECT_NE(complaintAbout(writeText("empty" + ending, "")).find("is empty"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
  All, MeshReaderFormat, testing::ValuesIn(allFormats()), [](const auto& format) { return format.param.name; });
INSTANTIATE_TEST_SUITE_P(
  All, MeshReaderCountedFormat, testing::ValuesIn(countedFormats()), [](const auto& format) { return format.param.name; });

TEST(MeshReader, UpperCaseEnding_IsTheSame)
{
  const fs::path upper = outputPath("UPPER.STL");
  fs::copy_file(writeSphere<vtkSTLWriter>("lower.stl"), upper, fs::copy_options::overwrite_existing);
  EXPECT_GT(readMesh(upper)->GetNumberOfPolys(), 0);
}

TEST(MeshReader, ObjCutBetweenTwoLines_IsASmallerMesh)
{
  const fs::path whole = writeSphere<vtkOBJWriter>("whole.obj");
  const std::string bytes = bytesOf(whole);
  const std::string::size_type middleOfFaces = (bytes.find("\nf ") + bytes.size()) / 2;
  const auto cut = readMesh(writeText("between_lines.obj", bytes.substr(0, bytes.rfind('\n', middleOfFaces) + 1)));
  EXPECT_NEAR(double(cut->GetNumberOfPolys()), sphere()->GetNumberOfPolys() / 2.0, sphere()->GetNumberOfPolys() / 20.0)
    << "the format does not say how many faces there are";
}

TEST(MeshReader, QuadsAndStrips_BecomeTriangles)
{
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkPolyDataWriter> writer;
  const fs::path quads = outputPath("quads.vtk");
  writer->SetFileName(quads.c_str());
  writer->SetInputConnection(cube->GetOutputPort());
  writer->Write();
  EXPECT_EQ(readMesh(quads)->GetNumberOfPolys(), 12);

  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(sphere());
  const fs::path strips = outputPath("strips.vtk");
  writer->SetFileName(strips.c_str());
  writer->SetInputConnection(stripper->GetOutputPort());
  writer->Write();
  const auto mesh = readMesh(strips);
  EXPECT_EQ(mesh->GetNumberOfPolys(), sphere()->GetNumberOfPolys());
  EXPECT_EQ(mesh->GetNumberOfStrips(), 0);
}

TEST(MeshReader, MissingFile_IsNamed)
{
  const std::string complaint = complaintAbout("/nowhere/vertebra.stl");
  EXPECT_EQ(complaint, "/nowhere/vertebra.stl: there is no such file");
  EXPECT_NE(complaintAbout(fs::path(HANDEYE_TEST_OUTPUT_DIR)).find("this is a folder"), std::string::npos);
}

TEST(MeshReader, UnknownEnding_SaysWhichAreKnown)
{
  const std::string complaint = complaintAbout(writeText("model.step", "ISO-10303-21;"));
  EXPECT_NE(complaint.find("'.step'"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find(".stl, .ply, .obj, .vtp or .vtk"), std::string::npos) << complaint;
}

TEST(MeshReader, VolumeInLegacyFile_IsRefused)
{
  const std::string complaint = complaintAbout(writeText("volume.vtk",
    "# vtk DataFile Version 3.0\nvolume\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n"));
  EXPECT_NE(complaint.find("DATASET POLYDATA"), std::string::npos) << complaint;
}

TEST(MeshReader, FacesNamingMissingPoints_AreRefused)
{
  EXPECT_THROW(static_cast<void>(readMesh(writeText("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"))), FileError);
  EXPECT_THROW(static_cast<void>(readMesh(writeText("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"))), FileError);
  EXPECT_THROW(
    static_cast<void>(readMesh(writeText("range.vtk",
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 9\n"))),
    FileError);
  EXPECT_THROW(static_cast<void>(readMesh(writeText("range.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n"))),
    FileError);
}

TEST(MeshReader, NonFiniteCoordinates_AreRefused)
{
  const std::string complaint = complaintAbout(writeText("nan.vtk",
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 nan 1 0\nPOLYGONS 1 4\n3 0 1 2\n"));
  EXPECT_FALSE(complaint.empty());
}

TEST(MeshReader, AbsurdCounts_AreRefused)
{
  const std::string vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS ";
  EXPECT_THROW(static_cast<void>(readMesh(writeText("huge.vtk", vtk + "900000000000000 float\n0 0 0\n"))), FileError);
  EXPECT_THROW(static_cast<void>(readMesh(writeText("negative.vtk", vtk + "-5 float\n0 0 0\n"))), FileError);
  const std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex 900000000000000\n";
  EXPECT_THROW(static_cast<void>(readMesh(writeText("huge.ply", ply + "property float x\nend_header\nabcdefgh"))), FileError);
  EXPECT_THROW(static_cast<void>(readMesh(writeText("nothing.ply", ply + "end_header\n"))), FileError);
}

TEST(MeshReader, PointsWithoutTriangles_AreRefused)
{
  const std::string complaint = complaintAbout(writeText("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
  EXPECT_NE(complaint.find("no triangles"), std::string::npos) << complaint;
}

TEST(MeshReader, Complaints_DoNotReachTheConsole)
{
  testing::internal::CaptureStderr();
  static_cast<void>(complaintAbout(
    writeText("damaged.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 30 float\n0 0 0 1 0 0\n")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}
