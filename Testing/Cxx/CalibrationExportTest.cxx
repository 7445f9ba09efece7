// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationExport.h"

#include "IoTestSupport.h"
#include "NamedTransform.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

namespace handeye
{

namespace
{

using io::test::expectFileError;

class CalibrationExport : public testing::Test
{
protected:
  ExportSources sourcesWith(const std::string& status) const
  {
    const std::string text = R"({ "status": ")" + status + R"(",
      "markerToCamera": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]], "camera": { "width": 640, "height": 480,
      "cameraMatrix": [[500, 0, 320], [0, 500, 240], [0, 0, 1]], "distortionCoefficients": [0.1, 0, 0, 0, 0] } })";
    ExportSources sources;
    sources.calibration = folder_.write(status + ".json", text);
    return sources;
  }

  io::test::TemporaryFolder folder_;
};

TEST_F(CalibrationExport, Formats_HaveWordsNamesAndFilesOfTheirOwn)
{
  std::set<std::string> words, names, files;
  for (const ExportFormat& format : exportFormats())
  {
    words.insert(format.word);
    names.insert(format.name);
    files.insert(format.fileName);
  }
  EXPECT_EQ(words.size(), exportFormats().size());
  EXPECT_EQ(names.size(), exportFormats().size());
  EXPECT_EQ(files.size(), exportFormats().size());
  for (const auto& camera : cameraFormats())
  {
    EXPECT_TRUE(words.count(camera.first)) << camera.first;
  }
}

TEST_F(CalibrationExport, EveryFormat_WritesItsFile)
{
  const ExportSources sources = sourcesWith("ok");
  for (const ExportFormat& format : exportFormats())
  {
    const ExportResult result = exportCalibration(sources, format.word, folder_.path() / format.fileName);
    ASSERT_FALSE(result.files.empty()) << format.word;
    for (const std::filesystem::path& file : result.files)
    {
      EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
    }
  }
  const Eigen::Isometry3d markerToCamera = io::readTransform(folder_.path() / "PlusCoordinateDefinitions.xml", "MarkerToCamera");
  EXPECT_TRUE((markerToCamera * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(3, 7, 10)));
}

TEST_F(CalibrationExport, WhatIsNotUsable_IsNotExported)
{
  const ExportSources sources = sourcesWith("poor_fit");
  const std::filesystem::path file = folder_.path() / "camera.tfm";
  expectFileError([&] { (void)exportCalibration(sources, "tfm", file); }, { "poor_fit.json", "status", "poor_fit" });
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(CalibrationExport, AFormatThatIsNone_IsTheCallersMistake)
{
  EXPECT_THROW((void)exportCalibration(sourcesWith("ok"), "docx", folder_.path() / "x"), std::invalid_argument);
}

}  // namespace

}  // namespace handeye
