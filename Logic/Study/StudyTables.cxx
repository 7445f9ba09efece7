// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StudyTables.h"

#include "NumberWords.h"
#include "StudyMethods.h"

#include <algorithm>

namespace handeye::study
{

namespace
{

const char* const Search = "branch-and-bound";

/// Mean as a validation shows it, and in brackets the calibrations' own; "none" without a result.
std::string meansCell(const std::string& method, const ComparisonResult& comparison, const ComparisonResult& truth)
{
  for (std::size_t i = 0; i < comparison.methods.size(); ++i)
  {
    if (comparison.methods[i].name == method && comparison.methods[i].isUsable())
    {
      return fixedDigits(comparison.methods[i].errorPx.mean, 2) + " (" + fixedDigits(truth.methods[i].errorPx.mean, 2) + ")";
    }
  }
  return "none";
}

/// The same of the first repetitions.
std::string meansOfFirst(const std::string& method, const StudyTiltResult& tilt, std::size_t repetitions)
{
  const MethodResult *shown = findMethod(tilt.comparison, method), *own = findMethod(tilt.truth, method);
  const std::optional<double> mean = shown != nullptr ? meanOverFirst(*shown, repetitions) : std::nullopt;
  const std::optional<double> ownMean = own != nullptr ? meanOverFirst(*own, repetitions) : std::nullopt;
  return mean && ownMean ? fixedDigits(*mean, 2) + " (" + fixedDigits(*ownMean, 2) + ")" : "none";
}

std::size_t repetitionsOf(const StudyTiltResult& tilt, const std::string& name)
{
  for (const MethodResult& method : tilt.comparison.methods)
  {
    if (method.name == name)
    {
      return method.captures.size();
    }
  }
  return 0;
}

/// The methods whose order is looked into: with a board, and `ml`.
std::vector<std::string> comparedNames(const StudyCameraResult& camera)
{
  std::vector<std::string> names;
  for (const MethodResult& method : camera.comparison.methods)
  {
    if (method.target == ComparedMethod::Target::Board || method.name == "ml")
    {
      names.push_back(method.name);
    }
  }
  return names;
}

}  // namespace

std::string tiltRepetitionWords(const StudyCameraResult& camera)
{
  if (camera.byTilt.empty())
  {
    return {};
  }
  const std::size_t all = repetitionsOf(camera.byTilt.front(), "ml"), searches = repetitionsOf(camera.byTilt.front(), Search);
  return std::to_string(all) + " repetitions" +
    (searches > 0 && searches < all ? ", " + std::to_string(searches) + " of branch and bound" : "");
}

report::Table conditionsTable(const StudyCameraResult& camera)
{
  report::Table table;
  table.caption =
    "What the order depends on: mean projection error (px) as a validation shows it, and in brackets the calibrations' own, with "
    "one thing changed at a time";
  table.headings = { "condition" };
  std::vector<std::string> names = comparedNames(camera);
  names.erase(std::remove(names.begin(), names.end(), "branch-and-bound"), names.end());  // is not run here: it takes too long
  table.headings.insert(table.headings.end(), names.begin(), names.end());
  for (const StudyConditionResult& condition : camera.byCondition)
  {
    std::vector<std::string> row = { condition.words };
    for (const std::string& name : names)
    {
      row.push_back(meansCell(name, condition.comparison, condition.truth));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table tiltTable(const StudyCameraResult& camera)
{
  report::Table table;
  table.caption =
    "The reason: mean projection error (px) as a validation shows it, and in brackets the calibrations' own, by how far off its "
    "normal the board was looked at (degrees); the camera turned by up to 4/3 of that to either side; " +
    tiltRepetitionWords(camera);
  table.headings = { "method" };
  for (const StudyTiltResult& tilt : camera.byTilt)
  {
    table.headings.push_back(fixedDigits(tilt.tiltDeg, 0));
  }
  for (const std::string& name : comparedNames(camera))
  {
    std::vector<std::string> row = { name };
    for (const StudyTiltResult& tilt : camera.byTilt)
    {
      row.push_back(meansCell(name, tilt.comparison, tilt.truth));
    }
    table.rows.push_back(std::move(row));
  }
  // To compare with in the same repetitions.
  const std::size_t searches = camera.byTilt.empty() ? 0 : repetitionsOf(camera.byTilt.front(), Search);
  if (searches > 0 && searches < repetitionsOf(camera.byTilt.front(), "ml"))
  {
    for (std::vector<std::string>& row : table.rows)
    {
      row[0] += row[0] == Search ? " (" + std::to_string(searches) + " repetitions)" : "";
    }
    std::vector<std::string> row = { "ml (the same " + std::to_string(searches) + " repetitions)" };
    for (const StudyTiltResult& tilt : camera.byTilt)
    {
      row.push_back(meansOfFirst("ml", tilt, searches));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table checksTable(const StudyResult& result, bool areOfThePaper)
{
  report::Table table;
  table.caption = areOfThePaper
    ? "What the paper reports of point-to-line (ml), checked against tsai, park, horaud, daniilidis and branch-and-bound"
    : "Beyond the paper: point-to-line (ml) against a board that is tracked itself, which is none of its five methods";
  table.headings = { "camera", "statement", "holds", "measured" };
  table.textColumns = 4;
  for (const StudyClaim& claim : result.claims)
  {
    for (const StudyCheck& check : claim.checks)
    {
      if (check.isOfThePaper == areOfThePaper)
      {
        table.rows.push_back({ claim.camera, check.what, check.holds ? "yes" : "NO", check.measured });
      }
    }
  }
  return table;
}

}  // namespace handeye::study
