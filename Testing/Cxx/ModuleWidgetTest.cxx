// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The module by itself, as an application without NavigationHost has it: what it says of itself, and its scene behind MRMLBridge.
#include "DesktopTestMain.h"
#include "HandEyeCalibrationPanel.h"
#include "HandEyeWorkbench.h"
#include "MRMLBridge.h"
#include "qSlicerHandEyeCalibrationModule.h"
#include "qSlicerHandEyeCalibrationModuleWidget.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>

#include <QCheckBox>
#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QPushButton>

#include <algorithm>
#include <cmath>
#include <map>

namespace
{

using Nodes = std::map<QString, vtkSmartPointer<vtkMatrix4x4>>;

/// A scene that is a map.
class MapBridge : public MRMLBridge
{
public:
  explicit MapBridge(std::shared_ptr<Nodes> nodes)
    : Scene(std::move(nodes))
  {
  }

  QStringList transformNames() const override
  {
    QStringList names;
    for (const auto& [name, matrix] : *this->Scene)
    {
      names << name;
    }
    return names;
  }

  bool transformToParent(const QString& name, vtkMatrix4x4* matrix) const override
  {
    const auto found = this->Scene->find(name);
    if (found != this->Scene->end())
    {
      matrix->DeepCopy(found->second);
    }
    return found != this->Scene->end();
  }

  void publishTransform(const QString& name, vtkMatrix4x4* toParent, const QString& description) override
  {
    QVERIFY(!description.isEmpty());
    (*this->Scene)[name] = vtkSmartPointer<vtkMatrix4x4>::New();
    (*this->Scene)[name]->DeepCopy(toParent);
    this->Published.insert(name);
  }

  void withdrawTransform(const QString& name) override
  {
    if (this->Published.remove(name))
    {
      this->Scene->erase(name);
    }
  }

private:
  std::shared_ptr<Nodes> Scene;
  QSet<QString> Published;
};

}  // namespace

class ModuleWidgetTest : public QObject
{
  Q_OBJECT

private slots:
  void init()
  {
    this->Module = std::make_unique<qSlicerHandEyeCalibrationModule>();
    this->Module->setName("HandEyeCalibration");
    this->Module->initialize(nullptr);
    this->Logic = vtkSlicerHandEyeCalibrationLogic::SafeDownCast(this->Module->logic());
    QVERIFY(this->Logic);
    this->Panel = dynamic_cast<qSlicerHandEyeCalibrationModuleWidget*>(this->Module->widgetRepresentation());
    QVERIFY(this->Panel);
    this->Scene = std::make_shared<Nodes>();
  }

  void cleanup()
  {
    this->Logic = nullptr;
    this->Module.reset();
  }

  void module_SaysWhatItIs()
  {
    QCOMPARE(this->Module->title(), QString("Hand-Eye Calibration"));
    QCOMPARE(qSlicerHandEyeCalibrationModule::staticTitle(), this->Module->title());
    QVERIFY(!this->Module->icon().isNull() && !this->Module->icon().pixmap(32, 32).isNull());
    QVERIFY(!this->Module->helpText().isEmpty() && this->Module->acknowledgementText().contains("10.1007/s11548-017-1590-9"));
    QVERIFY(!this->Module->contributors().isEmpty() && !this->Module->categories().isEmpty());
    QCOMPARE(QString(this->Module->metaObject()->className()), QString("qSlicerHandEyeCalibrationModule"));
  }

  void noScene_NoSceneGroup()
  {
    this->Panel->show();
    QVERIFY(!this->Panel->findChild<QGroupBox*>("sceneGroup")->isVisible());
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    QVERIFY(this->Panel->findChild<QGroupBox*>("sceneGroup")->isVisible());
    this->Panel->setBridge(nullptr);
    QVERIFY(!this->Panel->findChild<QGroupBox*>("sceneGroup")->isVisible());
  }

  void results_BecomeTransformNodes()
  {
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    QVERIFY(this->Scene->empty());
    this->registerPhantom(5);
    const Nodes::const_iterator node = this->Scene->find("ModelToPhantom");
    QVERIFY(node != this->Scene->end());
    QVERIFY(qAbs(node->second->GetElement(0, 3) - 5) < 1e-9);
    QVERIFY(this->Scene->find("MarkerToCamera") == this->Scene->end());  // there is none yet, and no identity in its place

    this->Panel->findChild<QCheckBox*>("publishResults")->setChecked(false);
    this->registerPhantom(9);
    QVERIFY(qAbs((*this->Scene)["ModelToPhantom"]->GetElement(0, 3) - 5) < 1e-9);
    this->Panel->findChild<QCheckBox*>("publishResults")->setChecked(true);
    QVERIFY(qAbs((*this->Scene)["ModelToPhantom"]->GetElement(0, 3) - 9) < 1e-9);
  }

  void stylusTip_ComesFromATransformNode()
  {
    vtkNew<vtkMatrix4x4> tipToStylus;
    tipToStylus->SetElement(0, 3, 1.5);
    tipToStylus->SetElement(1, 3, -2.5);
    tipToStylus->SetElement(2, 3, 180);
    MapBridge(this->Scene).publishTransform("Another", tipToStylus, "of a test");
    MapBridge(this->Scene).publishTransform("StylusTipToStylus", tipToStylus, "of a test");
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    QCOMPARE(this->Panel->findChild<QComboBox*>("stylusTipNode")->currentText(), QString("StylusTipToStylus"));
    double tip_Stylus[3] = {};
    QVERIFY(!this->Logic->GetStylusTip(tip_Stylus));
    this->Panel->findChild<QPushButton*>("takeStylusTip")->click();
    QVERIFY(this->Logic->GetStylusTip(tip_Stylus));
    QCOMPARE(tip_Stylus[0], 1.5);
    QCOMPARE(tip_Stylus[1], -2.5);
    QCOMPARE(tip_Stylus[2], 180.0);
    // p_Stylus = stylusTipToStylus * p_StylusTip: the tip is the origin's image, and the wizard has it.
    QVERIFY(this->workbench().stylus());
    QCOMPARE(this->workbench().stylus()->tip_Stylus, Eigen::Vector3d(1.5, -2.5, 180));
    QVERIFY(this->workbench().problemOf(handeye::WizardStep::Stylus).isEmpty());
    QVERIFY(this->tipMessage().contains("180.00 mm"));
  }

  void stylusTip_OfANodeThatNobodyHasSet_IsNotTaken()
  {
    vtkNew<vtkMatrix4x4> identity;
    MapBridge(this->Scene).publishTransform("StylusTipToStylus", identity, "of a test");
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    double tip_Stylus[3] = {};
    this->Panel->findChild<QPushButton*>("takeStylusTip")->click();
    QVERIFY2(this->tipMessage().startsWith("Not taken"), qPrintable(this->tipMessage()));
    identity->SetElement(1, 3, std::nan(""));
    MapBridge(this->Scene).publishTransform("StylusTipToStylus", identity, "of a test");
    this->Panel->findChild<QPushButton*>("takeStylusTip")->click();
    QVERIFY2(this->tipMessage().startsWith("Not taken"), qPrintable(this->tipMessage()));
    this->Scene->clear();
    this->Panel->findChild<QPushButton*>("takeStylusTip")->click();
    QVERIFY2(this->tipMessage().contains("any more"), qPrintable(this->tipMessage()));
    QVERIFY(!this->Logic->GetStylusTip(tip_Stylus) && !this->workbench().stylus());
  }

  void registrationInTheWizard_BecomesATransformNode()
  {
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    const std::vector<Eigen::Vector3d> points_Model = { { 0, 0, 0 }, { 40, 0, 0 }, { 0, 30, 0 }, { 0, 0, 50 }, { 20, 10, 30 } };
    std::vector<Eigen::Vector3d> points_Phantom;
    const Eigen::Isometry3d modelToPhantom = Eigen::Translation3d(3, -7, 11) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
    for (const Eigen::Vector3d& point_Model : points_Model)
    {
      points_Phantom.push_back(modelToPhantom * point_Model);
    }
    this->workbench().registerLandmarks(points_Model, points_Phantom);
    QTRY_VERIFY(this->Scene->count("ModelToPhantom") > 0);
    // A known point through the node's matrix, as Slicer applies it: p_Phantom = modelToPhantom * p_Model, nothing turned round.
    const double point_Model[4] = { 40, 0, 0, 1 };
    double point_Phantom[4] = {};
    (*this->Scene)["ModelToPhantom"]->MultiplyPoint(point_Model, point_Phantom);
    QVERIFY((Eigen::Map<Eigen::Vector3d>(point_Phantom) - points_Phantom[1]).norm() < 1e-9);
    QVERIFY(this->Logic->GetModelToPhantom());
  }

  void resultsOfTheLogic_BecomeTheWizards()
  {
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    this->registerPhantom(5);
    QTRY_VERIFY(this->workbench().modelToPhantom());
    QVERIFY((this->workbench().modelToPhantom()->translation() - Eigen::Vector3d(5, 0, 0)).norm() < 1e-9);
    this->calibrateDemo();
    QTRY_VERIFY_WITH_TIMEOUT(this->workbench().calibration() && this->workbench().calibration()->isUsable(), 60000);
    QVERIFY(this->differenceOfCalibrations() < 1e-9);
    QVERIFY(this->Scene->count("MarkerToCamera") > 0);
    QVERIFY(this->workbench().camera() && this->workbench().stylus());
    QTest::qWait(200);  // what went to and fro has settled
    QVERIFY(this->differenceOfCalibrations() < 1e-9);
    QVERIFY((this->workbench().modelToPhantom()->translation() - Eigen::Vector3d(5, 0, 0)).norm() < 1e-9);
  }

  void panelMadeLater_HasWhatTheLogicHas()
  {
    delete this->Panel;
    this->Logic->SetStylusTip(1, 2, 150);
    this->registerPhantom(4);
    this->Panel = dynamic_cast<qSlicerHandEyeCalibrationModuleWidget*>(this->Module->widgetRepresentation());
    QTRY_VERIFY(this->workbench().modelToPhantom() && this->workbench().stylus());
    QCOMPARE(this->workbench().stylus()->tip_Stylus, Eigen::Vector3d(1, 2, 150));
    QVERIFY(this->Logic->GetModelToPhantom());
  }

  /// With samples of its own the session's calibration stays, in words, and the logic gets it back.
  void sessionWithSamples_KeepsItsCalibration()
  {
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    const QString demo = QStringLiteral(HANDEYE_RESOURCES_DIR "/Demo/");
    handeye::HandEyeWorkbench& workbench = this->workbench();
    workbench.loadCamera(demo + "camera.yml");
    workbench.pivot().calibrateRecording(demo + "pivot.igs.mha", "StylusToTracker");
    QTRY_VERIFY_WITH_TIMEOUT(workbench.camera() && workbench.stylus(), 60000);
    workbench.capture().importRecording(demo + "calibration");
    QTRY_VERIFY_WITH_TIMEOUT(
      !workbench.capture().isBusy() && workbench.calibration() && workbench.calibration()->isUsable(), 60000);
    QTRY_VERIFY_WITH_TIMEOUT(this->Logic->GetMarkerToCamera() && this->differenceOfCalibrations() < 1e-9, 60000);
    const Eigen::Isometry3d own = workbench.calibration()->calibration.markerToCamera;

    QString refusal;
    connect(&workbench, &handeye::HandEyeWorkbench::refused, this,
      [&refusal](handeye::WizardStep, const QString& message) { refusal = message; });
    this->Logic->SetSolverMethod(vtkSlicerHandEyeCalibrationLogic::ProcrustesSolver);  // another solution, if by little
    this->calibrateDemo();
    QVERIFY(refusal.contains("samples of its own"));
    QTRY_VERIFY_WITH_TIMEOUT(this->differenceOfCalibrations() < 1e-9, 60000);
    QVERIFY(workbench.calibration()->calibration.markerToCamera.isApprox(own, 1e-12));

    // Another session has none of it, in the logic neither.
    workbench.openSession(handeye::HandEyeWorkbench::newSessionFolder());
    QVERIFY(!this->Logic->GetMarkerToCamera() && !workbench.stylus() && !workbench.model());
    double tip_Stylus[3] = {};
    QVERIFY(!this->Logic->GetStylusTip(tip_Stylus));
    QTest::qWait(300);
    QVERIFY(!this->Logic->GetMarkerToCamera());
  }

  void panelDeletedFirst_LeavesTheModuleWhole()
  {
    delete this->Panel;
    this->registerPhantom(1);  // nobody listens any more
    QVERIFY(this->Module->widgetRepresentation());
  }

private:
  handeye::HandEyeWorkbench& workbench() { return this->Panel->findChild<HandEyeCalibrationPanel*>()->workbench(); }
  QString tipMessage() { return this->Panel->findChild<QLabel*>("tipMessage")->text(); }

  /// As a script does it.
  void calibrateDemo()
  {
    const std::string demo = HANDEYE_RESOURCES_DIR "/Demo/";
    this->Logic->SetCameraFile(demo + "camera.yml");
    this->Logic->SetBallRadiusMm(15);
    this->Logic->SetStylusTransform("StylusToTracker");
    this->Logic->SetMarkerTransform("MarkerToTracker");
    double tip_Stylus[3] = {};
    if (!this->Logic->GetStylusTip(tip_Stylus))
    {
      QVERIFY2(this->Logic->CalibrateStylus(demo + "pivot.igs.mha"), this->Logic->GetLastMessage().c_str());
    }
    QVERIFY2(this->Logic->CalibrateCamera(demo + "calibration"), this->Logic->GetLastMessage().c_str());
  }

  /// The largest difference of the 16 numbers, wizard against logic.
  double differenceOfCalibrations()
  {
    const Eigen::Matrix4d own = this->workbench().calibration()->calibration.markerToCamera.matrix();
    double difference = 0;
    for (int i = 0; i < 16; ++i)
    {
      difference = std::max(difference, std::abs(own(i / 4, i % 4) - this->Logic->GetMarkerToCamera()->GetElement(i / 4, i % 4)));
    }
    return difference;
  }

  void registerPhantom(double shiftMm)
  {
    vtkNew<vtkPoints> points_Model;
    vtkNew<vtkPoints> points_Phantom;
    const double points[5][3] = { { 0, 0, 0 }, { 40, 0, 0 }, { 0, 30, 0 }, { 0, 0, 50 }, { 20, 10, 30 } };
    for (const auto& point : points)
    {
      points_Model->InsertNextPoint(point);
      points_Phantom->InsertNextPoint(point[0] + shiftMm, point[1], point[2]);
    }
    QVERIFY2(this->Logic->RegisterPhantom(points_Model, points_Phantom), this->Logic->GetLastMessage().c_str());
  }

  std::unique_ptr<qSlicerHandEyeCalibrationModule> Module;
  vtkSlicerHandEyeCalibrationLogic* Logic = nullptr;
  QPointer<qSlicerHandEyeCalibrationModuleWidget> Panel;
  std::shared_ptr<Nodes> Scene;
};

DESKTOP_TEST_MAIN(ModuleWidgetTest)
#include "ModuleWidgetTest.moc"
