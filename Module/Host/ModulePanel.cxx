// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModulePanel.h"

#include "qSlicerAbstractModule.h"
#include "qSlicerAbstractModuleWidget.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QStyle>
#include <QTextBrowser>
#include <QToolButton>
#include <QVBoxLayout>

#include <exception>

namespace desktop
{

ModulePanel::ModulePanel(QWidget* parent)
  : QWidget(parent)
  , Icon(new QLabel)
  , Title(new QLabel)
  , HelpButton(new QToolButton)
  , Help(new QTextBrowser)
  , Area(new QScrollArea)
{
  QFont font = this->Title->font();
  font.setBold(true);
  this->Title->setFont(font);
  this->Title->setTextFormat(Qt::PlainText);
  this->HelpButton->setText(tr("Help && acknowledgement"));
  this->HelpButton->setObjectName(QStringLiteral("ModuleHelpButton"));
  this->HelpButton->setToolTip(tr("What this module is for, who made it, and whom it thanks"));
  this->HelpButton->setCheckable(true);
  this->HelpButton->setAutoRaise(true);
  this->HelpButton->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  this->HelpButton->setArrowType(Qt::RightArrow);
  this->Help->setObjectName(QStringLiteral("ModuleHelp"));
  this->Help->setAccessibleName(tr("Help of the module"));
  this->Help->setOpenExternalLinks(true);
  this->Help->setMaximumHeight(220);
  this->Help->hide();
  connect(this->HelpButton, &QToolButton::toggled, this,
    [this](bool on)
    {
      this->Help->setVisible(on);
      this->HelpButton->setArrowType(on ? Qt::DownArrow : Qt::RightArrow);
    });
  this->Area->setWidgetResizable(true);
  this->Area->setFrameShape(QFrame::NoFrame);

  auto* const header = new QHBoxLayout;
  header->setContentsMargins(6, 4, 6, 0);
  header->addWidget(this->Icon);
  header->addWidget(this->Title, 1);
  header->addWidget(this->HelpButton);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addLayout(header);
  layout->addWidget(this->Help);
  layout->addWidget(this->Area, 1);
  this->setModule(nullptr);
}

ModulePanel::~ModulePanel()
{
  this->leave();
}

void ModulePanel::leave()
{
  if (!this->Panel)
  {
    return;
  }
  this->Panel->exit();
  // A scroll area deletes the widget it shows: this one is kept for the next time.
  this->Area->takeWidget();
  this->Panel->setParent(this);
  this->Panel->hide();
  this->Panel = nullptr;
}

void ModulePanel::showHelp(const qSlicerAbstractModule& module)
{
  QString text = module.helpText();
  if (!module.contributors().isEmpty())
  {
    text += tr("<p><b>Contributors:</b> %1</p>").arg(module.contributors().join(QStringLiteral(", ")).toHtmlEscaped());
  }
  if (!module.acknowledgementText().isEmpty())
  {
    text += tr("<p><b>Acknowledgement:</b> %1</p>").arg(module.acknowledgementText());
  }
  this->Help->setHtml(text);
}

void ModulePanel::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && this->Module)
  {
    this->showHelp(*this->Module);  // its links have the colour that they were set with
  }
}

QString ModulePanel::setModule(qSlicerAbstractModule* module)
{
  this->leave();
  this->Module = module;
  this->HelpButton->setVisible(module != nullptr);
  this->Title->setText(module ? module->title() : tr("No module"));
  this->Icon->setPixmap(module ? module->icon().pixmap(24, 24) : QPixmap());
  if (!module)
  {
    this->HelpButton->setChecked(false);
    return {};
  }
  this->showHelp(*module);
  try
  {
    this->Panel = dynamic_cast<qSlicerAbstractModuleWidget*>(module->widgetRepresentation());
  }
  catch (const std::exception& error)
  {
    return tr("The panel of the module \"%1\" could not be made: %2").arg(module->title(), QString::fromUtf8(error.what()));
  }
  if (this->Panel)
  {
    this->Area->setWidget(this->Panel);
    // Nothing is cut off to the side, whether there is a scroll bar or not.
    this->Area->setMinimumWidth(
      this->Panel->minimumSizeHint().width() + this->style()->pixelMetric(QStyle::PM_ScrollBarExtent, nullptr, this));
    this->Panel->show();
    this->Panel->enter();
  }
  return {};
}

}  // namespace desktop
