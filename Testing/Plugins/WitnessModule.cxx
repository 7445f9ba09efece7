// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A module that writes down what a desktop does with it: in the property "calls" of the application.
#include "findNavigationHost.h"
#include "qSlicerAbstractModuleWidget.h"
#include "qSlicerLoadableModule.h"
#include "vtkSlicerModuleLogic.h"

#include <QLabel>
#include <QVBoxLayout>

static void note(const QString& call)
{
  qApp->setProperty("calls", qApp->property("calls").toStringList() << call);
}

class WitnessWidget : public qSlicerAbstractModuleWidget
{
  Q_OBJECT

public:
  WitnessWidget() { note("widget"); }

  ~WitnessWidget() override { note("~widget"); }

  void enter() override
  {
    this->qSlicerAbstractModuleWidget::enter();
    NavigationHost* const host = findNavigationHost();
    note(host ? "enter with host" : "enter without host");
    if (host)
    {
      host->setFileHandler(this);
      host->setVideoWidget(this->Video);
    }
  }

  void exit() override
  {
    note("exit");
    if (NavigationHost* const host = findNavigationHost())
    {
      host->setFileHandler(nullptr);
      host->setVideoWidget(nullptr);
    }
    this->qSlicerAbstractModuleWidget::exit();
  }

  Q_INVOKABLE bool openFile(QString path)
  {
    note("open " + path);
    return path.endsWith(".good");
  }

protected:
  void setup() override
  {
    note(this->logic() ? "setup of widget with logic" : "setup of widget without logic");
    this->qSlicerAbstractModuleWidget::setup();
    auto* const layout = new QVBoxLayout(this);
    layout->addWidget(new QLabel("What the witness shows"));
    this->Video = new QLabel("The witness' video", this);
    this->Video->setObjectName("WitnessVideo");
    this->Video->setAlignment(Qt::AlignCenter);
    this->Video->hide();
  }

private:
  QLabel* Video = nullptr;
};

class WitnessModule : public qSlicerLoadableModule
{
  Q_OBJECT
  Q_PLUGIN_METADATA(IID "org.slicer.modules.loadable.qSlicerLoadableModule/1.0")
  Q_INTERFACES(qSlicerLoadableModule)

public:
  WitnessModule() { note("module"); }
  ~WitnessModule() override { note("~module"); }

  qSlicerGetTitleMacro("Witness")

    QStringList categories() const override
  {
    return { "Tests" };
  }
  QString helpText() const override { return "<p>Helps the tests.</p>"; }
  QStringList contributors() const override { return { "A <b>tester</b>" }; }

protected:
  void setup() override { note("setup of module"); }
  vtkMRMLAbstractLogic* createLogic() override
  {
    note("logic");
    return vtkSlicerModuleLogic::New();
  }
  qSlicerAbstractModuleRepresentation* createWidgetRepresentation() override { return new WitnessWidget; }
};

#include "WitnessModule.moc"
