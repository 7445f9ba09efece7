// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopFixture.h"
#include "Icons.h"
#include "SceneView.h"
#include "StreamLights.h"
#include "ViewArea.h"

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkCubeSource.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include <QLabel>
#include <QMenu>
#include <QToolButton>

using Light = NavigationHost::StreamLight;
using Stream = NavigationHost::Stream;

namespace
{

Stream stream(const QString& name, Light light, double rateHz, double ageSec, const QString& message = {})
{
  Stream result;
  result.name = name;
  result.source = "127.0.0.1:18944";
  result.light = light;
  result.rateHz = rateHz;
  result.ageSec = ageSec;
  result.message = message;
  return result;
}

}  // namespace

/// The desktop's views, and the lights of its streams.
class DesktopViewsTest : public DesktopFixture
{
  Q_OBJECT

private slots:
  void init() { this->setUp(); }
  void cleanup() { this->tearDown(); }

  void lights_SayTheStateInWordsAndForm()
  {
    using desktop::StreamLightWidget;
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Live, 59.8, 0.0123)), QString("60 Hz, 12 ms"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Live, 4.96, -1)), QString("5.0 Hz"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Live, 0, -1)), QString("live"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Stale, 60, 1.24)), QString("stale 1.2 s"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Lost, 0, 75)), QString("lost 75 s"));
    QCOMPARE(StreamLightWidget::stateText(stream("S", Light::Lost, 0, -1)), QString("lost"));
    const QString words = StreamLightWidget::description(stream("StylusToTracker", Light::Stale, 0, 1.24, "The tool is hidden."));
    QVERIFY(words.contains("StylusToTracker: stale") && words.contains("127.0.0.1:18944") && words.contains("The tool is hidden."));

    // The forms differ, not the colours alone.
    QVector<QImage> forms;
    for (const Light light : { Light::Live, Light::Stale, Light::Lost })
    {
      const QImage image = desktop::streamLightPixmap(light, 16, 2).toImage();
      QCOMPARE(image.size(), QSize(32, 32));
      forms.append(image.createAlphaMask());
    }
    for (int i = 0; i < 3; ++i)
    {
      int different = 0;
      for (int y = 0; y < 32; ++y)
      {
        for (int x = 0; x < 32; ++x)
        {
          different += forms[i].pixel(x, y) != forms[(i + 1) % 3].pixel(x, y) ? 1 : 0;
        }
      }
      QVERIFY2(different > 100, qPrintable(QString::number(different)));
    }
  }

  void lights_ThatDoNotFitAreCounted()
  {
    auto* const lights = this->Window->findChild<desktop::StreamLights*>();
    QVector<Stream> streams;
    for (int i = 0; i < 20; ++i)
    {
      streams.append(stream(QString("Tool%1ToTracker").arg(i), i == 17 ? Light::Lost : Light::Live, 30, 0.01));
    }
    this->Window->setStreams(streams);
    const auto shown = lights->findChildren<desktop::StreamLightWidget*>();
    QVERIFY(shown.size() >= 3 && shown.size() < 20);
    QVERIFY(lights->sizeHint().width() < this->Window->width());
    const auto& rest = shown.last();
    QVERIFY(rest->toolTip().contains("Tool17ToTracker: lost"));
    QVERIFY(rest->toolTip().startsWith(QString("+%1: lost").arg(20 - (shown.size() - 1))));
    this->Window->setStreams({});
    QVERIFY(lights->findChildren<desktop::StreamLightWidget*>().isEmpty());
  }

  void layouts_ShowWhatTheySay()
  {
    auto* const video = this->Window->findChild<desktop::VideoView*>();
    auto* const scene = this->Window->findChild<desktop::SceneView*>();
    const QVector<QPair<bool, bool>> expected = { { true, false }, { false, true }, { true, true }, { true, true } };
    for (int layout = 0; layout < 4; ++layout)
    {
      QTest::keyClick(this->Window.get(), Qt::Key(Qt::Key_1 + layout), Qt::ControlModifier);
      QCoreApplication::processEvents();
      QCOMPARE(video->isVisible(), expected[layout].first);
      QCOMPARE(scene->isVisible(), expected[layout].second);
    }
    QVERIFY(video->mapToGlobal(QPoint()).y() < scene->mapToGlobal(QPoint()).y());
    QVERIFY(qAbs(video->width() - scene->width()) < 3);
  }

  void videoWidget_StaysTheModules()
  {
    auto* const mine = new QLabel("mine");
    QPointer<QLabel> watched = mine;
    this->Window->setVideoWidget(mine);
    QVERIFY(mine->isVisible());
    this->Window.reset();
    QVERIFY(watched);
    delete mine;
    this->open();
    auto* const gone = new QLabel("gone");
    this->Window->setVideoWidget(gone);
    delete gone;
    QCoreApplication::processEvents();
    this->Window->setVideoWidget(nullptr);
    QVERIFY(this->Window->findChild<QLabel*>("NoVideo")->isVisible());
  }

  void scene_DrawsOnceForManyRequests()
  {
    auto* const scene = this->Window->findChild<desktop::SceneView*>();
    QTest::qWait(200);
    const int before = scene->renderCount();
    for (int i = 0; i < 1000; ++i)
    {
      this->Window->requestSceneRender();
    }
    QTRY_VERIFY(scene->renderCount() > before);
    QTest::qWait(100);
    QCOMPARE(scene->renderCount(), before + 1);
  }

  void sceneCamera_ShowsEverythingButNotTheFloorForIt()
  {
    vtkNew<vtkCubeSource> cube;
    cube->SetCenter(2000, 0, 0);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(cube->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkRenderer* const renderer = this->Window->sceneRenderer();
    renderer->AddActor(actor);
    this->Window->resetSceneCamera();
    double focus[3];
    renderer->SetWorldPoint(2000, 0, 0, 1);
    renderer->WorldToView();
    renderer->GetViewPoint(focus);
    QVERIFY(qAbs(focus[0]) < 0.05 && qAbs(focus[1]) < 0.05);  // the near half of a cube looks larger than the far one
    renderer->RemoveActor(actor);
  }

  void sceneCamera_FollowsUntilSomebodyTurnsIt()
  {
    vtkNew<vtkCubeSource> cube;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(cube->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkRenderer* const renderer = this->Window->sceneRenderer();
    renderer->AddActor(actor);
    const auto distanceFrom = [&](double x)
    {
      renderer->SetWorldPoint(x, 0, 0, 1);
      renderer->WorldToView();
      const double* const view = renderer->GetViewPoint();
      return std::max(std::abs(view[0]), std::abs(view[1]));
    };
    auto* const scene = this->Window->findChild<desktop::SceneView*>();
    const auto moveTo = [&](double x)
    {
      const int before = scene->renderCount();
      actor->SetPosition(x, 0, 0);
      this->Window->requestSceneRender();
      QTRY_VERIFY(scene->renderCount() > before);
    };
    moveTo(0);
    moveTo(3000);
    QVERIFY(distanceFrom(3000) < 1);
    auto* const view = scene->findChild<QVTKOpenGLNativeWidget*>();
    QTest::mousePress(view, Qt::LeftButton, Qt::NoModifier, QPoint(100, 100));
    QTest::mouseMove(view, QPoint(110, 100));
    QTest::mouseRelease(view, Qt::LeftButton, Qt::NoModifier, QPoint(110, 100));
    moveTo(90000);
    QVERIFY(distanceFrom(90000) > 1);
    QTest::mouseClick(scene->findChild<QToolButton*>("SceneReset"), Qt::LeftButton);
    QVERIFY(distanceFrom(90000) < 1);
    renderer->RemoveActor(actor);
  }
};

DESKTOP_TEST_MAIN(DesktopViewsTest)
#include "DesktopViewsTest.moc"
