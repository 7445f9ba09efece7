// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationExport.h"
#include "CommandOutput.h"
#include "Commands.h"
#include "ExportFormats.h"

#include <iostream>
#include <memory>

namespace handeye::cli
{

namespace
{

struct ExportArguments
{
  std::string calibration, format, stylus, registration, model;
  CommandOutput output;
};

int runExport(ExportArguments& arguments)
{
  const ExportSources sources{ arguments.calibration, arguments.stylus, arguments.registration, arguments.model };
  const ExportResult result = exportCalibration(sources, arguments.format, arguments.output.file);
  arguments.output.warn(result.warnings);
  return finishExport(arguments.output, arguments.format, result.files);
}

}  // namespace

int finishExport(const CommandOutput& output, const std::string& format, const std::vector<std::filesystem::path>& written)
{
  nlohmann::json result = { { "schema", "handeye-export/1" }, { "status", "ok" }, { "message", "written as " + format } };
  for (const std::filesystem::path& path : written)
  {
    result["files"].push_back(path.string());
    output.say("written to " + path.string());
  }
  if (output.json)
  {
    std::cout << result.dump(2) << std::endl;
  }
  return Good;
}

void addExportCommand(CLI::App& app, int& exitCode)
{
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write a calibration in the formats of other programs");
  command->add_option("calibration", arguments->calibration, "calibration.json, or another file with a lens and the marker's place")
    ->required()
    ->type_name("CALIBRATION");
  std::vector<std::string> formats;
  for (const ExportFormat& format : exportFormats())
  {
    formats.push_back(format.word);
  }
  command->add_option("--format", arguments->format, "What to write")
    ->required()
    ->check(CLI::IsMember(formats))
    ->type_name("plus|tfm|mrml|pinhole-xml|ros|opencv|text|vasst|json");
  command->add_option("--stylus", arguments->stylus, "stylus.json: adds StylusTipToStylus (plus, mrml)")->type_name("FILE");
  CLI::Option* registration =
    command->add_option("--registration", arguments->registration, "phantom.json: adds ModelToPhantom (plus, mrml)")
      ->type_name("FILE");
  command->add_option("--model", arguments->model, "Mesh that the scene shows (mrml)")->type_name("MESH")->needs(registration);
  arguments->output.addTo(*command);
  command->get_option("--output")->required();
  command->callback([arguments, &exitCode] { exitCode = runExport(*arguments); });
}

}  // namespace handeye::cli
