// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QDialog>

namespace desktop
{

/// Version, libraries, modules, licence; what it is not meant for.
class AboutDialog : public QDialog
{
  Q_OBJECT

public:
  /// @param modules a line each, as shown: title and file
  AboutDialog(const QStringList& modules, QWidget* parent);
};

}  // namespace desktop
