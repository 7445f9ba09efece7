// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LandmarkPanel.h"
#include "ui_LandmarkPanel.h"

class QKeySequence;

namespace handeye
{

/// Private to LandmarkPanel: its state, and how it is shown.
class LandmarkPanel::Private
{
public:
  explicit Private(LandmarkPanel& panel)
    : q(panel)
  {
  }

  void setUpUi();
  void connectButtons();
  void addShortcut(const QKeySequence& key, QWidget* where, Qt::ShortcutContext context, void (LandmarkPanel::*slot)());
  void update();
  void updateRow(int row, const QVector<int>& paired);
  void fitTable();
  void updateButtons();
  void updateVerdict();
  QString usableVerdict() const;
  QString refusal() const;
  void showVerdict(const QString& text, Level level);
  QString stateOf(int row) const;
  int nextUntouched(int after) const;
  void remember(const QString& what);
  int touchedBefore() const;
  void replace(const QVector<Landmark>& with, int newCurrent);
  void changed();

  LandmarkPanel& q;
  Ui::LandmarkPanel ui{};
  struct Before
  {
    QString what;
    QVector<Landmark> landmarks;
    int current = -1;
    QString fileWords, filePath;
  };

  QVector<Landmark> landmarks;
  QVector<Before> history;  ///< of these landmarks, the oldest first
  int current = -1;
  bool tipAvailable = false;
  QString tipReason;
  QString fileError;  ///< of the last file, until something else happens
  std::optional<LandmarkRegistrationResult> result;
  std::optional<Eigen::Vector3d> lastTaken_Phantom;
};

}  // namespace handeye
