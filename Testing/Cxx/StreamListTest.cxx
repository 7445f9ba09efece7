// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamList.h"

#include "WidgetTestSupport.h"

#include <QComboBox>
#include <QSignalSpy>
#include <QTableWidget>

using namespace handeye;

namespace
{

using Light = StreamList::Light;
using Role = StreamList::Role;
using Stream = StreamList::Stream;
using Type = StreamList::Type;

Stream streamOf(const char* name, Type type, Light light, double ageSec = 0.02)
{
  return { QString::fromLatin1(name), QStringLiteral("127.0.0.1:18944"), type, light, 60, ageSec, {} };
}

QVector<Stream> threeStreams()
{
  return { streamOf("StylusToTracker", Type::Transform, Light::Live), streamOf("MarkerToTracker", Type::Transform, Light::Live),
    streamOf("Image", Type::Video, Light::Live) };
}

QStringList namesIn(const QComboBox* box)
{
  QStringList names;
  for (int row = 0; row < box->count(); ++row)
  {
    names += box->itemText(row);
  }
  return names;
}

}  // namespace

class StreamListTest : public QObject
{
  Q_OBJECT

private slots:
  void EachRole_OffersTheStreamsOfItsKind()
  {
    StreamList list;
    list.setStreams(threeStreams());
    QCOMPARE(namesIn(list.choiceBox(Role::Stylus)),
      (QStringList{ QStringLiteral("(choose)"), QStringLiteral("StylusToTracker"), QStringLiteral("MarkerToTracker") }));
    QCOMPARE(namesIn(list.choiceBox(Role::Video)), (QStringList{ QStringLiteral("(choose)"), QStringLiteral("Image") }));
    QCOMPARE(namesIn(list.choiceBox(Role::RightVideo)), (QStringList{ QStringLiteral("(none)"), QStringLiteral("Image") }));
    QCOMPARE(namesIn(list.choiceBox(Role::Phantom))[0], QStringLiteral("(none)"));
  }

  void APerson_ChoosesByKeyboard_AProgramDoesNotSpeakForThem()
  {
    StreamList list;
    list.setStreams(threeStreams());
    testing_widgets::show(list, { 640, 320 });
    QSignalSpy chosen(&list, &StreamList::choiceChanged);
    list.setChoice(Role::Video, QStringLiteral("Image"));
    QCOMPARE(chosen.count(), 0);
    QCOMPARE(list.choice(Role::Video), QStringLiteral("Image"));
    QComboBox* box = list.choiceBox(Role::CameraMarker);
    box->setFocus();
    QTest::keyClick(box, Qt::Key_Down);
    QTest::keyClick(box, Qt::Key_Down);
    QCOMPARE(list.choice(Role::CameraMarker), QStringLiteral("MarkerToTracker"));
    QVERIFY(chosen.count() >= 1);
    QCOMPARE(chosen.last()[0].value<Role>(), Role::CameraMarker);
    QCOMPARE(chosen.last()[1].toString(), QStringLiteral("MarkerToTracker"));
  }

  void AChoice_OutlivesItsStream_AndSaysSo()
  {
    StreamList list;
    list.setStreams(threeStreams());
    list.setChoice(Role::Stylus, QStringLiteral("StylusToTracker"));
    QVector<Stream> fewer = threeStreams();
    fewer.removeFirst();
    list.setStreams(fewer);
    QCOMPARE(list.choice(Role::Stylus), QStringLiteral("StylusToTracker"));
    QCOMPARE(list.choiceBox(Role::Stylus)->currentText(), QStringLiteral("StylusToTracker (not there)"));
    list.setStreams(threeStreams());
    QCOMPARE(list.choiceBox(Role::Stylus)->currentText(), QStringLiteral("StylusToTracker"));
  }

  void TheTable_ShowsStateInWordsAndShape()
  {
    StreamList list;
    QVector<Stream> streams = threeStreams();
    streams[1].light = Light::Stale;
    streams[1].message = QStringLiteral("the tool is not seen");
    streams[2] = streamOf("Image", Type::Video, Light::Lost, -1);
    list.setStreams(streams);
    const auto* table = list.findChild<QTableWidget*>();
    QCOMPARE(table->item(0, 0)->text(), QStringLiteral("live"));
    QCOMPARE(table->item(1, 0)->text(), QStringLiteral("stale"));
    QCOMPARE(table->item(2, 0)->text(), QStringLiteral("lost"));
    QCOMPARE(table->item(1, 5)->text(), QStringLiteral("the tool is not seen"));
    QCOMPARE(table->item(0, 3)->text(), QStringLiteral("60.0"));
    QCOMPARE(table->item(2, 4)->text(), QStringLiteral("\u2013"));
    QVERIFY(table->item(1, 1)->toolTip().contains(QStringLiteral("127.0.0.1:18944")));
    QList<QImage> shapes;
    for (const Light light : { Light::Live, Light::Stale, Light::Lost })
    {
      shapes += StreamList::lightIcon(light).pixmap(24, 24).toImage().convertToFormat(QImage::Format_Alpha8);
    }
    QVERIFY(shapes[0] != shapes[1] && shapes[1] != shapes[2] && shapes[0] != shapes[2]);
  }

  void AnOpenList_IsNotDisturbedByNewRates()
  {
    StreamList list;
    list.setStreams(threeStreams());
    testing_widgets::show(list, { 640, 320 });
    QComboBox* box = list.choiceBox(Role::Stylus);
    QSignalSpy inserted(box->model(), &QAbstractItemModel::rowsInserted), removed(box->model(), &QAbstractItemModel::rowsRemoved);
    for (int step = 0; step < 5; ++step)
    {
      QVector<Stream> streams = threeStreams();
      streams[0].rateHz = 50 + step;
      list.setStreams(streams);
    }
    QCOMPARE(inserted.count() + removed.count(), 0);
  }
};

HANDEYE_WIDGET_TEST_MAIN(StreamListTest)
#include "StreamListTest.moc"
