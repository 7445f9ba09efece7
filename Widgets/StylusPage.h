// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WizardPage.h"

#include <memory>

namespace Ui
{
class StylusPage;
}

namespace handeye
{

/// The stylus' tip: pivoted live, with the dome of directions filling, or from a recording or a file; and, where it is wanted, the
/// direction of its shaft, by spinning.
class StylusPage : public WizardPage
{
  Q_OBJECT

public:
  explicit StylusPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~StylusPage() override;

  void leave() override;
  void refresh() override;

private:
  void connectPivot();
  void connectSpin();
  void showProgress();
  QString intro() const;
  QString hint() const;
  void showSpin();
  void refreshSpin();

  std::unique_ptr<Ui::StylusPage> ui_;
};

}  // namespace handeye
