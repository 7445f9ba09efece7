// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointLineQuadraticForm.h"

#include <vector>

namespace handeye
{

/// The methods of registerPointsToLines() and what they share. Each sets the status, the message where there is something to say,
/// the transform and the iterations of a result; information and covariance are for the caller, and so are residuals that are
/// missing. Internal.

using PointLinePairs = std::vector<PointLinePair>;

void solveGlobal(
  const PointLinePairs& pairs, const PointLineQuadraticForm& form, const PointLineOptions& options, PointLineResult& result);
void solveProcrustes(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result);
void solveOrthogonalIteration(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result);
void solveProcrustesPnP(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result);
/// `Epnp`, `Sqpnp` and `Iterative`, by OpenCV.
void solveByOpenCV(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result);
/// Goes on from result.pointsToLines; sets the covariance and the sigmas.
void solveMaximumLikelihood(
  const PointLinePairs& pairs, const std::vector<PointLineNoise>& noise, const PointLineOptions& options, PointLineResult& result);

/// The pairs that agree with each other, ascending; all of them where leaving out the others would not lower the scatter much.
std::vector<int> findAgreeingPairs(const PointLinePairs& pairs, const PointLineOptions& options);

/// Sets the residuals of a transform and their root mean square. @returns how many points lie in front of their ray's origin
std::size_t measureResiduals(const PointLinePairs& pairs, const PointLineQuadraticForm& form, PointLineResult& result);

/// The moved point relative to its line, across the line.
Eigen::Vector3d offsetFromLine(const PointLinePair& pair, const Eigen::Isometry3d& pointsToLines);

/// Whether most points lie in front of their ray's origin.
bool areMostInFront(const PointLinePairs& pairs, const Eigen::Isometry3d& pointsToLines);

/// Whether all lines have the same origin; otherwise, where a method needs it, says so in the result.
bool haveOneCentre(const PointLinePairs& pairs, const PointLineOptions& options, PointLineResult& result);

}  // namespace handeye
