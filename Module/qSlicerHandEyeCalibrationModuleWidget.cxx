// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerHandEyeCalibrationModuleWidget.h"

#include "HandEyeCalibrationPanel.h"
#include "MRMLBridge.h"
#include "PivotCalibration.h"
#include "findNavigationHost.h"
#include "ui_qSlicerHandEyeCalibrationModuleWidget.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <QSignalBlocker>

#include <array>
#include <cmath>
#include <vector>

class qSlicerHandEyeCalibrationModuleWidgetPrivate : public Ui_qSlicerHandEyeCalibrationModuleWidget
{
public:
  void observe(vtkSlicerHandEyeCalibrationLogic* newLogic);
  void publish();
  void fillTransformNames();
  void takeTip();

  vtkSmartPointer<vtkSlicerHandEyeCalibrationLogic> logic;
  std::vector<unsigned long> observers;
  std::unique_ptr<MRMLBridge> bridge;
  HandEyeCalibrationPanel* panel = nullptr;
};

void qSlicerHandEyeCalibrationModuleWidgetPrivate::observe(vtkSlicerHandEyeCalibrationLogic* newLogic)
{
  for (const unsigned long observer : this->observers)
  {
    this->logic->RemoveObserver(observer);
  }
  this->observers.clear();
  this->logic = newLogic;
  if (newLogic)
  {
    using Logic = vtkSlicerHandEyeCalibrationLogic;
    for (const unsigned long event : { Logic::CameraCalibratedEvent, Logic::PhantomRegisteredEvent, Logic::ResultsForgottenEvent })
    {
      this->observers.push_back(newLogic->AddObserver(event, this, &qSlicerHandEyeCalibrationModuleWidgetPrivate::publish));
    }
  }
}

void qSlicerHandEyeCalibrationModuleWidgetPrivate::publish()
{
  if (!this->bridge || !this->logic || !this->publishResults->isChecked())
  {
    return;
  }
  const auto keep = [this](const char* name, vtkMatrix4x4* matrix, const QString& description)
  {
    if (matrix)
    {
      this->bridge->publishTransform(QString::fromLatin1(name), matrix, description);
    }
    else
    {
      this->bridge->withdrawTransform(QString::fromLatin1(name));
    }
  };
  keep("MarkerToCamera", this->logic->GetMarkerToCamera(),
    qSlicerHandEyeCalibrationModuleWidget::tr(
      "From the camera's marker (as tracked) to the camera (OpenCV: x right, y down, z forward), mm"));
  keep("ModelToPhantom", this->logic->GetModelToPhantom(),
    qSlicerHandEyeCalibrationModuleWidget::tr(
      "From the model, its numbers as they stand in its file (open it as RAS), to the phantom's marker, mm"));
}

void qSlicerHandEyeCalibrationModuleWidgetPrivate::fillTransformNames()
{
  const QString chosen = this->stylusTipNode->currentText();
  const QSignalBlocker blocker(this->stylusTipNode);
  this->stylusTipNode->clear();
  if (this->bridge)
  {
    this->stylusTipNode->addItems(this->bridge->transformNames());
  }
  const int tip = this->stylusTipNode->findText(QStringLiteral("StylusTipToStylus"));
  const int before = this->stylusTipNode->findText(chosen);
  this->stylusTipNode->setCurrentIndex(before >= 0 ? before : tip >= 0 ? tip : 0);
  this->takeStylusTip->setEnabled(this->stylusTipNode->count() > 0);
}

void qSlicerHandEyeCalibrationModuleWidgetPrivate::takeTip()
{
  const QString name = this->stylusTipNode->currentText();
  vtkNew<vtkMatrix4x4> tipToStylus;
  if (!this->bridge || !this->logic || !this->bridge->transformToParent(name, tipToStylus))
  {
    this->tipMessage->setText(
      qSlicerHandEyeCalibrationModuleWidget::tr("There is no linear transform \"%1\" in the scene any more.").arg(name));
    return;
  }
  const std::array<double, 3> tip_Stylus = { tipToStylus->GetElement(0, 3), tipToStylus->GetElement(1, 3),
    tipToStylus->GetElement(2, 3) };
  const double lengthMm = std::hypot(tip_Stylus[0], tip_Stylus[1], tip_Stylus[2]);
  const handeye::PivotCalibrationOptions limits;
  if (!(lengthMm >= limits.nearestTipMm && lengthMm <= limits.furthestTipMm))
  {
    // The identity, which a node has that nobody has set, among them.
    this->tipMessage->setText(qSlicerHandEyeCalibrationModuleWidget::tr(
      "Not taken: by \"%1\" the tip is %2 mm away from the stylus' marker, which no stylus' is. Has it been pivoted?")
                                .arg(name)
                                .arg(lengthMm, 0, 'f', 1));
    return;
  }
  this->logic->SetStylusTip(tip_Stylus[0], tip_Stylus[1], tip_Stylus[2]);
  this->tipMessage->setText(qSlicerHandEyeCalibrationModuleWidget::tr("Tip of \"%1\": %2, %3, %4 mm")
                              .arg(name)
                              .arg(tip_Stylus[0], 0, 'f', 2)
                              .arg(tip_Stylus[1], 0, 'f', 2)
                              .arg(tip_Stylus[2], 0, 'f', 2));
}

// -----------------------------------------------------------------------------------------------------------------------------------------

qSlicerHandEyeCalibrationModuleWidget::qSlicerHandEyeCalibrationModuleWidget(QWidget* parent)
  : Superclass(parent)
  , d_ptr(new qSlicerHandEyeCalibrationModuleWidgetPrivate)
{
}

qSlicerHandEyeCalibrationModuleWidget::~qSlicerHandEyeCalibrationModuleWidget()
{
  Q_D(qSlicerHandEyeCalibrationModuleWidget);
  d->observe(nullptr);
  // Before the logic that it uses.
  delete d->panel;
}

void qSlicerHandEyeCalibrationModuleWidget::setup()
{
  Q_D(qSlicerHandEyeCalibrationModuleWidget);
  d->setupUi(this);
  this->Superclass::setup();
  d->observe(vtkSlicerHandEyeCalibrationLogic::SafeDownCast(this->logic()));
  d->panel = new HandEyeCalibrationPanel(d->logic, findNavigationHost(), this);
  d->panelLayout->addWidget(d->panel);
  this->setBridge(nullptr);
  connect(d->publishResults, &QCheckBox::toggled, this, [d] { d->publish(); });
  connect(d->takeStylusTip, &QPushButton::clicked, this, [d] { d->takeTip(); });
}

void qSlicerHandEyeCalibrationModuleWidget::setBridge(std::unique_ptr<MRMLBridge> bridge)
{
  Q_D(qSlicerHandEyeCalibrationModuleWidget);
  d->bridge = std::move(bridge);
  d->sceneGroup->setVisible(d->bridge != nullptr);
  d->fillTransformNames();
  d->publish();
}

void qSlicerHandEyeCalibrationModuleWidget::setMRMLScene(vtkMRMLScene* scene)
{
  this->Superclass::setMRMLScene(scene);
  this->setBridge(MRMLBridge::create(scene));
}

void qSlicerHandEyeCalibrationModuleWidget::enter()
{
  Q_D(qSlicerHandEyeCalibrationModuleWidget);
  this->Superclass::enter();
  d->fillTransformNames();
  if (d->panel)
  {
    d->panel->enterModule();
  }
}

void qSlicerHandEyeCalibrationModuleWidget::exit()
{
  Q_D(qSlicerHandEyeCalibrationModuleWidget);
  if (d->panel)
  {
    d->panel->exitModule();
  }
  this->Superclass::exit();
}
