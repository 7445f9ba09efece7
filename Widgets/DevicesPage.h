// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "StreamList.h"
#include "WizardPage.h"

#include <memory>

namespace Ui
{
class DevicesPage;
}

namespace handeye
{

/// Where the data come from, which stream is what, and the session's folder.
class DevicesPage : public WizardPage
{
  Q_OBJECT

public:
  explicit DevicesPage(HandEyeWorkbench& workbench, QWidget* parent = nullptr);
  ~DevicesPage() override;

  void refresh() override;
  /// A recording to be played, as if it had been chosen.
  void chooseRecording(const QString& path);

private:
  void connectOrNot();
  void choose(StreamList::Role role, const QString& name);
  void browseRecording();
  void newSession();
  void openSession();

  std::unique_ptr<Ui::DevicesPage> ui_;
};

}  // namespace handeye
