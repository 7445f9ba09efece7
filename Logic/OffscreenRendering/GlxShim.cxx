// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Debian's GLEW, which VTK uses, asks GLX for every OpenGL entry point. A program that exports these four symbols answers from
// OSMesa instead, so that the distribution's VTK renders with no X server.
#include "GlxShim.h"

#include <GL/osmesa.h>

#include <cstring>

namespace
{

int theDisplay;

void* currentDisplay()
{
  return &theDisplay;
}

}  // namespace

extern "C"
{
  using GlFunction = void (*)();

  GlFunction glXGetProcAddressARB(const unsigned char* name);
  GlFunction glXGetProcAddress(const unsigned char* name);
  int glXQueryVersion(void* display, int* major, int* minor);
  const char* glXGetClientString(void* display, int name);

  GlFunction glXGetProcAddressARB(const unsigned char* name)
  {
    const char* text = reinterpret_cast<const char*>(name);
    return std::strcmp(text, "glXGetCurrentDisplay") == 0 ? reinterpret_cast<GlFunction>(currentDisplay)
                                                          : reinterpret_cast<GlFunction>(OSMesaGetProcAddress(text));
  }

  GlFunction glXGetProcAddress(const unsigned char* name)
  {
    return glXGetProcAddressARB(name);
  }

  int glXQueryVersion(void* /*display*/, int* major, int* minor)
  {
    *major = 1;
    *minor = 4;
    return 1;
  }

  const char* glXGetClientString(void* /*display*/, int /*name*/)
  {
    return "";
  }
}

void handeye::linkGlxShim()
{
}
