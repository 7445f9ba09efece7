// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamList.h"

#include "Look.h"

#include <QComboBox>
#include <QFormLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QSignalBlocker>
#include <QTableWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <array>

namespace handeye
{

namespace
{

enum Column
{
  LightColumn,
  NameColumn,
  TypeColumn,
  RateColumn,
  AgeColumn,
  MessageColumn,
  ColumnCount
};

QString typeWord(StreamList::Type type)
{
  switch (type)
  {
    case StreamList::Type::Transform:
      return StreamList::tr("transform");
    case StreamList::Type::Video:
      return StreamList::tr("video");
    case StreamList::Type::Other:
      break;
  }
  return StreamList::tr("other");
}

StreamList::Type typeOf(StreamList::Role role)
{
  return role == StreamList::Role::Video || role == StreamList::Role::RightVideo ? StreamList::Type::Video
                                                                                 : StreamList::Type::Transform;
}

/// "0.02", "3.1", "75": as many digits as one can read while they change.
QString ageText(double seconds)
{
  return seconds < 0 ? QString(QChar(0x2013)) : QLocale().toString(seconds, 'f', seconds < 1 ? 2 : seconds < 10 ? 1 : 0);
}

}  // namespace

class StreamList::Private
{
public:
  void setUpTable(StreamList& list);
  void fill(Role role);
  void showRow(int row, const Stream& stream) const;
  const Stream* find(const QString& name) const
  {
    const auto found = std::find_if(streams.begin(), streams.end(), [&](const Stream& stream) { return stream.name == name; });
    return found == streams.end() ? nullptr : &*found;
  }

  QTableWidget* table = nullptr;
  QLabel* nothing = nullptr;
  std::array<QComboBox*, RoleCount> boxes{};
  std::array<QString, RoleCount> choices;
  QVector<Stream> streams;
};

void StreamList::Private::showRow(int row, const Stream& stream) const
{
  const QString texts[ColumnCount] = { StreamList::lightWord(stream.light), stream.name, typeWord(stream.type),
    stream.rateHz > 0 ? QLocale().toString(stream.rateHz, 'f', 1) : QString(QChar(0x2013)), ageText(stream.ageSec),
    stream.message };
  QStringList about = { stream.name, stream.source.isEmpty() ? QString() : StreamList::tr("from %1").arg(stream.source),
    typeWord(stream.type), StreamList::lightWord(stream.light), stream.message };
  about.removeAll(QString());
  for (int column = 0; column < ColumnCount; ++column)
  {
    QTableWidgetItem* item = table->item(row, column);
    if (!item)
    {
      item = new QTableWidgetItem();
      table->setItem(row, column, item);
    }
    const bool isNumber = column == RateColumn || column == AgeColumn;
    item->setTextAlignment(int((isNumber ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter));
    item->setText(texts[column]);
    item->setToolTip(about.join(QLatin1Char('\n')));
  }
  table->item(row, LightColumn)->setIcon(StreamList::lightIcon(stream.light));
}

/// The streams of the role's type, what was chosen even if it is not there, and nothing where that is allowed.
void StreamList::Private::fill(Role role)
{
  const auto index = std::size_t(role);
  QComboBox* box = boxes[index];
  QStringList names, labels;
  names += QString();
  labels += role == Role::Phantom || role == Role::RightVideo ? StreamList::tr("(none)") : StreamList::tr("(choose)");
  for (const Stream& stream : streams)
  {
    if (stream.type == typeOf(role))
    {
      names += stream.name;
      labels += stream.name;
    }
  }
  if (!choices[index].isEmpty() && !names.contains(choices[index]))
  {
    names += choices[index];
    labels += StreamList::tr("%1 (not there)").arg(choices[index]);
  }
  const QSignalBlocker blocker(box);
  bool isSame = box->count() == labels.size();
  for (int row = 0; isSame && row < labels.size(); ++row)
  {
    isSame = box->itemText(row) == labels[row] && box->itemData(row).toString() == names[row];
  }
  if (!isSame)
  {
    box->clear();
    for (int row = 0; row < labels.size(); ++row)
    {
      box->addItem(labels[row], names[row]);
    }
  }
  box->setCurrentIndex(std::max(0, names.indexOf(choices[index])));
  for (int row = 1; row < labels.size(); ++row)
  {
    const Stream* stream = this->find(names[row]);
    const Light light = stream ? stream->light : Light::Lost;
    if (box->itemData(row, Qt::UserRole + 1) != QVariant(int(light)))
    {
      box->setItemData(row, int(light), Qt::UserRole + 1);
      box->setItemIcon(row, StreamList::lightIcon(light));
    }
  }
}

void StreamList::Private::setUpTable(StreamList& list)
{
  table = new QTableWidget(0, ColumnCount, &list);
  table->setAccessibleName(StreamList::tr("Streams"));
  table->setHorizontalHeaderLabels({ StreamList::tr("State"), StreamList::tr("Stream"), StreamList::tr("Type"),
    StreamList::tr("Rate [Hz]"), StreamList::tr("Age [s]"), StreamList::tr("Message") });
  const QStringList toolTips = {
    StreamList::tr("Live: arriving. Stale: nothing new for a while, or its tool is hidden. Lost: its source is gone."),
    StreamList::tr("Name of the stream, as its source gives it"), StreamList::tr("What the stream carries"),
    StreamList::tr("Samples a second"), StreamList::tr("Time since the last sample, s"),
    StreamList::tr("Why the stream is not live")
  };
  for (int column = 0; column < ColumnCount; ++column)
  {
    table->horizontalHeaderItem(column)->setToolTip(toolTips[column]);
  }
  table->verticalHeader()->hide();
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table->setSelectionBehavior(QAbstractItemView::SelectRows);
  table->setTabKeyNavigation(false);
  table->setShowGrid(false);
  table->setWordWrap(false);
  table->setAlternatingRowColors(true);
  table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table->horizontalHeader()->setSectionResizeMode(MessageColumn, QHeaderView::Stretch);
  table->horizontalHeader()->setHighlightSections(false);
}

StreamList::StreamList(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>())
{
  qRegisterMetaType<handeye::StreamList::Role>("handeye::StreamList::Role");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  d->setUpTable(*this);
  layout->addWidget(d->table, 1);
  d->nothing = new QLabel(tr("No stream arrives yet."), this);
  d->nothing->setAlignment(Qt::AlignCenter);
  layout->addWidget(d->nothing);

  auto* form = new QFormLayout();
  const QString titles[RoleCount] = { tr("&Stylus"), tr("&Camera's marker"), tr("P&hantom"), tr("&Video"),
    tr("&Right eye's video") };
  const QString uses[RoleCount] = { tr("Transform of the stylus: StylusToTracker, mm"),
    tr("Transform of the marker on the camera: MarkerToTracker, mm"),
    tr("Transform of the marker on the phantom: PhantomToTracker, mm; only the overlay needs it"), tr("The camera's images"),
    tr("The images of a stereo rig's right eye; only the overlay for two eyes needs them") };
  for (int role = 0; role < RoleCount; ++role)
  {
    auto* box = new QComboBox(this);
    box->setToolTip(uses[role]);
    box->setAccessibleName(QString(titles[role]).remove(QLatin1Char('&')));
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(8);
    box->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    d->boxes[std::size_t(role)] = box;
    form->addRow(titles[role], box);
    d->fill(Role(role));
    connect(box, QOverload<int>::of(&QComboBox::activated), this,
      [this, role, box](int row)
      {
        const QString name = box->itemData(row).toString();
        if (name != d->choices[std::size_t(role)])
        {
          d->choices[std::size_t(role)] = name;
          emit choiceChanged(Role(role), name);
        }
      });
  }
  layout->addLayout(form);
}

StreamList::~StreamList() = default;

void StreamList::setStreams(const QVector<Stream>& streams)
{
  d->streams = streams;
  d->nothing->setVisible(streams.isEmpty());
  d->table->setRowCount(streams.size());
  // As high as its rows: what follows is not pushed out of a low window.
  constexpr int MostRows = 8;
  const int rows = std::clamp(streams.size(), 2, MostRows);
  d->table->setFixedHeight(d->table->horizontalHeader()->sizeHint().height() +
    rows * d->table->verticalHeader()->defaultSectionSize() + 2 * d->table->frameWidth());
  for (int row = 0; row < streams.size(); ++row)
  {
    d->showRow(row, streams[row]);
  }
  for (int role = 0; role < RoleCount; ++role)
  {
    d->fill(Role(role));
  }
}

QString StreamList::choice(Role role) const
{
  return d->choices[std::size_t(role)];
}

void StreamList::setChoice(Role role, const QString& name)
{
  d->choices[std::size_t(role)] = name;
  d->fill(role);
}

QComboBox* StreamList::choiceBox(Role role) const
{
  return d->boxes[std::size_t(role)];
}

QSize StreamList::minimumSizeHint() const
{
  return { 260, QWidget::minimumSizeHint().height() };
}

void StreamList::resizeEvent(QResizeEvent* event)
{
  QWidget::resizeEvent(event);
  // In a narrow panel the message is worth more than the type, which the tooltip says too.
  d->table->setColumnHidden(TypeColumn, this->width() < 28 * this->fontMetrics().averageCharWidth() + 260);
}

QIcon StreamList::lightIcon(Light light)
{
  switch (light)
  {
    case Light::Live:
      return icon(QStringLiteral("stream-live"));
    case Light::Stale:
      return icon(QStringLiteral("stream-stale"));
    case Light::Lost:
      break;
  }
  return icon(QStringLiteral("stream-lost"));
}

QString StreamList::lightWord(Light light)
{
  switch (light)
  {
    case Light::Live:
      return tr("live");
    case Light::Stale:
      return tr("stale");
    case Light::Lost:
      break;
  }
  return tr("lost");
}

}  // namespace handeye
