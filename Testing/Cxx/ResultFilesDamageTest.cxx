// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CaptureSimulation.h"
#include "GeometryMatchers.h"
#include "ResultFiles.h"

#include <gtest/gtest.h>

#include <functional>

using namespace handeye;
using namespace handeye::test;
using handeye::io::test::expectFileError;
using handeye::io::test::TemporaryFolder;
using nlohmann::json;

namespace
{

const json IdentityRows = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 }, { 0, 0, 0, 1 } };

const json GoodStylus = { { "status", "ok" }, { "tip_Stylus_Mm", { 1, -2.5, -150 } } };
const json GoodPhantom = { { "status", "ok" }, { "modelToPhantom", IdentityRows } };
const json GoodCalibration = { { "status", "ok" }, { "markerToCamera", IdentityRows }, { "tip_Stylus_Mm", { 1, -2.5, -150 } },
  { "ballRadiusMm", 12 },
  { "camera",
    { { "width", 640 }, { "height", 480 }, { "cameraMatrix", { { 600, 0, 320 }, { 0, 600, 240 }, { 0, 0, 1 } } },
      { "distortionCoefficients", { -0.1, 0.01, 0, 0 } } } } };

class ResultFilesDamage : public testing::Test
{
protected:
  using Read = std::function<void(const std::filesystem::path&)>;

  const Read readStylus = [](const std::filesystem::path& path) { (void)readStylusTip(path); };
  const Read readCamera = [](const std::filesystem::path& path) { (void)readCalibration(path); };
  const Read readPhantom = [](const std::filesystem::path& path) { (void)readPhantomRegistration(path); };
  const TemporaryFolder folder;

  /// A good file with one thing changed is refused, and the sentence names file and key.
  void expectRefused(const Read& read, json object, const std::function<void(json&)>& damage, const std::string& word) const
  {
    damage(object);
    const auto path = folder.write("result.json", object.dump());
    SCOPED_TRACE(object.dump());
    expectFileError([&] { read(path); }, { "result.json", word });
  }

  /// Each of the ways in which a list of numbers can be wrong.
  void expectVectorIsChecked(const Read& read, const json& good, const std::string& key) const
  {
    expectRefused(
      read, good, [&](json& object) { object.erase(key); }, key);
    for (const json& wrong : { json(), json(5), json("1 2 3"), json::array(), json({ 1, 2 }), json({ 1, 2, 3, 4 }),
           json({ 1, "2", 3 }), json({ 1, nullptr, 3 }), json({ 1, { 2 }, 3 }), json{ { "x", 1 } } })
    {
      expectRefused(
        read, good, [&](json& object) { object[key] = wrong; }, key);
    }
  }

  void expectTransformIsChecked(const Read& read, const json& good, const std::string& key) const
  {
    expectRefused(
      read, good, [&](json& object) { object.erase(key); }, key);
    for (const json& wrong : { json(), json(5), json::array(), json({ 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }) })
    {
      expectRefused(
        read, good, [&](json& object) { object[key] = wrong; }, key);
    }
    expectRefused(
      read, good, [&](json& object) { object[key].erase(3); }, key);
    expectRefused(
      read, good, [&](json& object) { object[key][2].erase(3); }, key);
    expectRefused(
      read, good, [&](json& object) { object[key][1][3] = "12"; }, key);
    expectRefused(
      read, good, [&](json& object) { object[key][1][3] = nullptr; }, key);
    expectRefused(
      read, good, [&](json& object) { object[key][0][0] = -1; }, key);
    expectRefused(
      read, good, [&](json& object) { object[key][0][0] = 1.1; }, key);
    expectRefused(
      read, good, [&](json& object) { object[key][3][0] = 7; }, key);
  }
};

}  // namespace

TEST_F(ResultFilesDamage, GoodFiles_AreRead)
{
  EXPECT_EQ(readStylusTip(folder.write("s.json", GoodStylus.dump())), Eigen::Vector3d(1, -2.5, -150));
  EXPECT_EQ(readCalibration(folder.write("c.json", GoodCalibration.dump())).ballRadiusMm, 12);
  EXPECT_EQ(readCalibration(folder.write("c.json", GoodCalibration.dump())).tools.stylusToTracker, "StylusToTracker");
  EXPECT_EQ(readPhantomRegistration(folder.write("p.json", GoodPhantom.dump())).matrix(), Eigen::Matrix4d::Identity());
}

TEST_F(ResultFilesDamage, TipCovariance_IsReadOrRefusedNamingTheKey)
{
  const Read readCovariance = [](const std::filesystem::path& path) { (void)readStylusTipCovariance(path); };
  EXPECT_TRUE(readStylusTipCovariance(folder.write("s.json", GoodStylus.dump())).isZero(0)) << "older files hold none";
  json good = GoodStylus;
  good["tipCovariance_Mm2"] = { { 0.04, 0.01, 0 }, { 0.01, 0.09, 0 }, { 0, 0, 0.01 } };
  EXPECT_EQ(readStylusTipCovariance(folder.write("s.json", good.dump()))(1, 1), 0.09);
  for (const json& wrong : { json(5), json::array(), json({ { 1, 0, 0 }, { 0, 1, 0 } }), json({ { 1, 0 }, { 0, 1 }, { 0, 0 } }),
         json({ { 1, 0, "x" }, { 0, 1, 0 }, { 0, 0, 1 } }), json({ { 1, 0.5, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }),
         json({ { 1, 2, 0 }, { 2, 1, 0 }, { 0, 0, 1 } }), json({ { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }) })
  {
    expectRefused(
      readCovariance, good, [&](json& object) { object["tipCovariance_Mm2"] = wrong; }, "tipCovariance_Mm2");
  }
}

TEST_F(ResultFilesDamage, Stylus_IsRefusedNamingTheKey)
{
  expectVectorIsChecked(readStylus, GoodStylus, "tip_Stylus_Mm");
}

TEST_F(ResultFilesDamage, Phantom_IsRefusedNamingTheKey)
{
  expectTransformIsChecked(readPhantom, GoodPhantom, "modelToPhantom");
}

TEST_F(ResultFilesDamage, Calibration_IsRefusedNamingTheKey)
{
  expectTransformIsChecked(readCamera, GoodCalibration, "markerToCamera");
  expectVectorIsChecked(readCamera, GoodCalibration, "tip_Stylus_Mm");
  for (const json& wrong : { json(), json("12"), json({ 12 }), json(true), json(0), json(-12) })
  {
    expectRefused(
      readCamera, GoodCalibration, [&](json& object) { object["ballRadiusMm"] = wrong; }, "ballRadiusMm");
  }
  expectRefused(
    readCamera, GoodCalibration, [](json& object) { object.erase("ballRadiusMm"); }, "ballRadiusMm");
}

TEST_F(ResultFilesDamage, CalibrationsCamera_IsRefusedNamingTheKey)
{
  expectRefused(
    readCamera, GoodCalibration, [](json& object) { object.erase("camera"); }, "camera");
  expectRefused(
    readCamera, GoodCalibration, [](json& object) { object["camera"] = 5; }, "camera");
  for (const char* key : { "width", "height", "cameraMatrix", "distortionCoefficients" })
  {
    expectRefused(
      readCamera, GoodCalibration, [&](json& object) { object["camera"].erase(key); }, key);
    expectRefused(
      readCamera, GoodCalibration, [&](json& object) { object["camera"][key] = "wrong"; }, key);
    expectRefused(
      readCamera, GoodCalibration, [&](json& object) { object["camera"][key] = nullptr; }, key);
  }
  expectRefused(
    readCamera, GoodCalibration, [](json& object) { object["camera"]["width"] = -640; }, "width");
  expectRefused(
    readCamera, GoodCalibration, [](json& object) { object["camera"]["cameraMatrix"][0][0] = 0; }, "cameraMatrix");
  expectRefused(
    readCamera, GoodCalibration,
    [](json& object) {
      object["camera"]["distortionCoefficients"] = { 1, 2, 3 };
    },
    "distortionCoefficients");
}

TEST_F(ResultFilesDamage, FileWhoseStatusIsNotOk_IsRefused)
{
  const auto fail = [](json& object)
  {
    object["status"] = "too_uncertain";
    object["message"] = "spread them over the image";
  };
  for (const auto& [read, good] :
    { std::pair(readStylus, GoodStylus), std::pair(readCamera, GoodCalibration), std::pair(readPhantom, GoodPhantom) })
  {
    expectRefused(read, good, fail, "too_uncertain");
    expectRefused(read, good, fail, "spread them over the image");
    expectRefused(
      read, good, [](json& object) { object["status"] = 0; }, "status");
    expectRefused(
      read, good, [](json& object) { object["status"] = nullptr; }, "status");
  }
}

TEST_F(ResultFilesDamage, WhatIsNoResultFile_IsRefused)
{
  for (const Read& read : { readStylus, readCamera, readPhantom })
  {
    expectFileError([&] { read(folder.path() / "none.json"); }, { "none.json", "cannot be opened" });
    expectFileError([&] { read(folder.path()); }, { "cannot be opened" });
    expectFileError([&] { read(folder.write("result.json", "")); }, { "result.json", "JSON" });
    expectFileError([&] { read(folder.write("result.json", "{\"status\": \"ok\", ")); }, { "result.json", "JSON" });
    expectFileError([&] { read(folder.write("result.json", "[1, 2, 3]")); }, { "result.json", "JSON object" });
    expectFileError([&] { read(folder.write("result.json", "{}")); }, { "result.json", "missing" });
    expectFileError(
      [&] { read(folder.write("result.json", std::string("\x89PNG\r\n\x1a\n\0\0", 10))); }, { "result.json", "JSON" });
  }
}

TEST_F(ResultFilesDamage, FolderThatIsNotThere_CannotBeWrittenTo)
{
  expectFileError([&] { writeJson(folder.path() / "none" / "stylus.json", GoodStylus); }, { "none" });
  EXPECT_EQ(folder.entryCount(), 0U);
}
