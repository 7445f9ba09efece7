// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSlicerHandEyeCalibrationLogic.h"
#include "vtkSlicerModuleLogic.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>

#include <string>

namespace
{

/// What a module's logic gets to see of a scene.
class SceneWitness : public vtkSlicerModuleLogic
{
public:
  static SceneWitness* New();
  vtkTypeMacro(SceneWitness, vtkSlicerModuleLogic)

  std::string Calls;

protected:
  void SetMRMLSceneInternal(vtkMRMLScene* newScene) override
  {
    this->Superclass::SetMRMLSceneInternal(newScene);
    this->Calls += "set ";
  }
  void UnobserveMRMLScene() override { this->Calls += "leave "; }
  void RegisterNodes() override { this->Calls += "register "; }
  void ObserveMRMLScene() override
  {
    this->Calls += "observe ";
    this->Superclass::ObserveMRMLScene();
  }
  void UpdateFromMRMLScene() override { this->Calls += "update "; }
};

vtkStandardNewMacro(SceneWitness);

}  // namespace

TEST(SlicerBase, Scene_ComesInTheOrderOfSlicer)
{
  int somewhere = 0;
  auto* const scene = reinterpret_cast<vtkMRMLScene*>(&somewhere);  // never looked into
  vtkNew<SceneWitness> witness;
  witness->SetMRMLScene(nullptr);
  EXPECT_EQ(witness->Calls, "");
  witness->SetMRMLScene(scene);
  witness->SetMRMLScene(scene);
  EXPECT_EQ(witness->GetMRMLScene(), scene);
  EXPECT_EQ(witness->Calls, "set register observe update ");
  witness->Calls.clear();
  witness->SetMRMLScene(nullptr);
  EXPECT_EQ(witness->Calls, "leave set ");
  EXPECT_EQ(witness->GetMRMLScene(), nullptr);

  vtkNew<vtkSlicerHandEyeCalibrationLogic> logic;
  logic->SetMRMLScene(scene);
  EXPECT_EQ(logic->GetMRMLScene(), scene);
  EXPECT_TRUE(logic->IsA("vtkSlicerModuleLogic"));
  EXPECT_TRUE(logic->IsA("vtkMRMLAbstractLogic"));
}
