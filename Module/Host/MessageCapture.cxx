// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MessageCapture.h"

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <QMutex>
#include <QMutexLocker>
#include <QThread>

#include <cstdio>

namespace desktop
{
namespace
{

// Guarded by the mutex: a thread may log while the window closes.
QMutex captureMutex;
LogModel* capturedInto = nullptr;
QtMessageHandler formerHandler = nullptr;

/// The mutex is not held while those who listen to the log are told: what they say themselves comes here again.
void put(LogModel::Level level, const QString& text)
{
  LogModel* own = nullptr;
  {
    const QMutexLocker lock(&captureMutex);
    if (!capturedInto)
    {
      return;
    }
    if (QThread::currentThread() != capturedInto->thread())
    {
      capturedInto->append(level, text);  // put into a queue
      return;
    }
    own = capturedInto;  // nobody else takes it away: that happens in this thread
  }
  own->append(level, text);
}

void handleQtMessage(QtMsgType type, const QMessageLogContext& context, const QString& text)
{
  if (formerHandler)
  {
    formerHandler(type, context, text);
  }
  const bool isError = type == QtCriticalMsg || type == QtFatalMsg;
  put(isError ? LogModel::Level::Error : type == QtWarningMsg ? LogModel::Level::Warning : LogModel::Level::Info, text);
}

class LogOutputWindow : public vtkOutputWindow
{
public:
  static LogOutputWindow* New();
  vtkTypeMacro(LogOutputWindow, vtkOutputWindow)

  void DisplayText(const char* text) override { this->Show(LogModel::Level::Info, text); }
  void DisplayErrorText(const char* text) override { this->Show(LogModel::Level::Error, text); }
  void DisplayWarningText(const char* text) override { this->Show(LogModel::Level::Warning, text); }
  void DisplayGenericWarningText(const char* text) override { this->Show(LogModel::Level::Warning, text); }
  void DisplayDebugText(const char* text) override { this->Show(LogModel::Level::Info, text); }

private:
  void Show(LogModel::Level level, const char* text)
  {
    std::fprintf(stderr, "%s\n", text);
    put(level, QString::fromUtf8(text).trimmed());
  }
};

vtkStandardNewMacro(LogOutputWindow);

}  // namespace

MessageCapture::MessageCapture(LogModel& log)
  : FormerWindow(vtkOutputWindow::GetInstance())
{
  {
    const QMutexLocker lock(&captureMutex);
    capturedInto = &log;
  }
  formerHandler = qInstallMessageHandler(handleQtMessage);
  const auto window = vtkSmartPointer<LogOutputWindow>::New();
  vtkOutputWindow::SetInstance(window);
}

MessageCapture::~MessageCapture()
{
  qInstallMessageHandler(formerHandler);
  vtkOutputWindow::SetInstance(this->FormerWindow);
  const QMutexLocker lock(&captureMutex);
  capturedInto = nullptr;
}

}  // namespace desktop
