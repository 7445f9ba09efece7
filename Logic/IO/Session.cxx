// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Session.h"

#include "AtomicFile.h"
#include "FileError.h"
#include "ImageFile.h"
#include "JsonWords.h"
#include "NumberText.h"
#include "SequenceMetafileWriter.h"
#include "SessionJson.h"
#include "TextFile.h"

#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye::io
{

namespace
{

using Json = nlohmann::json;
using Path = std::filesystem::path;

constexpr const char* Schema = "handeye-session/1";
constexpr std::size_t LargestDocument = std::size_t(64) << 20;
constexpr std::size_t LargestImage = std::size_t(1) << 30;

std::uint32_t crcOf(const void* bytes, std::size_t count)
{
  return std::uint32_t(crc32_z(0, static_cast<const Bytef*>(bytes), count));
}

void makeFolder(const Path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
  {
    throw FileError(folder, "the folder cannot be made (" + error.message() + ")");
  }
}

/// The files of a folder in the order of their names.
std::vector<Path> filesOf(const Path& folder)
{
  std::vector<Path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
  {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool isTemporary(const Path& file)
{
  const std::string name = file.filename().string();
  return name.rfind(".handeye-", 0) == 0 && file.extension() == ".tmp";
}

/// Whatever could not be written, or not be read again.
void checkSample(const SessionSample& sample)
{
  if (!std::isfinite(sample.timeSec))
  {
    throw std::invalid_argument("a session's sample: its time is not finite");
  }
  for (const auto& [name, transform] : sample.transforms)
  {
    const bool isName = !name.empty() && name.find_first_of(" \t\r\n=") == std::string::npos &&
      (withoutTransformSuffix(name) == name || sample.transforms.count(withoutTransformSuffix(name)) == 0);
    if (!isName || transform.status.find_first_of("\r\n") != std::string::npos ||
      (transform.matrix && !transform.matrix->allFinite()))
    {
      throw std::invalid_argument("a session's sample: the transform " + inQuotes(name) +
        " is not finite, or its name or status cannot be written (blanks, '=', line ends, or there twice)");
    }
  }
  try
  {
    (void)toJson(StoredSample{ sample, 0, 0 }).dump();
  }
  catch (const Json::exception& error)
  {
    throw std::invalid_argument(std::string("a session's sample cannot be written (") + error.what() + ")");
  }
}

/// 0 where a sample does not say.
double latencyOf(const SessionSample& sample)
{
  const Json value = sample.pairing.is_object() ? sample.pairing.value("latencySec", Json()) : Json();
  return value.is_number() ? value.get<double>() : 0;
}

/// Whether a folder is empty, or has no more than what a session leaves that was killed while it was being made: its lock, and what
/// has nothing in it.
bool isBegun(const Path& folder)
{
  const std::vector<Path> files = filesOf(folder);
  const auto isOurs = [](const Path& file)
  {
    const std::string name = file.filename().string();
    const bool isPart = name == "frames" || name == "samples" || name == "documents";
    return name == ".lock" || name == "tracking.igs.mha" || isTemporary(file) ||
      (isPart && std::filesystem::is_directory(file) && std::filesystem::is_empty(file));
  };
  return files.empty() || (std::filesystem::exists(folder / ".lock") && std::all_of(files.begin(), files.end(), isOurs));
}

bool isDocumentName(const std::string& name)
{
  const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  return !name.empty() && name.size() < 100 && name.find_first_not_of(allowed) == std::string::npos;
}

}  // namespace

/// Held as long as the session is open; gone with the program, however it ends.
struct Session::Lock
{
  explicit Lock(const Path& folder)
    : descriptor(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666))
  {
    if (descriptor < 0)
    {
      throw FileError(folder, "the session cannot be written to");
    }
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0)
    {
      close(descriptor);
      throw FileError(folder, "another program has this session open");
    }
  }
  ~Lock() { close(descriptor); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  int descriptor;
};

Session::Session(const Path& folder)
  : folder_(folder)
{
}

Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Session Session::create(const Path& folder)
{
  makeFolder(folder);
  if (!isBegun(folder))
  {
    throw FileError(folder, "the folder is not empty; a session is made in an empty or new one");
  }
  Session session(folder);
  session.lock_ = std::make_unique<Lock>(folder);
  for (const char* part : { "frames", "samples", "documents" })
  {
    makeFolder(folder / part);
  }
  session.writeTracking();
  writeFileAtomically(folder / "session.json", Json({ { "schema", Schema } }).dump(2) + "\n");
  return session;
}

Session Session::open(const Path& folder)
{
  const Path file = folder / "session.json";
  std::string schema;
  try
  {
    schema = Json::parse(readWholeFile(file, LargestDocument)).at("schema").get<std::string>();
  }
  catch (const Json::exception& error)
  {
    throw FileError(file, "this is no session (" + jsonProblem(error) + ")");
  }
  if (schema != Schema)
  {
    throw FileError(file, "the schema is " + inQuotes(schema) + ", perhaps of a newer version; " + Schema + " was expected");
  }
  Session session(folder);
  session.lock_ = std::make_unique<Lock>(folder);
  session.read();
  session.refreshTracking();
  return session;
}

Session Session::openOrCreate(const Path& folder)
{
  return std::filesystem::exists(folder / "session.json") ? open(folder) : create(folder);
}

void Session::read()
{
  for (const char* part : { "", "frames", "samples", "documents" })
  {
    const Path inside = folder_ / part;
    if (!std::filesystem::is_directory(inside))
    {
      problems_.push_back("the folder '" + inside.string() + "' is missing; it was made anew");
      makeFolder(inside);
    }
    for (const Path& file : filesOf(inside))
    {
      std::error_code ignored;
      if (isTemporary(file))
      {
        std::filesystem::remove(file, ignored);
      }
    }
  }
  for (const Path& file : filesOf(folder_ / "samples"))
  {
    const int id = idOf(file, ".json");
    if (id < 0)
    {
      problems_.push_back(file.string() + ": this is no name for a sample; it is left alone");
      continue;
    }
    nextId_ = std::max(nextId_, id + 1);
    try
    {
      readSample(file, id);
    }
    catch (const FileError& error)
    {
      problems_.push_back(error.what());
    }
  }
  for (const Path& file : filesOf(folder_ / "frames"))
  {
    const int id = idOf(file, ".png");
    nextId_ = std::max(nextId_, id + 1);
    if (id >= 0 && !std::filesystem::exists(folder_ / "samples" / (frameDigits(id) + ".json")))
    {
      problems_.push_back(file.string() + ": the image of a sample that was not accepted any more, or whose file is gone");
    }
  }
  for (const Path& file : filesOf(folder_ / "documents"))
  {
    try
    {
      documents_[file.stem().string()] = Json::parse(readWholeFile(file, LargestDocument));
    }
    catch (const Json::exception& error)
    {
      problems_.push_back(file.string() + ": the document cannot be read (" + jsonProblem(error) + ")");
    }
    catch (const std::exception& error)
    {
      problems_.push_back(file.string() + ": the document cannot be read (" + printable(error.what()) + ")");
    }
  }
}

void Session::readSample(const Path& path, int id)
{
  const StoredSample stored = parseSample(path, id);
  const Path imagePath = folder_ / "frames" / (frameDigits(id) + ".png");
  const std::string bytes = readWholeFile(imagePath, LargestImage);
  if (bytes.size() != stored.imageBytes || crcOf(bytes.data(), bytes.size()) != stored.imageCrc)
  {
    throw FileError(imagePath, "the image is not the one that was stored: its size or checksum differs");
  }
  samples_[id] = stored.sample;
  images_[id] = { stored.imageBytes, stored.imageCrc };
}

int Session::addSample(const cv::Mat& image, SessionSample sample)
{
  checkSample(sample);
  std::vector<std::uint8_t> png;
  if (image.empty() || !cv::imencode(".png", image, png, { cv::IMWRITE_PNG_COMPRESSION, 1 }))
  {
    throw std::invalid_argument("an image of 8 or 16 bits is expected for a session's sample");
  }
  if (!fitsLatency(latencyOf(sample)))
  {
    const auto inMs = [](double sec) { return formatDouble(std::round(1e4 * sec) / 10) + " ms"; };
    throw std::invalid_argument("the session's samples have a latency of " + inMs(*latencySec()) + ", this one of " +
      inMs(latencyOf(sample)) + ": set the latency to " + inMs(*latencySec()) + ", or begin a new session");
  }
  sample.id = nextId_;
  const Path imagePath = folder_ / "frames" / (frameDigits(sample.id) + ".png");
  writeFileAtomically(imagePath, { reinterpret_cast<const char*>(png.data()), png.size() });
  const StoredImage stored{ png.size(), crcOf(png.data(), png.size()) };
  try
  {
    writeSample(sample, stored.bytes, stored.crc);
  }
  catch (...)
  {
    std::error_code ignored;
    std::filesystem::remove(imagePath, ignored);
    throw;
  }
  ++nextId_;
  images_[sample.id] = stored;
  samples_[sample.id] = std::move(sample);
  refreshTracking();
  return nextId_ - 1;
}

void Session::writeSample(const SessionSample& sample, std::size_t imageBytes, std::uint32_t imageCrc)
{
  writeFileAtomically(
    folder_ / "samples" / (frameDigits(sample.id) + ".json"), toJson(StoredSample{ sample, imageBytes, imageCrc }).dump(2) + "\n");
}

void Session::setExcluded(const std::vector<int>& ids, bool isExcluded)
{
  bool isChanged = false;
  for (const int id : ids)
  {
    SessionSample changed = samples_.at(id);
    if (changed.isExcluded != isExcluded)
    {
      changed.isExcluded = isExcluded;
      writeSample(changed, images_.at(id).bytes, images_.at(id).crc);
      samples_[id] = std::move(changed);
      isChanged = true;
    }
  }
  if (isChanged)
  {
    refreshTracking();
  }
}

/// The accepted samples stay accepted when this fails: it follows from them, and is tried again each time.
void Session::refreshTracking()
{
  try
  {
    writeTracking();
  }
  catch (const std::exception& error)
  {
    problems_.push_back(error.what());
  }
}

void Session::writeTracking()
{
  SequenceMetafileWriterOptions options;
  options.transformsOnly = true;
  options.fields[AppliedLatencyField] = formatDouble(latencySec().value_or(0));
  SequenceMetafileWriter writer(folder_ / "tracking.igs.mha", options);
  for (int id = 0; id < nextId_; ++id)
  {
    SequenceFrame frame;
    const auto sample = samples_.find(id);
    if (sample != samples_.end())
    {
      frame.timestampSec = sample->second.timeSec;
      frame.fields["Excluded"] = sample->second.isExcluded ? "1" : "0";
      if (!sample->second.isExcluded)
      {
        frame.transforms = sample->second.transforms;
      }
    }
    writer.append(frame);
  }
  writer.close();
}

void Session::setDocument(const std::string& name, const Json& document)
{
  if (!isDocumentName(name))
  {
    throw std::invalid_argument("'" + name + "' is no name for a document: letters, digits, '-' and '_' are expected");
  }
  writeFileAtomically(folder_ / "documents" / (name + ".json"), document.dump(2) + "\n");
  documents_[name] = document;
}

std::optional<Json> Session::document(const std::string& name) const
{
  const auto found = documents_.find(name);
  return found == documents_.end() ? std::nullopt : std::optional<Json>(found->second);
}

std::vector<std::string> Session::documentNames() const
{
  std::vector<std::string> names;
  for (const auto& document : documents_)
  {
    names.push_back(document.first);
  }
  return names;
}

bool Session::fitsLatency(double sec) const
{
  constexpr double toleranceSec = 1.01e-4;
  return std::abs(latencySec().value_or(sec) - sec) <= toleranceSec;
}

std::optional<double> Session::latencySec() const
{
  return samples_.empty() ? std::nullopt : std::optional<double>(latencyOf(samples_.begin()->second));
}

cv::Mat Session::image(int id) const
{
  return readImage(folder_ / "frames" / (frameDigits(samples_.at(id).id) + ".png"));
}

}  // namespace handeye::io
