// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SettingsDialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include <algorithm>

namespace desktop
{

DesktopSettings DesktopSettings::load()
{
  const QSettings stored;
  DesktopSettings settings;
  settings.theme = themeFromName(stored.value(QStringLiteral("Desktop/theme")).toString());
  settings.moduleFolders = stored.value(QStringLiteral("Desktop/moduleFolders")).toStringList();
  settings.startModule = stored.value(QStringLiteral("Desktop/startModule")).toString();
  settings.logLevel = qBound(0, stored.value(QStringLiteral("Desktop/logLevel"), 0).toInt(), 2);
  settings.showSplash = stored.value(QStringLiteral("Desktop/splash"), true).toBool();
  return settings;
}

void DesktopSettings::save() const
{
  QSettings stored;
  stored.setValue(QStringLiteral("Desktop/theme"), themeName(this->theme));
  stored.setValue(QStringLiteral("Desktop/moduleFolders"), this->moduleFolders);
  stored.setValue(QStringLiteral("Desktop/startModule"), this->startModule);
  stored.setValue(QStringLiteral("Desktop/logLevel"), this->logLevel);
  stored.setValue(QStringLiteral("Desktop/splash"), this->showSplash);
}

SettingsDialog::SettingsDialog(const DesktopSettings& settings, const QVector<QPair<QString, QString>>& modules, QWidget* parent)
  : QDialog(parent)
  , ThemeBox(new QComboBox)
  , Folders(new QListWidget)
  , StartModule(new QComboBox)
  , LogLevel(new QComboBox)
  , Splash(new QCheckBox(tr("Show a &picture while starting")))
{
  this->setWindowTitle(tr("Settings"));
  this->ThemeBox->setObjectName(QStringLiteral("Theme"));
  this->ThemeBox->addItem(tr("As the system"), themeName(Theme::System));
  this->ThemeBox->addItem(tr("Light"), themeName(Theme::Light));
  this->ThemeBox->addItem(tr("Dark"), themeName(Theme::Dark));
  this->ThemeBox->setCurrentIndex(this->ThemeBox->findData(themeName(settings.theme)));
  this->ThemeBox->setToolTip(tr("Colours of the desktop"));
  this->LogLevel->setObjectName(QStringLiteral("LogLevelSetting"));
  this->LogLevel->addItems({ tr("All"), tr("Warnings and errors"), tr("Errors") });
  this->LogLevel->setCurrentIndex(settings.logLevel);
  this->LogLevel->setToolTip(tr("Which lines the log window shows at first"));
  this->Splash->setChecked(settings.showSplash);

  auto* const look = new QGroupBox(tr("Appearance"));
  auto* const lookForm = new QFormLayout(look);
  lookForm->addRow(tr("&Theme:"), this->ThemeBox);
  lookForm->addRow(tr("&Log shows:"), this->LogLevel);
  lookForm->addRow(this->Splash);

  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* const layout = new QVBoxLayout(this);
  layout->addWidget(look);
  layout->addWidget(this->makeModulesPage(settings, modules), 1);
  layout->addWidget(buttons);
  this->resize(560, 460);
}

QWidget* SettingsDialog::makeModulesPage(const DesktopSettings& settings, const QVector<QPair<QString, QString>>& modules)
{
  this->StartModule->setObjectName(QStringLiteral("StartModule"));
  this->StartModule->setToolTip(tr("The module that is shown after the start"));
  this->StartModule->addItem(tr("The one of last time"), QString());
  for (const auto& module : modules)
  {
    this->StartModule->addItem(module.second, module.first);
  }
  this->StartModule->setCurrentIndex(std::max(0, this->StartModule->findData(settings.startModule)));
  this->Folders->setObjectName(QStringLiteral("ModuleFolders"));
  this->Folders->setAccessibleName(tr("Further folders of modules"));
  this->Folders->addItems(settings.moduleFolders);
  auto* const add = new QPushButton(tr("&Add..."));
  add->setToolTip(tr("Adds a folder in which modules are looked for"));
  connect(add, &QPushButton::clicked, this, &SettingsDialog::addFolder);
  auto* const remove = new QPushButton(tr("&Remove"));
  remove->setToolTip(tr("Takes the chosen folder off the list; its files stay"));
  connect(remove, &QPushButton::clicked, this, [this] { delete this->Folders->takeItem(this->Folders->currentRow()); });

  auto* const box = new QGroupBox(tr("Modules"));
  auto* const form = new QFormLayout;
  form->addRow(tr("&Start with:"), this->StartModule);
  auto* const label = new QLabel(tr("&Further folders of modules, used from the next start on:"));
  label->setBuddy(this->Folders);
  auto* const buttons = new QVBoxLayout;
  buttons->addWidget(add);
  buttons->addWidget(remove);
  buttons->addStretch(1);
  auto* const list = new QHBoxLayout;
  list->addWidget(this->Folders, 1);
  list->addLayout(buttons);
  auto* const layout = new QVBoxLayout(box);
  layout->addLayout(form);
  layout->addWidget(label);
  layout->addLayout(list, 1);
  return box;
}

void SettingsDialog::addFolder()
{
  const QString folder = QFileDialog::getExistingDirectory(this, tr("A folder of modules"));
  if (!folder.isEmpty() && this->Folders->findItems(folder, Qt::MatchExactly).isEmpty())
  {
    this->Folders->addItem(folder);
  }
}

DesktopSettings SettingsDialog::settings() const
{
  DesktopSettings settings;
  settings.theme = themeFromName(this->ThemeBox->currentData().toString());
  settings.startModule = this->StartModule->currentData().toString();
  settings.logLevel = this->LogLevel->currentIndex();
  settings.showSplash = this->Splash->isChecked();
  for (int row = 0; row < this->Folders->count(); ++row)
  {
    settings.moduleFolders << this->Folders->item(row)->text();
  }
  return settings;
}

}  // namespace desktop
