// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeCalibrationPanel.h"

#include "BallPage.h"
#include "CameraPage.h"
#include "CapturePage.h"
#include "ComparisonPage.h"
#include "DevicesPage.h"
#include "FinishPage.h"
#include "HandEyeWorkbench.h"
#include "HostLink.h"
#include "LogicLink.h"
#include "Look.h"
#include "OverlayPage.h"
#include "StylusPage.h"
#include "ValidationPage.h"
#include "VideoPresenter.h"
#include "VideoView.h"
#include "WheelGuard.h"
#include "WizardStepBar.h"
#include "ui_HandEyeCalibrationPanel.h"

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
  Private(HandEyeCalibrationPanel& panel, NavigationHost* host);

  void makePages();
  void makeVideo();
  void connectAll();
  void refresh();
  void showMessage(const QString& text, handeye::Level level);
  void showProgress(int done, int total, const QString& what);
  void connectRefusals();
  void refuse(WizardStep step, const QString& message);
  void forgive(WizardStep of);
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
  std::unique_ptr<handeye::LogicLink> logicLink;
  std::array<WizardPage*, handeye::WizardStepCount> pages{};
  WizardStep step = WizardStep::Devices;
  std::array<QString, handeye::WizardStepCount> refusals;  ///< the last one of each page; empty if there is none
};

HandEyeCalibrationPanel::Private::Private(HandEyeCalibrationPanel& panel, NavigationHost* navigationHost)
  : q(panel)
  , host(navigationHost)
  , workbench(std::make_unique<HandEyeWorkbench>())
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
  // Most verdicts take two lines: there is room for them at once, and the page above does not move with the words.
  ui.messageLabel->setMinimumHeight(2 * ui.messageLabel->fontMetrics().lineSpacing());
  makePages();
  makeVideo();
  connectAll();
}

void HandEyeCalibrationPanel::Private::makePages()
{
  pages = { new handeye::DevicesPage(*workbench), new handeye::CameraPage(*workbench), new handeye::StylusPage(*workbench),
    new handeye::BallPage(*workbench), new handeye::CapturePage(*workbench), new handeye::ValidationPage(*workbench),
    new handeye::ComparisonPage(*workbench), new handeye::OverlayPage(*workbench), new handeye::FinishPage(*workbench) };
  for (WizardPage* const page : pages)
  {
    new handeye::WheelGuard(*page);
    page->hide();
    ui.pagesLayout->addWidget(page);
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
  connectRefusals();
  // After the page, which takes more room then.
  connect(&workbench->comparison(), &handeye::ComparisonTask::finished, &q, [this] { refresh(); });
  connect(&workbench->comparison(), &handeye::ComparisonTask::reportWritten, &q, [this] { refresh(); });
  for (handeye::CaptureTask* task : { &workbench->capture(), &workbench->validationCapture() })
  {
    connect(task, &handeye::CaptureTask::progress, &q,
      [this](int done, int total, const QString& what) { showProgress(done, total, what); });
    connect(task, &handeye::CaptureTask::busyChanged, &q, [this, task] { ui.progressBox->setVisible(task->isBusy()); });
  }
  connect(video.get(), &handeye::VideoView::imageClicked, &q,
    [this](const QPointF& point) { currentPage().clickInVideo(presenter->onScreen(), point); });
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

/// What was refused is said until it has been made good.
void HandEyeCalibrationPanel::Private::connectRefusals()
{
  using handeye::CaptureTask;
  HandEyeWorkbench* const bench = workbench.get();
  connect(bench, &HandEyeWorkbench::refused, &q, [this](WizardStep of, const QString& message) { refuse(of, message); });
  connect(bench, &HandEyeWorkbench::sessionOpened, &q,
    [this]
    {
      refusals.fill({});
      // Where it was left, there it is gone on with.
      if (const std::optional<WizardStep> left = workbench->storedStep())
      {
        q.goTo(*left);
      }
      refresh();
    });
  const auto forgiving = [this](WizardStep of) { return [this, of] { forgive(of); }; };
  connect(bench, &HandEyeWorkbench::cameraChanged, &q, forgiving(WizardStep::Camera));
  connect(bench, &HandEyeWorkbench::stylusChanged, &q, forgiving(WizardStep::Stylus));
  connect(bench, &HandEyeWorkbench::ballChanged, &q, forgiving(WizardStep::Ball));
  // What could not be taken with another lens, stylus or ball, or from other devices, may be possible now.
  const auto forgiveTaking = [this]
  {
    forgive(WizardStep::Capture);
    forgive(WizardStep::Validation);
  };
  connect(bench, &HandEyeWorkbench::cameraChanged, &q, forgiveTaking);
  connect(bench, &HandEyeWorkbench::stylusChanged, &q, forgiveTaking);
  connect(bench, &HandEyeWorkbench::ballChanged, &q, forgiveTaking);
  connect(&bench->devices(), &handeye::DeviceHub::connectionChanged, &q, forgiveTaking);
  connect(bench, &HandEyeWorkbench::latencyChanged, &q, forgiving(WizardStep::Ball));
  connect(bench, &HandEyeWorkbench::modelChanged, &q, forgiving(WizardStep::Overlay));
  connect(bench, &HandEyeWorkbench::registrationChanged, &q,
    [this]
    {
      if (workbench->registrationOfModel())
      {
        forgive(WizardStep::Overlay);
      }
    });
  connect(&bench->latency(), &handeye::LatencyTask::runningChanged, &q,
    [this]
    {
      if (workbench->latency().isRunning())
      {
        forgive(WizardStep::Ball);
      }
    });
  connect(&workbench->comparison(), &handeye::ComparisonTask::changed, &q,
    [this]
    {
      if (workbench->comparison().isWorking())
      {
        forgive(WizardStep::Comparison);
      }
      refresh();
    });
  for (const auto& [task, of] :
    { std::pair(&workbench->capture(), WizardStep::Capture), std::pair(&workbench->validationCapture(), WizardStep::Validation) })
  {
    connect(task, &CaptureTask::accepted, &q, forgiving(of));
    connect(task, &CaptureTask::busyChanged, &q,
      [this, of = of, task = task]
      {
        if (task->isBusy())
        {
          forgive(of);
        }
      });
  }
  connect(&workbench->pivot(), &handeye::PivotTask::collectingChanged, &q,
    [this]
    {
      if (workbench->pivot().isCollecting())
      {
        forgive(WizardStep::Stylus);
      }
      refresh();
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
  // The last page has no work of its own: what fails there is another page's.
  refusals[std::size_t(step == WizardStep::Finish ? step : of)] = message;
  refresh();
}

void HandEyeCalibrationPanel::Private::forgive(WizardStep of)
{
  refusals[std::size_t(of)].clear();
  refresh();
}

void HandEyeCalibrationPanel::Private::showMessage(const QString& text, handeye::Level level)
{
  QPalette palette = wizard->palette();
  palette.setColor(QPalette::WindowText, handeye::levelColor(level, wizard->palette()));
  ui.messageLabel->setPalette(palette);
  ui.messageLabel->setText(handeye::asSentence(text));
  ui.messageLabel->setVisible(!text.isEmpty());
}

void HandEyeCalibrationPanel::Private::refresh()
{
  const auto isDoubtful = [this](WizardStep each)
  {
    const handeye::Level level = workbench->levelOf(each);
    return level == handeye::Level::Warning || level == handeye::Level::Error;
  };
  for (int i = 0; i < handeye::WizardStepCount; ++i)
  {
    const WizardStep each = WizardStep(i);
    const QString missing = workbench->missingFor(each), problem = workbench->problemOf(each);
    steps->setState(each,
      !missing.isEmpty()           ? WizardStepBar::State::Blocked
        : !workbench->isDone(each) ? WizardStepBar::State::Open
        : isDoubtful(each)         ? WizardStepBar::State::Doubtful
                                   : WizardStepBar::State::Done,
      missing.isEmpty() ? problem : missing);
  }
  currentPage().refresh();
  const QString missing = workbench->missingFor(step), problem = workbench->problemOf(step);
  const bool isLast = step == WizardStep::Finish;
  ui.missingLabel->setText(handeye::asSentence(missing));
  ui.missingLabel->setVisible(!missing.isEmpty());
  ui.nextButton->setVisible(!isLast);
  ui.nextButton->setEnabled(problem.isEmpty());
  ui.backButton->setEnabled(step != WizardStep::Devices);
  ui.reasonLabel->setText(
    problem.isEmpty() || isLast ? QString() : HandEyeCalibrationPanel::tr("Next is closed: %1").arg(handeye::asSentence(problem)));
  ui.reasonLabel->setVisible(!ui.reasonLabel->text().isEmpty() && missing.isEmpty());
  if (const QString& refusal = refusals[std::size_t(step)]; !refusal.isEmpty())
  {
    showMessage(refusal, handeye::Level::Error);
  }
  else
  {
    showMessage(problem.isEmpty() && !isLast ? workbench->verdictOf(step) : QString(), workbench->levelOf(step));
  }
}

HandEyeCalibrationPanel::HandEyeCalibrationPanel(vtkSlicerHandEyeCalibrationLogic* logic, NavigationHost* host, QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>(*this, host))
{
  const auto shortcut = [this](const QKeySequence& keys, const QString& words, void (HandEyeCalibrationPanel::*slot)())
  {
    auto* made = new QShortcut(keys, this, nullptr, nullptr, Qt::WidgetWithChildrenShortcut);
    made->setWhatsThis(words);
    connect(made, &QShortcut::activated, this, slot);
  };
  shortcut(QKeySequence(Qt::ALT + Qt::Key_Right), tr("Next page of the wizard"), &HandEyeCalibrationPanel::goNext);
  shortcut(QKeySequence(Qt::ALT + Qt::Key_Left), tr("Page before in the wizard"), &HandEyeCalibrationPanel::goBack);
  // The pages and the video take these themselves.
  this->setProperty("keysAndWhatTheyDo",
    QStringList{ tr("Space") + QLatin1Char('\t') + tr("Take a sample (video)"),
      tr("Space") + QLatin1Char('\t') + tr("Touch the landmark (list of landmarks)"),
      tr("Backspace") + QLatin1Char('\t') + tr("Touch the landmark again (list of landmarks)") });
  d->workbench->openSession(HandEyeWorkbench::newSessionFolder());
  if (logic)
  {
    d->logicLink = std::make_unique<handeye::LogicLink>(*d->workbench, *logic);
  }
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
  if (d->step != step)
  {
    d->refusals[std::size_t(d->step)].clear();
  }
  d->step = step;
  d->steps->setCurrent(step);
  for (WizardPage* const page : d->pages)
  {
    page->setVisible(page == &d->currentPage());  // a page that is hidden asks for no room
  }
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
