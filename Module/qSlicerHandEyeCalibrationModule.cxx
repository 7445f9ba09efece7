// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerHandEyeCalibrationModule.h"

#include "qSlicerHandEyeCalibrationModuleWidget.h"
#include "vtkSlicerHandEyeCalibrationLogic.h"

qSlicerHandEyeCalibrationModule::qSlicerHandEyeCalibrationModule(QObject* parent)
  : Superclass(parent)
{
}

qSlicerHandEyeCalibrationModule::~qSlicerHandEyeCalibrationModule() = default;

QString qSlicerHandEyeCalibrationModule::helpText() const
{
  return tr(
    "<p>Finds where a camera's optical centre sits relative to the tracking marker that is fixed on the camera (the hand-eye "
    "transform), with a tracked stylus that ends in a coloured ball, and draws virtual anatomy onto the video where it belongs.</p>"
    "<p>Pages: devices, camera, stylus, ball, capture, validation, overlay, finish. Each page says when its result is good enough "
    "for the next, and why not if it is not. Lengths are in mm, images in px.</p>"
    "<p>Not a medical device: validate every calibration on captures of your own.</p>");
}

QString qSlicerHandEyeCalibrationModule::acknowledgementText() const
{
  return tr("The method is that of Morgan, Jayarathne, Rankin, Peters and Chen, <i>Hand-eye calibration for surgical cameras: a "
            "Procrustean "
            "Perspective-n-Point solution</i>, Int J CARS 12:1141-1149 (2017), "
            "<a href=\"https://doi.org/10.1007/s11548-017-1590-9\">doi 10.1007/s11548-017-1590-9</a>.");
}

QStringList qSlicerHandEyeCalibrationModule::contributors() const
{
  return { QStringLiteral("HandEyeCalibration contributors") };
}

QIcon qSlicerHandEyeCalibrationModule::icon() const
{
  return QIcon(QStringLiteral(":/Icons/HandEyeCalibration.svg"));
}

QStringList qSlicerHandEyeCalibrationModule::categories() const
{
  return { QStringLiteral("IGT") };
}

QStringList qSlicerHandEyeCalibrationModule::dependencies() const
{
  return {};
}

void qSlicerHandEyeCalibrationModule::setup()
{
  this->Superclass::setup();
}

qSlicerAbstractModuleRepresentation* qSlicerHandEyeCalibrationModule::createWidgetRepresentation()
{
  return new qSlicerHandEyeCalibrationModuleWidget;
}

vtkMRMLAbstractLogic* qSlicerHandEyeCalibrationModule::createLogic()
{
  return vtkSlicerHandEyeCalibrationLogic::New();
}
