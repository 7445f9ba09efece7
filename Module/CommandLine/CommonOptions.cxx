// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CommonOptions.h"

#include <cmath>
#include <map>

namespace handeye::cli
{

namespace
{

/// An option that takes one of some words.
template<typename Choice>
void addChoice(CLI::App& command, const std::string& option, Choice& chosen, const std::map<std::string, Choice>& choices,
  const std::string& byDefault, const std::string& what)
{
  std::string words;
  for (const auto& choice : choices)
  {
    words += (words.empty() ? "" : "|") + choice.first;
  }
  command
    .add_option_function<std::string>(
      option,
      [option, &chosen, choices, words](const std::string& word)
      {
        const auto found = choices.find(word);
        if (found == choices.end())
        {
          throw CLI::ValidationError(option, "'" + word + "' is not one of " + words);
        }
        chosen = found->second;
      },
      what)
    ->type_name(words)
    ->default_str(byDefault);
}

}  // namespace

void addRecordingArgument(CLI::App& command, std::string& recording, const std::string& what)
{
  command.add_option("recording", recording, what)->required()->type_name("RECORDING");
}

void addCameraOption(CLI::App& command, std::string& camera)
{
  command.add_option("--camera", camera, "Lens: OpenCV, ROS, SlicerPinholeCameras, VASST, scikit-surgery or calibration.json")
    ->required()
    ->type_name("CAMERA");
}

void addBallRadiusOption(CLI::App& command, double& ballRadiusMm)
{
  const auto isRadius = [](const std::string& text)
  {
    double radius = 0;
    const bool good = CLI::detail::lexical_cast(text, radius) && radius > 0 && std::isfinite(radius);
    return good ? std::string() : "'" + text + "' is not a radius, a positive number of mm is expected";
  };
  command.add_option("--ball-radius", ballRadiusMm, "Radius of the ball, mm")
    ->required()
    ->check(CLI::Validator(isRadius, std::string()))
    ->type_name("MM");
}

void addSegmentationOption(CLI::App& command, BallDetectionOptions::Method& method)
{
  using Method = BallDetectionOptions::Method;
  addChoice<Method>(command, "--segmentation", method, { { "exact", Method::Exact }, { "hough", Method::Hough } }, "exact",
    "How the ball is found: by its outline's cone of rays, or by the paper's pipeline");
}

void addSolverOption(CLI::App& command, PointLineOptions::Method& method)
{
  using Method = PointLineOptions::Method;
  std::map<std::string, Method> methods;
  for (const Method named : { Method::MaximumLikelihood, Method::Global, Method::Procrustes, Method::OrthogonalIteration,
         Method::ProcrustesPnP, Method::Epnp, Method::Sqpnp, Method::Iterative })
  {
    methods[toString(named)] = named;
  }
  method = Method::MaximumLikelihood;
  addChoice<Method>(command, "--method", method, methods, "ml",
    "How points are brought onto lines: ml (most likely under the noise), global (least distance), procrustes (the paper's "
    "iteration); for comparison oi, ppnp, and OpenCV's epnp, sqpnp, iterative");
}

void addSigmaOption(CLI::App& command, const std::string& option, double& sigma, const std::string& what)
{
  const auto isSigma = [](const std::string& text)
  {
    double value = 0;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= 0 && std::isfinite(value);
    return good ? std::string() : "'" + text + "' is not a standard deviation, a number of at least 0 is expected";
  };
  command.add_option(option, sigma, what)->check(CLI::Validator(isSigma, std::string()))->capture_default_str();
}

void addPivotMethodOption(CLI::App& command, PivotMethod& method)
{
  std::map<std::string, PivotMethod> choices;
  for (const PivotMethod choice :
    { PivotMethod::Robust, PivotMethod::AlgebraicOneStep, PivotMethod::AlgebraicTwoStep, PivotMethod::SphereFit })
  {
    choices[toString(choice)] = choice;
  }
  addChoice<PivotMethod>(command, "--method", method, choices, toString(method),
    "How the tip is found: robustly, or by a classical method that takes all poses");
}

namespace
{

template<typename Seconds> void addLatency(CLI::App& command, Seconds& latencySec)
{
  const auto store = [&latencySec](const double& latencyMs) { latencySec = latencyMs / 1000; };
  command
    .add_option_function<double>(
      "--latency", store, "The poses of an image are those at its time plus this, ms; see `handeye latency`")
    ->check(CLI::Range(-10000.0, 10000.0))
    ->type_name("MS");
}

}  // namespace

void addLatencyOption(CLI::App& command, double& latencySec)
{
  addLatency(command, latencySec);
}

void addLatencyOption(CLI::App& command, std::optional<double>& latencySec)
{
  addLatency(command, latencySec);
}

double chooseLatency(const std::optional<double>& asked, double ofCalibrationSec, const CommandOutput& output)
{
  if (asked && ofCalibrationSec != 0 && std::abs(*asked - ofCalibrationSec) > 1e-6)
  {
    output.warn({ format("--latency %.1f is taken instead of the calibration's %.1f ms", 1000 * *asked, 1000 * ofCalibrationSec) });
  }
  return asked.value_or(ofCalibrationSec);
}

void addCalibrationOption(CLI::App& command, std::string& calibration)
{
  command.add_option("--calibration", calibration, "What `handeye calibrate` wrote")->required()->type_name("calibration.json");
}

CLI::Option* addTransformOption(CLI::App& command, const std::string& option, std::string& name, const std::string& what)
{
  CLI::Option* added = command.add_option(
    option, name, "Pose of the " + what + " in the recording" + (name.empty() ? ", if not the calibration's" : ""));
  added->type_name("NAME");
  return name.empty() ? added : added->capture_default_str();
}

}  // namespace handeye::cli
