// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeWorkbench.h"

#include <algorithm>
#include <filesystem>

namespace handeye
{

namespace
{

constexpr int LeastSamples = 4;  ///< below that no method can say anything

bool areSamples(const std::vector<CapturedFrame>& a, const std::vector<CapturedFrame>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
    [](const CapturedFrame& one, const CapturedFrame& other)
    { return one.frame == other.frame && one.ball.ball_Image == other.ball.ball_Image && one.tip_Marker == other.tip_Marker; });
}

}  // namespace

QString HandEyeWorkbench::missingForComparison() const
{
  if (capture_->isBusy() || validationCapture_->isBusy())
  {
    return tr("The samples are being looked at.");
  }
  for (const CaptureTask* task : { capture_, validationCapture_ })
  {
    if (task->isBroken())
    {
      return tr("Stored placements are those of another lens, stylus or ball: press Look again on the page %1.")
        .arg(task == capture_ ? tr("Capture") : tr("Validation"));
    }
    if (task->isStale() && !task->samples().isEmpty())
    {
      return tr("The samples are being looked at.");
    }
  }
  const int samples = int(capture_->frames().size());
  if (samples == 0 && isCalibrationLoaded_)
  {
    return tr("The calibration was loaded from a file, without its samples: collect placements of the ball on the page Capture to "
              "compare methods.");
  }
  if (samples < LeastSamples)
  {
    return tr("At least %1 placements of the ball are needed to compare methods: collect them on the page Capture.")
      .arg(LeastSamples);
  }
  if (validationCapture_->frames().empty())
  {
    return tr("There are no placements to test the methods on: collect some on the page Validation.");
  }
  return {};
}

void HandEyeWorkbench::compare(const ComparisonExtras& extras)
{
  const QString missing = missingFor(WizardStep::Comparison);
  if (!missing.isEmpty())
  {
    refuse(WizardStep::Comparison, missing);
    return;
  }
  const CaptureInputs& taken = *capture_->inputs();
  std::vector<std::filesystem::path> others;
  for (const QString& path : extras.otherCaptures)
  {
    others.emplace_back(path.toStdString());
  }
  const SessionComparisonInput input{ taken.camera, camera_->origin.toStdString(), taken.tip_Stylus, stylus_->tipCovariance,
    taken.ballRadiusMm, taken.detection, taken.tools, capture_->frames(), validationCapture_->frames(),
    capture_->folder().toStdString(), validationCapture_->folder().toStdString(), others, extras.boardRecording.toStdString(),
    extras.board, extras.branchAndBoundSec, {} };
  comparison_->start(input);
}

bool HandEyeWorkbench::isComparisonStale() const
{
  const SessionComparisonInput& compared = comparison_->input();
  const std::optional<CaptureInputs>& taken = capture_->inputs();
  return comparison_->result() &&
    (!taken || compared.camera.cameraMatrix() != taken->camera.cameraMatrix() ||
      compared.camera.distortionCoefficients() != taken->camera.distortionCoefficients() ||
      !areSamples(compared.capture, capture_->frames()) || !areSamples(compared.validation, validationCapture_->frames()));
}

QString HandEyeWorkbench::comparisonFolder() const
{
  return capture_->isOpen() ? sessionFolder() + QStringLiteral("/comparison") : QString();
}

}  // namespace handeye
