// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "qSlicerAbstractCoreModule.h"

#include "qSlicerAbstractModuleRepresentation.h"
#include "vtkMRMLAbstractLogic.h"

#include <QWidget>

qSlicerAbstractCoreModule::qSlicerAbstractCoreModule(QObject* parent)
  : QObject(parent)
{
}

qSlicerAbstractCoreModule::~qSlicerAbstractCoreModule()
{
  qSlicerAbstractModuleRepresentation* const representation = this->Representation;
  if (!representation)
  {
    return;
  }
  representation->setModule(nullptr);
  // A panel in a window is the window's.
  auto* const widget = dynamic_cast<QWidget*>(representation);
  if (!widget || !widget->parent())
  {
    delete representation;
  }
}

void qSlicerAbstractCoreModule::initialize(vtkSlicerApplicationLogic* appLogic)
{
  this->AppLogic = appLogic;
  this->logic();
  this->setup();
}

QString qSlicerAbstractCoreModule::name() const
{
  return this->Name;
}

void qSlicerAbstractCoreModule::setName(const QString& name)
{
  this->Name = name;
}

void qSlicerAbstractCoreModule::setPath(const QString& path)
{
  this->Path = path;
}

QStringList qSlicerAbstractCoreModule::categories() const
{
  return { QString() };
}

int qSlicerAbstractCoreModule::index() const
{
  return -1;
}

bool qSlicerAbstractCoreModule::isHidden() const
{
  return false;
}

QString qSlicerAbstractCoreModule::helpText() const
{
  return {};
}

QString qSlicerAbstractCoreModule::acknowledgementText() const
{
  return {};
}

QStringList qSlicerAbstractCoreModule::contributors() const
{
  return {};
}

QStringList qSlicerAbstractCoreModule::dependencies() const
{
  return {};
}

QStringList qSlicerAbstractCoreModule::associatedNodeTypes() const
{
  return {};
}

qSlicerAbstractModuleRepresentation* qSlicerAbstractCoreModule::widgetRepresentation()
{
  if (!this->Representation)
  {
    this->Representation = this->createWidgetRepresentation();
    if (this->Representation)
    {
      this->Representation->setModule(this);
      this->Representation->setup();
      this->Representation->setMRMLScene(this->Scene);
    }
  }
  return this->Representation;
}

vtkMRMLAbstractLogic* qSlicerAbstractCoreModule::logic()
{
  if (!this->Logic)
  {
    this->Logic.TakeReference(this->createLogic());
    if (this->Logic)
    {
      this->Logic->SetMRMLScene(this->Scene);
    }
  }
  return this->Logic;
}

void qSlicerAbstractCoreModule::setMRMLScene(vtkMRMLScene* scene)
{
  if (this->Scene == scene)
  {
    return;
  }
  this->Scene = scene;
  if (this->Logic)
  {
    this->Logic->SetMRMLScene(scene);
  }
  if (this->Representation)
  {
    this->Representation->setMRMLScene(scene);
  }
}

void qSlicerAbstractCoreModule::representationDeleted(qSlicerAbstractModuleRepresentation* representation)
{
  if (this->Representation == representation)
  {
    this->Representation = nullptr;
  }
}
