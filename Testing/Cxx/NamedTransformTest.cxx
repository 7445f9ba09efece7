// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NamedTransform.h"
#include "IoTestSupport.h"
#include "Simulation.h"

namespace
{

using namespace handeye::io;
using handeye::test::typicalMarkerToCamera;
using test::TemporaryFolder;

std::vector<NamedTransform> examples()
{
  handeye::test::Random random(3);
  return { { "Marker", "Camera", typicalMarkerToCamera(), 0.42, "2024.05.17 13:45:01" },
    { "StylusTip", "Stylus", random.rigid(150), {}, "" }, { "Model", "Phantom", random.rigid(80), {}, "" } };
}

void expectNear(const Eigen::Isometry3d& read, const Eigen::Isometry3d& expected)
{
  EXPECT_LT((read.matrix() - expected.matrix()).norm(), 1e-11);
}

TEST(NamedTransform, PlusConfiguration_ReadsBack)
{
  const TemporaryFolder folder;
  writePlusConfiguration(folder.path() / "plus.xml", examples());
  const std::vector<NamedTransform> read = readTransforms(folder.path() / "plus.xml");
  ASSERT_EQ(read.size(), 3U);
  for (std::size_t i = 0; i < read.size(); ++i)
  {
    EXPECT_EQ(read[i].name(), examples()[i].name());
    EXPECT_EQ(read[i].errorMm, examples()[i].errorMm);
    EXPECT_EQ(read[i].date, examples()[i].date);
    expectNear(read[i].transform, examples()[i].transform);
  }
}

TEST(NamedTransform, PlusConfiguration_MapsAKnownPoint)
{
  const TemporaryFolder folder;
  const auto path = folder.write("plus.xml",
    "<PlusConfiguration version=\"2.1\"><CoordinateDefinitions>"
    "<Transform From=\"StylusTip\" To=\"Stylus\" Matrix=\"0 -1 0 10  1 0 0 20  0 0 1 30  0 0 0 1\"/>"
    "</CoordinateDefinitions></PlusConfiguration>");
  const Eigen::Vector3d mapped = readTransform(path, "StylusTipToStylus") * Eigen::Vector3d(1, 2, 3);
  EXPECT_LT((mapped - Eigen::Vector3d(8, 21, 33)).norm(), 1e-12);
  const Eigen::Vector3d back = readTransform(path, "StylusToStylusTip") * mapped;
  EXPECT_LT((back - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(NamedTransform, FrameNameWithTo_IsRefused)
{
  const TemporaryFolder folder;
  EXPECT_THROW(writePlusConfiguration(folder.path() / "plus.xml", { { "ToolTip", "Stylus", {}, {}, "" } }), std::invalid_argument);
  EXPECT_EQ(folder.entryCount(), 0U);
  EXPECT_FALSE(splitTransformName("ToolToTracker"));
  EXPECT_FALSE(splitTransformName("Tracker"));
  EXPECT_EQ(splitTransformName("StylusToTracker")->second, "Tracker");
}

TEST(NamedTransform, ItkTransform_IsFromParentInLps)
{
  const TemporaryFolder folder;
  NamedTransform shift{ "Marker", "Camera", Eigen::Isometry3d::Identity(), {}, "" };
  shift.transform.translation() = Eigen::Vector3d(1, 2, 3);
  writeItkTransform(folder.path() / "MarkerToCamera.tfm", shift);
  const std::string text = test::readBytes(folder.path() / "MarkerToCamera.tfm");
  EXPECT_NE(text.find("Parameters: 1 0 0 0 1 0 0 0 1 1 2 -3\n"), std::string::npos) << text;  // from parent -1 -2 -3, in LPS 1 2 -3
}

TEST(NamedTransform, ItkTransform_ReadsBack)
{
  const TemporaryFolder folder;
  writeItkTransform(folder.path() / "MarkerToCamera.tfm", examples()[0]);
  expectNear(readTransform(folder.path() / "MarkerToCamera.tfm", "MarkerToCamera"), typicalMarkerToCamera());
}

TEST(NamedTransform, ItkTransform_TurnsAboutItsCenter)
{
  const TemporaryFolder folder;
  const auto path = folder.write("turn.txt",
    "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
    "Parameters: 0 -1 0 1 0 0 0 0 1 0 0 5\nFixedParameters: 10 0 0\n");
  // from the parent, LPS: (10, 0, 0) stays but for 5 mm along z
  const Eigen::Vector3d fixed_Lps(10, 0, 0);
  const Eigen::Vector3d mapped = readTransform(path, "").inverse() * Eigen::Vector3d(-fixed_Lps.x(), -fixed_Lps.y(), 0);
  EXPECT_LT((mapped - Eigen::Vector3d(-10, 0, 5)).norm(), 1e-12);
}

TEST(NamedTransform, MrmlScene_ReadsBackAndHangsTheModelUnderItsTransform)
{
  const TemporaryFolder folder;
  writeMrmlScene(folder.path() / "scene.mrml", examples(), { { "Vertebra", "Vertebra.ply", "ModelToPhantom" } });
  expectNear(readTransform(folder.path() / "scene.mrml", "ModelToPhantom"), examples()[2].transform);
  EXPECT_NE(test::readBytes(folder.path() / "scene.mrml").find("transform:vtkMRMLLinearTransformNode3"), std::string::npos);
  EXPECT_THROW(writeMrmlScene(folder.path() / "b.mrml", {}, { { "Vertebra", "v.ply", "ModelToPhantom" } }), std::invalid_argument);
}

TEST(NamedTransform, Matrix4x4_ReadsBack)
{
  const TemporaryFolder folder;
  writeMatrix4x4(folder.path() / "MarkerToCamera.txt", examples()[0]);
  expectNear(readTransform(folder.path() / "MarkerToCamera.txt", "MarkerToCamera"), typicalMarkerToCamera());
}

TEST(NamedTransform, BadFiles_AreExplained)
{
  const TemporaryFolder folder;
  const auto damaged = folder.write("a.xml", "<PlusConfiguration><CoordinateDefinitions>");
  test::expectFileError([&] { (void)readTransforms(damaged); }, { "a.xml", "damaged" });
  const auto scaled = folder.write("b.xml",
    "<PlusConfiguration><CoordinateDefinitions><Transform From=\"A\" To=\"B\" "
    "Matrix=\"2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1\"/></CoordinateDefinitions></PlusConfiguration>");
  test::expectFileError([&] { (void)readTransforms(scaled); }, { "'A'", "'B'", "rigid" });
  const auto shortMatrix = folder.write("c.tfm",
    "#Insight Transform File V1.0\nTransform: AffineTransform_double_3_3\nParameters: 1 0 0\n"
    "FixedParameters: 0 0 0\n");
  test::expectFileError([&] { (void)readTransforms(shortMatrix); }, { "Parameters", "3 numbers", "12" });
  writePlusConfiguration(folder.path() / "d.xml", examples());
  test::expectFileError(
    [&] { (void)readTransform(folder.path() / "d.xml", "ProbeToTracker"); }, { "ProbeToTracker", "StylusTipToStylus" });
}

}  // namespace
