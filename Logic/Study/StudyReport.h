// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeStudy.h"
#include "ReportDocument.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace handeye::study
{

/// The report of a study: whether the paper's claims hold, per camera the table of the methods (the paper's tables 2-4), error
/// against distance, number of samples and repeatability, the noise and where it comes from; with the data as CSV.
[[nodiscard]] report::ReportDocument studyDocument(const StudyResult& result);

/// The report, and its plots as PNG beside it. @throws as report::writeReport()
void writeStudyReport(const std::filesystem::path& folder, const StudyResult& result);

/// What `handeye study --json` prints.
[[nodiscard]] nlohmann::json studyJson(const StudyResult& result);

}  // namespace handeye::study
