// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SessionJson.h"

#include "FileError.h"
#include "JsonWords.h"
#include "NumberText.h"
#include "TextFile.h"

#include <cmath>

namespace handeye::io
{

namespace
{

using Json = nlohmann::json;

constexpr std::size_t LargestSample = std::size_t(16) << 20;
constexpr const char* Schema = "handeye-sample/1";

Json rowsOf(const Eigen::Matrix4d& matrix)
{
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row)
  {
    rows.push_back({ matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3) });
  }
  return rows;
}

Eigen::Matrix4d matrixOf(const Json& rows)
{
  Eigen::Matrix4d matrix;
  for (std::size_t i = 0; i < 16; ++i)
  {
    matrix(Eigen::Index(i / 4), Eigen::Index(i % 4)) = rows.at(i / 4).at(i % 4).get<double>();
  }
  return matrix;
}

}  // namespace

std::string frameDigits(int id)
{
  const std::string digits = std::to_string(id);
  return std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

int idOf(const std::filesystem::path& path, const std::string& extension)
{
  const std::string stem = path.stem().string();
  const std::optional<long long> number = parseInteger(stem);
  const bool isGood =
    path.extension() == extension && number && *number >= 0 && *number < 1000000 && frameDigits(int(*number)) == stem;
  return isGood ? int(*number) : -1;
}

Json toJson(const StoredSample& stored)
{
  const SessionSample& sample = stored.sample;
  Json object = { { "schema", Schema }, { "timeSec", sample.timeSec }, { "excluded", sample.isExcluded },
    { "image", { { "bytes", stored.imageBytes }, { "crc32", stored.imageCrc } } }, { "detection", sample.detection },
    { "pairing", sample.pairing }, { "transforms", Json::object() } };
  for (const auto& [name, transform] : sample.transforms)
  {
    object["transforms"][name] = { { "status", transform.status } };
    if (transform.matrix)
    {
      object["transforms"][name]["matrix"] = rowsOf(*transform.matrix);
    }
  }
  return object;
}

StoredSample parseSample(const std::filesystem::path& path, int id)
{
  try
  {
    const Json object = Json::parse(readWholeFile(path, LargestSample));
    if (object.at("schema") != Schema)
    {
      throw FileError(path, "the schema is " + printable(object.at("schema").dump()) + "; " + Schema + " was expected");
    }
    StoredSample stored;
    stored.imageBytes = object.at("image").at("bytes").get<std::size_t>();
    stored.imageCrc = object.at("image").at("crc32").get<std::uint32_t>();
    SessionSample& sample = stored.sample;
    sample.id = id;
    sample.timeSec = object.at("timeSec").get<double>();
    sample.isExcluded = object.at("excluded").get<bool>();
    sample.detection = object.at("detection");
    sample.pairing = object.at("pairing");
    for (const auto& [name, transform] : object.at("transforms").items())
    {
      SequenceTransform& read = sample.transforms[name];
      read.status = transform.at("status").get<std::string>();
      if (transform.contains("matrix"))
      {
        read.matrix = matrixOf(transform.at("matrix"));
      }
    }
    return stored;
  }
  catch (const Json::exception& error)
  {
    throw FileError(path, "this is no sample of a session (" + jsonProblem(error) + ")");
  }
}

}  // namespace handeye::io
