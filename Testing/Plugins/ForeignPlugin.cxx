// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A Qt plugin that is no module: by its interface, or in spite of it. If it is ever instantiated, the environment tells.
#include <QObject>
#include <QtPlugin>

class ForeignPlugin : public QObject
{
  Q_OBJECT
  Q_PLUGIN_METADATA(IID PLUGIN_IID)

public:
  ForeignPlugin() { qputenv("FOREIGN_PLUGIN_WAS_MADE", PLUGIN_IID); }
};

#include "ForeignPlugin.moc"
