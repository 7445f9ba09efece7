// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CalibrationStep.h"
#include "CaptureTask.h"
#include "SampleTableModel.h"
#include "ValidationStep.h"

#include <optional>

namespace handeye
{

/// The samples of a capture as the table shows them, with what the calibration made of each.
QVector<SampleRow> calibrationRows(
  const QMap<int, CaptureSample>& samples, const std::optional<CalibrationStepResult>& calibration);

/// The samples of a validation, with the projection error of each.
QVector<SampleRow> validationRows(const QMap<int, CaptureSample>& samples, const std::optional<ValidationStepResult>& validation);

/// What came of a recording, in a sentence or two. @param reason which frame was refused first, and why
QString importedWords(int taken, int refused, const QString& reason);

}  // namespace handeye
