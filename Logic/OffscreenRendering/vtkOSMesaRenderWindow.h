// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

#include <memory>

/// A render window in memory: OpenGL 3.3 core by OSMesa (Mesa's software renderer), no X server, no display.
///
/// VTK 9 renders into a framebuffer object of its own and reads pictures from there; the context's own buffer only has to exist.
class vtkOSMesaRenderWindow : public vtkGenericOpenGLRenderWindow
{
public:
  static vtkOSMesaRenderWindow* New();
  vtkTypeMacro(vtkOSMesaRenderWindow, vtkGenericOpenGLRenderWindow)

  void Start() override;
  void Render() override;
  void MakeCurrent() override;
  bool IsCurrent() override;
  int SupportsOpenGL() override { return 1; }
  vtkTypeBool IsDirect() override { return 1; }
  void Finalize() override;

protected:
  vtkOSMesaRenderWindow();
  ~vtkOSMesaRenderWindow() override;

private:
  vtkOSMesaRenderWindow(const vtkOSMesaRenderWindow&) = delete;
  void operator=(const vtkOSMesaRenderWindow&) = delete;

  void CreateContext();
  void BindContext();

  struct Internals;
  std::unique_ptr<Internals> Context;
};
