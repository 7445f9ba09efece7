// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensRepeatability.h"

#include <numeric>
#include <random>

namespace handeye
{

namespace
{

/// So many different indices, drawn with the same result everywhere.
std::vector<std::size_t> draw(std::size_t from, std::size_t count, std::mt19937& engine)
{
  std::vector<std::size_t> indices(from);
  std::iota(indices.begin(), indices.end(), 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    std::swap(indices[i], indices[i + engine() % (from - i)]);
  }
  indices.resize(count);
  std::sort(indices.begin(), indices.end());
  return indices;
}

/// How far (px) one lens sees the rays of another from where that one does, over a grid of the image.
std::vector<double> shiftsPx(const CameraModel& reference, const CameraModel& camera)
{
  constexpr int Columns = 9, Rows = 7;
  std::vector<double> shifts;
  for (int i = 0; i < Columns * Rows; ++i)
  {
    const Eigen::Vector2d pixel(
      (reference.width() - 1) * double(i % Columns) / (Columns - 1), (reference.height() - 1) * double(i / Columns) / (Rows - 1));
    const CameraModel::Unprojection ray = reference.unproject(pixel);
    const CameraModel::Projection seen = ray.isUsable() ? camera.project(ray.ray_Camera) : CameraModel::Projection();
    if (seen.isUsable())
    {
      shifts.push_back((seen.point_Image - pixel).norm());
    }
  }
  return shifts;
}

void summarizeParameters(LensRepetition& repetition)
{
  const auto over = [&](const std::function<double(const CameraModel&)>& parameter)
  {
    std::vector<double> values;
    for (const LensCalibrationResult& result : repetition.results)
    {
      values.push_back(parameter(*result.camera));
    }
    return summarize(values);
  };
  repetition.fx = over([](const CameraModel& camera) { return camera.fx(); });
  repetition.fy = over([](const CameraModel& camera) { return camera.fy(); });
  repetition.cx = over([](const CameraModel& camera) { return camera.cx(); });
  repetition.cy = over([](const CameraModel& camera) { return camera.cy(); });
  const std::size_t count = repetition.results.empty() ? 0 : repetition.results[0].camera->distortionCoefficients().size();
  for (std::size_t i = 0; i < count; ++i)
  {
    repetition.coefficients.push_back(over([i](const CameraModel& camera) { return camera.distortionCoefficients()[i]; }));
  }
}

}  // namespace

void LensRepetitionOptions::check() const
{
  if (repetitions < 2 || !(viewShare > 0) || !(viewShare < 1))
  {
    throw std::invalid_argument("LensRepetitionOptions: repetitions are at least 2 and viewShare is between 0 and 1");
  }
}

LensRepetition repeatLensCalibration(const std::vector<LensView>& views, int width, int height,
  const LensCalibrationOptions& options, const LensRepetitionOptions& repetition, const std::function<bool(int, int)>& progress)
{
  repetition.check();
  LensCalibrationOptions each = options;
  each.compareModels = false;
  const LensCalibrationResult all = calibrateLens(views, width, height, each);
  LensRepetition result;
  std::mt19937 engine(repetition.seed);
  const std::size_t count = std::size_t(std::lround(repetition.viewShare * double(views.size())));
  std::vector<double> shifts;
  for (int i = 0; i < repetition.repetitions; ++i)
  {
    std::vector<LensView> part;
    for (const std::size_t index : draw(views.size(), count, engine))
    {
      part.push_back(views[index]);
    }
    LensCalibrationResult calibration = calibrateLens(part, width, height, each);
    if (!calibration.isUsable())
    {
      ++result.failedCount;
    }
    else
    {
      if (all.isUsable())
      {
        const std::vector<double> more = shiftsPx(*all.camera, *calibration.camera);
        shifts.insert(shifts.end(), more.begin(), more.end());
      }
      result.results.push_back(std::move(calibration));
    }
    if (progress && !progress(i + 1, repetition.repetitions))
    {
      break;
    }
  }
  summarizeParameters(result);
  const Summary shift = summarize(shifts);
  result.meanShiftPx = shift.mean;
  result.maximumShiftPx = shift.maximum;
  return result;
}

}  // namespace handeye
