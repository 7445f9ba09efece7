// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The module by itself, as an application without NavigationHost has it: what it says of itself, and its scene behind MRMLBridge.
#include "DesktopTestMain.h"
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
#include <QPushButton>

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

  void publishTransform(const QString& name, vtkMatrix4x4* toParent) override
  {
    (*this->Scene)[name] = vtkSmartPointer<vtkMatrix4x4>::New();
    (*this->Scene)[name]->DeepCopy(toParent);
  }

private:
  std::shared_ptr<Nodes> Scene;
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
    MapBridge(this->Scene).publishTransform("Another", tipToStylus);
    MapBridge(this->Scene).publishTransform("StylusTipToStylus", tipToStylus);
    this->Panel->setBridge(std::make_unique<MapBridge>(this->Scene));
    QCOMPARE(this->Panel->findChild<QComboBox*>("stylusTipNode")->currentText(), QString("StylusTipToStylus"));
    double tip_Stylus[3] = {};
    QVERIFY(!this->Logic->GetStylusTip(tip_Stylus));
    this->Panel->findChild<QPushButton*>("takeStylusTip")->click();
    QVERIFY(this->Logic->GetStylusTip(tip_Stylus));
    QCOMPARE(tip_Stylus[0], 1.5);
    QCOMPARE(tip_Stylus[1], -2.5);
    QCOMPARE(tip_Stylus[2], 180.0);
  }

  void panelDeletedFirst_LeavesTheModuleWhole()
  {
    delete this->Panel;
    this->registerPhantom(1);  // nobody listens any more
    QVERIFY(this->Module->widgetRepresentation());
  }

private:
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
