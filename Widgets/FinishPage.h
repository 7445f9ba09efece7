// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <memory>

namespace Ui
{
class FinishPage;
}

namespace handeye
{

/// The session's folder, exports in the formats of other programs, and the report.
class FinishPage : public WizardPage
{
  Q_OBJECT

public:
  explicit FinishPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~FinishPage() override;

  void enter() override;
  void refresh() override;

private:
  void renew();
  QString linkTo(const QString& path, const QString& words) const;

  std::unique_ptr<Ui::FinishPage> ui_;
  QString exportsOf_;  ///< the session whose folder was offered
};

}  // namespace handeye
