// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistinctCaptures.h"

#include "FileError.h"

#include <algorithm>
#include <stdexcept>

namespace handeye
{

namespace
{

/// Far below any tracker's noise; more than files round.
constexpr double SameTipMm = 1e-3;
constexpr double SameBallPx = 0.5;

bool areTheSame(const HandEyeSample& a, const HandEyeSample& b)
{
  return (a.tip_Marker - b.tip_Marker).norm() < SameTipMm && (a.ball_Image - b.ball_Image).norm() < SameBallPx;
}

const char* const WhyNot = "no method may be fitted to what it is judged by, and captures are to be independent of each other";

}  // namespace

void DistinctCaptures::addPath(const std::filesystem::path& path, const std::string& what)
{
  std::error_code ignored;
  std::filesystem::path canonical = std::filesystem::weakly_canonical(path, ignored);
  canonical = canonical.empty() ? path.lexically_normal() : canonical;
  // "folder/" and "folder" are the same.
  canonical = canonical.has_filename() ? canonical : canonical.parent_path();
  for (const Capture& other : captures_)
  {
    if (other.canonical == canonical)
    {
      throw io::FileError(path, "this is " + other.what + " already: " + WhyNot + ". Choose another capture");
    }
  }
  captures_.push_back({ path, canonical, what, {} });
}

void DistinctCaptures::addSamples(const std::filesystem::path& path, const std::vector<HandEyeSample>& samples)
{
  const auto own = std::find_if(captures_.begin(), captures_.end(), [&](const Capture& one) { return one.path == path; });
  if (own == captures_.end())
  {
    throw std::invalid_argument("samples of a capture that was not added");
  }
  for (const Capture& other : captures_)
  {
    const auto shared = std::count_if(samples.begin(), samples.end(),
      [&](const HandEyeSample& sample)
      {
        return &other != &*own &&
          std::any_of(
            other.samples.begin(), other.samples.end(), [&](const HandEyeSample& one) { return areTheSame(sample, one); });
      });
    if (shared > 0)
    {
      throw io::FileError(path,
        std::to_string(shared) + " of its " + std::to_string(samples.size()) + " samples are those of " + other.what + " (" +
          other.path.string() + "): " + WhyNot + ". Choose another capture");
    }
  }
  own->samples = samples;
}

}  // namespace handeye
