// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A module that is told by definitions what to be.
#include "qSlicerAbstractModuleWidget.h"
#include "qSlicerLoadableModule.h"

#include <stdexcept>

#ifdef MODULE_CALLS
void MODULE_CALLS();
#endif

class SmallModuleWidget : public qSlicerAbstractModuleWidget
{
};

class SmallModule : public qSlicerLoadableModule
{
  Q_OBJECT
  Q_PLUGIN_METADATA(IID "org.slicer.modules.loadable.qSlicerLoadableModule/1.0")
  Q_INTERFACES(qSlicerLoadableModule)

public:
  qSlicerGetTitleMacro(MODULE_TITLE)

    QStringList categories() const override
  {
    return { "Tests.Small" };
  }

  QStringList dependencies() const override
  {
#ifdef MODULE_NEEDS
    return { MODULE_NEEDS };
#else
    return {};
#endif
  }

protected:
  void setup() override
  {
#ifdef MODULE_THROWS
    throw std::runtime_error("the moon is in the wrong phase");
#endif
#ifdef MODULE_CALLS
    MODULE_CALLS();
#endif
  }

  qSlicerAbstractModuleRepresentation* createWidgetRepresentation() override
  {
    return new SmallModuleWidget;
  }

  vtkMRMLAbstractLogic* createLogic() override
  {
    return nullptr;
  }
};

#include "SmallModule.moc"
