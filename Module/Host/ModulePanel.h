// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QWidget>

class QLabel;
class QScrollArea;
class QTextBrowser;
class QToolButton;
class qSlicerAbstractModule;
class qSlicerAbstractModuleWidget;

namespace desktop
{

/// Shows one module at a time: icon and title, its help and acknowledgement behind a button, and its panel, which scrolls.
///
/// The panel is made when the module is shown for the first time, and told enter() and exit() as 3D Slicer does. Panels become children
/// of this widget.
class ModulePanel : public QWidget
{
  Q_OBJECT

public:
  explicit ModulePanel(QWidget* parent = nullptr);
  ~ModulePanel() override;

  /// Null: none. @return an empty string, or why the panel of this module could not be made; the one before is left then all the same.
  QString setModule(qSlicerAbstractModule* module);
  qSlicerAbstractModule* module() const { return this->Module; }

protected:
  void changeEvent(QEvent* event) override;

private:
  void leave();
  void showHelp(const qSlicerAbstractModule& module);

  qSlicerAbstractModule* Module = nullptr;
  qSlicerAbstractModuleWidget* Panel = nullptr;
  QLabel* Icon;
  QLabel* Title;
  QToolButton* HelpButton;
  QTextBrowser* Help;
  QScrollArea* Area;
};

}  // namespace desktop
