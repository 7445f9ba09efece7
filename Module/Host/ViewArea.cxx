// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ViewArea.h"

#include "SceneView.h"

#include <QLabel>
#include <QSplitter>
#include <QStackedLayout>
#include <QVBoxLayout>

namespace desktop
{

VideoView::VideoView(QWidget* parent)
  : QWidget(parent)
  , Stack(new QStackedLayout(this))
{
  this->setObjectName(QStringLiteral("VideoView"));
  this->setMinimumSize(160, 120);
  auto* const words = new QLabel(tr("No video\n\nA module that receives video shows it here."));
  words->setObjectName(QStringLiteral("NoVideo"));
  words->setAlignment(Qt::AlignCenter);
  words->setWordWrap(true);
  words->setForegroundRole(QPalette::PlaceholderText);
  words->setBackgroundRole(QPalette::Base);
  words->setAutoFillBackground(true);
  words->setFrameShape(QFrame::StyledPanel);
  this->Stack->addWidget(words);
}

VideoView::~VideoView()
{
  this->setWidget(nullptr);
}

void VideoView::setWidget(QWidget* widget)
{
  if (this->Widget == widget)
  {
    return;
  }
  if (this->Widget)
  {
    this->Stack->removeWidget(this->Widget);
    this->Widget->hide();
    this->Widget->setParent(nullptr);
  }
  this->Widget = widget;
  if (widget)
  {
    this->Stack->addWidget(widget);
    this->Stack->setCurrentWidget(widget);
    widget->show();
  }
  else
  {
    this->Stack->setCurrentIndex(0);
  }
}

ViewArea::ViewArea(QWidget* parent)
  : QWidget(parent)
  , Splitter(new QSplitter(Qt::Horizontal))
  , Video(new VideoView)
  , Scene(new SceneView)
{
  this->Splitter->addWidget(this->Video);
  this->Splitter->addWidget(this->Scene);
  this->Splitter->setChildrenCollapsible(false);
  this->Splitter->setStretchFactor(0, 1);
  this->Splitter->setStretchFactor(1, 1);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Splitter);
}

void ViewArea::setLayoutKind(Layout layout)
{
  this->Kind = layout;
  this->Video->setVisible(layout != SceneOnly);
  this->Scene->setVisible(layout != VideoOnly);
  const Qt::Orientation orientation = layout == Stacked ? Qt::Vertical : Qt::Horizontal;
  if (this->Splitter->orientation() != orientation)
  {
    this->Splitter->setOrientation(orientation);
    this->Splitter->setSizes({ 1000, 1000 });
  }
}

QByteArray ViewArea::saveState() const
{
  return this->Splitter->saveState();
}

void ViewArea::restoreState(const QByteArray& state)
{
  this->Splitter->restoreState(state);
  // The layout says which way it lies.
  this->Splitter->setOrientation(this->Kind == Stacked ? Qt::Vertical : Qt::Horizontal);
}

}  // namespace desktop
