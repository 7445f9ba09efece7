// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeCalibrationPanel.h"

#include "BallPage.h"
#include "CameraPage.h"
#include "CapturePage.h"
#include "DevicesPage.h"
#include "FinishPage.h"
#include "HandEyeWorkbench.h"
#include "HostLink.h"
#include "Look.h"
#include "OverlayPage.h"
#include "StylusPage.h"
#include "ValidationPage.h"
#include "VideoPresenter.h"
#include "VideoView.h"
#include "WizardStepBar.h"
#include "ui_HandEyeCalibrationPanel.h"

#include <QFileInfo>
#include <QScrollBar>
#include <QShortcut>
#include <QSplitter>
#include <QVBoxLayout>

#include <algorithm>
#include <array>

using handeye::HandEyeWorkbench;
using handeye::WizardPage;
using handeye::WizardStep;
using handeye::WizardStepBar;

class HandEyeCalibrationPanel::Private
{
public:
  Private(HandEyeCalibrationPanel& panel, vtkSlicerHandEyeCalibrationLogic* logic, NavigationHost* host);

  void makePages();
  void makeVideo();
  void connectAll();
  void refresh();
  void showMessage(const QString& text, handeye::Level level);
  void showProgress(int done, int total, const QString& what);
  void refuse(WizardStep step, const QString& message);
  WizardPage& currentPage() const { return *pages[std::size_t(step)]; }

  HandEyeCalibrationPanel& q;
  NavigationHost* host;
  std::unique_ptr<HandEyeWorkbench> workbench;
  Ui::HandEyeCalibrationPanel ui;
  QWidget* wizard = nullptr;
  WizardStepBar* steps = nullptr;
  std::unique_ptr<handeye::VideoView> video;
  handeye::VideoPresenter* presenter = nullptr;
  std::unique_ptr<handeye::HostLink> link;
  std::array<WizardPage*, handeye::WizardStepCount> pages{};
  WizardStep step = WizardStep::Devices;
  QString refusal;  ///< the last one of this page; empty if there is none
};

HandEyeCalibrationPanel::Private::Private(
  HandEyeCalibrationPanel& panel, vtkSlicerHandEyeCalibrationLogic* logic, NavigationHost* navigationHost)
  : q(panel)
  , host(navigationHost)
  , workbench(std::make_unique<HandEyeWorkbench>(logic))
{
  auto* layout = new QVBoxLayout(&q);
  layout->setContentsMargins(0, 0, 0, 0);
  wizard = new QWidget;
  ui.setupUi(wizard);
  wizard->layout()->setContentsMargins(6, 6, 6, 6);
  steps = new WizardStepBar(ui.stepBar);
  ui.stepBarLayout->addWidget(steps, 0, 0);
  ui.progressBox->hide();
  wizard->setMinimumWidth(380);
  makePages();
  makeVideo();
  connectAll();
}

void HandEyeCalibrationPanel::Private::makePages()
{
  pages = { new handeye::DevicesPage(*workbench), new handeye::CameraPage(*workbench), new handeye::StylusPage(*workbench),
    new handeye::BallPage(*workbench), new handeye::CapturePage(*workbench), new handeye::ValidationPage(*workbench),
    new handeye::OverlayPage(*workbench), new handeye::FinishPage(*workbench) };
  for (WizardPage* page : pages)
  {
    ui.pages->addWidget(page);
  }
}

void HandEyeCalibrationPanel::Private::makeVideo()
{
  video = std::make_unique<handeye::VideoView>();
  presenter = new handeye::VideoPresenter(*workbench, *video, &q);
  if (host)
  {
    q.layout()->addWidget(wizard);
    link = std::make_unique<handeye::HostLink>(*workbench, *host);
    return;
  }
  auto* splitter = new QSplitter(Qt::Horizontal, &q);
  splitter->addWidget(video.get());
  splitter->addWidget(wizard);
  splitter->setStretchFactor(0, 1);
  splitter->setStretchFactor(1, 0);
  splitter->setChildrenCollapsible(false);
  splitter->setSizes({ 800, 420 });
  q.layout()->addWidget(splitter);
}

void HandEyeCalibrationPanel::Private::connectAll()
{
  connect(steps, &WizardStepBar::chosen, &q, &HandEyeCalibrationPanel::goTo);
  connect(ui.nextButton, &QPushButton::clicked, &q, &HandEyeCalibrationPanel::goNext);
  connect(ui.backButton, &QPushButton::clicked, &q, &HandEyeCalibrationPanel::goBack);
  connect(ui.cancelButton, &QPushButton::clicked, workbench.get(), &HandEyeWorkbench::cancelWork);
  connect(workbench.get(), &HandEyeWorkbench::stateChanged, &q, [this] { refresh(); });
  connect(workbench.get(), &HandEyeWorkbench::sessionOpened, &q,
    [this]
    {
      refusal.clear();
      refresh();
    });
  connect(workbench.get(), &HandEyeWorkbench::refused, &q, [this](WizardStep of, const QString& message) { refuse(of, message); });
  const auto forget = [this](WizardStep of)
  {
    return [this, of]
    {
      if (step == of)
      {
        refusal.clear();
        refresh();
      }
    };
  };
  connect(workbench.get(), &HandEyeWorkbench::cameraChanged, &q, forget(WizardStep::Camera));
  connect(workbench.get(), &HandEyeWorkbench::stylusChanged, &q, forget(WizardStep::Stylus));
  connect(workbench.get(), &HandEyeWorkbench::ballChanged, &q, forget(WizardStep::Ball));
  connect(workbench.get(), &HandEyeWorkbench::latencyChanged, &q, forget(WizardStep::Ball));
  connect(workbench.get(), &HandEyeWorkbench::modelChanged, &q, forget(WizardStep::Overlay));
  connect(&workbench->capture(), &handeye::CaptureTask::accepted, &q, forget(WizardStep::Capture));
  connect(&workbench->validationCapture(), &handeye::CaptureTask::accepted, &q, forget(WizardStep::Validation));
  connect(&workbench->pivot(), &handeye::PivotTask::collectingChanged, &q,
    [this]
    {
      if (workbench->pivot().isCollecting())
      {
        refusal.clear();
      }
      refresh();
    });
  for (handeye::CaptureTask* task : { &workbench->capture(), &workbench->validationCapture() })
  {
    connect(task, &handeye::CaptureTask::progress, &q,
      [this](int done, int total, const QString& what) { showProgress(done, total, what); });
    connect(task, &handeye::CaptureTask::busyChanged, &q, [this, task] { ui.progressBox->setVisible(task->isBusy()); });
  }
  connect(video.get(), &handeye::VideoView::imageClicked, &q, [this](const QPointF& point) { currentPage().clickInVideo(point); });
  connect(video.get(), &handeye::VideoView::keyPressed, &q,
    [this](int key, Qt::KeyboardModifiers modifiers)
    {
      // Which keys + and > are on, the keyboard decides.
      if (!(modifiers & ~(Qt::ShiftModifier | Qt::KeypadModifier)) && presenter->overlay().handleKey(key))
      {
        return;
      }
      if (modifiers == Qt::NoModifier)
      {
        currentPage().keyInVideo(key);
      }
    });
  auto* overlay = static_cast<handeye::OverlayPage*>(pages[std::size_t(WizardStep::Overlay)]);
  handeye::OverlayPresenter* drawn = &presenter->overlay();
  connect(overlay, &handeye::OverlayPage::opacityChanged, drawn, &handeye::OverlayPresenter::setOpacity);
  connect(overlay, &handeye::OverlayPage::lookChanged, drawn, &handeye::OverlayPresenter::setLook);
  connect(overlay, &handeye::OverlayPage::smoothingChanged, drawn, &handeye::OverlayPresenter::setSmoothing);
  connect(overlay, &handeye::OverlayPage::snapshotWanted, drawn, &handeye::OverlayPresenter::takeSnapshot);
  connect(overlay, &handeye::OverlayPage::stereoChanged, drawn, &handeye::OverlayPresenter::setStereo);
  connect(overlay, &handeye::OverlayPage::recordingWanted, drawn, &handeye::OverlayPresenter::startRecording);
  connect(overlay, &handeye::OverlayPage::recordingUnwanted, drawn, &handeye::OverlayPresenter::stopRecording);
  connect(drawn, &handeye::OverlayPresenter::recordingChanged, overlay, &handeye::OverlayPage::setRecording);
  connect(drawn, &handeye::OverlayPresenter::stateChanged, overlay, &handeye::OverlayPage::setState);
  connect(drawn, &handeye::OverlayPresenter::lookChanged, overlay,
    [drawn, overlay]
    {
      overlay->setLook(drawn->look(), drawn->opacity());
      overlay->setStereo(drawn->stereo());
    });
}

void HandEyeCalibrationPanel::Private::showProgress(int done, int total, const QString& what)
{
  ui.progressBar->setRange(0, total);
  ui.progressBar->setValue(done);
  ui.progressBar->setFormat(QStringLiteral("%v/%m"));
  ui.progressBar->setToolTip(what);
}

void HandEyeCalibrationPanel::Private::refuse(WizardStep of, const QString& message)
{
  if (of == step || step == WizardStep::Finish)
  {
    refusal = message;
    refresh();
  }
}

void HandEyeCalibrationPanel::Private::showMessage(const QString& text, handeye::Level level)
{
  QPalette palette = wizard->palette();
  palette.setColor(QPalette::WindowText, handeye::levelColor(level, wizard->palette()));
  ui.messageLabel->setPalette(palette);
  ui.messageLabel->setText(text);
  ui.messageLabel->setVisible(!text.isEmpty());
}

void HandEyeCalibrationPanel::Private::refresh()
{
  for (int i = 0; i < handeye::WizardStepCount; ++i)
  {
    const WizardStep each = WizardStep(i);
    const QString missing = workbench->missingFor(each), problem = workbench->problemOf(each);
    steps->setState(each,
      !missing.isEmpty()                                  ? WizardStepBar::State::Blocked
        : problem.isEmpty() && each != WizardStep::Finish ? WizardStepBar::State::Done
                                                          : WizardStepBar::State::Open,
      problem);
  }
  currentPage().refresh();
  // A stack of pages does not ask for the height that wrapped words need at this width.
  if (const auto* layout = qobject_cast<QBoxLayout*>(currentPage().layout()))
  {
    ui.pages->setMinimumHeight(std::max(0, layout->minimumHeightForWidth(ui.scrollArea->viewport()->width())));
  }
  const QString missing = workbench->missingFor(step), problem = workbench->problemOf(step);
  const bool isLast = step == WizardStep::Finish;
  ui.missingLabel->setText(missing);
  ui.missingLabel->setVisible(!missing.isEmpty());
  ui.nextButton->setVisible(!isLast);
  ui.nextButton->setEnabled(problem.isEmpty());
  ui.backButton->setEnabled(step != WizardStep::Devices);
  ui.reasonLabel->setText(problem.isEmpty() || isLast ? QString() : HandEyeCalibrationPanel::tr("Next is closed: %1").arg(problem));
  ui.reasonLabel->setVisible(!ui.reasonLabel->text().isEmpty() && missing.isEmpty());
  if (!refusal.isEmpty())
  {
    showMessage(refusal, handeye::Level::Error);
  }
  else
  {
    showMessage(problem.isEmpty() && !isLast ? workbench->verdictOf(step) : QString(), handeye::Level::Good);
  }
}

HandEyeCalibrationPanel::HandEyeCalibrationPanel(vtkSlicerHandEyeCalibrationLogic* logic, NavigationHost* host, QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>(*this, logic, host))
{
  const auto shortcut = [this](const QKeySequence& keys, void (HandEyeCalibrationPanel::*slot)())
  { connect(new QShortcut(keys, this, nullptr, nullptr, Qt::WidgetWithChildrenShortcut), &QShortcut::activated, this, slot); };
  shortcut(QKeySequence(Qt::ALT + Qt::Key_Right), &HandEyeCalibrationPanel::goNext);
  shortcut(QKeySequence(Qt::ALT + Qt::Key_Left), &HandEyeCalibrationPanel::goBack);
  d->workbench->openSession(HandEyeWorkbench::newSessionFolder());
  goTo(WizardStep::Devices);
  if (d->link && d->link->isDemonstration())
  {
    d->workbench->connectDevices({});
  }
}

HandEyeCalibrationPanel::~HandEyeCalibrationPanel()
{
  exitModule();
  // The pages look at the workbench; the video belongs to whoever shows it as long as this lives.
  delete d->wizard;
}

HandEyeWorkbench& HandEyeCalibrationPanel::workbench()
{
  return *d->workbench;
}

handeye::VideoView& HandEyeCalibrationPanel::videoView()
{
  return *d->video;
}

WizardStep HandEyeCalibrationPanel::currentStep() const
{
  return d->step;
}

WizardPage* HandEyeCalibrationPanel::page(WizardStep step) const
{
  return d->pages[std::size_t(step)];
}

void HandEyeCalibrationPanel::goTo(WizardStep step)
{
  d->currentPage().leave();
  d->step = step;
  d->refusal.clear();
  d->steps->setCurrent(step);
  d->ui.pages->setCurrentWidget(&d->currentPage());
  d->ui.scrollArea->verticalScrollBar()->setValue(0);
  d->workbench->enterStep(step);
  d->currentPage().enter();
  d->refresh();
}

void HandEyeCalibrationPanel::goNext()
{
  if (d->step != WizardStep::Finish && d->workbench->problemOf(d->step).isEmpty())
  {
    goTo(WizardStep(int(d->step) + 1));
  }
}

void HandEyeCalibrationPanel::goBack()
{
  if (d->step != WizardStep::Devices)
  {
    goTo(WizardStep(int(d->step) - 1));
  }
}

void HandEyeCalibrationPanel::enterModule()
{
  if (d->host)
  {
    d->link->enter(d->video.get(), this);
  }
}

void HandEyeCalibrationPanel::exitModule()
{
  if (d->host)
  {
    d->link->exit();
  }
}

void HandEyeCalibrationPanel::showEvent(QShowEvent* event)
{
  QWidget::showEvent(event);
  enterModule();
}

void HandEyeCalibrationPanel::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && d)
  {
    d->refresh();
  }
}

bool HandEyeCalibrationPanel::openFile(const QString& path)
{
  const QFileInfo file(path);
  const QString ending = file.suffix().toLower();
  static const QStringList meshes = { QStringLiteral("stl"), QStringLiteral("ply"), QStringLiteral("obj"), QStringLiteral("vtp"),
    QStringLiteral("vtk") };
  static const QStringList cameras = { QStringLiteral("yml"), QStringLiteral("yaml"), QStringLiteral("xml"),
    QStringLiteral("txt") };
  if (!file.exists())
  {
    return false;
  }
  if (file.isDir() && QFileInfo::exists(path + QStringLiteral("/session.json")))
  {
    d->workbench->openSession(path);
    return true;
  }
  if (file.isDir() || ending == QStringLiteral("mha"))
  {
    if (d->step == WizardStep::Stylus)
    {
      d->workbench->pivot().calibrateRecording(path, d->workbench->devices().setup().stylusToTracker);
    }
    else if (d->step == WizardStep::Capture || d->step == WizardStep::Validation)
    {
      (d->step == WizardStep::Capture ? d->workbench->capture() : d->workbench->validationCapture()).importRecording(path);
    }
    else
    {
      goTo(WizardStep::Devices);
      static_cast<handeye::DevicesPage*>(page(WizardStep::Devices))->chooseRecording(path);
    }
    return true;
  }
  if (meshes.contains(ending))
  {
    goTo(WizardStep::Overlay);
    d->workbench->loadModel(path);
    return true;
  }
  if (d->step == WizardStep::Stylus && ending == QStringLiteral("json"))
  {
    d->workbench->loadStylus(path);
    return true;
  }
  if (d->step == WizardStep::Capture && ending == QStringLiteral("json"))
  {
    d->workbench->loadCalibration(path);
    return true;
  }
  if (d->step == WizardStep::Overlay && ending == QStringLiteral("json"))
  {
    d->workbench->loadRegistration(path);
    return true;
  }
  if (cameras.contains(ending) || ending == QStringLiteral("json"))
  {
    goTo(WizardStep::Camera);
    d->workbench->loadCamera(path);
    return true;
  }
  return false;
}
