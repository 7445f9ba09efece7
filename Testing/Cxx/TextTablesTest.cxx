// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TextTables.h"

#include "IoTestSupport.h"

using namespace handeye::io;
using namespace handeye::io::test;

TEST(TextTables, Matrix_ReadsRowsWithCommentsCommasAndCarriageReturns)
{
  const TemporaryFolder folder;
  const auto path = folder.write("m.txt", "# left to right\r\n0, -1, 0, 10.5\r\n\r\n1 0 0 -2e1 # second\r\n0\t0;1 +3\r\n0 0 0 1");
  const Eigen::Isometry3d leftToRight = readMatrix4x4(path);
  EXPECT_TRUE((leftToRight * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(8.5, -19, 6), 1e-12));
}

TEST(TextTables, Matrix_RefusesEverythingElse)
{
  const TemporaryFolder folder;
  const auto expectError = [&](const std::string& text, const std::vector<std::string>& words)
  {
    const auto path = folder.write("m.txt", text);
    expectFileError([&] { (void)readMatrix4x4(path); }, words);
  };
  expectError("1 0 0 0\n0 1 0 0\n0 0 1 0\n", { "m.txt", "3 rows", "expected the 4 rows" });
  expectError("1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n", { "line 2", "3 numbers", "expected 4" });
  expectError("1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n", { "line 1", "not a rigid motion" });
  expectError("-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", { "not a rigid motion" });
  expectError("1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n", { "line 2", "'nan'", "not a finite number" });
  expectError("1 0 0 0\n0 1 0 1e999\n0 0 1 0\n0 0 0 1\n", { "line 2", "not a finite number" });
  expectError("1 0 0 0\n0 1 0 3px\n0 0 1 0\n0 0 0 1\n", { "line 2", "'3px'", "not a number" });
  expectError("", { "no numbers" });
  expectError(std::string("\x7f\x45LF\0\0\x01", 7), { "line 1", "not a number" });
}

TEST(TextTables, Points_ReadsThreeColumns)
{
  const TemporaryFolder folder;
  const auto points = readPoints(folder.write("p.txt", "\xEF\xBB\xBF# x y z\n1 2 3\n\n-0 1e-3 4.5\n"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(points[1], Eigen::Vector3d(0, 1e-3, 4.5));
}

TEST(TextTables, Points_NamesTheLineOfAnError)
{
  const TemporaryFolder folder;
  const auto path = folder.write("p.txt", "# x y z\n1 2 3\n4 5\n");
  expectFileError([&] { (void)readPoints(path); }, { "p.txt, line 3", "2 numbers", "x y z" });
}

TEST(TextTables, PointsAndLines_MakesDirectionsUnitLength)
{
  const TemporaryFolder folder;
  const auto rows = readPointsAndLines(folder.write("l.txt", "1 2 3  4 5 6  0 0 -8\n1 2 3 4 5 6 1e200 0 0\n"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(rows[0].lineOrigin, Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(rows[0].lineDirection.isApprox(-Eigen::Vector3d::UnitZ(), 1e-15));
  EXPECT_TRUE(rows[1].lineDirection.isApprox(Eigen::Vector3d::UnitX(), 1e-15));
}

TEST(TextTables, PointsAndLines_RefusesAZeroDirection)
{
  const TemporaryFolder folder;
  const auto path = folder.write("l.txt", "1 2 3 4 5 6 0 0 1\n1 2 3 4 5 6 0 0 0\n");
  expectFileError([&] { (void)readPointsAndLines(path); }, { "line 2", "direction is 0 0 0" });
}

TEST(TextTables, MissingFileAndFolder_AreReported)
{
  const TemporaryFolder folder;
  expectFileError([&] { (void)readPoints(folder.path() / "none.txt"); }, { "none.txt", "no such file" });
  expectFileError([&] { (void)readPoints(folder.path()); }, { "this is a folder" });
}
