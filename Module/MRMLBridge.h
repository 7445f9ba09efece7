// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QStringList>

#include <memory>

class vtkMRMLScene;
class vtkMatrix4x4;

/// What only 3D Slicer has: transform nodes of a scene, as sources and as results. The one place of the module that knows of MRML; outside
/// Slicer there is none.
///
/// A node is known by its name; its matrix is its transform to its parent: for a node "MarkerToCamera", p_Camera = markerToCamera * p_Marker,
/// mm.
///
/// Nothing is turned round between us and the scene. A tracker's frames are neither RAS nor LPS: SlicerOpenIGTLink puts the numbers of a
/// TRANSFORM message into its node as they come, SlicerIGT's pivot calibration works with those, and so do we. (Only .tfm files hold LPS:
/// io::NamedTransform.) For the model this means: `ModelToPhantom` takes the mesh's numbers as they stand in its file. Slicer itself
/// reads a mesh as LPS, that is with x and y turned round, unless "RAS" is chosen when it is opened or the file says SPACE=RAS.
class MRMLBridge
{
public:
  virtual ~MRMLBridge() = default;

  /// Null for no scene, and always outside Slicer.
  static std::unique_ptr<MRMLBridge> create(vtkMRMLScene* scene);

  /// The names of the linear transform nodes, in the order of the scene.
  virtual QStringList transformNames() const = 0;

  /// The transform to the parent of the node of this name. @return false, and the matrix as it was, if there is no such linear transform
  virtual bool transformToParent(const QString& name, vtkMatrix4x4* matrix) const = 0;

  /// Sets the node of this name, which is made if there is none. @param description of what it maps, for the person who reads the node
  virtual void publishTransform(const QString& name, vtkMatrix4x4* toParent, const QString& description) = 0;

  /// Removes the node of this name if this bridge has published it: what it said does not hold any more.
  virtual void withdrawTransform(const QString& name) = 0;
};
