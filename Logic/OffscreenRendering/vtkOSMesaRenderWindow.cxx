// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOSMesaRenderWindow.h"

#include <vtkObjectFactory.h>

#include <GL/osmesa.h>

#include <array>
#include <stdexcept>

struct vtkOSMesaRenderWindow::Internals
{
  static constexpr int Size = 16;
  OSMesaContext Handle = nullptr;
  std::array<unsigned char, 4 * Size * Size> Pixels{};
};

vtkStandardNewMacro(vtkOSMesaRenderWindow);

vtkOSMesaRenderWindow::vtkOSMesaRenderWindow()
  : Context(std::make_unique<Internals>())
{
  this->SetOwnContext(0);
}

vtkOSMesaRenderWindow::~vtkOSMesaRenderWindow()
{
  this->vtkOSMesaRenderWindow::Finalize();
}

void vtkOSMesaRenderWindow::Start()
{
  this->CreateContext();
  this->Superclass::Start();
}

void vtkOSMesaRenderWindow::Render()
{
  this->CreateContext();
  this->Superclass::Render();
}

void vtkOSMesaRenderWindow::MakeCurrent()
{
  this->CreateContext();
  this->BindContext();
}

bool vtkOSMesaRenderWindow::IsCurrent()
{
  return this->Context->Handle && OSMesaGetCurrentContext() == this->Context->Handle;
}

void vtkOSMesaRenderWindow::Finalize()
{
  if (this->Context->Handle)
  {
    this->Superclass::Finalize();
    OSMesaDestroyContext(this->Context->Handle);
    this->Context->Handle = nullptr;
  }
}

void vtkOSMesaRenderWindow::BindContext()
{
  OSMesaMakeCurrent(this->Context->Handle, this->Context->Pixels.data(), GL_UNSIGNED_BYTE, Internals::Size, Internals::Size);
}

void vtkOSMesaRenderWindow::CreateContext()
{
  if (this->Context->Handle)
  {
    return;
  }
  const int attributes[] = { OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_STENCIL_BITS, 8, OSMESA_PROFILE,
    OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION, 3, OSMESA_CONTEXT_MINOR_VERSION, 3, 0 };
  this->Context->Handle = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!this->Context->Handle)
  {
    throw std::runtime_error("OSMesa offers no OpenGL 3.3 core context on this machine");
  }
  this->BindContext();
  this->SetReadyForRendering(true);
  this->OpenGLInit();
}
