// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Outside of 3D Slicer.
#include "MRMLBridge.h"

std::unique_ptr<MRMLBridge> MRMLBridge::create(vtkMRMLScene*)
{
  return nullptr;
}
