// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
// Camera files that are not what they should be: every one is refused with a sentence that says where and why.
#include "CameraFile.h"

#include "IoTestSupport.h"

#include <random>

using namespace handeye::io;
using namespace handeye::io::test;

namespace
{

const std::string OpenCVYaml = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n"
                               "   cols: 3\n   dt: d\n   data: [ 601.7, 0., 316.2, 0., 602.9, 244.8, 0., 0., 1. ]\n"
                               "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                               "   data: [ 0.041, -0.112, -0.0007, 0.0011, 0.02 ]\n";

const std::string Xml =
  "<?xml version=\"1.0\"?>\n<opencv_storage>\n<camera_matrix type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols>"
  "<dt>d</dt><data>600. 0. 320. 0. 600. 240. 0. 0. 1.</data></camera_matrix>\n<distortion_coefficients "
  "type_id=\"opencv-matrix\"><rows>1</rows><cols>4</cols><dt>d</dt><data>0. 0. 0. 0.</data>"
  "</distortion_coefficients>\n</opencv_storage>\n";

const std::string Json = R"({"camera_matrix": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
  "data": [600, 0, 320, 0, 600, 240, 0, 0, 1]}, "distortion_coefficients": [0, 0, 0, 0]})";

void expectRefused(const std::string& text, const std::vector<std::string>& words)
{
  const TemporaryFolder folder;
  const auto path = folder.write("camera.yml", text);
  expectFileError([&] { (void)readCameraFile(path); }, words);
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t found = text.find(from);
  EXPECT_NE(found, std::string::npos) << from;
  return text.replace(found, from.size(), to);
}

}  // namespace

TEST(CameraFileDamage, NoCameraFileAtAll)
{
  const TemporaryFolder folder;
  expectFileError([&] { (void)readCameraFile(folder.path() / "none.yml"); }, { "none.yml", "no such file" });
  expectFileError([&] { (void)readCameraFile(folder.path()); }, { "this is a folder" });
  expectRefused("", { "camera.yml", "empty" });
  expectRefused("# only a comment", { "empty" });
  expectRefused(std::string("\x7f\x45LF\0\0\x01", 7), { "not text" });
  expectRefused("hello world\n", { "begins with 'hello world'", "camera file was expected" });
  expectRefused("name: value\n", { "there is no 'camera_matrix'" });
  expectRefused("[1, 2]: 3\n", { "camera.yml" });
  expectRefused("{}", { "there is no 'camera_matrix'" });
  expectRefused("<a/>", { "there is no 'camera_matrix'" });
  expectRefused(
    "<PlusConfiguration version=\"2.1\"><DataCollection StartupDelaySec=\"1.0\"/></PlusConfiguration>", { "camera_matrix" });
}

TEST(CameraFileDamage, Keys_NameWhatWasExpected)
{
  expectRefused(OpenCVYaml.substr(0, OpenCVYaml.find("distortion")), { "there is no 'distortion_coefficients'" });
  expectRefused(replaced(OpenCVYaml, "rows: 3", "rows: 2"), { "'camera_matrix.data' has 9 numbers", "2 * 3" });
  expectRefused(replaced(OpenCVYaml, "rows: 3", "rows: -3"), { "'camera_matrix.rows' is '-3'" });
  expectRefused(replaced(OpenCVYaml, "rows: 3", "rows: 99999999999999"), { "'camera_matrix.rows'" });
  expectRefused(replaced(OpenCVYaml, "   rows: 3\n", ""), { "'camera_matrix.rows' is missing" });
  expectRefused(replaced(OpenCVYaml, "601.7", "wide"), { "'camera_matrix.data'", "not a number", "'wide'" });
  expectRefused(replaced(OpenCVYaml, "601.7", ".Nan"), { "'camera_matrix'", "not finite" });
  expectRefused(replaced(OpenCVYaml, "-0.112", "-.Inf"), { "'distortion_coefficients'", "not finite" });
  expectRefused(replaced(OpenCVYaml, "601.7", "-601.7"), { "do not make a camera" });
  expectRefused(replaced(OpenCVYaml, "601.7, 0.", "601.7, 3."), { "'camera_matrix'", "do not make a camera" });
  expectRefused(replaced(OpenCVYaml, "dt: d", "dt: \"2d\""), { "'camera_matrix.dt' is '2d'" });
  expectRefused(replaced(OpenCVYaml, "image_width: 640\n", ""), { "only one of 'image_width' and 'image_height'" });
  expectRefused(replaced(OpenCVYaml, "640", "640.5"), { "'image_width' is '640.5'", "whole number" });
  expectRefused(replaced(OpenCVYaml, "640", "-640"), { "'image_width' is '-640'" });
}

TEST(CameraFileDamage, CoefficientCounts_OtherThanOpenCVsAreRefused)
{
  const TemporaryFolder folder;
  for (int count = 0; count <= 15; ++count)
  {
    std::string list = "distortion_coefficients: [";
    for (int i = 0; i < count; ++i)
    {
      list += i ? ", 0" : "0";
    }
    const std::string text = OpenCVYaml.substr(0, OpenCVYaml.find("distortion")) + list + "]\n";
    const bool isKnown = count == 0 || count == 4 || count == 5 || count == 8 || count == 12 || count == 14;
    const auto path = folder.write("camera.yml", text);
    if (isKnown)
    {
      EXPECT_EQ(readCameraFile(path).camera.distortionCoefficients().size(), static_cast<std::size_t>(count));
    }
    else
    {
      expectFileError([&] { (void)readCameraFile(path); }, { "'distortion_coefficients'", "0, 4, 5, 8, 12 or 14" });
    }
  }
}

TEST(CameraFileDamage, CutShort_IsRefusedWhereverItHappens)
{
  const TemporaryFolder folder;
  for (const std::string& text : { OpenCVYaml, Xml, Json })
  {
    const auto whole = folder.write("camera", text);
    EXPECT_NO_THROW((void)readCameraFile(whole)) << text.substr(0, 20);
    const std::string content = text.substr(0, text.find_last_of("]>}"));
    for (std::size_t length = 0; length < content.size(); length += 3)
    {
      const auto path = folder.write("camera", content.substr(0, length));
      EXPECT_THROW((void)readCameraFile(path), FileError) << length << " of " << text.substr(0, 20);
    }
  }
}

TEST(CameraFileDamage, Yaml_NamesTheLine)
{
  expectRefused(replaced(OpenCVYaml, "   rows: 3\n", "rows 3\n"), { "line 7", "'cols: 3' or the line before", "key: value" });
  expectRefused(replaced(OpenCVYaml, "   cols: 3\n", "     cols: 3\n"), { "line 7", "'cols: 3'", "indented alike" });
  expectRefused(replaced(OpenCVYaml, "0., 0., 1. ]", "0., 0., 1. "), { "line 10", "every bracket closed" });
  expectRefused(replaced(OpenCVYaml, "[ 601.7, 0.,", "[ 601.7, 0. ] x"), { "line 9", "'data: [ 601.7, 0. ] x", "bracket" });
  expectRefused(OpenCVYaml + "fisheye_model 1\n", { "line 15", "'fisheye_model 1' has no colon", "key: value" });
  expectRefused("image_width: 3\n" + OpenCVYaml.substr(14), { "line 2", "twice" });
}

TEST(CameraFileDamage, Yaml_OnlyTheFirstDocumentCounts)
{
  const TemporaryFolder folder;
  EXPECT_NO_THROW((void)readCameraFile(folder.write("camera", OpenCVYaml + "---\nimage_width: [\n")));
  EXPECT_NO_THROW((void)readCameraFile(folder.write("camera", OpenCVYaml + "...\n")));
  expectRefused("  image_width: 640\n" + OpenCVYaml.substr(OpenCVYaml.find("image_height")), { "line 2", "outside" });
  expectRefused(OpenCVYaml + "- 1\n", { "line 15" });
  EXPECT_NO_THROW((void)readCameraFile(folder.write("camera", "---\n---\n" + OpenCVYaml.substr(OpenCVYaml.find("image")))));
  expectRefused("%YAML 1.2\n]\n", { "line 2", "illegal flow end" });
  expectRefused("---\n, a: 1\n", { "line 2", "outside" });
}

/// A few lines of aliases can stand for any amount of values.
TEST(CameraFileDamage, Yaml_AliasesAreRefused)
{
  std::string bomb = "a: &a [1, 1]\n";
  for (char name = 'b'; name <= 'z'; ++name)
  {
    const std::string before(1, static_cast<char>(name - 1));
    bomb += std::string(1, name) + ": &" + name + " [*" + before + ", *" + before + "]\n";
  }
  expectRefused(bomb, { "line 2", "alias" });
  expectRefused(OpenCVYaml + "b: *none\n", { "line 15" });
}

TEST(CameraFileDamage, Yaml_SizeIsLimited)
{
  expectRefused(OpenCVYaml + std::string(std::size_t(9) << 20, '\n'), { "8 MB" });
}

TEST(CameraFileDamage, Xml_NamesTheLine)
{
  expectRefused(replaced(Xml, "</cols>", "</rows>"), { "line 3", "before 'rows>", "tags mismatch" });
  expectRefused(replaced(Xml, "<dt>", "<rows>3</rows><dt>"), { "line 3", "'rows' twice" });
  expectRefused(replaced(Xml, "<opencv_storage>", "<!DOCTYPE a [<!ENTITY b \"bbb\">]><opencv_storage>"), { "<!DOCTYPE" });
  expectRefused(Xml + "<b/>\n", { "line 6", "beside its root element" });
  expectRefused(Xml + "trailing\n", { "line 6", "'trailing" });
  expectRefused(replaced(Xml, "<dt>", "<_>3</_><dt>"), { "line 3", "mixes" });
  expectRefused(replaced(Xml, "<data>0. 0.", "<data>0. &#0; 0."), { "not a number", "'&#0;'" });
  expectRefused("<?xml vion=", { "cut short" });
}

TEST(CameraFileDamage, DeepNesting_DoesNotUseUpTheStack)
{
  expectRefused("a: " + std::string(100000, '[') + std::string(100000, ']'), { "line 1", "levels deep" });
  expectRefused("a: " + std::string(1000000, '['), { "line 1", "every bracket closed" });
  expectRefused("a: " + std::string(1000000, '{'), { "line 1" });
  std::string dashes = "a:\n ";
  std::string tags;
  std::string closingTags;
  std::string maps;
  std::string keys;
  for (int i = 0; i < 100000; ++i)
  {
    dashes += "- ";
    tags += "<a>";
    closingTags += "</a>";
    maps += "{a: ";
    keys += "? ";
  }
  expectRefused(dashes + "1\n", { "line 2", "levels deep" });
  expectRefused("a: " + maps, { "line 1" });
  expectRefused(keys + ": 1\n", { "line 1", "key" });
  expectRefused(tags + closingTags, { "line 1", "levels deep" });
  expectRefused(tags, { "line 1", "cut short" });
  expectRefused("{\"a\":" + std::string(1000000, '['), { "this is not JSON: line 1, column " });
}

/// Random damage: whatever the bytes, the answer is a camera or a FileError.
TEST(CameraFileDamage, RandomBytes_NeverDoMoreThanAFileError)
{
  const TemporaryFolder folder;
  const std::vector<std::string> seeds = { OpenCVYaml, Xml, Json, "600 0 320\n0 600 240\n0 0 1\n0 0 0 0\n" };
  const std::vector<std::string> pieces = { "[", "]", "{", "}", ":", "- ", "\n", "<a>", "</a>", "\"", "'", "1e999", ".nan", "-",
    "---", "!!opencv-matrix", "|", "<_>", "<!--", "99999999999999999999", "\t", "#" };
  std::mt19937 generator(5);
  int refusedCount = 0;
  for (int i = 0; i < 1000; ++i)
  {
    std::string text = seeds[generator() % seeds.size()];
    for (unsigned damage = 0; damage < 1 + generator() % 4; ++damage)
    {
      const std::size_t position = generator() % (text.size() + 1);
      const unsigned kind = generator() % 3;
      if (kind == 0 && position < text.size())
      {
        text[position] = static_cast<char>(generator());
      }
      else if (kind == 1)
      {
        text.erase(position, 1 + generator() % 20);
      }
      else
      {
        text.insert(position, pieces[generator() % pieces.size()]);
      }
    }
    const auto path = folder.write("camera", text);
    try
    {
      (void)readCameraFile(path);
    }
    catch (const FileError&)
    {
      ++refusedCount;
    }
  }
  EXPECT_GT(refusedCount, 500);
}
