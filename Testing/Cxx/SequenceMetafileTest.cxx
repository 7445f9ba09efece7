// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SequenceMetafile.h"
#include "SequenceMetafileWriter.h"

#include "IoTestSupport.h"

#include <Eigen/Geometry>

#include <locale>
#include <random>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

std::mt19937 generator(17);

Eigen::Matrix4d randomMotion()
{
  std::normal_distribution<double> normal;
  Eigen::Isometry3d motion(
    Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator)).normalized());
  motion.translation() = 100 * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
  return motion.matrix();
}

cv::Mat randomImage(int type, int width = 7, int height = 5)
{
  cv::Mat image(height, width, type);
  cv::randu(image, cv::Scalar::all(0), cv::Scalar::all(CV_MAT_DEPTH(type) == CV_16U ? 65536 : 256));
  return image;
}

SequenceFrame randomFrame(int index)
{
  SequenceFrame frame;
  frame.transforms["MarkerToTracker"] = { randomMotion(), "" };
  frame.transforms["StylusToTracker"] = { randomMotion(), index % 5 == 3 ? "INVALID" : "OK" };
  frame.timestampSec = 1000.0 / 3 + index * 0.1;
  frame.unfilteredTimestampSec = *frame.timestampSec + 1e-9;
  frame.frameNumber = 7000000000LL + index;
  frame.fields["Note"] = "ball held still = yes";
  return frame;
}

bool isSame(const cv::Mat& a, const cv::Mat& b)
{
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/// Writes frames, reads them back and compares everything exactly.
void expectRoundTrip(const std::filesystem::path& path, int frameCount, bool isCompressed, std::optional<int> imageType)
{
  std::vector<SequenceFrame> frames;
  std::vector<cv::Mat> images;
  SequenceMetafileWriterOptions options;
  options.compressed = isCompressed;
  options.transformsOnly = !imageType;
  options.fields["Comment"] = "a test";
  SequenceMetafileWriter writer(path, options);
  for (int i = 0; i < frameCount; ++i)
  {
    frames.push_back(randomFrame(i));
    images.push_back(imageType ? randomImage(*imageType) : cv::Mat());
    writer.append(frames.back(), images.back());
  }
  EXPECT_FALSE(std::filesystem::exists(path)) << "before close()";
  writer.close();

  const SequenceMetafile metafile = SequenceMetafile::open(path);
  ASSERT_EQ(metafile.frameCount(), frameCount);
  EXPECT_EQ(metafile.hasImages(), imageType.has_value());
  EXPECT_TRUE(metafile.warnings().empty());
  EXPECT_EQ(metafile.fields().at("Comment"), "a test");
  EXPECT_EQ(metafile.transformNames(), (std::vector<std::string>{ "MarkerToTracker", "StylusToTracker" }));
  for (int i = 0; i < frameCount; ++i)
  {
    const SequenceFrame& frame = metafile.frame(i);
    EXPECT_EQ(frame.transforms.at("MarkerToTracker").matrix, frames[i].transforms.at("MarkerToTracker").matrix) << i;
    EXPECT_EQ(frame.transforms.at("StylusToTracker").matrix, frames[i].transforms.at("StylusToTracker").matrix) << i;
    EXPECT_EQ(frame.transforms.at("StylusToTracker").status, frames[i].transforms.at("StylusToTracker").status) << i;
    EXPECT_EQ(frame.timestampSec, frames[i].timestampSec);
    EXPECT_EQ(frame.unfilteredTimestampSec, frames[i].unfilteredTimestampSec);
    EXPECT_EQ(frame.frameNumber, frames[i].frameNumber);
    EXPECT_EQ(frame.fields, frames[i].fields);
    EXPECT_EQ(frame.isImageValid, imageType.has_value());
    EXPECT_TRUE(!imageType || isSame(metafile.image(i), images[i])) << i;
  }
  if (imageType)
  {
    EXPECT_TRUE(isSame(metafile.image(0), images[0])) << "back to the beginning";
    EXPECT_TRUE(isSame(metafile.image(frameCount - 1), images.back())) << "over several frames";
    EXPECT_TRUE(isSame(metafile.image(frameCount / 2), images[frameCount / 2]));
  }
}

/// A file of 2x3 grey pixels 1 to 6 in one frame.
std::string smallFile(const std::string& orientation)
{
  return "ObjectType = Image\nNDims = 3\nDimSize = 2 3 1\nElementType = MET_UCHAR\nUltrasoundImageOrientation = " + orientation +
    "\nSeq_Frame0000_ImageStatus = OK\nElementDataFile = LOCAL\n\x01\x02\x03\x04\x05\x06";
}

}  // namespace

TEST(SequenceMetafile, RoundTrip_Plain)
{
  const TemporaryFolder folder;
  for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3 })
  {
    expectRoundTrip(folder.path() / ("plain" + std::to_string(type) + ".mha"), 9, false, type);
  }
  EXPECT_EQ(folder.entryCount(), 5u);
}

TEST(SequenceMetafile, RoundTrip_Compressed)
{
  const TemporaryFolder folder;
  for (int type : { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3 })
  {
    expectRoundTrip(folder.path() / ("compressed" + std::to_string(type) + ".mha"), 9, true, type);
  }
  EXPECT_EQ(folder.entryCount(), 5u);
}

TEST(SequenceMetafile, RoundTrip_TransformsOnly)
{
  const TemporaryFolder folder;
  expectRoundTrip(folder.path() / "tracking.igs.mha", 20, false, std::nullopt);
  expectRoundTrip(folder.path() / "compressed.igs.mha", 20, true, std::nullopt);
}

TEST(SequenceMetafile, RoundTrip_TwelveThousandFramesHaveFiveDigits)
{
  const TemporaryFolder folder;
  const auto path = folder.path() / "long.igs.mha";
  expectRoundTrip(path, 12000, false, std::nullopt);
  const std::string text = readBytes(path);
  EXPECT_NE(text.find("Seq_Frame0007_"), std::string::npos);
  EXPECT_NE(text.find("Seq_Frame11999_"), std::string::npos);
}

TEST(SequenceMetafile, RoundTrip_NumbersAtTheirLimits)
{
  const TemporaryFolder folder;
  const auto path = folder.path() / "limits.igs.mha";
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.row(0) << 5e-324, 1.7976931348623157e308, -0.0, 0.1;
  matrix.row(1) << 1.0 / 3, -2.2250738585072014e-308, 1e-300, 123456789.123456789;
  SequenceFrame frame;
  frame.transforms["AToB"].matrix = matrix;
  SequenceMetafileWriter writer(path);
  writer.append(frame);
  writer.close();
  const SequenceMetafile metafile = SequenceMetafile::open(path);
  const Eigen::Matrix4d& read = *metafile.frame(0).transforms.at("AToB").matrix;
  EXPECT_EQ(read, matrix);
  EXPECT_TRUE(std::signbit(read(0, 2)));
}

TEST(SequenceMetafile, RealTrackerFile_ReadsAsPlusWroteIt)
{
  const SequenceMetafile metafile = SequenceMetafile::open(std::filesystem::path(HANDEYE_TEST_DATA_DIR) / "plus_excerpt.igs.mha");
  ASSERT_EQ(metafile.frameCount(), 20);
  EXPECT_FALSE(metafile.hasImages());
  EXPECT_TRUE(metafile.warnings().empty());
  EXPECT_EQ(metafile.transformNames(), (std::vector<std::string>{ "ReferenceToTracker", "StylusToTracker" }));
  const TransformSample stylusToTracker = metafile.transform(0, "StylusToTrackerTransform");
  ASSERT_TRUE(stylusToTracker.isUsable()) << stylusToTracker.reason;
  EXPECT_EQ(stylusToTracker.transform.translation().x(), 315.55283203125);
  EXPECT_NEAR(
    stylusToTracker.transform.linear()(0, 0), 0.6839311099507384, 1e-4);  // this tracker's rotations are orthonormal to 1e-4 only
  EXPECT_NEAR(stylusToTracker.transform.linear().determinant(), 1, 1e-12);
  EXPECT_EQ(metafile.frame(0).timestampSec, 280.4611428572264);
  EXPECT_EQ(metafile.frame(0).isImageValid, false);
}

TEST(SequenceMetafile, Orientation_IsTurnedToRowsFromTheTop)
{
  const TemporaryFolder folder;
  const auto pixels = [&](const std::string& orientation)
  {
    const auto metafile = SequenceMetafile::open(folder.write(orientation + ".mha", smallFile(orientation)));
    const cv::Mat image = metafile.image(0);
    EXPECT_EQ(image.size(), cv::Size(2, 3));
    return std::vector<int>(image.begin<uchar>(), image.end<uchar>());
  };
  EXPECT_EQ(pixels("MF"), (std::vector<int>{ 1, 2, 3, 4, 5, 6 }));
  EXPECT_EQ(pixels("XX"), (std::vector<int>{ 1, 2, 3, 4, 5, 6 }));
  EXPECT_EQ(pixels("MN"), (std::vector<int>{ 5, 6, 3, 4, 1, 2 }));
  EXPECT_EQ(pixels("UF"), (std::vector<int>{ 2, 1, 4, 3, 6, 5 }));
  EXPECT_EQ(pixels("UN"), (std::vector<int>{ 6, 5, 4, 3, 2, 1 }));
}

TEST(SequenceMetafile, Orientation_TransposedIsRefused)
{
  const TemporaryFolder folder;
  const auto metafile = SequenceMetafile::open(folder.write("FM.mha", smallFile("FM")));
  expectFileError([&] { metafile.image(0); }, { "UltrasoundImageOrientation", "'FM'", "expected MF" });
}

TEST(SequenceMetafile, Colour_FileHasRgbAndImageHasBgr)
{
  const TemporaryFolder folder;
  const std::string header = "ObjectType = Image\nNDims = 4\nDimSize = 1 1 1 2\nKinds = domain domain domain list\n"
                             "ElementType = MET_UCHAR\nElementNumberOfChannels = 3\nElementDataFile = LOCAL\n";
  const auto path = folder.write("rgb.mha", header + "\x0a\x14\x1e\x28\x32\x3c");
  const auto metafile = SequenceMetafile::open(path);
  ASSERT_EQ(metafile.frameCount(), 2);
  EXPECT_EQ(metafile.image(0).at<cv::Vec3b>(0, 0), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(metafile.image(1).at<cv::Vec3b>(0, 0), cv::Vec3b(60, 50, 40));

  const auto written = folder.path() / "written.mha";
  SequenceMetafileWriter writer(written);
  writer.append({}, cv::Mat(1, 1, CV_8UC3, cv::Scalar(30, 20, 10)));
  writer.close();
  const std::string bytes = readBytes(written);
  EXPECT_EQ(bytes.substr(bytes.size() - 3), "\x0a\x14\x1e");
}

TEST(SequenceMetafile, SixteenBits_BothByteOrders)
{
  const TemporaryFolder folder;
  for (const bool isBigEndian : { false, true })
  {
    const std::string header = std::string("ObjectType = Image\nNDims = 3\nDimSize = 1 1 1\nElementType = MET_USHORT\n") +
      "BinaryDataByteOrderMSB = " + (isBigEndian ? "True" : "False") + "\nElementDataFile = LOCAL\n";
    const auto metafile = SequenceMetafile::open(folder.write("wide.mha", header + (isBigEndian ? "\x01\x02" : "\x02\x01")));
    EXPECT_EQ(metafile.image(0).at<std::uint16_t>(0, 0), 0x0102);
  }
}

TEST(SequenceMetafile, Header_ToleratesCarriageReturnsBlanksAndALocaleWithComma)
{
  struct CommaPoint : std::numpunct<char>
  {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale previous = std::locale::global(std::locale(std::locale(), new CommaPoint));
  const TemporaryFolder folder;
  const auto path = folder.write("crlf.igs.mha",
    "ObjectType = Image\r\nNDims=3\r\nDimSize = 0 0 2              \r\n\r\nElementType = MET_OTHER\r\n"
    "Seq_Frame0000_AToBTransform =  -0 -1 0 1.5  1 0 0 +2.5e1 0 0 1.0 -3 0 0 0 1   \r\n"
    "Seq_Frame0000_AToBTransformStatus = OK \r\nSeq_Frame0000_Timestamp = 12.25 \r\n"
    "Seq_Frame0001_AToBTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\r\nElementDataFile = LOCAL\r\n");
  const auto metafile = SequenceMetafile::open(path);
  std::locale::global(previous);
  const TransformSample aToB = metafile.transform(0, "AToB");
  ASSERT_TRUE(aToB.isUsable()) << aToB.reason;
  EXPECT_TRUE((aToB.transform * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1.5, 26, -3)));
  EXPECT_EQ(metafile.frame(0).timestampSec, 12.25);
  EXPECT_FALSE(metafile.frame(1).timestampSec.has_value());
}

TEST(SequenceMetafile, PixelsInAnotherFile_AreFoundBesideTheHeader)
{
  const TemporaryFolder folder;
  folder.write("pixels.raw", "\x05\x06");
  const auto path = folder.write(
    "split.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 1 1 2\nElementType = MET_UCHAR\nElementDataFile = pixels.raw\n");
  const auto metafile = SequenceMetafile::open(path);
  EXPECT_EQ(metafile.image(0).at<uchar>(0, 0), 5);
  EXPECT_EQ(metafile.image(1).at<uchar>(0, 0), 6);
}

TEST(SequenceMetafile, Transform_SaysWhyItIsNotUsable)
{
  const TemporaryFolder folder;
  const std::string identity = "Transform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  const auto path = folder.write("bad.igs.mha",
    "ObjectType = Image\nNDims = 3\nDimSize = 0 0 1\n"
    "Seq_Frame0000_GoodToT" +
      identity + "Seq_Frame0000_HiddenToT" + identity +
      "Seq_Frame0000_HiddenToTTransformStatus = INVALID\n"
      "Seq_Frame0000_NanToTTransform = nan 0 0 0 0 1 0 0 0 0 1 -1.#IND 0 0 0 1\n"
      "Seq_Frame0000_InfToTTransform = 1 0 0 1e999 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0000_ScaleToTTransform = 2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1\n"
      "Seq_Frame0000_MirrorToTTransform = -1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0000_ProjectiveToTTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.1 1\n"
      "Seq_Frame0000_ZeroToTTransform = 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n"
      "Seq_Frame0000_LostToTTransformStatus = OK\n"
      "ElementDataFile = LOCAL\n");
  const auto metafile = SequenceMetafile::open(path);
  EXPECT_TRUE(metafile.transform(0, "GoodToT").isUsable());
  const auto expectInvalid = [&](const std::string& name, const std::string& word)
  {
    const TransformSample sample = metafile.transform(0, name);
    EXPECT_EQ(sample.status, TransformSample::Status::Invalid) << name;
    EXPECT_NE(sample.reason.find(word), std::string::npos) << sample.reason;
  };
  expectInvalid("HiddenToT", "'INVALID'");
  expectInvalid("NanToT", "not finite");
  expectInvalid("InfToT", "not finite");
  expectInvalid("ScaleToT", "not a rigid motion");
  expectInvalid("MirrorToT", "not a rigid motion");
  expectInvalid("ProjectiveToT", "not a rigid motion");
  expectInvalid("ZeroToT", "not a rigid motion");
  EXPECT_EQ(metafile.transform(0, "NoneToT").status, TransformSample::Status::Missing);
  EXPECT_EQ(metafile.transform(0, "LostToT").status, TransformSample::Status::Missing);
  EXPECT_THROW((void)metafile.transform(1, "GoodToT"), std::out_of_range);
}

TEST(SequenceMetafile, FrameIndicesWithGaps_AreFramesWithoutTransforms)
{
  const TemporaryFolder folder;
  const std::string transform = "_AToBTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  const auto path = folder.write("gaps.igs.mha",
    "ObjectType = Image\nNDims = 3\nDimSize = 0 0 10\nSeq_Frame0001" + transform + "Seq_Frame0005" + transform + "Seq_Frame0006" +
      transform + "ElementDataFile = LOCAL\n");
  const auto metafile = SequenceMetafile::open(path);
  EXPECT_TRUE(hasWarning(metafile.warnings(), "0, 2-4, 7-9 (7 of 10)"));
  EXPECT_EQ(metafile.transform(0, "AToB").status, TransformSample::Status::Missing);
  EXPECT_TRUE(metafile.transform(5, "AToB").isUsable());
}

TEST(SequenceMetafileWriter, EmptyImages_AreBlackAndNotValid)
{
  const TemporaryFolder folder;
  const auto path = folder.path() / "blank.mha";
  SequenceMetafileWriter writer(path);
  writer.append({});
  writer.append({}, cv::Mat(2, 2, CV_8UC1, cv::Scalar(9)));
  writer.append({});
  writer.close();
  const auto metafile = SequenceMetafile::open(path);
  EXPECT_EQ(metafile.frame(0).isImageValid, false);
  EXPECT_EQ(metafile.frame(1).isImageValid, true);
  EXPECT_EQ(cv::countNonZero(metafile.image(0)), 0);
  EXPECT_EQ(cv::countNonZero(metafile.image(1)), 4);
  EXPECT_EQ(cv::countNonZero(metafile.image(2)), 0);
}

TEST(SequenceMetafileWriter, WithoutClose_LeavesNothing)
{
  const TemporaryFolder folder;
  {
    SequenceMetafileWriter writer(folder.path() / "lost.mha");
    writer.append({}, cv::Mat::zeros(100, 100, CV_8UC3));
  }
  EXPECT_EQ(folder.entryCount(), 0u);
}

TEST(SequenceMetafileWriter, UnwritablePlace_IsReportedAtOnce)
{
  const TemporaryFolder folder;
  expectFileError([&] { SequenceMetafileWriter writer(folder.path() / "no" / "file.mha"); }, { "there is no folder" });
  expectFileError([&] { SequenceMetafileWriter writer(folder.path()); }, { "this is a folder" });
}

TEST(SequenceMetafileWriter, WrongInput_ThrowsInvalidArgument)
{
  const TemporaryFolder folder;
  SequenceMetafileWriter writer(folder.path() / "x.mha");
  SequenceFrame frame;
  frame.fields["two words"] = "x";
  EXPECT_THROW(writer.append(frame), std::invalid_argument);
  frame.fields = { { "Note", "two\nlines" } };
  EXPECT_THROW(writer.append(frame), std::invalid_argument);
  frame.fields = { { "FrameNumber", "3" } };
  frame.frameNumber = 3;
  EXPECT_THROW(writer.append(frame), std::invalid_argument);
  frame = {};
  frame.timestampSec = std::nan("");
  EXPECT_THROW(writer.append(frame), std::invalid_argument);
  EXPECT_THROW(writer.append({}, cv::Mat::zeros(2, 2, CV_32F)), std::invalid_argument);
  writer.append({}, cv::Mat::zeros(2, 2, CV_8U));
  EXPECT_THROW(writer.append({}, cv::Mat::zeros(2, 3, CV_8U)), std::invalid_argument);
  writer.close();
  EXPECT_THROW(writer.append({}), std::invalid_argument);
  EXPECT_EQ(SequenceMetafile::open(folder.path() / "x.mha").frameCount(), 1);
  SequenceMetafileWriterOptions options;
  options.fields["DimSize"] = "0 0 0";
  EXPECT_THROW(SequenceMetafileWriter(folder.path() / "y.mha", options), std::invalid_argument);
}

TEST(SequenceMetafileWriter, FieldThatIsKnownLate_IsInTheFile)
{
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "late.igs.mha";
  SequenceMetafileWriter writer(path, { false, true, { { "Early", "1" } } });
  writer.append(SequenceFrame());
  writer.setField("Late", "2");
  writer.setField("Early", "3");
  EXPECT_THROW(writer.setField("DimSize", "1 1 1"), std::invalid_argument);
  EXPECT_THROW(writer.setField("Seq_Frame0000_Status", "OK"), std::invalid_argument);
  EXPECT_THROW(writer.setField("a b", "1"), std::invalid_argument);
  EXPECT_THROW(SequenceMetafileWriter(path, { false, true, { { "DimSize", "1 1 1" } } }), std::invalid_argument);
  writer.close();
  const SequenceMetafile file = SequenceMetafile::open(path);
  EXPECT_EQ(file.fields().at("Late"), "2");
  EXPECT_EQ(file.fields().at("Early"), "3");
}

TEST(SequenceMetafileWriter, NoFrames_ReadsBackWithAWarning)
{
  const TemporaryFolder folder;
  SequenceMetafileWriter writer(folder.path() / "none.mha");
  writer.close();
  const auto metafile = SequenceMetafile::open(folder.path() / "none.mha");
  EXPECT_EQ(metafile.frameCount(), 0);
  EXPECT_TRUE(hasWarning(metafile.warnings(), "no frames"));
}
