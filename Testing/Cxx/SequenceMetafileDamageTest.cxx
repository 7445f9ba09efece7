// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
// Files that are not what they should be: every one is refused with a sentence that says where and why.
#include "SequenceMetafile.h"
#include "SequenceMetafileWriter.h"

#include "IoTestSupport.h"

#include <random>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

const std::string Start = "ObjectType = Image\nNDims = 3\n";
const std::string End = "ElementDataFile = LOCAL\n";
const std::string Identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";

/// Opens a file with these bytes and reads all its images.
void readAll(const std::filesystem::path& path)
{
  const SequenceMetafile metafile = SequenceMetafile::open(path);
  for (int i = 0; metafile.hasImages() && i < metafile.frameCount(); ++i)
  {
    (void)metafile.image(i);
  }
}

void expectRefused(const std::string& bytes, const std::vector<std::string>& words)
{
  const TemporaryFolder folder;
  const auto path = folder.write("damaged.mha", bytes);
  expectFileError([&] { readAll(path); }, words);
}

/// Four frames of 3x2 pixels, compressed.
std::string compressedFile(const std::filesystem::path& folder)
{
  SequenceMetafileWriterOptions options;
  options.compressed = true;
  SequenceMetafileWriter writer(folder / "good.mha", options);
  for (int i = 0; i < 4; ++i)
  {
    cv::Mat image(32, 32, CV_8UC3);
    cv::randu(image, cv::Scalar::all(0), cv::Scalar::all(256));
    SequenceFrame frame;
    frame.transforms["AToB"].matrix = Eigen::Matrix4d::Identity();
    frame.timestampSec = i;
    writer.append(frame, image);
  }
  writer.close();
  const std::string bytes = readBytes(folder / "good.mha");
  std::filesystem::remove(folder / "good.mha");
  return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t found = text.find(from);
  EXPECT_NE(found, std::string::npos) << from;
  return text.replace(found, from.size(), to);
}

std::string compressedSizeLine(const std::string& bytes)
{
  const std::size_t start = bytes.find("CompressedDataSize");
  return bytes.substr(start, bytes.find('\n', start) - start);
}

}  // namespace

TEST(SequenceMetafileDamage, NoSequenceMetafileAtAll)
{
  const TemporaryFolder folder;
  expectFileError([&] { readAll(folder.path() / "none.mha"); }, { "none.mha", "no such file" });
  expectFileError([&] { readAll(folder.path()); }, { "this is a folder" });
  expectRefused("", { "damaged.mha", "empty" });
  expectRefused("\n\r\n  \n", { "empty" });
  expectRefused(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), { "line 1", "begins with '?PNG'", "ObjectType = Image" });
  expectRefused(std::string(5 << 20, '\xff'), { "line 1", "more than a million characters" });
  expectRefused("camera_matrix: 3\n", { "line 1", "ObjectType = Image" });
}

TEST(SequenceMetafileDamage, HeaderWithoutEnd)
{
  expectRefused(Start + "DimSize = 0 0 1\n", { "after line 3", "ElementDataFile" });
  expectRefused(Start + "DimSize = 0 0 1\nSeq_Frame0000_AToBTr", { "line 4", "expected 'Key = Value'" });
  expectRefused(Start + "DimSize = 0 0 1\nwhat is this\n" + End, { "line 4", "'what is this'", "Key = Value" });
  expectRefused(Start + "DimSize = 0 0 1\n = 3\n" + End, { "line 4", "Key = Value" });
  expectRefused(Start + End, { "no 'DimSize'" });
}

TEST(SequenceMetafileDamage, Dimensions)
{
  const auto expectDimensions = [](const std::string& dimensions, const std::vector<std::string>& words)
  { expectRefused(Start + "DimSize = " + dimensions + "\nElementType = MET_UCHAR\n" + End, words); };
  expectDimensions("640 480", { "line 3", "'DimSize' is '640 480'", "width height frames" });
  expectDimensions("640 480 x", { "line 3", "DimSize" });
  expectDimensions("-640 480 3", { "DimSize", "negative" });
  expectDimensions("640 480 -3", { "DimSize", "negative" });
  expectDimensions("640 480 99999999999999999999", { "DimSize", "larger than the machine can count" });
  expectDimensions("0 0 2000000000", { "DimSize", "at most 10000000 frames" });
  expectDimensions("4000000000 4000000000 4000000000", { "DimSize", "pixels a side" });
  expectDimensions("65536 65536 1", { "DimSize", "256 MB" });
  expectDimensions("0 480 3", { "DimSize", "0 0 frames" });
  expectDimensions("10000 10000 10000000", { "cut short", "10000000 frames of 10000x10000x1", "0 whole frames" });
  expectRefused("ObjectType = Image\nNDims = 4\nDimSize = 2 2 7 1\n" + End, { "volumes with 7 slices" });
  expectRefused("ObjectType = Image\nNDims = 4\nDimSize = 2 2 1\n" + End, { "line 2", "NDims", "3" });
  expectRefused(Start + "DimSize = 2 2 1\nKinds = domain domain domain\n" + End, { "line 4", "Kinds", "list" });
}

TEST(SequenceMetafileDamage, PixelFormat)
{
  const auto expectFormat = [](const std::string& lines, const std::vector<std::string>& words)
  { expectRefused(Start + "DimSize = 2 2 1\n" + lines + End + "12345678", words); };
  expectFormat("", { "no 'ElementType'", "MET_UCHAR or MET_USHORT" });
  expectFormat("ElementType = MET_DOUBLE\n", { "line 4", "'MET_DOUBLE'" });
  expectFormat("ElementType = MET_UCHAR\nElementNumberOfChannels = 2\n", { "line 5", "1 (grey), 3 (RGB) or 4" });
  expectFormat("ElementType = MET_UCHAR\nElementNumberOfChannels = -1\n", { "line 5", "ElementNumberOfChannels" });
  expectFormat("ElementType = MET_UCHAR\nBinaryData = False\n", { "BinaryData", "written as text" });
  expectFormat("ElementType = MET_UCHAR\nCompressedData = perhaps\n", { "CompressedData", "True or False" });
  expectFormat("ElementType = MET_UCHAR\nHeaderSize = 100\n", { "HeaderSize" });
}

TEST(SequenceMetafileDamage, DataFileElsewhere)
{
  const auto expectName = [](const std::string& name, const std::string& word)
  { expectRefused(Start + "DimSize = 1 1 1\nElementType = MET_UCHAR\nElementDataFile = " + name + "\nx", { word }); };
  expectName("", "expected LOCAL");
  expectName("../secret.raw", "same folder");
  expectName("/etc/passwd", "same folder");
  expectName("..", "same folder");
  expectName(".", "same folder");
  expectName("LIST", "same folder");
  expectName("image%03d.raw 1 10 1", "same folder");
  expectName("none.raw", "none.raw");
}

TEST(SequenceMetafileDamage, FewerPixelsThanAnnounced)
{
  const std::string header = Start + "DimSize = 2 2 3\nElementType = MET_UCHAR\n" + End;
  expectRefused(header + "1234567890", { "cut short", "3 frames of 2x2x1", "12 bytes", "only 10", "2 whole frames" });
  expectRefused(header, { "cut short", "0 whole frames" });
}

TEST(SequenceMetafileDamage, CompressedPixels)
{
  const TemporaryFolder folder;
  const std::string good = compressedFile(folder.path());
  const std::string sizeLine = compressedSizeLine(good);
  const std::size_t pixels = good.find(End) + End.size();
  const std::size_t size = good.size() - pixels;

  std::string flipped = good;
  flipped[pixels + size / 2] = static_cast<char>(flipped[pixels + size / 2] ^ 0x40);
  expectRefused(flipped, { "damaged at frame" });
  std::string noStream = good;
  noStream.replace(pixels, 2, "xx");
  expectRefused(noStream, { "damaged at frame 0" });
  std::string wrongChecksum = good;
  wrongChecksum.back() = static_cast<char>(wrongChecksum.back() ^ 1);
  expectRefused(wrongChecksum, { "damaged at frame 3", "data check" });

  expectRefused(good.substr(0, good.size() - 10), { "CompressedDataSize", "cut short" });
  expectRefused(replaced(good, sizeLine, "CompressedDataSize = 5000"), { "end within frame 1 of 4" });
  expectRefused(replaced(good, sizeLine, "CompressedDataSize = " + std::to_string(size - 2)), { "before their checksum" });
  expectRefused(replaced(good, sizeLine, "CompressedDataSize = -1"), { "CompressedDataSize", "'-1'" });
  expectRefused(replaced(good, sizeLine, "CompressedDataSize = 99999999999999999999999"), { "CompressedDataSize" });
  expectRefused(replaced(good, "DimSize = 32 32 4", "DimSize = 32 32 9"), { "end within frame 4 of 9" });
  expectRefused(replaced(good, "DimSize = 32 32 4", "DimSize = 32 32 2"), { "frame 3", "only 2 frames" });
  expectRefused(replaced(good, "DimSize = 32 32 4", "DimSize = 10000 8000 1000000"), { "more than", "bytes can hold compressed" });

  const auto path = folder.write("no_size.mha", replaced(good, sizeLine + "\n", ""));
  EXPECT_NO_THROW(readAll(path)) << "without CompressedDataSize, the rest of the file is the stream";
}

TEST(SequenceMetafileDamage, MoreCompressedPixelsThanFrames)
{
  const TemporaryFolder folder;
  SequenceMetafileWriterOptions options;
  options.compressed = true;
  SequenceMetafileWriter writer(folder.path() / "good.mha", options);
  writer.append({}, cv::Mat::zeros(4, 4, CV_8U));
  writer.close();
  expectRefused(
    replaced(readBytes(folder.path() / "good.mha"), "DimSize = 4 4 1", "DimSize = 4 3 1"), { "go on after the 1 frames" });
}

TEST(SequenceMetafileDamage, ADamagedFrame_DoesNotSpoilTheOnesBeforeIt)
{
  const TemporaryFolder folder;
  std::string bytes = compressedFile(folder.path());
  const std::size_t last = bytes.size() - 200;
  bytes[last] = static_cast<char>(bytes[last] ^ 0x55);
  const auto metafile = SequenceMetafile::open(folder.write("damaged.mha", bytes));
  const cv::Mat first = metafile.image(0);
  EXPECT_THROW(metafile.image(3), FileError);
  EXPECT_EQ(cv::norm(metafile.image(0), first, cv::NORM_INF), 0);
  EXPECT_NO_THROW(metafile.image(1));
}

TEST(SequenceMetafileDamage, Matrices)
{
  const auto expectMatrix = [](const std::string& matrix, const std::vector<std::string>& words)
  { expectRefused(Start + "DimSize = 0 0 1\nSeq_Frame0000_AToBTransform = " + matrix + "\n" + End, words); };
  expectMatrix("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0", { "line 4", "'AToBTransform' has 15 numbers", "expected 16" });
  expectMatrix(Identity + " 1", { "line 4", "17 numbers" });
  expectMatrix("", { "line 4", "0 numbers" });
  expectMatrix("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 one", { "line 4", "'one'", "not a number" });
  expectMatrix("1,5 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", { "line 4", "'1,5'", "not a number" });
}

TEST(SequenceMetafileDamage, FrameFields)
{
  const auto expectField = [](const std::string& lines, const std::vector<std::string>& words)
  { expectRefused(Start + "DimSize = 0 0 2\n" + lines + "\n" + End, words); };
  expectField("Seq_Frame0000_Timestamp = now", { "line 4", "'Timestamp' is 'now'", "seconds" });
  expectField("Seq_Frame0000_Timestamp = nan", { "line 4", "'Timestamp' is 'nan'" });
  expectField("Seq_Frame0000_FrameNumber = 1.5", { "line 4", "whole number" });
  expectField("Seq_Frame0002_Timestamp = 1", { "line 4", "frame 2", "only 2 frames" });
  expectField("Seq_Frame0000_Timestamp = 1\nSeq_Frame2147483646_Timestamp = 1", { "line 5", "frame 2147483646" });
  expectField("Seq_Frame99999999999999999999_Timestamp = 1", { "line 4", "not a frame's field" });
  expectField("Seq_Frame-1_Timestamp = 1", { "line 4", "not a frame's field" });
  expectField("Seq_FrameX_Timestamp = 1", { "line 4", "not a frame's field" });
  expectField("Seq_Frame0000 = 1", { "line 4", "not a frame's field" });
  expectField("Seq_Frame0000_ = 1", { "line 4", "not a frame's field" });
}

TEST(SequenceMetafileDamage, FieldsThatAreThereTwice)
{
  const auto expectTwice = [](const std::string& line) {
    expectRefused(Start + "DimSize = 0 0 1\n" + line + "\n" + line + "\n" + End, { "line 5", "twice" });
  };
  expectTwice("Kinds = domain domain list");
  expectTwice("Seq_Frame0000_AToBTransform = " + Identity);
  expectTwice("Seq_Frame0000_AToBTransformStatus = OK");
  expectTwice("Seq_Frame0000_Timestamp = 1");
  expectTwice("Seq_Frame0000_UnfilteredTimestamp = 1");
  expectTwice("Seq_Frame0000_FrameNumber = 1");
  expectTwice("Seq_Frame0000_ImageStatus = OK");
  expectTwice("Seq_Frame0000_Note = hello");
}

/// Random damage: whatever the bytes, the answer is a recording or a FileError.
TEST(SequenceMetafileDamage, RandomBytes_NeverDoMoreThanAFileError)
{
  const TemporaryFolder folder;
  const std::string compressed = compressedFile(folder.path());
  const std::string plain = Start + "DimSize = 2 2 2\nElementType = MET_UCHAR\nSeq_Frame0000_AToBTransform = " + Identity +
    "\nSeq_Frame0001_Timestamp = 2.5\n" + End + "12345678";
  std::mt19937 generator(3);
  int refusedCount = 0;
  for (int i = 0; i < 600; ++i)
  {
    std::string bytes = i % 2 ? plain : compressed;
    for (unsigned damage = 0; damage < 1 + generator() % 4; ++damage)
    {
      const std::size_t position = generator() % std::min<std::size_t>(bytes.size() + 1, 900);
      const unsigned kind = generator() % 4;
      if (kind == 0 && position < bytes.size())
      {
        bytes[position] = static_cast<char>(generator());
      }
      else if (kind == 1)
      {
        bytes.erase(position, 1 + generator() % 8);
      }
      else if (kind == 2)
      {
        bytes.insert(position, std::to_string(generator()));
      }
      else if (generator() % 8 == 0)
      {
        bytes.resize(position);
      }
    }
    const auto path = folder.write("random.mha", bytes);
    try
    {
      readAll(path);
    }
    catch (const FileError&)
    {
      ++refusedCount;
    }
  }
  EXPECT_GT(refusedCount, 150);
}
