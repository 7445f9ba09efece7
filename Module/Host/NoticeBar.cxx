// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoticeBar.h"

#include "Icons.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

namespace desktop
{

NoticeBar::NoticeBar(QWidget* parent)
  : QFrame(parent)
  , Text(new QLabel)
{
  this->setObjectName(QStringLiteral("NoticeBar"));
  this->setFrameShape(QFrame::StyledPanel);
  this->Text->setObjectName(QStringLiteral("NoticeText"));
  this->Text->setTextFormat(Qt::PlainText);
  this->Text->setWordWrap(true);
  this->Text->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* const sign = new QLabel;
  sign->setPixmap(levelIcon(NavigationHost::LogLevel::Warning).pixmap(16, 16));
  auto* const details = new QPushButton(tr("Show &log"));
  details->setToolTip(tr("Opens the log, which says more"));
  auto* const close = new QPushButton(tr("&Dismiss"));
  close->setToolTip(tr("Takes this notice away"));
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(8, 4, 8, 4);
  row->addWidget(sign, 0, Qt::AlignTop);
  row->addWidget(this->Text, 1);
  row->addWidget(details, 0, Qt::AlignTop);
  row->addWidget(close, 0, Qt::AlignTop);
  connect(details, &QPushButton::clicked, this, &NoticeBar::detailsRequested);
  connect(close, &QPushButton::clicked, this, &NoticeBar::dismiss);
  this->hide();
}

void NoticeBar::addNotice(const QString& text)
{
  this->Text->setText(this->Text->text().isEmpty() ? text : this->Text->text() + QLatin1Char('\n') + text);
  this->setAccessibleName(this->Text->text());
  this->show();
}

QString NoticeBar::text() const
{
  return this->Text->text();
}

void NoticeBar::dismiss()
{
  this->Text->clear();
  this->hide();
}

}  // namespace desktop
