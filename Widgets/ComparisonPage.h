// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <QStringList>

#include <memory>
#include <optional>

namespace Ui
{
class ComparisonPage;
}

namespace handeye
{

/// Every calibration method on the session's samples, tested on its validation placements, and with a recording of a board if there
/// is one: table, plots, report. The page can be left out.
class ComparisonPage : public WizardPage
{
  Q_OBJECT

public:
  explicit ComparisonPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~ComparisonPage() override;

  void refresh() override;
  /// The methods with a board are compared, too, from now on; nothing: no longer.
  void chooseBoardRecording(const QString& path);
  /// Independent captures of the ball, recordings or sessions, for the repeatability.
  void addCapture(const QString& path);

private:
  std::optional<BoardDescription> board() const;
  void connectButtons();
  void start();
  void showProgress(const QString& what, int done, int total);
  void showResult();
  void showPlots(const ComparisonResult& result);
  void showRepeatability(const ComparisonResult& result);
  void linkReport(const QString& path);
  void showReport(const QString& path);

  std::unique_ptr<Ui::ComparisonPage> ui_;
  QString boardRecording_, linkedReport_;
  QStringList otherCaptures_;
};

}  // namespace handeye
