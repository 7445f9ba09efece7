// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CameraFileWriter.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace handeye
{

/// Result files of a session, as the formats of other programs take them.
struct ExportSources
{
  std::filesystem::path calibration;   ///< calibration.json, or another file with a lens and the marker's place
  std::filesystem::path stylus;        ///< stylus.json: adds StylusTipToStylus (plus, mrml); may be empty
  std::filesystem::path registration;  ///< phantom.json: adds ModelToPhantom (plus, mrml); may be empty
  std::filesystem::path model;         ///< the mesh that a scene shows (mrml); may be empty
};

struct ExportFormat
{
  std::string word;      ///< "plus", as --format takes it
  std::string name;      ///< "PLUS configuration"
  std::string fileName;  ///< "HandEye.plus.xml": what a file of this format is called if nobody says otherwise
  bool isOneCamera;      ///< a second eye of a stereo rig is left out
};

/// The words for the kinds of camera file: "opencv", "ros", ...
const std::map<std::string, io::CameraFormat>& cameraFormats();

/// All formats that a calibration is exported in, each once.
const std::vector<ExportFormat>& exportFormats();

struct ExportResult
{
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;  ///< sentences: what the format cannot hold, what its readers are known to do
};

/// Writes a calibration in the format of another program.
/// @param format a word of exportFormats() @param file what to write; some formats take a second file beside it
/// @throws io::FileError naming the file and what was expected; std::invalid_argument for a format that is none
[[nodiscard]] ExportResult exportCalibration(
  const ExportSources& sources, const std::string& format, const std::filesystem::path& file);

}  // namespace handeye
