// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "DeviceHub.h"
#include "SessionMemory.h"
#include "StreamList.h"
#include "WizardPage.h"

#include <memory>
#include <optional>

class QRadioButton;

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
  void showSetup();
  QRadioButton* buttonOf(DeviceSetup::Kind kind) const;
  void choose(StreamList::Role role, const QString& name);
  void browseRecording();
  void newSession();
  void openSession();

  std::unique_ptr<Ui::DevicesPage> ui_;
  std::optional<SessionSummary> lastSession_;  ///< offered as long as the one that is open has nothing in it
};

}  // namespace handeye
