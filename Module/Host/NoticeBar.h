// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QFrame>

class QLabel;

namespace desktop
{

/// A line above the views for what a person has to know and need not answer: hidden until addNotice(), gone when it is closed.
class NoticeBar : public QFrame
{
  Q_OBJECT

public:
  explicit NoticeBar(QWidget* parent = nullptr);

  /// A further notice comes under the ones that are still there.
  void addNotice(const QString& text);
  QString text() const;

public slots:
  void dismiss();

signals:
  void detailsRequested();

private:
  QLabel* Text;
};

}  // namespace desktop
