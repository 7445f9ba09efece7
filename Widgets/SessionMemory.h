// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QDateTime>
#include <QString>

#include <optional>

namespace handeye
{

/// What a session's folder holds, as far as its list of files tells.
struct SessionSummary
{
  QString folder;
  QDateTime changed;  ///< when something was last put into it
  int sampleCount = 0;
  bool hasStylus = false, isCalibrated = false, isValidated = false, isRegistered = false;

  /// Whether there is anything in it that a person would miss.
  bool isUsed() const { return sampleCount > 0 || hasStylus || isCalibrated || isRegistered; }
};

/// Where new sessions are put, and where the one that was worked with last is remembered.
QString sessionsFolder();

SessionSummary summarizeSession(const QString& folder);
/// "14 samples, calibrated, validated".
QString toString(const SessionSummary& summary);

/// This session is the one to be gone on with next time.
void rememberSession(const QString& folder);
/// The one that was remembered, if its folder is still there, is used, and is not the one that is open.
std::optional<SessionSummary> rememberedSession(const QString& openFolder);

}  // namespace handeye
