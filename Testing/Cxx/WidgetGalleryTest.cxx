// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of each widget with realistic data, light and dark, into HANDEYE_SCREENSHOT_DIR: for people to look at. What a program
// can say of them is checked: they are not empty, differ between the palettes, and have the size that they ask for.
#include "CalibrationExport.h"
#include "CoverageView.h"
#include "DemoResults.h"
#include "DirectionDome.h"
#include "ErrorDistancePlot.h"
#include "ExportPanel.h"
#include "HandEyeSceneProps.h"
#include "ImageConversion.h"
#include "LandmarkFiles.h"
#include "LandmarkPanel.h"
#include "MeshReader.h"
#include "PivotCollector.h"
#include "SampleTable.h"
#include "SphereCone.h"
#include "StagesView.h"
#include "StatisticsTable.h"
#include "StreamList.h"
#include "VideoView.h"
#include "WidgetTestSupport.h"

#include "BallStages.h"

#include <QDir>
#include <QScreen>
#include <QTableView>
#include <QTemporaryDir>
#include <opencv2/imgproc.hpp>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkHandEyeOverlayPipeline.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include <cmath>
#include <functional>
#include <memory>

using namespace handeye;

namespace
{

QPolygonF outlineOf(const Eigen::Vector3d& ball_Camera, double radiusMm, const CameraModel& camera)
{
  const SphereCone cone{ ball_Camera.normalized(), std::asin(radiusMm / ball_Camera.norm()) };
  QPolygonF line;
  for (const Eigen::Vector2d& point : cone.outline(camera, 90).points_Image)
  {
    line.append({ point.x(), point.y() });
  }
  return line;
}

}  // namespace

class WidgetGalleryTest : public QObject
{
  Q_OBJECT

private slots:
  void initTestCase()
  {
    demo_ = std::make_unique<DemoResults>();
    QVERIFY(demo_->calibration.isUsable());
    QVERIFY(demo_->validation.isUsable());
    QDir().mkpath(folder());
  }

  void videoView()
  {
    this->picture(QStringLiteral("VideoView"), { 640, 500 },
      [this]
      {
        auto view = std::make_unique<VideoView>();
        const CapturedFrame& frame = demo_->captured[3];
        view->setFrame(demo_->calibrationRecording.image(frame.frame));
        VideoView::DetectionMark mark;
        mark.ball_Image_Px = QPointF(frame.ball.ball_Image.x(), frame.ball.ball_Image.y());
        mark.outline_Image_Px = outlineOf(frame.ball.ray_Camera * frame.ball.distanceMm, demo_->ballRadiusMm, demo_->camera);
        mark.text = QStringLiteral("hold still");
        mark.level = Level::Good;
        view->setDetection(mark);
        VideoView::GhostBall ghost;
        ghost.outline_Image_Px = outlineOf({ 60, -40, 260 }, demo_->ballRadiusMm, demo_->camera);
        ghost.hint = QStringLiteral("5 cm further away");
        view->setGhostBall(ghost);
        view->setBanner(QStringLiteral("The camera's marker is not seen: turn the camera towards the tracker"), Level::Warning);
        return view;
      });
  }

  void videoViewWithoutVideo()
  {
    this->picture(QStringLiteral("VideoViewWithoutVideo"), { 640, 480 },
      []
      {
        auto view = std::make_unique<VideoView>();
        view->setPlaceholderText(QStringLiteral("No video arrives. Choose a source of images above, or start the simulated room."));
        return view;
      });
  }

  void stages()
  {
    this->picture(QStringLiteral("StagesView"), { 760, 190 }, [this] { return this->makeStages(); });
    this->picture(QStringLiteral("StagesViewNarrow"), { 380, 340 }, [this] { return this->makeStages(); });
  }

  void dome()
  {
    this->picture(QStringLiteral("DirectionDome"), { 300, 370 },
      [this]
      {
        PivotCollector collector;
        const int count = demo_->pivotRecording.frameCount();
        for (int frame = 0; frame < 2 * count / 3; ++frame)
        {
          const io::TransformSample sample = demo_->pivotRecording.transform(frame, "StylusToTracker");
          sample.isUsable() ? collector.add(sample.transform) : collector.addInvalid();
        }
        auto dome = std::make_unique<DirectionDome>();
        dome->setCoverage(collector.coverage());
        dome->setCurrentDirection(QPointF(0.45, 0.3));
        dome->setHint(QStringLiteral("lean it more to the left"));
        return dome;
      });
  }

  void coverage()
  {
    this->picture(QStringLiteral("CoverageView"), { 520, 220 },
      [this]
      {
        auto view = std::make_unique<CoverageView>();
        view->setImageSize({ demo_->camera.width(), demo_->camera.height() });
        view->setWorkingRange(150, 450);
        QVector<CoverageView::Place> places;
        for (const CapturedFrame& frame : demo_->captured)
        {
          if (frame.isSample())
          {
            places.append({ { frame.ball.ball_Image.x(), frame.ball.ball_Image.y() }, frame.ball.distanceMm });
          }
        }
        view->setPlaces(places);
        view->setNextPlace(CoverageView::Place{ { 560, 90 }, 400 });
        view->setCurrentPlace(CoverageView::Place{ { 200, 300 }, 200 });
        return view;
      });
  }

  void sampleTable()
  {
    this->picture(QStringLiteral("SampleTable"), { 680, 420 }, [this] { return this->makeSampleTable(); });
    this->picture(QStringLiteral("SampleTableNarrow"), { 370, 480 }, [this] { return this->makeSampleTable(); });
  }

  void plotAndStatistics()
  {
    this->picture(QStringLiteral("ErrorDistancePlot"), { 560, 360 },
      [this]
      {
        auto plot = std::make_unique<ErrorDistancePlot>();
        plot->setSeries(this->errorSeries());
        return plot;
      });
    this->picture(QStringLiteral("StatisticsTable"), { 560, 110 }, [this] { return this->makeStatistics(); });
    this->picture(QStringLiteral("StatisticsTableNarrow"), { 370, 480 }, [this] { return this->makeStatistics(); });
  }

  void streamList()
  {
    this->picture(QStringLiteral("StreamList"), { 700, 330 }, [this] { return this->makeStreamList(); });
    this->picture(QStringLiteral("StreamListNarrow"), { 370, 480 }, [this] { return this->makeStreamList(); });
  }

  void landmarkPanel()
  {
    this->picture(QStringLiteral("LandmarkPanel"), { 520, 460 }, [this] { return this->makeLandmarkPanel(); });
    this->picture(QStringLiteral("LandmarkPanelNarrow"), { 370, 480 }, [this] { return this->makeLandmarkPanel(); });
  }

  void exportPanel()
  {
    this->picture(QStringLiteral("ExportPanel"), { 560, 520 }, [this] { return this->makeExportPanel(); });
    this->picture(QStringLiteral("ExportPanelNarrow"), { 370, 480 }, [this] { return this->makeExportPanel(); });
  }

  void scene()
  {
    this->picture(QStringLiteral("HandEyeSceneProps"), { 640, 480 }, [this] { return this->makeScene(); });
  }

private:
  /// HANDEYE_SCREENSHOT_DIR: the environment's, else that of the build.
  static QString folder()
  {
    return qEnvironmentVariable("HANDEYE_SCREENSHOT_DIR", QStringLiteral(HANDEYE_SCREENSHOT_DIR)) + QStringLiteral("/Widgets");
  }

  void picture(const QString& name, const QSize& size, const std::function<std::unique_ptr<QWidget>()>& make)
  {
    QImage light, dark;
    for (const bool isDark : { false, true })
    {
      QApplication::setPalette(isDark ? testing_widgets::darkPalette() : testing_widgets::lightPalette());
      const std::unique_ptr<QWidget> widget = make();
      testing_widgets::show(*widget, size);
      QTest::qWait(150);
      QPixmap shot = widget->grab();
      QImage& image = isDark ? dark : light;
      image = shot.toImage().convertToFormat(QImage::Format_RGB32);
      const int scale = int(std::lround(widget->devicePixelRatioF()));
      QCOMPARE(image.size(), widget->size() * scale);
      const QString file = QStringLiteral("%1/%2-%3-%4x.png")
                             .arg(folder(), name, isDark ? QStringLiteral("dark") : QStringLiteral("light"))
                             .arg(scale);
      QVERIFY2(image.save(file), qPrintable(file));
      QSet<QRgb> colors;
      for (int y = 0; y < image.height(); y += 2)
      {
        for (int x = 0; x < image.width(); x += 2)
        {
          colors.insert(image.pixel(x, y));
        }
      }
      QVERIFY2(colors.size() > 8, qPrintable(name + QStringLiteral(" is all but empty")));
      // The font here may be larger than the person's, but what a widget asks for it gets in the wizard.
      const QSize least = widget->minimumSizeHint();
      QVERIFY2(least.width() <= 360,
        qPrintable(QStringLiteral("%1 is %2 px wide at least: too much for a module's panel").arg(name).arg(least.width())));
      QVERIFY2(least.width() <= size.width() && least.height() <= size.height(),
        qPrintable(QStringLiteral("%1 wants %2 x %3").arg(name).arg(least.width()).arg(least.height())));
    }
    QVERIFY2(
      light != dark || name == QStringLiteral("VideoView"), qPrintable(name + QStringLiteral(" does not follow the palette")));
  }

  std::unique_ptr<QWidget> makeSampleTable()
  {
    auto table = std::make_unique<SampleTable>();
    table->setRows(this->sampleRows());
    table->selectSample(2);
    return table;
  }

  std::unique_ptr<QWidget> makeStatistics()
  {
    auto table = std::make_unique<StatisticsTable>();
    table->setSeries(this->errorSeries());
    return table;
  }

  std::unique_ptr<QWidget> makeStreamList()
  {
    using Stream = StreamList::Stream;
    using Light = StreamList::Light;
    using Type = StreamList::Type;
    auto list = std::make_unique<StreamList>();
    const QString server = QStringLiteral("127.0.0.1:18944");
    list->setStreams({ Stream{ QStringLiteral("StylusToTracker"), server, Type::Transform, Light::Live, 60.1, 0.02, {} },
      Stream{ QStringLiteral("MarkerToTracker"), server, Type::Transform, Light::Stale, 60.1, 0.02,
        QStringLiteral("the tool is not seen") },
      Stream{ QStringLiteral("PhantomToTracker"), server, Type::Transform, Light::Live, 60.1, 0.01, {} },
      Stream{ QStringLiteral("Image"), QStringLiteral("/dev/video0"), Type::Video, Light::Lost, 0, 12.4,
        QStringLiteral("the camera was unplugged") } });
    list->setChoice(StreamList::Role::Stylus, QStringLiteral("StylusToTracker"));
    list->setChoice(StreamList::Role::CameraMarker, QStringLiteral("MarkerToTracker"));
    list->setChoice(StreamList::Role::Video, QStringLiteral("EndoscopeImage"));
    return list;
  }

  std::unique_ptr<QWidget> makeLandmarkPanel()
  {
    auto panel = std::make_unique<LandmarkPanel>();
    panel->loadModelLandmarks(QString::fromStdString((demo_->folder / "../Meshes/VertebraLandmarks.txt").string()));
    panel->setTipAvailable(true);
    const LandmarkLists lists =
      readLandmarkLists(demo_->folder / "phantom_model_points.txt", demo_->folder / "phantom_touched_points.txt");
    QVector<LandmarkPanel::Landmark> landmarks = panel->landmarks();
    for (int index = 0; index + 2 < landmarks.size(); ++index)
    {
      landmarks[index].touched_Phantom = lists.points_Phantom.at(std::size_t(index));
    }
    landmarks[landmarks.size() - 2].skipped = true;
    panel->setLandmarks(landmarks);
    const LandmarkPanel::Pairs pairs = panel->pairs();
    panel->setResult(registerLandmarks(pairs.points_Model, pairs.points_Phantom));
    return panel;
  }

  std::unique_ptr<QWidget> makeExportPanel()
  {
    const QString session = QStringLiteral(HANDEYE_TEST_OUTPUT_DIR "/GallerySession");
    QDir().mkpath(session);
    ExportSources sources;
    sources.calibration = (session + QStringLiteral("/calibration.json")).toStdString();
    sources.stylus = (session + QStringLiteral("/stylus.json")).toStdString();
    writeJson(sources.calibration, calibrationJson(demo_->calibration));
    writeJson(sources.stylus, stylusJson(demo_->pivot));
    auto panel = std::make_unique<ExportPanel>();
    panel->setSources(sources);
    panel->setFolder(session + QStringLiteral("/export"));
    panel->setReportEnabled(true);
    panel->exportNow();
    return panel;
  }

  std::unique_ptr<QWidget> makeStages() const
  {
    auto view = std::make_unique<StagesView>();
    const CapturedFrame& frame = demo_->captured[3];
    const cv::Mat image = demo_->calibrationRecording.image(frame.frame);
    view->setStages(image, drawBallStages(image, frame.ball, demo_->camera, demo_->ballRadiusMm));
    return view;
  }

  QVector<SampleRow> sampleRows() const
  {
    QVector<SampleRow> rows;
    for (const CalibratedFrame& frame : demo_->calibration.frames)
    {
      SampleRow row;
      row.id = frame.captured.frame;
      const cv::Mat image = demo_->calibrationRecording.image(row.id);
      if (frame.captured.isSample())
      {
        const Eigen::Vector2d center = frame.captured.ball.ball_Image;
        const int side = int(3 * frame.captured.ball.radiusPx);
        const cv::Rect window = cv::Rect(int(center.x()) - side / 2 * 4 / 3, int(center.y()) - side / 2, side * 4 / 3, side) &
          cv::Rect(0, 0, image.cols, image.rows);
        row.thumbnail = toQImage(image(window));
        row.residualPx = frame.residualPx;
        row.residualMm = frame.residualMm;
        row.distanceMm = frame.captured.ball.distanceMm;
      }
      row.used = frame.used;
      row.status = QString::fromStdString(frame.status);
      row.level = frame.used ? Level::Good : Level::Warning;
      row.excluded = row.id == 1;
      if (row.id == 3)
      {
        row.status = QStringLiteral("disagrees with the others: 31 times what is expected");
        row.level = row.residualLevel = Level::Error;
        row.used = false;
        row.residualPx = 41.37;
        row.residualMm = 18.2;
      }
      rows.append(row);
    }
    return rows;
  }

  QVector<ErrorSeries> errorSeries() const
  {
    ErrorSeries fit, validation;
    fit.name = QStringLiteral("Fit");
    validation.name = QStringLiteral("Validation");
    std::vector<double> residuals;
    for (const CalibratedFrame& frame : demo_->calibration.frames)
    {
      if (frame.used)
      {
        fit.points.append({ frame.captured.ball.distanceMm, frame.residualPx });
        residuals.push_back(frame.residualPx);
      }
    }
    fit.errorPx = summarize(residuals);
    for (const ValidatedFrame& frame : demo_->validation.frames)
    {
      if (frame.validated)
      {
        validation.points.append({ frame.validated->distanceMm, frame.validated->errorPx });
      }
    }
    validation.errorPx = demo_->validation.projectionErrorPx;
    return { validation, fit };
  }

  std::unique_ptr<QWidget> makeScene()
  {
    auto widget = std::make_unique<QVTKOpenGLNativeWidget>();
    vtkNew<vtkGenericOpenGLRenderWindow> window;
    widget->setRenderWindow(window);
    vtkNew<vtkRenderer> renderer;
    const QColor ground = QApplication::palette().color(QPalette::Base);
    renderer->SetBackground(ground.redF(), ground.greenF(), ground.blueF());
    window->AddRenderer(renderer);
    props_ = std::make_unique<HandEyeSceneProps>();
    props_->addTo(renderer);
    const auto pose = [this](const char* name) -> std::optional<Eigen::Isometry3d>
    {
      const io::TransformSample sample = demo_->calibrationRecording.transform(2, name);
      return sample.isUsable() ? std::optional<Eigen::Isometry3d>(sample.transform) : std::nullopt;
    };
    props_->setMarkerToTracker(pose("MarkerToTracker"));
    props_->setStylusToTracker(pose("StylusToTracker"));
    props_->setStylusTip(demo_->pivot.calibration.tip_Stylus, demo_->ballRadiusMm);
    props_->setCameraModel(demo_->camera, 320);
    props_->setMarkerToCamera(demo_->calibration.calibration.markerToCamera);
    const LandmarkLists lists =
      readLandmarkLists(demo_->folder / "phantom_model_points.txt", demo_->folder / "phantom_touched_points.txt");
    mesh_ = readMesh(demo_->folder / "../Meshes/Vertebra.ply");
    props_->setPhantomMesh(mesh_);
    props_->setModelToPhantom(registerLandmarks(lists.points_Model, lists.points_Phantom).modelToPhantom);
    props_->setTouchedLandmarks(lists.points_Phantom);
    props_->setPhantomToTracker(pose("PhantomToTracker"));
    std::vector<HandEyeSceneProps::CapturedPoint> points;
    for (const CalibratedFrame& frame : demo_->calibration.frames)
    {
      if (frame.captured.tip_Marker)
      {
        points.push_back({ *frame.captured.tip_Marker, frame.residualPx, frame.used });
      }
    }
    props_->setCapturedPoints(points);
    props_->setResidualScalePx(1);
    props_->setNextPlace(Eigen::Vector3d(70, -40, 260));
    props_->setTrackerVisible(false);
    renderer->ResetCamera();
    renderer->GetActiveCamera()->Elevation(20);
    renderer->GetActiveCamera()->Azimuth(30);
    renderer->ResetCameraClippingRange();
    return widget;
  }

  std::unique_ptr<DemoResults> demo_;
  std::unique_ptr<HandEyeSceneProps> props_;
  vtkSmartPointer<vtkPolyData> mesh_;
};

HANDEYE_WIDGET_TEST_MAIN(WidgetGalleryTest)
#include "WidgetGalleryTest.moc"
