// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OverlayPage.h"

#include "FoldBehind.h"
#include "LandmarkDocument.h"
#include "LandmarkPanel.h"
#include "ui_OverlayPage.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QIcon>
#include <QMap>
#include <QPainter>
#include <QPixmap>
#include <QScopedValueRollback>
#include <QSignalBlocker>

#include <algorithm>

namespace handeye
{

namespace
{

constexpr int TipIntervalMs = 50;  // between two looks at where the stylus' tip is

/// A red disc while it is recorded, a grey ring otherwise.
QIcon recordingLight(OverlayRecordingState::Phase phase)
{
  const bool isOn = phase == OverlayRecordingState::Phase::Recording;
  QPixmap picture(32, 32);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(isOn ? QColor(150, 20, 20) : QColor(128, 128, 128), 4));
  painter.setBrush(isOn ? QBrush(QColor(225, 40, 40)) : QBrush(Qt::NoBrush));
  painter.drawEllipse(QRectF(5, 5, 22, 22));
  return QIcon(picture);
}

}  // namespace

OverlayPage::OverlayPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Overlay, parent)
  , ui_(std::make_unique<Ui::OverlayPage>())
{
  ui_->setupUi(this);
  foldBehind(*ui_->lookButton, *ui_->lookGroup);
  ui_->lookGroup->layout()->setContentsMargins(0, 0, 0, 0);
  connect(ui_->lookButton, &QToolButton::clicked, this, [this] { isLookChosen_ = true; });
  connect(ui_->ownModelButton, &QPushButton::clicked, this,
    [this]
    {
      workbench_.loadModel(HandEyeWorkbench::ownModel());
      ui_->landmarks->loadModelLandmarks(HandEyeWorkbench::ownLandmarks());
    });
  connect(ui_->loadModelButton, &QPushButton::clicked, this,
    [this]
    {
      const QString path =
        QFileDialog::getOpenFileName(this, tr("Model"), {}, tr("Meshes (*.stl *.ply *.obj *.vtp *.vtk);;All files (*)"));
      if (!path.isEmpty())
      {
        workbench_.loadModel(path);
      }
    });
  connectLook();
  connectEyesAndVideo();
  connect(ui_->landmarks, &LandmarkPanel::touchRequested, this, &OverlayPage::takeTip);
  connect(ui_->landmarks, &LandmarkPanel::currentLandmarkChanged, this, &OverlayPage::playRoom);
  connect(ui_->landmarks, &LandmarkPanel::pairsChanged, this,
    [this]
    {
      const LandmarkPanel::Pairs pairs = ui_->landmarks->pairs();
      if (areLandmarksOfAnotherTime_)
      {
        return;
      }
      workbench_.storeLandmarks(landmarksJson(ui_->landmarks->landmarks(), touchedModel_));
      // Landmarks that were only loaded say nothing against the registration there is.
      const bool wasTouched = workbench_.registration().has_value() || !pairs.landmarks.isEmpty();
      workbench_.setTouchingAnew(wasTouched && pairs.landmarks.size() < LandmarkPanel::FewestLandmarks);
      if (pairs.landmarks.size() < LandmarkPanel::FewestLandmarks)
      {
        ui_->landmarks->setResult({});
        checkLandmarks();
        return;
      }
      workbench_.registerLandmarks(pairs.points_Model, pairs.points_Phantom, touchedModel_);
    });
  connect(
    ui_->landmarks, &LandmarkPanel::loadRequested, &workbench_, [this](const QString& path) { workbench_.loadRegistration(path); });
  connect(ui_->landmarks, &LandmarkPanel::saveRequested, &workbench_, &HandEyeWorkbench::saveRegistration);
  connect(&workbench_, &HandEyeWorkbench::registrationChanged, this, &OverlayPage::showRegistration);
  connect(ui_->keepButton, &QPushButton::clicked, &workbench_, &HandEyeWorkbench::keepRegistration);
  ui_->keepButton->hide();
  connect(&workbench_, &HandEyeWorkbench::modelChanged, this, &OverlayPage::takeModel);
  connect(&workbench_, &HandEyeWorkbench::resultsForgotten, this,
    [this]
    {
      const QScopedValueRollback<bool> others(areLandmarksOfAnotherTime_, true);
      forgetTouched();
    });
  connect(&workbench_, &HandEyeWorkbench::sessionOpened, this, &OverlayPage::recallLandmarks);
  setState({});
  tipTimer_.setInterval(TipIntervalMs);
  connect(&tipTimer_, &QTimer::timeout, this, &OverlayPage::followTip);
  tipTimer_.start();
}

OverlayPage::~OverlayPage() = default;

void OverlayPage::enter()
{
  if (workbench_.wantedModelPath().isEmpty() && !HandEyeWorkbench::ownModel().isEmpty())
  {
    workbench_.loadModel(HandEyeWorkbench::ownModel());
  }
  offerOwnLandmarks();
  playRoom();
  // Where there is room for it, it is open, until a person says otherwise.
  constexpr int HighWindow = 1000;
  if (!isLookChosen_)
  {
    ui_->lookButton->setChecked(window()->height() >= HighWindow);
  }
}

/// What was touched belongs to the session of its time, and so do the landmarks of the program's own mesh.
void OverlayPage::forgetTouched()
{
  if (touchedModel_ == HandEyeWorkbench::ownModel())
  {
    ui_->landmarks->setLandmarks({});
  }
  else
  {
    ui_->landmarks->forgetTouched();  // and what could be brought back of it
  }
  touchedModel_.clear();
}

/// Before anything is touched, a person knows whether the landmarks are this mesh's.
void OverlayPage::checkLandmarks()
{
  std::vector<Eigen::Vector3d> points_Model;
  for (const LandmarkPanel::Landmark& landmark : ui_->landmarks->landmarks())
  {
    points_Model.push_back(landmark.point_Model);
  }
  if (!points_Model.empty() && workbench_.modelPath() == touchedModel_)
  {
    workbench_.checkLandmarks(points_Model, ui_->landmarks->pairs().landmarks.size() >= LandmarkPanel::FewestLandmarks);
  }
}

/// What was touched comes back with its session, and is not touched anew by that.
void OverlayPage::recallLandmarks()
{
  const QVector<LandmarkPanel::Landmark> landmarks = landmarksOf(workbench_.storedLandmarks());
  if (landmarks.isEmpty())
  {
    return;
  }
  const QScopedValueRollback<bool> others(areLandmarksOfAnotherTime_, true);
  touchedModel_ = landmarksModelOf(workbench_.storedLandmarks());
  ui_->landmarks->setLandmarks(landmarks);
  const LandmarkPanel::Pairs pairs = ui_->landmarks->pairs();
  if (pairs.landmarks.size() >= LandmarkPanel::FewestLandmarks)
  {
    workbench_.recallRegistration(pairs.points_Model, pairs.points_Phantom);
  }
}

/// Landmarks that were touched for another mesh do not place this one.
void OverlayPage::takeModel()
{
  const QString model = workbench_.modelPath();
  if (model.isEmpty() || model == touchedModel_)
  {
    return;
  }
  if (!touchedModel_.isEmpty())
  {
    forgetTouched();
  }
  touchedModel_ = model;
  offerOwnLandmarks();
  checkLandmarks();
}

/// With the program's own mesh, also while that is being read: a person can begin to touch.
void OverlayPage::offerOwnLandmarks()
{
  const bool isOwn = workbench_.wantedModelPath() == HandEyeWorkbench::ownModel() && !HandEyeWorkbench::ownLandmarks().isEmpty();
  if (isOwn && ui_->landmarks->landmarks().isEmpty())
  {
    ui_->landmarks->loadModelLandmarks(HandEyeWorkbench::ownLandmarks());
  }
}

/// The simulated room's stylus goes to the landmark that is asked for.
void OverlayPage::playRoom()
{
  const int landmark = ui_->landmarks->currentLandmark();
  if (workbench_.step() == WizardStep::Overlay)
  {
    workbench_.devices().playRoom(landmark < 0 ? RoomScene::Free : RoomScene::Landmarks, std::max(landmark, 0));
  }
}

void OverlayPage::connectLook()
{
  connect(ui_->opacitySlider, &QSlider::valueChanged, this, [this](int percent) { emit opacityChanged(percent / 100.0); });
  connect(ui_->lensBox, QOverload<int>::of(&QComboBox::activated), this,
    [this](int way)
    {
      look_.undistorted = way == 1;
      emit lookChanged(look_);
    });
  for (QCheckBox* box : ui_->lookGroup->findChildren<QCheckBox*>())
  {
    const std::string name = box->property("look").toString().toStdString();
    if (!name.empty())
    {
      connect(box, &QCheckBox::clicked, this,
        [this, name](bool isOn)
        {
          *findOverlaySwitch(look_, name) = isOn;
          emit lookChanged(look_);
        });
    }
  }
  connect(ui_->smoothBox, &QCheckBox::toggled, this, &OverlayPage::smoothingChanged);
  connect(ui_->snapshotButton, &QPushButton::clicked, this, &OverlayPage::snapshotWanted);
  connect(&workbench_, &HandEyeWorkbench::snapshotSaved, this,
    [this](const QString& path)
    {
      ui_->snapshotLabel->setText(tr("Stored: snapshots/%1").arg(QFileInfo(path).fileName()));
      ui_->snapshotLabel->setToolTip(path);
    });
  QString rows;
  for (const OverlayKey& key : overlayKeys())
  {
    rows += QStringLiteral("<tr><td><b>%1</b>&nbsp;</td><td>%2</td></tr>")
              .arg(QString(QLatin1Char(key.key)).toHtmlEscaped(), QString::fromStdString(key.help).toHtmlEscaped());
  }
  ui_->keysLabel->setToolTip(QStringLiteral("<table>%1</table>").arg(rows));
  showLook();
}

void OverlayPage::connectEyesAndVideo()
{
  const auto choose = [this]
  {
    const int row = ui_->eyesBox->currentIndex();
    OverlayStereo stereo;
    if (row > 0)
    {
      stereo.layout = vtkHandEyeStereoOverlay::Layout(row - 1);
    }
    stereo.isSwapped = ui_->swapBox->isChecked();
    emit stereoChanged(stereo);
  };
  connect(ui_->eyesBox, QOverload<int>::of(&QComboBox::activated), this, choose);
  connect(ui_->swapBox, &QCheckBox::clicked, this, choose);
  connect(ui_->recordButton, &QPushButton::clicked, this,
    [this]
    {
      if (isRecording_)
      {
        emit recordingUnwanted();
        return;
      }
      emit recordingWanted(ui_->formatBox->currentIndex() == 1 ? QStringLiteral(".avi") : QStringLiteral(".mp4"));
    });
  setRecording({});
}

void OverlayPage::setStereo(const OverlayStereo& stereo)
{
  ui_->eyesBox->setCurrentIndex(stereo.layout ? int(*stereo.layout) + 1 : 0);
  ui_->swapBox->setChecked(stereo.isSwapped);
}

void OverlayPage::setRecording(const OverlayRecordingState& state)
{
  using Phase = OverlayRecordingState::Phase;
  isRecording_ = state.phase == Phase::Recording;
  const int seconds = int(state.elapsedSec);
  const QString time = QStringLiteral("%1:%2").arg(seconds / 60).arg(seconds % 60, 2, 10, QLatin1Char('0'));
  const QString name = QFileInfo(state.path).fileName();
  const QString counted = tr("%1, %2 pictures").arg(time).arg(state.pictureCount);
  const QMap<Phase, QString> words = { { Phase::Idle, QString() }, { Phase::Recording, tr("Recording: %1").arg(counted) },
    { Phase::Finishing, tr("Storing: %1").arg(counted) }, { Phase::Stored, tr("Stored: videos/%1 (%2)").arg(name, counted) },
    { Phase::Failed, tr("Not recorded:") } };
  ui_->recordButton->setText(isRecording_ ? tr("Stop recording") : tr("Record a video"));
  // Also where the controls are closed.
  ui_->lookButton->setText(isRecording_ ? tr("Look, pictures and video (recording)") : tr("Look, pictures and video"));
  ui_->recordButton->setEnabled(state.phase != Phase::Finishing);
  ui_->formatBox->setEnabled(!isRecording_ && state.phase != Phase::Finishing);
  ui_->eyesBox->setEnabled(!isRecording_);
  ui_->swapBox->setEnabled(!isRecording_);
  ui_->recordLight->setPixmap(recordingLight(state.phase).pixmap(16, 16));
  ui_->recordLight->setToolTip(isRecording_ ? tr("What the video shows is being recorded") : tr("Nothing is being recorded"));
  ui_->recordLight->setAccessibleDescription(ui_->recordLight->toolTip());
  ui_->recordLabel->setText((words.value(state.phase) + QLatin1Char(' ') + state.message).trimmed());
  ui_->recordLabel->setToolTip(state.path);
  ui_->recordLabel->setVisible(!ui_->recordLabel->text().isEmpty());
  if (state.phase == Phase::Failed)
  {
    ui_->lookButton->setChecked(true);  // the reason is behind it
  }
}

void OverlayPage::showLook()
{
  ui_->lensBox->setCurrentIndex(look_.undistorted ? 1 : 0);
  for (QCheckBox* box : ui_->lookGroup->findChildren<QCheckBox*>())
  {
    if (const bool* isOn = findOverlaySwitch(look_, box->property("look").toString().toStdString()))
    {
      box->setChecked(*isOn);
    }
  }
}

void OverlayPage::setLook(const OverlayLook& look, double opacity)
{
  look_ = look;
  showLook();
  const QSignalBlocker blocker(ui_->opacitySlider);
  ui_->opacitySlider->setValue(qRound(100 * opacity));
}

void OverlayPage::setState(const OverlayState& state)
{
  ui_->overlayLabel->setText(!state.problem.isEmpty() ? state.problem
      : state.isDrawn                                 ? tr("The model is drawn where the calibration puts it.")
                                                      : tr("The model is not drawn: no picture has come yet."));
  ui_->haloBox->setEnabled(state.hasHalo);
  ui_->eyesLabel->setText(ui_->eyesBox->currentIndex() > 0 ? state.stereoProblem : QString());
  ui_->eyesLabel->setVisible(!ui_->eyesLabel->text().isEmpty());
  const QString delay = ui_->smoothBox->isChecked() ? tr("delay %1 ms").arg(1000 * state.delaySec, 0, 'f', 0) : tr("no delay");
  ui_->delayLabel->setText(delay);
  ui_->haloLabel->setText(state.predictedErrorPx ? tr("Halo: predicted error %1 px").arg(*state.predictedErrorPx, 0, 'f', 1)
      : state.hasHalo                            ? QString()
                                                 : tr("No halo: the error of this calibration is not known."));
  ui_->haloLabel->setVisible(!ui_->haloLabel->text().isEmpty());
}

void OverlayPage::followTip()
{
  if (!isVisible())
  {
    return;
  }
  const DeviceSetup& setup = workbench_.devices().setup();
  const std::optional<HandEyeWorkbench::Stylus>& stylus = workbench_.stylus();
  TouchTask& task = workbench_.touch();
  task.follow(stylus ? std::optional<Eigen::Vector3d>(stylus->tip_Stylus) : std::nullopt, setup.stylusToTracker.toStdString(),
    setup.phantomToTracker.toStdString());
  touch_ = task.newest();
  ui_->landmarks->setTipAvailable(touch_.tip_Phantom.has_value(), touch_.problem);
  if (touch_.rest_Phantom)
  {
    ui_->landmarks->offerTip(*touch_.rest_Phantom);
  }
}

void OverlayPage::takeTip()
{
  if (touch_.tip_Phantom)
  {
    ui_->landmarks->setTouched(touch_.rest_Phantom.value_or(*touch_.tip_Phantom));
  }
}

void OverlayPage::showRegistration()
{
  ui_->keepButton->setVisible(workbench_.isRegisteredForAnotherModel());
  const std::optional<LandmarkRegistrationResult>& result = workbench_.registration();
  const int pairCount = ui_->landmarks->pairs().landmarks.size();
  if (!result || int(result->residualsMm.size()) == pairCount || !result->isUsable())
  {
    ui_->landmarks->setResult(result);
  }
}

void OverlayPage::refresh()
{
  ui_->modelLabel->setText(workbench_.model() ? QFileInfo(workbench_.modelPath()).fileName() : tr("none"));
  ui_->modelLabel->setToolTip(workbench_.modelPath());
}

}  // namespace handeye
