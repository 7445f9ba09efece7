// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// In 3D Slicer.
#include "MRMLBridge.h"

#include <QSet>
#include <vtkMRMLLinearTransformNode.h>
#include <vtkMRMLScene.h>
#include <vtkMatrix4x4.h>
#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>

#include <vector>

namespace
{

class SceneBridge : public MRMLBridge
{
public:
  explicit SceneBridge(vtkMRMLScene* scene)
    : Scene(scene)
  {
  }

  QStringList transformNames() const override
  {
    QStringList names;
    for (vtkMRMLLinearTransformNode* const node : this->nodes())
    {
      names << QString::fromUtf8(node->GetName());
    }
    return names;
  }

  bool transformToParent(const QString& name, vtkMatrix4x4* matrix) const override
  {
    vtkMRMLLinearTransformNode* const node = this->find(name);
    if (node)
    {
      node->GetMatrixTransformToParent(matrix);
    }
    return node != nullptr;
  }

  void publishTransform(const QString& name, vtkMatrix4x4* toParent, const QString& description) override
  {
    if (!this->Scene)
    {
      return;
    }
    vtkSmartPointer<vtkMRMLLinearTransformNode> node = this->find(name);
    if (!node)
    {
      node = vtkSmartPointer<vtkMRMLLinearTransformNode>::New();
      node->SetName(name.toUtf8().constData());
      this->Scene->AddNode(node);
    }
    node->SetDescription(description.toUtf8().constData());
    node->SetMatrixTransformToParent(toParent);
    this->Published.insert(name);
  }

  void withdrawTransform(const QString& name) override
  {
    vtkMRMLLinearTransformNode* const node = this->Published.remove(name) ? this->find(name) : nullptr;
    if (node)
    {
      this->Scene->RemoveNode(node);
    }
  }

private:
  std::vector<vtkMRMLLinearTransformNode*> nodes() const
  {
    std::vector<vtkMRMLLinearTransformNode*> nodes;
    const int count = this->Scene ? this->Scene->GetNumberOfNodesByClass("vtkMRMLLinearTransformNode") : 0;
    for (int i = 0; i < count; ++i)
    {
      auto* const node = vtkMRMLLinearTransformNode::SafeDownCast(this->Scene->GetNthNodeByClass(i, "vtkMRMLLinearTransformNode"));
      if (node && node->GetName())
      {
        nodes.push_back(node);
      }
    }
    return nodes;
  }

  vtkMRMLLinearTransformNode* find(const QString& name) const
  {
    for (vtkMRMLLinearTransformNode* const node : this->nodes())
    {
      if (name == QString::fromUtf8(node->GetName()))
      {
        return node;
      }
    }
    return nullptr;
  }

  vtkWeakPointer<vtkMRMLScene> Scene;
  QSet<QString> Published;
};

}  // namespace

std::unique_ptr<MRMLBridge> MRMLBridge::create(vtkMRMLScene* scene)
{
  return scene ? std::make_unique<SceneBridge>(scene) : nullptr;
}
