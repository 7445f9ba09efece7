// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>
#include <QString>
#include <QTemporaryDir>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkSlicerHandEyeCalibrationLogic;

namespace handeye
{

class HandEyeWorkbench;

/// Keeps the module's logic and the wizard at the same stylus, calibration and registration, whichever of them got a new one: what the
/// wizard has is given to the logic, whose events make transform nodes of it in 3D Slicer; what somebody else gives the logic (a transform
/// node's stylus tip, a script) becomes the wizard's.
///
/// The session is the owner. Where it has samples of its own, its calibration stays: one that was given to the logic is refused in words,
/// and the session's is given back. Another session takes the results of the one before away, from the logic as well, and so does what
/// the wizard withdraws: a calibration of another lens, a registration of another mesh. A calibration that was tried and is not usable
/// leaves the one before it in the logic, as the logic's own steps do.
///
/// Results go over as files: the session's documents in the one direction, a temporary folder in the other. Belongs to the thread of the
/// user interface, as do the events of the logic.
class LogicLink : public QObject
{
  Q_OBJECT

public:
  /// The wizard takes what the logic has already. The workbench outlives the link.
  LogicLink(HandEyeWorkbench& workbench, vtkSlicerHandEyeCalibrationLogic& logic);
  ~LogicLink() override;

private:
  void giveStylus();
  void giveCalibration();
  void giveRegistration();
  /// One result of the wizard: the session's document that holds it, and how it is given.
  struct Result
  {
    const char* document;
    bool (vtkSlicerHandEyeCalibrationLogic::*load)(const std::string& file);
    bool (LogicLink::*isTheSame)() const;
    int changes = 0;  ///< counted: what is on the disk may be older than what the wizard has
  };
  void give(Result& result);
  void takeStylus();
  void takeCalibration();
  void takeRegistration();

  bool isStylusTheSame() const;
  bool isCalibrationTheSame() const;
  bool isRegistrationTheSame() const;

  HandEyeWorkbench& workbench_;
  vtkSmartPointer<vtkSlicerHandEyeCalibrationLogic> logic_;
  std::vector<unsigned long> observers_;
  Result stylus_, calibration_, registration_;
  QTemporaryDir folder_;   ///< for what comes from the logic
  bool isGiving_ = false;  ///< the logic's event is an answer to this link
};

}  // namespace handeye
