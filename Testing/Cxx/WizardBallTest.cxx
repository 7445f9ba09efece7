// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoPresenter.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"
#include "WizardDriver.h"
#include "WizardScreens.h"

#include <QScreen>
#include <QSignalBlocker>
#include <QToolButton>

#include <cmath>
#include <memory>
#include <optional>

using handeye::HandEyeWorkbench;
using handeye::LiveView;
using handeye::WizardStep;

/// The page Ball in the simulated room: a person clicks with a mouse, and takes time for it.
class WizardBallTest : public QObject
{
  Q_OBJECT

private slots:
  void init();
  void cleanup();

  void ball_StaysWhereItIs_UntilItIsClicked();
  void click_OnTheBall_LearnsItsColour_AndUndoTakesItBack();
  void click_OnTheBoard_IsSaidAndKeepsTheColour();
  void click_MeansTheFrameThatWasShown();

private:
  HandEyeWorkbench& workbench() { return panel_->workbench(); }
  QPointF ball_Image();
  void clickAt(const QPointF& point_Image);
  void photograph(const QString& name);
  QString color() { return driver_->onPage<QLabel>("colorLabel")->text(); }

  std::unique_ptr<HandEyeCalibrationPanel> panel_;
  std::unique_ptr<WizardDriver> driver_;
};

namespace
{

/// On the wooden board behind the ball.
const QPointF OnTheBoard(150, 110);

bool hasBall(const std::shared_ptr<const LiveView>& view)
{
  return view && view->ball && view->ball->isFound();
}

}  // namespace

void WizardBallTest::init()
{
  panel_ = std::make_unique<HandEyeCalibrationPanel>(nullptr, nullptr);
  driver_ = std::make_unique<WizardDriver>(*panel_);
  printRefusals(*panel_);
  testing_widgets::show(*panel_, QSize(1280, 800));
  driver_->click(driver_->onPage("connectButton"));
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
  panel_->goTo(WizardStep::Ball);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext() && hasBall(workbench().live().newest()), PatienceMs);
  QTest::qWait(300);
}

void WizardBallTest::cleanup()
{
  driver_.reset();
  panel_.reset();
}

/// Where it is seen, and how large.
QPointF WizardBallTest::ball_Image()
{
  const Eigen::Vector2d ball_Image = workbench().live().newest()->ball->ball_Image;
  return { ball_Image.x(), ball_Image.y() };
}

void WizardBallTest::clickAt(const QPointF& point_Image)
{
  handeye::VideoView& view = panel_->videoView();
  QTest::mouseClick(view.findChild<QVTKOpenGLNativeWidget*>(), Qt::LeftButton, {}, view.imageToWidget(point_Image)->toPoint());
}

void WizardBallTest::photograph(const QString& name)
{
  QTest::qWait(400);
  const QString file = QStringLiteral("%1/%2.png").arg(screenshotFolder(), name);
  QVERIFY2(panel_->screen()->grabWindow(panel_->winId()).save(file), qPrintable(file));
  QVERIFY2(faultsOf(*panel_).isEmpty(), qPrintable(faultsOf(*panel_).join(QLatin1Char('\n'))));
}

void WizardBallTest::ball_StaysWhereItIs_UntilItIsClicked()
{
  QTRY_VERIFY_WITH_TIMEOUT(hasBall(workbench().live().newest()), PatienceMs);
  const QPointF before = ball_Image();
  const double radiusPx = workbench().live().newest()->ball->radiusPx;
  QVERIFY(radiusPx > 20);
  for (int i = 0; i < 40; ++i)
  {
    QTest::qWait(200);
    QTRY_VERIFY_WITH_TIMEOUT(hasBall(workbench().live().newest()), PatienceMs);
    const QPointF moved = ball_Image() - before;
    QVERIFY2(std::hypot(moved.x(), moved.y()) < 0.4 * radiusPx, qPrintable(QString::number(std::hypot(moved.x(), moved.y()))));
  }
}

void WizardBallTest::click_OnTheBall_LearnsItsColour_AndUndoTakesItBack()
{
  QCOMPARE(color(), QStringLiteral("any saturated red"));
  QVERIFY(!driver_->onPage<QToolButton>("undoButton")->isEnabled());
  // A ball of the colour that was just learnt has not been seen yet.
  std::optional<bool> isDoneAtOnce;
  QObject listener;
  connect(&workbench(), &HandEyeWorkbench::ballChanged, &listener,
    [&]
    {
      if (!isDoneAtOnce && workbench().ball().isColorLearnt)
      {
        isDoneAtOnce = workbench().isDone(WizardStep::Ball);
      }
    });
  clickAt(ball_Image() + QPointF(6, 5));
  QTRY_VERIFY_WITH_TIMEOUT(workbench().ball().isColorLearnt, PatienceMs);
  QVERIFY2(color().contains(QStringLiteral("learnt")), qPrintable(color()));
  QVERIFY(isDoneAtOnce && !*isDoneAtOnce);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->canGoNext(), PatienceMs);
  photograph(QStringLiteral("ball-learnt"));
  driver_->click(driver_->onPage<QToolButton>("undoButton"));
  QCOMPARE(color(), QStringLiteral("any saturated red"));
  QVERIFY(!workbench().ball().isColorLearnt && !driver_->onPage<QToolButton>("undoButton")->isEnabled());
}

void WizardBallTest::click_OnTheBoard_IsSaidAndKeepsTheColour()
{
  clickAt(ball_Image());
  QTRY_VERIFY_WITH_TIMEOUT(workbench().ball().isColorLearnt, PatienceMs);
  const QString before = color();
  clickAt(OnTheBoard);
  QTRY_VERIFY_WITH_TIMEOUT(driver_->message().contains(QStringLiteral("There is no ball at the place clicked")), PatienceMs);
  QVERIFY2(driver_->message().contains(before), qPrintable(driver_->message()));
  QCOMPARE(color(), before);
  QTRY_VERIFY_WITH_TIMEOUT(hasBall(workbench().live().newest()) && driver_->canGoNext(), PatienceMs);
  photograph(QStringLiteral("ball-refused"));
  // What was refused is forgotten with a click that hits.
  clickAt(ball_Image());
  QTRY_VERIFY_WITH_TIMEOUT(!driver_->message().contains(QStringLiteral("no ball at the place")), PatienceMs);
}

/// A click on the picture where the ball is in it, while the newest frame, which is not drawn yet, has it elsewhere.
void WizardBallTest::click_MeansTheFrameThatWasShown()
{
  workbench().devices().playRoom(handeye::RoomScene::Free);
  QTest::qWait(800);
  const auto* const presenter = panel_->findChild<handeye::VideoPresenter*>();
  QVERIFY(presenter);
  // From now on frames come, and nobody is told to draw them; as where drawing is slow, but for longer.
  QSignalBlocker notTold(workbench().live());
  QTest::qWait(400);
  for (int tries = 0; tries < 50 && !hasBall(presenter->onScreen()); ++tries)
  {
    notTold.unblock();
    QTest::qWait(200);
    notTold.reblock();
    QTest::qWait(400);
  }
  QPointF place;
  const auto isElsewhereByNow = [&]
  {
    const std::shared_ptr<const LiveView> onScreen = presenter->onScreen();
    if (!hasBall(onScreen) || !hasBall(workbench().live().newest()))
    {
      return false;
    }
    place = { onScreen->ball->ball_Image.x(), onScreen->ball->ball_Image.y() };
    const QPointF moved = ball_Image() - place;
    return std::hypot(moved.x(), moved.y()) > 2.5 * onScreen->ball->radiusPx;
  };
  QTRY_VERIFY_WITH_TIMEOUT(isElsewhereByNow(), PatienceMs);
  clickAt(place);
  QTRY_VERIFY_WITH_TIMEOUT(workbench().ball().isColorLearnt || driver_->message().contains(QStringLiteral("no ball")), PatienceMs);
  QVERIFY2(workbench().ball().isColorLearnt, qPrintable(driver_->message()));
  QVERIFY2(!driver_->message().contains(QStringLiteral("no ball")), qPrintable(driver_->message()));
}

HANDEYE_WIDGET_TEST_MAIN(WizardBallTest)

#include "WizardBallTest.moc"
