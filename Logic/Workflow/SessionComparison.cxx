// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SessionComparison.h"

#include "BallDetector.h"
#include "ComparedBoardCapture.h"
#include "ComparedBoardMethods.h"
#include "DistinctCaptures.h"
#include "NumberWords.h"
#include "TimedPose.h"

#include <cmath>

namespace handeye
{

namespace
{

/// One comparison under way; steps return early once it was stopped.
class SessionComparer
{
public:
  SessionComparer(const SessionComparisonInput& input, const ComparisonProgress& progress)
    : input_(input)
    , progress_(progress)
  {
  }

  SessionComparison run()
  {
    addPaths();
    const io::Recording capture = io::Recording::open(input_.captureFolder);
    SessionComparison comparison{ {}, cameraForRecording(input_.camera, capture), {}, input_.validation, {}, {} };
    comparison.validation = toSamples(input_.validation);
    comparison.validationRecording = io::Recording::open(input_.validationFolder);
    comparison.facts = { describeInput(comparison) };
    distinct_.addSamples(input_.validationFolder, comparison.validation);
    std::vector<BallCapture> balls = { ownCapture(capture, comparison) };
    for (const std::filesystem::path& path : input_.otherCaptures)
    {
      balls.push_back(otherCapture(path, comparison));
    }
    std::vector<ComparedMethod> methods = ballMethods(balls, comparison.camera, calibrationOptions());
    for (ComparedMethod& method : readBoard(comparison))
    {
      methods.push_back(std::move(method));
    }
    if (isStopped_)
    {
      comparison.result.wasStopped = true;
      comparison.result.status = "stopped";
      comparison.result.message = "stopped before all methods were compared";
      return comparison;
    }
    ComparisonOptions options = input_.comparison;
    options.progress = [this](const std::string& what, int done, int total) { return tell("comparing " + what, done, total); };
    comparison.result = compareMethods(methods, comparison.validation, comparison.camera, options);
    return comparison;
  }

private:
  void addPaths()
  {
    distinct_.addPath(input_.validationFolder, "the validation set");
    distinct_.addPath(input_.captureFolder, "the session's own capture");
    for (const std::filesystem::path& path : input_.otherCaptures)
    {
      distinct_.addPath(path, "a further capture");
    }
  }

  bool tell(const std::string& what, int done, int total)
  {
    isStopped_ = isStopped_ || (progress_ && !progress_(what, done, total));
    return !isStopped_;
  }
  Progress telling(const std::string& what)
  {
    return [this, what](int done, int total) { return tell(what, done, total); };
  }

  HandEyeCalibrationOptions calibrationOptions() const
  {
    HandEyeCalibrationOptions options;
    options.tipCovariance_Stylus = input_.tipCovariance_Stylus;
    return options;
  }

  std::string describeInput(const SessionComparison& comparison) const
  {
    const CameraModel& camera = comparison.camera;
    return "Validation: " + input_.validationFolder.string() + ", " + std::to_string(comparison.validation.size()) +
      " samples. Lens: " + input_.lensOrigin + ", " + std::to_string(camera.width()) + " x " + std::to_string(camera.height()) +
      " px, fx " + fixedDigits(camera.fx(), 1) + ", fy " + fixedDigits(camera.fy(), 1) + " px. Ball: radius " +
      fixedDigits(input_.ballRadiusMm, 2) + " mm.";
  }

  static std::string describeBall(const std::filesystem::path& path, const BallCapture& capture)
  {
    return "Ball: " + path.string() + ", " + std::to_string(capture.samples.size()) + " samples, " +
      std::to_string(capture.publishedSamples.size()) + " by the paper's segmentation.";
  }

  BallDetectionOptions publishedDetection() const
  {
    BallDetectionOptions options = input_.detection;
    options.method = BallDetectionOptions::Method::Hough;
    return options;
  }

  /// The session's samples, and the same pictures by the paper's segmentation.
  BallCapture ownCapture(const io::Recording& recording, SessionComparison& comparison)
  {
    const BallDetector detector(comparison.camera, input_.ballRadiusMm, publishedDetection());
    std::vector<CapturedFrame> published;
    for (std::size_t i = 0; i < input_.capture.size() && !isStopped_; ++i)
    {
      CapturedFrame frame = input_.capture[i];
      if (frame.tip_Marker && recording.hasImage(frame.frame))
      {
        frame.ball = detector.detect(recording.image(frame.frame));
        frame.status = toString(frame.ball.status);
        published.push_back(std::move(frame));
      }
      tell("looking for the ball as the paper does", int(i) + 1, int(input_.capture.size()));
    }
    BallCapture capture{ toSamples(input_.capture), toSamples(published) };
    distinct_.addSamples(input_.captureFolder, capture.samples);
    comparison.facts.push_back(describeBall(input_.captureFolder, capture));
    return capture;
  }

  BallCapture otherCapture(const std::filesystem::path& path, SessionComparison& comparison)
  {
    BallCapture capture;
    if (isStopped_)
    {
      return capture;
    }
    const io::Recording recording = io::Recording::open(path);
    const CameraModel camera = cameraForRecording(comparison.camera, recording);
    ToolNames tools = input_.tools;
    // The poses of a session are those of its samples' own moments.
    tools.latencySec = std::filesystem::exists(path / "session.json") ? 0 : tools.latencySec;
    const std::vector<std::string> notes = latencyNotes(recording, tools.latencySec);
    const auto read = [&](const BallDetectionOptions& options, const std::string& what)
    {
      return toSamples(
        readCapture(recording, tools, camera, input_.tip_Stylus, input_.ballRadiusMm, options, telling(what + path.string())));
    };
    capture.samples = read(input_.detection, "looking for the ball in ");
    distinct_.addSamples(path, capture.samples);
    capture.publishedSamples = isStopped_ ? std::vector<HandEyeSample>() : read(publishedDetection(), "as the paper does, in ");
    comparison.facts.push_back(describeBall(path, capture));
    comparison.facts.insert(comparison.facts.end(), notes.begin(), notes.end());
    return capture;
  }

  std::vector<ComparedMethod> readBoard(SessionComparison& comparison)
  {
    if (input_.boardRecording.empty() || !input_.board || isStopped_)
    {
      return {};
    }
    const io::Recording recording = io::Recording::open(input_.boardRecording);
    const std::vector<std::string> notes = latencyNotes(recording, input_.tools.latencySec);
    const ComparedBoardCapture capture =
      readComparedBoard(recording, *input_.board, comparison.camera, input_.tools, {}, telling("looking for the board"));
    comparison.facts.push_back(capture.fact);
    comparison.facts.insert(comparison.facts.end(), notes.begin(), notes.end());
    BoardMethodsOptions options;
    options.withBranchAndBound = input_.branchAndBoundSec > 0;
    options.options.timeLimitSec = options.withBranchAndBound ? input_.branchAndBoundSec : options.options.timeLimitSec;
    options.progress = [this](const BranchAndBoundState& state)
    {
      return tell("branch and bound: best " + fixedDigits(1e3 * state.bestErrorRad, 2) + " mrad, proven bound " +
          fixedDigits(1e3 * state.lowerBoundRad, 2) + " mrad; seconds",
        int(state.elapsedSec), int(std::ceil(input_.branchAndBoundSec)));
    };
    return boardMethods({ capture.views }, comparison.camera, options);
  }

  const SessionComparisonInput& input_;
  const ComparisonProgress& progress_;
  DistinctCaptures distinct_;
  bool isStopped_ = false;
};

}  // namespace

SessionComparison compareSession(const SessionComparisonInput& input, const ComparisonProgress& progress)
{
  return SessionComparer(input, progress).run();
}

}  // namespace handeye
