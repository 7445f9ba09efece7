// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandEyeSlicerBaseExport.h"

#include <vtkObject.h>

class vtkMRMLNode;
class vtkMRMLScene;

/// Stands in for 3D Slicer's class of this name in a build without Slicer: what our logic overrides and calls, with Slicer 5's
/// signatures.
///
/// Nothing here looks into a scene, and no node is ever reported: without Slicer there is no MRML. The scene is a pointer that is
/// handed on; it is not kept alive and may be null.
class HANDEYE_SLICER_BASE_EXPORT vtkMRMLAbstractLogic : public vtkObject
{
public:
  static vtkMRMLAbstractLogic* New();
  vtkTypeMacro(vtkMRMLAbstractLogic, vtkObject)
  void PrintSelf(std::ostream& os, vtkIndent indent) override;

  vtkMRMLScene* GetMRMLScene() const;

  /// In this order: UnobserveMRMLScene() if there was a scene, SetMRMLSceneInternal(), and, if there is a scene now, RegisterNodes() and
  /// ObserveMRMLScene(). Nothing happens for the scene that is set already.
  void SetMRMLScene(vtkMRMLScene* newScene);

protected:
  vtkMRMLAbstractLogic() = default;
  ~vtkMRMLAbstractLogic() override = default;

  /// Keeps the pointer; an override calls it.
  virtual void SetMRMLSceneInternal(vtkMRMLScene* newScene);

  /// A scene is no longer that of the logic: whatever was kept of it goes.
  virtual void UnobserveMRMLScene() {}
  /// There is a new scene: UpdateFromMRMLScene().
  virtual void ObserveMRMLScene();
  /// Makes the logic's own node classes known to the scene.
  virtual void RegisterNodes() {}
  /// The scene has changed as a whole.
  virtual void UpdateFromMRMLScene() {}

  virtual void OnMRMLSceneNodeAdded(vtkMRMLNode* vtkNotUsed(node)) {}
  virtual void OnMRMLSceneNodeRemoved(vtkMRMLNode* vtkNotUsed(node)) {}

  /// For the logic itself, as in Slicer: others do not say that it was modified.
  void Modified() override;

private:
  vtkMRMLAbstractLogic(const vtkMRMLAbstractLogic&) = delete;
  void operator=(const vtkMRMLAbstractLogic&) = delete;

  vtkMRMLScene* Scene = nullptr;
};
