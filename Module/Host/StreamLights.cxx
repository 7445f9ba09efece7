// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamLights.h"

#include "Icons.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>

#include <algorithm>
#include <limits>

namespace desktop
{
namespace
{

const QString stateTemplate = QStringLiteral("00 Hz, 000 ms");

QString ageText(double ageSec)
{
  return ageSec < 1 ? StreamLightWidget::tr("%1 ms").arg(qRound(ageSec * 1000))
                    : StreamLightWidget::tr("%1 s").arg(ageSec, 0, 'f', ageSec < 10 ? 1 : 0);
}

QString lightName(NavigationHost::StreamLight light)
{
  switch (light)
  {
    case NavigationHost::StreamLight::Live:
      return StreamLightWidget::tr("live");
    case NavigationHost::StreamLight::Stale:
      return StreamLightWidget::tr("stale");
    case NavigationHost::StreamLight::Lost:
      return StreamLightWidget::tr("lost");
  }
  return {};
}

}  // namespace

StreamLightWidget::StreamLightWidget(QWidget* parent)
  : QFrame(parent)
  , Sign(new QLabel)
  , Name(new QLabel)
  , State(new QLabel)
{
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(4, 0, 4, 0);
  row->setSpacing(4);
  row->addWidget(this->Sign);
  row->addWidget(this->Name);
  row->addWidget(this->State);
  this->Name->setTextFormat(Qt::PlainText);
  this->State->setTextFormat(Qt::PlainText);
  // Numbers that change do not push the neighbours about.
  this->State->setMinimumWidth(this->fontMetrics().horizontalAdvance(stateTemplate));
}

int StreamLightWidget::widthFor(const QString& name, const QFontMetrics& metrics)
{
  return 16 + metrics.ascent() + metrics.horizontalAdvance(name) + metrics.horizontalAdvance(stateTemplate);
}

QString StreamLightWidget::stateText(const NavigationHost::Stream& stream)
{
  QStringList words;
  if (stream.light != NavigationHost::StreamLight::Live)
  {
    words << lightName(stream.light);
  }
  if (stream.light == NavigationHost::StreamLight::Live && stream.rateHz > 0)
  {
    words << tr("%1 Hz").arg(stream.rateHz, 0, 'f', stream.rateHz < 9.95 ? 1 : 0);
  }
  if (stream.ageSec >= 0)
  {
    words << ageText(stream.ageSec);
  }
  return words.isEmpty() ? lightName(stream.light)
                         : words.join(stream.light == NavigationHost::StreamLight::Live ? tr(", ") : tr(" "));
}

QString StreamLightWidget::description(const NavigationHost::Stream& stream)
{
  QString text = tr("%1: %2").arg(stream.name, lightName(stream.light));
  if (stream.rateHz > 0)
  {
    text += tr(", %1 samples a second").arg(stream.rateHz, 0, 'f', 1);
  }
  if (stream.ageSec >= 0)
  {
    text += tr(", last one %1 ago").arg(ageText(stream.ageSec));
  }
  if (!stream.source.isEmpty())
  {
    text += tr("\nfrom %1").arg(stream.source);
  }
  return stream.message.isEmpty() ? text : text + QLatin1Char('\n') + stream.message;
}

void StreamLightWidget::setStream(const NavigationHost::Stream& stream)
{
  this->Sign->setPixmap(streamLightPixmap(stream.light, this->fontMetrics().ascent(), this->devicePixelRatioF()));
  this->Name->setText(stream.name);
  this->State->setText(stateText(stream));
  this->setToolTip(description(stream));
  this->setAccessibleName(description(stream));
}

StreamLights::StreamLights(QWidget* parent)
  : QWidget(parent)
  , Row(new QHBoxLayout(this))
{
  this->Row->setContentsMargins(0, 0, 0, 0);
  this->Row->setSpacing(4);
  this->setAccessibleName(tr("Streams"));
  if (parent)
  {
    parent->installEventFilter(this);
  }
}

bool StreamLights::eventFilter(QObject* watched, QEvent* event)
{
  if (event->type() == QEvent::Resize && watched == this->parent())
  {
    this->setStreams(QVector<NavigationHost::Stream>(this->Streams));
  }
  return this->QWidget::eventFilter(watched, event);
}

int StreamLights::countThatFits() const
{
  const QWidget* const bar = this->parentWidget();
  int room = bar ? bar->width() * 3 / 4 : std::numeric_limits<int>::max();
  int count = 0;
  for (const NavigationHost::Stream& stream : this->Streams)
  {
    room -= StreamLightWidget::widthFor(stream.name, this->fontMetrics()) + this->Row->spacing();
    if (room < 0)
    {
      break;
    }
    ++count;
  }
  return count;
}

void StreamLights::setStreams(const QVector<NavigationHost::Stream>& streams)
{
  this->Streams = streams;
  const int shown = this->countThatFits();
  while (this->Lights.size() > shown)
  {
    delete this->Lights.takeLast();
  }
  while (this->Lights.size() < shown)
  {
    this->Lights.append(new StreamLightWidget);
    this->Row->insertWidget(this->Lights.size() - 1, this->Lights.last());
  }
  for (int i = 0; i < shown; ++i)
  {
    this->Lights[i]->setStream(streams[i]);
  }
  delete this->Rest;
  this->Rest = nullptr;
  if (streams.size() > shown)
  {
    NavigationHost::Stream rest;
    rest.name = tr("+%1").arg(streams.size() - shown);
    rest.light = NavigationHost::StreamLight::Live;
    for (int i = shown; i < streams.size(); ++i)
    {
      rest.light = std::max(rest.light, streams[i].light);
      rest.message += (rest.message.isEmpty() ? QString() : QStringLiteral("\n")) + StreamLightWidget::description(streams[i]);
    }
    this->Rest = new StreamLightWidget;
    this->Row->addWidget(this->Rest);
    this->Rest->setStream(rest);
  }
}

}  // namespace desktop
