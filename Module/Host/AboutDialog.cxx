// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AboutDialog.h"

#include "ApplicationSetup.h"

#include <vtkVersion.h>

#include <QApplication>
#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QIcon>
#include <QLabel>
#include <QVBoxLayout>

namespace desktop
{

AboutDialog::AboutDialog(const QStringList& modules, QWidget* parent)
  : QDialog(parent)
{
  this->setWindowTitle(tr("About NavigationDesktop"));
  QString list;
  for (const QString& module : modules)
  {
    list += QStringLiteral("<li>%1</li>").arg(module.toHtmlEscaped());
  }
  auto* const text =
    new QLabel(tr("<h3>NavigationDesktop %1</h3>"
                  "<p>A desktop for modules of surgical navigation, written to the contract of 3D Slicer's loadable modules.</p>"
                  "<p><b>Not a medical device.</b> Research software: whoever uses it validates it.</p>"
                  "<p>Qt %2, VTK %3. BSD-3-Clause licence.</p>"
                  "<p>Modules:</p><ul>%4</ul>")
                 .arg(applicationVersion(), QString::fromLatin1(qVersion()), QString::fromLatin1(vtkVersion::GetVTKVersion()),
                   list.isEmpty() ? QStringLiteral("<li>%1</li>").arg(tr("none")) : list));
  text->setObjectName(QStringLiteral("AboutText"));
  text->setTextFormat(Qt::RichText);
  text->setWordWrap(true);
  text->setTextInteractionFlags(Qt::TextBrowserInteraction);
  auto* const logo = new QLabel;
  logo->setPixmap(QApplication::windowIcon().pixmap(64, 64));
  auto* const row = new QHBoxLayout;
  row->addWidget(logo, 0, Qt::AlignTop);
  row->addWidget(text, 1);
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* const layout = new QVBoxLayout(this);
  layout->addLayout(row);
  layout->addWidget(buttons);
  this->setMinimumWidth(480);
}

}  // namespace desktop
