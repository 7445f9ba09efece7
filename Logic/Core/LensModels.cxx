// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LensModels.h"

#include "NumberWords.h"

namespace handeye
{

namespace
{

/// A larger model has to lower Schwarz' criterion by this much ("very strong" evidence: Kass and Raftery 1995).
constexpr double StrongEvidence = 10;

double informationCriterion(const LensFit& fit, int coefficients, std::size_t views)
{
  const double n = 2.0 * fit.pointCount, parameters = 4 + coefficients + 6 * double(views);
  return n * std::log(std::max(fit.squares, 1e-12) / n) + parameters * std::log(n);
}

std::string hint(const LensCalibrationResult& result, int chosen)
{
  const int supported = result.supportedCoefficients;
  if (chosen == supported)
  {
    return "the data support the model with " + std::to_string(chosen) + " coefficients";
  }
  const auto rms = [&](int coefficients)
  {
    for (const LensModelComparison& model : result.models)
    {
      if (model.coefficients == coefficients)
      {
        return fixedDigits(model.rmsPx, 3);
      }
    }
    return std::string("?");
  };
  return "the data support " + std::to_string(supported) + " coefficients (" + rms(supported) + " px RMS against " + rms(chosen) +
    ")" + (supported < chosen ? ": the others only follow the noise" : ": with fewer the lens is not described");
}

}  // namespace

void compareLensModels(const std::vector<const LensView*>& views, int width, int height, const LensCalibrationOptions& options,
  const LensFit& own, LensCalibrationResult& result)
{
  double best = 0;
  for (const int coefficients : { 4, 5, 8 })
  {
    const std::optional<LensFit> fit =
      coefficients == options.coefficients ? own : fitLens(views, width, height, coefficients, options.circleDiameterMm);
    if (!fit)
    {
      continue;
    }
    LensModelComparison model;
    model.coefficients = coefficients;
    model.rmsPx = fit->rmsPx();
    model.focalPx = (fit->camera.fx() + fit->camera.fy()) / 2;
    model.informationCriterion = informationCriterion(*fit, coefficients, views.size());
    model.isSupported = result.supportedCoefficients == 0 || model.informationCriterion < best - StrongEvidence;
    if (model.isSupported)
    {
      best = model.informationCriterion;
      result.supportedCoefficients = coefficients;
    }
    result.models.push_back(model);
  }
  result.modelHint = hint(result, options.coefficients);
}

}  // namespace handeye
