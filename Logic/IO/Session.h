// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SequenceMetafile.h"

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace handeye::io
{

/// One accepted sample of a session.
struct SessionSample
{
  int id = -1;                                          ///< the number of its frame; given by the session
  double timeSec = 0;                                   ///< of the image
  std::map<std::string, SequenceTransform> transforms;  ///< the poses of its moment, mm; each with "OK" or why it is not usable
  nlohmann::json detection;                             ///< what was found in the image
  nlohmann::json pairing;                               ///< how image and poses came together: gaps, latency, ...
  bool isExcluded = false;                              ///< set aside by the user; stays on the disk and can be brought back
};

/// A folder in which everything that was accepted is kept, and from which the whole state comes back.
///
///     session.json             schema and version
///     frames/0000.png          the image of sample 0, as it was
///     samples/0000.json        its time, transforms, detection; the sample is accepted once this file is there
///     tracking.igs.mha         the samples' transforms; with it the folder is a recording that every command takes
///     documents/NAME.json      stylus, calibration, phantom, settings, ...
///
/// addSample() returns when image and sample are on the disk (flushed, renamed): what it returned is never lost, whenever the
/// program
/// or the computer dies. tracking.igs.mha follows from the samples and is written anew when it does not fit them. Excluded samples
/// have
/// no transforms there.
///
/// open() reports what is damaged (an image whose checksum differs, a sample that cannot be read) in problems() and opens the rest;
/// nothing is deleted but temporary files of a program that died. One program at a time has a session open.
///
/// Not safe to share between threads.
class Session
{
public:
  /// @throws FileError where the folder holds something else, or cannot be written to
  [[nodiscard]] static Session create(const std::filesystem::path& folder);
  /// @throws FileError where there is no session, it is of a newer version, or another program has it open
  [[nodiscard]] static Session open(const std::filesystem::path& folder);
  /// Opens a session if there is one.
  [[nodiscard]] static Session openOrCreate(const std::filesystem::path& folder);

  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  /// Stores a sample. @return its id
  /// @throws FileError where it cannot be stored (disk full); nothing is accepted then, and the session goes on as before
  /// @throws std::invalid_argument before anything is written: for an empty image, numbers that are not finite, names or statuses
  /// of transforms that a sequence metafile cannot hold (blanks, '=', line ends) and text that is no UTF-8
  int addSample(const cv::Mat& image, SessionSample sample);

  /// Sets samples aside, or brings them back. @throws FileError; std::out_of_range for an id that there is not
  void setExcluded(int id, bool isExcluded) { setExcluded(std::vector<int>{ id }, isExcluded); }
  void setExcluded(const std::vector<int>& ids, bool isExcluded);

  /// Stores a result or settings under a name of letters, digits, '-' and '_'. @throws FileError; std::invalid_argument for other
  /// names
  void setDocument(const std::string& name, const nlohmann::json& document);
  /// Nothing if there is none (or it is damaged: see problems()).
  std::optional<nlohmann::json> document(const std::string& name) const;
  std::vector<std::string> documentNames() const;

  const std::filesystem::path& folder() const { return folder_; }
  const std::map<int, SessionSample>& samples() const { return samples_; }
  /// The latency that the samples' poses have been taken at (`latencySec` of their pairing); nothing without samples. All have
  /// the same: addSample() refuses others.
  std::optional<double> latencySec() const;
  /// Whether poses that were taken at this latency go together with the samples: there are none, or theirs is the same to 0.1 ms,
  /// which is less than can be measured, and in which a hand moves a few hundredths of a mm.
  bool fitsLatency(double latencySec) const;
  /// The image of a sample. @throws FileError
  cv::Mat image(int id) const;

  /// Sentences about what is damaged.
  const std::vector<std::string>& problems() const { return problems_; }

private:
  explicit Session(const std::filesystem::path& folder);
  void read();
  void readSample(const std::filesystem::path& path, int id);
  void writeSample(const SessionSample& sample, std::size_t imageBytes, std::uint32_t imageCrc);
  void writeTracking();
  void refreshTracking();

  struct Lock;
  struct StoredImage
  {
    std::size_t bytes = 0;
    std::uint32_t crc = 0;
  };

  std::filesystem::path folder_;
  std::unique_ptr<Lock> lock_;
  std::map<int, SessionSample> samples_;
  std::map<int, StoredImage> images_;
  std::map<std::string, nlohmann::json> documents_;
  int nextId_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace handeye::io
