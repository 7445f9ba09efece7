// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeStudy.h"
#include "ReportDocument.h"

#include <string>

namespace handeye::study
{

/// Tables of the study's report. Internal.

/// Which statements hold: the paper's, or those about methods that it does not have.
report::Table checksTable(const StudyResult& result, bool areOfThePaper);

/// What the order of the methods depends on.
report::Table conditionsTable(const StudyCameraResult& camera);

/// The errors by the range of the board's directions.
report::Table tiltTable(const StudyCameraResult& camera);

/// "20 repetitions, 5 of branch and bound"
std::string tiltRepetitionWords(const StudyCameraResult& camera);

}  // namespace handeye::study
