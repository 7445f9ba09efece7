// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files that come into DesktopWindow: dropped, chosen, or from the list of recent ones.
#include "DesktopWindow.h"
#include "NoticeBar.h"
#include "RecentFiles.h"

#include <QDir>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QLabel>
#include <QMimeData>
#include <QUrl>

#include <exception>

namespace desktop
{

QStringList DesktopWindow::localPaths(const QMimeData* data)
{
  QStringList paths;
  for (const QUrl& url : data->urls())
  {
    if (url.isLocalFile())
    {
      paths << url.toLocalFile();
    }
  }
  return paths;
}

bool DesktopWindow::openPath(const QString& path)
{
  const QString shown = QDir::toNativeSeparators(path);
  QString problem;
  if (!QFileInfo::exists(path))
  {
    problem = tr("%1 is not there.").arg(shown);
  }
  else if (!this->FileHandler)
  {
    problem = tr("%1 was not opened: no module takes files now.").arg(shown);
  }
  else
  {
    bool taken = false;
    try
    {
      if (!QMetaObject::invokeMethod(
            this->FileHandler, "openFile", Qt::DirectConnection, Q_RETURN_ARG(bool, taken), Q_ARG(QString, path)))
      {
        problem = tr("%1 was not opened: the module has no method for it.").arg(shown);
      }
      else if (!taken)
      {
        problem = tr("%1 was not opened: the module could make nothing of it.").arg(shown);
      }
    }
    catch (const std::exception& error)
    {
      problem = tr("%1 was not opened: %2").arg(shown, QString::fromUtf8(error.what()));
    }
  }
  if (problem.isEmpty())
  {
    this->Recent->add(path);
    return true;
  }
  this->Log->append(LogLevel::Warning, problem);
  this->Notices->addNotice(problem);
  return false;
}

void DesktopWindow::dragEnterEvent(QDragEnterEvent* event)
{
  if (!localPaths(event->mimeData()).isEmpty())
  {
    event->acceptProposedAction();
    this->showDropHint(true);
  }
}

void DesktopWindow::dragLeaveEvent(QDragLeaveEvent* event)
{
  this->showDropHint(false);
  this->QMainWindow::dragLeaveEvent(event);
}

void DesktopWindow::dropEvent(QDropEvent* event)
{
  this->showDropHint(false);
  const QStringList paths = localPaths(event->mimeData());
  if (paths.isEmpty())
  {
    return;
  }
  event->acceptProposedAction();
  // After the drop is over: what takes long would otherwise hold the program that the files come from.
  for (const QString& path : paths)
  {
    QMetaObject::invokeMethod(
      this, [this, path] { this->openPath(path); }, Qt::QueuedConnection);
  }
}

void DesktopWindow::showDropHint(bool on)
{
  delete this->DropHint;
  if (!on)
  {
    return;
  }
  auto* const hint = new QLabel(tr("Drop recordings, meshes, cameras or results here"), this);
  hint->setObjectName(QStringLiteral("DropHint"));
  hint->setAttribute(Qt::WA_TransparentForMouseEvents);
  hint->setAlignment(Qt::AlignCenter);
  hint->setAutoFillBackground(true);
  hint->setFrameShape(QFrame::Box);
  hint->adjustSize();
  hint->resize(hint->width() + 40, hint->height() + 24);
  hint->move(this->rect().center() - hint->rect().center());
  hint->show();
  this->DropHint = hint;
}

}  // namespace desktop
