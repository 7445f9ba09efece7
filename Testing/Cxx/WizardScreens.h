// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QAbstractButton>
#include <QDir>
#include <QLabel>
#include <QString>
#include <QStringList>

inline QString screenshotFolder()
{
  const QString asked = qEnvironmentVariable("HANDEYE_SCREENSHOT_DIR");
  const QString folder = asked.isEmpty() ? QStringLiteral(HANDEYE_SCREENSHOT_DIR) : asked;
  QDir().mkpath(folder);
  return folder;
}

/// Labels, buttons and boxes that get less room than their words need, or that lie outside of their parents or over one another.
inline QStringList faultsOf(QWidget& page)
{
  QStringList faults;
  const QList<QWidget*> children = page.findChildren<QWidget*>();
  for (QWidget* child : children)
  {
    const bool isText = qobject_cast<QLabel*>(child) || qobject_cast<QAbstractButton*>(child);
    if (!isText || !child->isVisibleTo(&page) || child->size().isEmpty())
    {
      continue;
    }
    const auto* label = qobject_cast<QLabel*>(child);
    const bool wraps = label && label->wordWrap();
    const int needed = wraps ? label->heightForWidth(label->width()) : child->minimumSizeHint().height();
    const QString name =
      child->objectName().isEmpty() ? QString::fromLatin1(child->metaObject()->className()) : child->objectName();
    if (child->height() < needed || (!wraps && child->width() < child->minimumSizeHint().width()))
    {
      faults << QStringLiteral("%1 is cut off (%2 x %3)").arg(name).arg(child->width()).arg(child->height());
    }
    if (child->parentWidget() && !child->parentWidget()->rect().adjusted(-1, -1, 1, 1).contains(child->geometry()))
    {
      faults << QStringLiteral("%1 reaches out of %2").arg(name, child->parentWidget()->objectName());
    }
  }
  return faults;
}
