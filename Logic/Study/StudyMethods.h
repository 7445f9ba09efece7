// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MethodComparison.h"

#include <optional>
#include <string>

namespace handeye::study
{

/// Looking up methods in the study's results. Internal.

/// Null unless it is there and usable.
const MethodResult* findMethod(const ComparisonResult& comparison, const std::string& name);

/// With a board that is tracked itself, which is not one of the paper's.
bool isWithTrackedBoard(const MethodResult& method);

/// With a board that stands still: tsai, park, horaud, daniilidis, branch-and-bound.
bool isOfThePaper(const MethodResult& method);

/// The usable method with a board that stands still whose mean error is the lowest; null where there is none.
const MethodResult* lowestWithBoard(const ComparisonResult& comparison);

/// The mean error of `other` over that of `one`, in the repetitions and at the samples for which both have a result.
std::optional<double> ratioOfMeans(const MethodResult& other, const MethodResult& one);

/// Mean error over the first repetitions; nothing without a result.
std::optional<double> meanOverFirst(const MethodResult& method, std::size_t repetitions);

}  // namespace handeye::study
