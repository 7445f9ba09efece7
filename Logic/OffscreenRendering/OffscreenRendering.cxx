// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OffscreenRendering.h"

#include "GlxShim.h"
#include "vtkOSMesaRenderWindow.h"

#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkVersion.h>

namespace handeye
{

namespace
{

VTK_CREATE_CREATE_FUNCTION(vtkOSMesaRenderWindow)

class OffscreenRenderingFactory : public vtkObjectFactory
{
public:
  static OffscreenRenderingFactory* New()
  {
    auto* factory = new OffscreenRenderingFactory;
    factory->InitializeObjectBase();
    return factory;
  }
  vtkTypeMacro(OffscreenRenderingFactory, vtkObjectFactory)
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "render windows in memory, through OSMesa"; }

protected:
  OffscreenRenderingFactory()
  {
    this->RegisterOverride(
      "vtkRenderWindow", "vtkOSMesaRenderWindow", "render window in memory", 1, vtkObjectFactoryCreatevtkOSMesaRenderWindow);
  }
};

}  // namespace

void registerOffscreenRendering()
{
  static bool registered = false;
  if (registered)
  {
    return;
  }
  registered = true;
  linkGlxShim();
  // VTK's own X11 window was registered when its library was loaded; the first enabled override wins.
  vtkObjectFactory::SetAllEnableFlags(0, "vtkRenderWindow");
  vtkNew<OffscreenRenderingFactory> factory;
  vtkObjectFactory::RegisterFactory(factory);
}

}  // namespace handeye
