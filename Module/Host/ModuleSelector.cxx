// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModuleSelector.h"

#include "Icons.h"
#include "qSlicerAbstractModule.h"

#include <QAction>
#include <QCompleter>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QStandardItemModel>
#include <QToolButton>

#include <algorithm>

namespace desktop
{
namespace
{

QToolButton* toolButton(QAction* action)
{
  auto* const button = new QToolButton;
  button->setDefaultAction(action);
  button->setAutoRaise(true);
  return button;
}

}  // namespace

ModuleSelector::ModuleSelector(QWidget* parent)
  : QWidget(parent)
  , Button(new QToolButton)
  , Menu(new QMenu(this))
  , HistoryMenu(new QMenu(this))
  , Search(new QLineEdit)
  , Back(new QAction(tr("Previous module"), this))
  , Forward(new QAction(tr("Next module"), this))
  , Find(new QAction(tr("Find a module"), this))
  , HistoryButton(new QToolButton)
{
  this->Button->setObjectName(QStringLiteral("ModuleButton"));
  this->Button->setAccessibleName(tr("Modules by category"));
  this->Button->setToolTip(tr("Choose a module by its category"));
  this->Button->setPopupMode(QToolButton::InstantPopup);
  this->Button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  this->Button->setMenu(this->Menu);
  this->Button->setMinimumWidth(this->fontMetrics().averageCharWidth() * 26);
  this->Search->setObjectName(QStringLiteral("ModuleSearch"));
  this->Search->setPlaceholderText(tr("Find a module"));
  this->Search->setAccessibleName(tr("Find a module"));
  this->Search->setToolTip(tr("Type a part of a module's name or category, then Enter"));
  this->Search->setClearButtonEnabled(true);
  this->Search->setMaximumWidth(this->fontMetrics().averageCharWidth() * 26);
  connect(this->Search, &QLineEdit::returnPressed, this, &ModuleSelector::selectFound);
  this->makeHistoryActions();

  auto* const label = new QLabel(tr("&Module:"));
  label->setBuddy(this->Button);
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(4, 0, 4, 0);
  row->addWidget(label);
  row->addWidget(this->Button);
  row->addWidget(toolButton(this->Back));
  row->addWidget(toolButton(this->Forward));
  row->addWidget(this->HistoryButton);
  row->addWidget(this->Search);
  this->rebuildMenu();
  this->updateIcons();
  this->showCurrent();
}

void ModuleSelector::makeHistoryActions()
{
  this->Back->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_PageUp));
  this->Forward->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_PageDown));
  this->Find->setShortcut(QKeySequence::Find);
  this->HistoryButton->setObjectName(QStringLiteral("ModuleHistory"));
  this->HistoryButton->setMenu(this->HistoryMenu);
  this->HistoryButton->setPopupMode(QToolButton::InstantPopup);
  this->HistoryButton->setAutoRaise(true);
  this->HistoryButton->setAccessibleName(tr("Modules shown before"));
  this->HistoryButton->setToolTip(tr("Modules shown before"));
  connect(this->HistoryMenu, &QMenu::aboutToShow, this, &ModuleSelector::rebuildHistoryMenu);
  connect(this->Back, &QAction::triggered, this, &ModuleSelector::back);
  connect(this->Forward, &QAction::triggered, this, &ModuleSelector::forward);
  connect(this->Find, &QAction::triggered, this,
    [this]
    {
      this->Search->setFocus(Qt::ShortcutFocusReason);
      this->Search->selectAll();
    });
}

void ModuleSelector::updateIcons()
{
  this->Back->setIcon(icon(QStringLiteral("back")));
  this->Forward->setIcon(icon(QStringLiteral("forward")));
  this->HistoryButton->setIcon(icon(QStringLiteral("history")));
}

QString ModuleSelector::searchText(const qSlicerAbstractModule& module)
{
  return module.title() + QLatin1Char(' ') + module.name() + QLatin1Char(' ') + module.categories().join(QLatin1Char(' '));
}

void ModuleSelector::addModule(qSlicerAbstractModule* module)
{
  if (module->isHidden())
  {
    return;
  }
  this->Modules.append(module);
  // As in Slicer: those with an index first, then by title.
  const auto key = [](const qSlicerAbstractModule* m)
  { return std::make_pair(m->index() < 0 ? 1 << 30 : m->index(), m->title().toLower()); };
  std::sort(this->Modules.begin(), this->Modules.end(),
    [key](const qSlicerAbstractModule* a, const qSlicerAbstractModule* b) { return key(a) < key(b); });
  this->rebuildMenu();
  this->updateCompleter();
}

QMenu* ModuleSelector::categoryMenu(const QString& category)
{
  QMenu* menu = this->Menu;
  for (const QString& part : category.split(QLatin1Char('.'), Qt::SkipEmptyParts))
  {
    auto* child = menu->findChild<QMenu*>(part, Qt::FindDirectChildrenOnly);
    if (!child)
    {
      child = menu->addMenu(part);
      child->setObjectName(part);
    }
    menu = child;
  }
  return menu;
}

void ModuleSelector::rebuildMenu()
{
  this->Menu->clear();
  qDeleteAll(this->Menu->findChildren<QMenu*>(QString(), Qt::FindDirectChildrenOnly));
  for (qSlicerAbstractModule* const module : this->Modules)
  {
    const QStringList categories = module->categories();
    for (const QString& category : categories.isEmpty() ? QStringList{ QString() } : categories)
    {
      QAction* const action = this->categoryMenu(category)->addAction(module->icon(), module->title());
      action->setData(module->name());
      connect(action, &QAction::triggered, this, [this, name = module->name()] { this->select(name); });
    }
  }
  if (this->Modules.isEmpty())
  {
    this->Menu->addAction(tr("No modules were found"))->setEnabled(false);
  }
}

void ModuleSelector::updateCompleter()
{
  auto* const completer = new QCompleter(this);
  auto* const model = new QStandardItemModel(completer);
  for (const qSlicerAbstractModule* const module : this->Modules)
  {
    auto* const item = new QStandardItem(module->icon(), module->title());
    item->setData(searchText(*module), Qt::UserRole);
    item->setData(module->name(), Qt::UserRole + 1);
    model->appendRow(item);
  }
  completer->setModel(model);
  completer->setCompletionRole(Qt::UserRole);
  completer->setFilterMode(Qt::MatchContains);
  completer->setCaseSensitivity(Qt::CaseInsensitive);
  delete this->Search->completer();
  this->Search->setCompleter(completer);
  // Chosen from the list: the line would receive the text that was searched.
  connect(completer, QOverload<const QModelIndex&>::of(&QCompleter::activated), this,
    [this](const QModelIndex& index)
    {
      this->select(index.data(Qt::UserRole + 1).toString());
      QMetaObject::invokeMethod(this->Search, "clear", Qt::QueuedConnection);
    });
}

void ModuleSelector::selectFound()
{
  const QString wanted = this->Search->text().trimmed();
  if (wanted.isEmpty())
  {
    return;
  }
  const auto found = std::find_if(this->Modules.begin(), this->Modules.end(),
    [&](const qSlicerAbstractModule* module) { return searchText(*module).contains(wanted, Qt::CaseInsensitive); });
  if (found != this->Modules.end())
  {
    this->select((*found)->name());
    this->Search->clear();
  }
}

qSlicerAbstractModule* ModuleSelector::find(const QString& name) const
{
  for (qSlicerAbstractModule* const module : this->Modules)
  {
    if (module->name() == name)
    {
      return module;
    }
  }
  return nullptr;
}

QString ModuleSelector::currentModule() const
{
  return this->History.value(this->Position);
}

bool ModuleSelector::select(const QString& name)
{
  if (!this->find(name))
  {
    return false;
  }
  if (name != this->currentModule())
  {
    this->History = this->History.mid(0, this->Position + 1);
    this->History << name;
    this->goTo(this->History.size() - 1);
  }
  return true;
}

void ModuleSelector::back()
{
  this->goTo(this->Position - 1);
}

void ModuleSelector::forward()
{
  this->goTo(this->Position + 1);
}

void ModuleSelector::goTo(int position)
{
  if (position < 0 || position >= this->History.size())
  {
    return;
  }
  this->Position = position;
  this->showCurrent();
  emit this->moduleSelected(this->History[position]);
}

void ModuleSelector::showCurrent()
{
  const qSlicerAbstractModule* const module = this->find(this->currentModule());
  this->Button->setText(module ? module->title() : tr("Choose a module"));
  this->Button->setIcon(module ? module->icon() : QIcon());
  this->Back->setEnabled(this->Position > 0);
  this->Forward->setEnabled(this->Position + 1 < this->History.size());
  this->HistoryButton->setEnabled(!this->History.isEmpty());
}

void ModuleSelector::rebuildHistoryMenu()
{
  this->HistoryMenu->clear();
  QStringList seen;
  for (int i = this->History.size() - 1; i >= 0; --i)
  {
    const QString name = this->History[i];
    const qSlicerAbstractModule* const module = this->find(name);
    if (module && !seen.contains(name))
    {
      seen << name;
      connect(this->HistoryMenu->addAction(module->icon(), module->title()), &QAction::triggered, this,
        [this, name] { this->select(name); });
    }
  }
}

}  // namespace desktop
