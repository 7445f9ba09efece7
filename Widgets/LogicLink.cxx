// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LogicLink.h"

#include "EigenVtk.h"
#include "HandEyeWorkbench.h"
#include "ResultFiles.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

#include <QPointer>
#include <QScopedValueRollback>
#include <vtkMatrix4x4.h>

namespace handeye
{

namespace
{

/// Below what any file keeps of a number (mm, and numbers of a rotation).
constexpr double SameNumber = 1e-9;

}  // namespace

LogicLink::LogicLink(HandEyeWorkbench& workbench, vtkSlicerHandEyeCalibrationLogic& logic)
  : workbench_(workbench)
  , logic_(&logic)
  , stylus_{ "stylus", &vtkSlicerHandEyeCalibrationLogic::LoadStylus, &LogicLink::isStylusTheSame }
  , calibration_{ "calibration", &vtkSlicerHandEyeCalibrationLogic::LoadCalibration, &LogicLink::isCalibrationTheSame }
  , registration_{ "phantom", &vtkSlicerHandEyeCalibrationLogic::LoadPhantomRegistration, &LogicLink::isRegistrationTheSame }
{
  using Logic = vtkSlicerHandEyeCalibrationLogic;
  connect(&workbench_, &HandEyeWorkbench::stylusChanged, this, &LogicLink::giveStylus);
  connect(&workbench_, &HandEyeWorkbench::calibrationChanged, this, &LogicLink::giveCalibration);
  connect(&workbench_, &HandEyeWorkbench::registrationChanged, this, &LogicLink::giveRegistration);
  connect(&workbench_, &HandEyeWorkbench::resultsForgotten, this, [this] { logic_->ForgetResults(); });
  observers_.push_back(logic_->AddObserver(Logic::StylusCalibratedEvent, this, &LogicLink::takeStylus));
  observers_.push_back(logic_->AddObserver(Logic::CameraCalibratedEvent, this, &LogicLink::takeCalibration));
  observers_.push_back(logic_->AddObserver(Logic::PhantomRegisteredEvent, this, &LogicLink::takeRegistration));
  // What it was given before there was a wizard.
  takeStylus();
  takeCalibration();
  takeRegistration();
}

LogicLink::~LogicLink()
{
  for (const unsigned long observer : observers_)
  {
    logic_->RemoveObserver(observer);
  }
}

bool LogicLink::isStylusTheSame() const
{
  double tip[3] = {}, shaft[3] = {};
  if (!logic_->HasStylusDocument() || !workbench_.stylus() || !logic_->GetStylusTip(tip) ||
    !workbench_.stylus()->tip_Stylus.isApprox(Eigen::Vector3d(tip), SameNumber))
  {
    return false;
  }
  const std::optional<Eigen::Isometry3d>& stylusTipToStylus = workbench_.stylus()->stylusTipToStylus;
  const bool hasShaft = logic_->GetStylusShaft(shaft);
  return hasShaft == stylusTipToStylus.has_value() &&
    (!hasShaft || Eigen::Vector3d(-stylusTipToStylus->linear().col(2)).isApprox(Eigen::Vector3d(shaft), SameNumber));
}

void LogicLink::giveStylus()
{
  ++stylus_.changes;
  const std::optional<HandEyeWorkbench::Stylus>& stylus = workbench_.stylus();
  if (stylus && !stylus->document.is_null())
  {
    if (!isStylusTheSame())
    {
      give(stylus_);
    }
  }
  else if (stylus)
  {
    const QScopedValueRollback<bool> giving(isGiving_, true);
    logic_->SetStylusTip(stylus->tip_Stylus.x(), stylus->tip_Stylus.y(), stylus->tip_Stylus.z());
  }
}

/// A document of the session, once it is on the disk; again, if it has become another one meanwhile.
void LogicLink::give(Result& result)
{
  const int change = ++result.changes;
  workbench_.afterStoring(
    [link = QPointer<LogicLink>(this), &result, change]
    {
      const QString file = link ? link->workbench_.documentPath(QString::fromLatin1(result.document)) : QString();
      if (file.isEmpty() || change != result.changes || (link->*result.isTheSame)())
      {
        return;
      }
      const QScopedValueRollback<bool> giving(link->isGiving_, true);
      (link->logic_->*result.load)(file.toStdString());
    });
}

bool LogicLink::isCalibrationTheSame() const
{
  const StoredCalibration* const known = logic_->GetCalibration();
  const std::optional<CalibrationStepResult>& own = workbench_.calibration();
  return known && own && known->markerToCamera.isApprox(own->calibration.markerToCamera, SameNumber) &&
    known->camera.cameraMatrix().isApprox(own->camera.cameraMatrix(), SameNumber) &&
    known->camera.distortionCoefficients() == own->camera.distortionCoefficients();
}

void LogicLink::giveCalibration()
{
  const std::optional<CalibrationStepResult>& calibration = workbench_.calibration();
  ++calibration_.changes;
  if (!calibration)
  {
    logic_->ForgetCalibration();
  }
  else if (calibration->isUsable() && !isCalibrationTheSame())
  {
    give(calibration_);
  }
}

bool LogicLink::isRegistrationTheSame() const
{
  vtkMatrix4x4* const known = logic_->GetModelToPhantom();
  return known && workbench_.modelToPhantom() && toIsometry(known).isApprox(*workbench_.modelToPhantom(), SameNumber);
}

void LogicLink::giveRegistration()
{
  ++registration_.changes;
  if (!workbench_.registrationOfModel())
  {
    logic_->ForgetPhantomRegistration();
  }
  else if (!isRegistrationTheSame())
  {
    give(registration_);
  }
}

void LogicLink::takeStylus()
{
  double tip[3] = {};
  if (isGiving_ || !logic_->GetStylusTip(tip))
  {
    return;
  }
  const QString file = folder_.filePath(QStringLiteral("stylus.json"));
  if (logic_->HasStylusDocument() && logic_->SaveStylus(file.toStdString()))
  {
    workbench_.loadStylus(file);
  }
  else
  {
    workbench_.takeStylusTip({ tip[0], tip[1], tip[2] }, tr("given to the module from outside of the wizard"));
  }
}

void LogicLink::takeCalibration()
{
  if (isGiving_ || !logic_->GetCalibration() || isCalibrationTheSame())
  {
    return;
  }
  const bool isKept = !workbench_.capture().samples().isEmpty();
  const QString file = folder_.filePath(QStringLiteral("calibration.json"));
  if (isKept || logic_->SaveCalibration(file.toStdString()))
  {
    workbench_.loadCalibration(file);  // which says why not, where the session has its own
  }
  if (isKept)
  {
    giveCalibration();
  }
}

void LogicLink::takeRegistration()
{
  const QString file = folder_.filePath(QStringLiteral("phantom.json"));
  if (!isGiving_ && logic_->GetModelToPhantom() && !isRegistrationTheSame() && logic_->SavePhantomRegistration(file.toStdString()))
  {
    workbench_.loadRegistration(file);
  }
}

}  // namespace handeye
