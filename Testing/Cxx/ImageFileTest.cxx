// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFile.h"

#include "IoTestSupport.h"

#include <opencv2/imgcodecs.hpp>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

cv::Mat gradient(int type)
{
  cv::Mat image(48, 64, type);
  cv::randu(image, cv::Scalar::all(0), cv::Scalar::all(CV_MAT_DEPTH(type) == CV_16U ? 65535 : 255));
  return image;
}

bool isSame(const cv::Mat& a, const cv::Mat& b)
{
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

}  // namespace

TEST(ImageFile, Png_KeepsDepthAndColours)
{
  const TemporaryFolder folder;
  for (int type : { CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3 })
  {
    const cv::Mat image = gradient(type);
    writePng(folder.path() / "image.png", image);
    EXPECT_TRUE(isSame(readImage(folder.path() / "image.png"), image)) << "type " << type;
  }
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(ImageFile, CutShort_IsAnErrorAndNotHalfAPicture)
{
  const TemporaryFolder folder;
  for (const std::string ending : { ".jpg", ".png", ".bmp", ".tiff" })
  {
    std::vector<uchar> bytes;
    ASSERT_TRUE(cv::imencode(ending, gradient(CV_8UC3), bytes));
    const std::string half(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2));
    const auto path = folder.write("half" + ending, half);
    expectFileError([&] { (void)readImage(path); }, { "half" + ending });
  }
}

TEST(ImageFile, NoImage_IsReported)
{
  const TemporaryFolder folder;
  const auto text = folder.write("text.png", "this is no picture");
  const auto empty = folder.write("empty.jpg", "");
  expectFileError([&] { (void)readImage(text); }, { "text.png", "not a readable image" });
  expectFileError([&] { (void)readImage(empty); }, { "empty.jpg", "not a readable image" });
  expectFileError([&] { (void)readImage(folder.path() / "none.png"); }, { "no such file" });
}

TEST(ImageFile, WritePng_RefusesWhatPngCannotHold)
{
  const TemporaryFolder folder;
  EXPECT_THROW(writePng(folder.path() / "x.png", cv::Mat()), std::invalid_argument);
  EXPECT_THROW(writePng(folder.path() / "x.png", cv::Mat::zeros(2, 2, CV_32F)), std::invalid_argument);
  EXPECT_EQ(folder.entryCount(), 0u);
}
