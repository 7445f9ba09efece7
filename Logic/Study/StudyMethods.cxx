// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyMethods.h"

#include <algorithm>

namespace handeye::study
{

const MethodResult* findMethod(const ComparisonResult& comparison, const std::string& name)
{
  const auto found = std::find_if(comparison.methods.begin(), comparison.methods.end(),
    [&](const MethodResult& method) { return method.name == name && method.isUsable(); });
  return found != comparison.methods.end() ? &*found : nullptr;
}

bool isWithTrackedBoard(const MethodResult& method)
{
  return method.name.rfind("tracked-", 0) == 0;
}

bool isOfThePaper(const MethodResult& method)
{
  return method.target == ComparedMethod::Target::Board && !isWithTrackedBoard(method);
}

const MethodResult* lowestWithBoard(const ComparisonResult& comparison)
{
  const MethodResult* lowest = nullptr;
  for (const MethodResult& method : comparison.methods)
  {
    if (isOfThePaper(method) && method.isUsable() && (lowest == nullptr || method.errorPx.mean < lowest->errorPx.mean))
    {
      lowest = &method;
    }
  }
  return lowest;
}

std::optional<double> ratioOfMeans(const MethodResult& other, const MethodResult& one)
{
  double ofOther = 0, ofOne = 0;
  for (std::size_t capture = 0; capture < std::min(other.captures.size(), one.captures.size()); ++capture)
  {
    const std::vector<HandEyeValidationSample>& others = other.captures[capture].validation.samples;
    const std::vector<HandEyeValidationSample>& ones = one.captures[capture].validation.samples;
    for (std::size_t i = 0; i < std::min(others.size(), ones.size()); ++i)
    {
      if (others[i].status == CameraModel::Status::Ok && ones[i].status == CameraModel::Status::Ok)
      {
        ofOther += others[i].errorPx;
        ofOne += ones[i].errorPx;
      }
    }
  }
  return ofOne > 0 ? std::make_optional(ofOther / ofOne) : std::nullopt;
}

std::optional<double> meanOverFirst(const MethodResult& method, std::size_t repetitions)
{
  std::vector<double> errors;
  for (std::size_t capture = 0; capture < std::min(repetitions, method.captures.size()); ++capture)
  {
    for (const HandEyeValidationSample& sample : method.captures[capture].validation.samples)
    {
      if (sample.status == CameraModel::Status::Ok)
      {
        errors.push_back(sample.errorPx);
      }
    }
  }
  return errors.empty() ? std::nullopt : std::make_optional(summarize(errors).mean);
}

}  // namespace handeye::study
