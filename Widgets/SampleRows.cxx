// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleRows.h"

#include "Look.h"

#include <QCoreApplication>

#include <map>
#include <optional>

namespace handeye
{

namespace
{

QString words(const char* text)
{
  return QCoreApplication::translate("handeye::SampleRows", text);
}

/// How far the tip is from the ray on which the ball is seen, mm; nothing where the camera is not known.
std::optional<double> errorMm(const ValidatedFrame& frame, const ValidationStepResult& validation)
{
  if (!validation.subject.camera)
  {
    return std::nullopt;
  }
  const CameraModel& camera = *validation.subject.camera;
  const CameraModel::Unprojection seen = camera.unproject(frame.captured.ball.ball_Image),
                                  drawn = camera.unproject(frame.validated->projected_Image);
  return seen.isUsable() && drawn.isUsable()
    ? std::optional(frame.validated->distanceMm * drawn.ray_Camera.cross(seen.ray_Camera).norm())
    : std::nullopt;
}

SampleRow rowOf(const CaptureSample& sample)
{
  SampleRow row;
  row.id = sample.id;
  row.thumbnail = sample.thumbnail;
  row.excluded = sample.isExcluded;
  const CapturedFrame& captured = sample.captured;
  row.status = captured.isSample() ? words("not used yet") : QString::fromStdString(captured.message);
  row.level = captured.isSample() ? Level::Info : Level::Warning;
  if (captured.ball.isFound())
  {
    row.distanceMm = captured.ball.distanceMm;
  }
  if (sample.isExcluded)
  {
    // That it is left out the table says. What the calibration made of it before is not known any more.
    row.status = captured.isSample() ? QString() : row.status;
    row.level = Level::Info;
  }
  return row;
}

}  // namespace

QVector<SampleRow> calibrationRows(const QMap<int, CaptureSample>& samples, const std::optional<CalibrationStepResult>& calibration)
{
  std::map<int, const CalibratedFrame*> frames;
  if (calibration)
  {
    for (const CalibratedFrame& frame : calibration->frames)
    {
      frames[frame.captured.frame] = &frame;
    }
  }
  QVector<SampleRow> rows;
  for (const CaptureSample& sample : samples)
  {
    if (sample.isDeleted)
    {
      continue;
    }
    SampleRow row = rowOf(sample);
    const auto found = frames.find(sample.id);
    if (found != frames.end() && sample.takesPart() && calibration->isUsable() && sample.captured.isSample())
    {
      const CalibratedFrame& frame = *found->second;
      row.used = frame.used;
      row.status = frame.used ? words("ok") : words("disagrees with the others");
      row.level = frame.used ? Level::Good : Level::Error;
      row.residualPx = frame.residualPx;
      row.residualMm = frame.residualMm;
      row.residualLevel = frame.used ? Level::Info : Level::Error;
    }
    rows.push_back(row);
  }
  return rows;
}

QVector<SampleRow> validationRows(const QMap<int, CaptureSample>& samples, const std::optional<ValidationStepResult>& validation)
{
  std::map<int, const ValidatedFrame*> frames;
  if (validation)
  {
    for (const ValidatedFrame& frame : validation->frames)
    {
      frames[frame.captured.frame] = &frame;
    }
  }
  QVector<SampleRow> rows;
  for (const CaptureSample& sample : samples)
  {
    if (sample.isDeleted)
    {
      continue;
    }
    SampleRow row = rowOf(sample);
    const auto found = frames.find(sample.id);
    if (found != frames.end() && found->second->validated && found->second->status == "ok")
    {
      row.used = true;
      row.status = words("ok");
      row.level = Level::Good;
      row.residualPx = found->second->validated->errorPx;
      row.distanceMm = found->second->validated->distanceMm;
      row.residualMm = errorMm(*found->second, *validation);
    }
    rows.push_back(row);
  }
  return rows;
}

QString importedWords(int taken, int refused, const QString& reason)
{
  QString text = taken == 0 ? words("Nothing was taken from the recording.")
                            : counted(taken, words("1 sample from the recording."), words("%1 samples from the recording."));
  if (refused > 0)
  {
    text += QLatin1Char(' ') +
      (refused == 1 ? words("1 frame was left out, %1").arg(reason)
                    : words("%1 frames were left out, the first, %2").arg(QString::number(refused), reason));
  }
  return text;
}

}  // namespace handeye
