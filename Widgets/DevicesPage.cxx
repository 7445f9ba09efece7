// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DevicesPage.h"

#include "ui_DevicesPage.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QLocale>
#include <QSignalBlocker>

namespace handeye
{

DevicesPage::DevicesPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Devices, parent)
  , ui_(std::make_unique<Ui::DevicesPage>())
{
  ui_->setupUi(this);
  const auto showBoxes = [this]
  {
    ui_->serversBox->setVisible(ui_->serversButton->isChecked());
    ui_->recordingBox->setVisible(ui_->recordingButton->isChecked());
  };
  for (QRadioButton* button : { ui_->roomButton, ui_->serversButton, ui_->recordingButton })
  {
    connect(button, &QRadioButton::toggled, this, showBoxes);
  }
  showBoxes();
  connect(ui_->connectButton, &QPushButton::clicked, this, &DevicesPage::connectOrNot);
  connect(ui_->recordingBrowseButton, &QPushButton::clicked, this, &DevicesPage::browseRecording);
  connect(ui_->streamList, &StreamList::choiceChanged, this, &DevicesPage::choose);
  connect(ui_->latencySpin, &QDoubleSpinBox::editingFinished, this,
    [this]
    {
      DeviceSetup setup = workbench_.devices().setup();
      setup.latencySec = ui_->latencySpin->value() / 1000;
      workbench_.setStreamNames(setup);
    });
  connect(ui_->newSessionButton, &QPushButton::clicked, this, &DevicesPage::newSession);
  connect(ui_->openSessionButton, &QPushButton::clicked, this, &DevicesPage::openSession);
  lastSession_ = rememberedSession(workbench_.sessionFolder());
  connect(ui_->lastSessionButton, &QPushButton::clicked, &workbench_,
    [this]
    {
      if (lastSession_)
      {
        workbench_.openSession(QString(lastSession_->folder));
      }
    });
  connect(&workbench_, &HandEyeWorkbench::sessionUsed, this, [this] { lastSession_.reset(); });
  connect(&workbench_, &HandEyeWorkbench::sessionOpened, this, &DevicesPage::showSetup);
}

DevicesPage::~DevicesPage() = default;

void DevicesPage::connectOrNot()
{
  if (workbench_.devices().isConnected())
  {
    workbench_.devices().disconnectDevices();
    return;
  }
  DeviceSetup setup = workbench_.devices().setup();
  setup.kind = ui_->roomButton->isChecked() ? DeviceSetup::Kind::SimulatedRoom
    : ui_->serversButton->isChecked()       ? DeviceSetup::Kind::Servers
                                            : DeviceSetup::Kind::Recording;
  setup.servers = ui_->serversEdit->text().split(QLatin1Char(','), Qt::SkipEmptyParts);
  setup.camera = ui_->cameraEdit->text().trimmed();
  setup.recording = ui_->recordingEdit->text().trimmed();
  setup.replaySpeed = ui_->speedSpin->value();
  workbench_.connectDevices(setup);
}

/// What the session was connected to stands there to be connected to again.
void DevicesPage::showSetup()
{
  const DeviceSetup& setup = workbench_.devices().setup();
  if (!workbench_.devices().isConnected())
  {
    buttonOf(setup.kind)->setChecked(true);
    ui_->serversEdit->setText(setup.servers.join(QStringLiteral(", ")));
    ui_->cameraEdit->setText(setup.camera);
    ui_->recordingEdit->setText(setup.recording);
  }
}

QRadioButton* DevicesPage::buttonOf(DeviceSetup::Kind kind) const
{
  return kind == DeviceSetup::Kind::SimulatedRoom ? ui_->roomButton
    : kind == DeviceSetup::Kind::Servers          ? ui_->serversButton
                                                  : ui_->recordingButton;
}

void DevicesPage::choose(StreamList::Role role, const QString& name)
{
  DeviceSetup setup = workbench_.devices().setup();
  switch (role)
  {
    case StreamList::Role::Stylus:
      setup.stylusToTracker = name;
      break;
    case StreamList::Role::CameraMarker:
      setup.markerToTracker = name;
      break;
    case StreamList::Role::Phantom:
      setup.phantomToTracker = name;
      break;
    case StreamList::Role::Video:
      setup.image = name;
      break;
    case StreamList::Role::RightVideo:
      // Which of two videos the left one is, is said from now on.
      setup.image = workbench_.devices().imageName();
      setup.rightImage = name;
      break;
  }
  workbench_.setStreamNames(setup);
}

void DevicesPage::browseRecording()
{
  const QString path = QFileDialog::getOpenFileName(
    this, tr("Recording"), ui_->recordingEdit->text(), tr("Sequence metafiles (*.mha *.igs.mha);;All files (*)"));
  if (!path.isEmpty())
  {
    chooseRecording(path);
  }
}

void DevicesPage::chooseRecording(const QString& path)
{
  ui_->recordingButton->setChecked(true);
  ui_->recordingEdit->setText(path);
  if (workbench_.devices().isConnected())
  {
    workbench_.refuse(WizardStep::Devices,
      tr("%1 can be played once nothing else is connected: press Disconnect, then Connect. "
         "The pages Stylus, Capture and Validation take a recording at once.")
        .arg(QFileInfo(path).fileName()));
  }
}

void DevicesPage::newSession()
{
  const QString path = QFileDialog::getSaveFileName(
    this, tr("Folder of the new session"), HandEyeWorkbench::newSessionFolder(), {}, nullptr, QFileDialog::ShowDirsOnly);
  if (!path.isEmpty())
  {
    workbench_.openSession(path);
  }
}

void DevicesPage::openSession()
{
  const QString path = QFileDialog::getExistingDirectory(this, tr("Folder of a session"), workbench_.sessionFolder());
  if (!path.isEmpty())
  {
    workbench_.openSession(path);
  }
}

void DevicesPage::refresh()
{
  DeviceHub& hub = workbench_.devices();
  const bool isConnected = hub.isConnected();
  ui_->connectButton->setText(isConnected ? tr("Dis&connect") : tr("&Connect"));
  for (QWidget* widget : std::initializer_list<QWidget*>{
         ui_->roomButton, ui_->serversButton, ui_->recordingButton, ui_->serversBox, ui_->recordingBox })
  {
    widget->setEnabled(!isConnected);
  }
  if (isConnected)
  {
    buttonOf(hub.setup().kind)->setChecked(true);
  }
  ui_->connectionLabel->setText(isConnected ? tr("connected") : tr("not connected"));
  ui_->sourceStatusLabel->setText(hub.status());
  ui_->sourceStatusLabel->setVisible(!hub.status().isEmpty());
  ui_->streamList->setStreams(hub.streams());
  const DeviceSetup& setup = hub.setup();
  ui_->streamList->setChoice(StreamList::Role::Stylus, setup.stylusToTracker);
  ui_->streamList->setChoice(StreamList::Role::CameraMarker, setup.markerToTracker);
  ui_->streamList->setChoice(StreamList::Role::Phantom, setup.phantomToTracker);
  ui_->streamList->setChoice(StreamList::Role::Video, hub.imageName());
  ui_->streamList->setChoice(StreamList::Role::RightVideo, setup.rightImage);
  if (!ui_->latencySpin->hasFocus())
  {
    const QSignalBlocker blocker(ui_->latencySpin);
    ui_->latencySpin->setValue(1000 * setup.latencySec);
  }
  const QString folder = workbench_.sessionFolder();
  ui_->sessionLabel->setText(folder.isEmpty() ? tr("No session is open.") : folder);
  ui_->lastSessionBox->setVisible(lastSession_.has_value());
  if (lastSession_)
  {
    ui_->lastSessionLabel->setText(
      tr("Last time, %1: %2.").arg(QLocale().toString(lastSession_->changed, QLocale::ShortFormat), toString(*lastSession_)));
    ui_->lastSessionLabel->setToolTip(lastSession_->folder);
    ui_->lastSessionButton->setToolTip(tr("Opens %1 with everything in it").arg(lastSession_->folder));
  }
  ui_->sessionLabel->setToolTip(workbench_.sessionProblems().join(QLatin1Char('\n')));
}

}  // namespace handeye
