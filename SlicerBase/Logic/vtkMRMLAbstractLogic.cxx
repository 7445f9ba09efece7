// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMRMLAbstractLogic.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkMRMLAbstractLogic);

void vtkMRMLAbstractLogic::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MRMLScene: " << static_cast<const void*>(this->Scene) << "\n";
}

vtkMRMLScene* vtkMRMLAbstractLogic::GetMRMLScene() const
{
  return this->Scene;
}

void vtkMRMLAbstractLogic::SetMRMLScene(vtkMRMLScene* newScene)
{
  if (this->Scene == newScene)
  {
    return;
  }
  if (this->Scene)
  {
    this->UnobserveMRMLScene();
  }
  this->SetMRMLSceneInternal(newScene);
  if (newScene)
  {
    this->RegisterNodes();
    this->ObserveMRMLScene();
  }
  this->Modified();
}

void vtkMRMLAbstractLogic::SetMRMLSceneInternal(vtkMRMLScene* newScene)
{
  this->Scene = newScene;
}

void vtkMRMLAbstractLogic::ObserveMRMLScene()
{
  this->UpdateFromMRMLScene();
}

void vtkMRMLAbstractLogic::Modified()
{
  this->Superclass::Modified();
}
