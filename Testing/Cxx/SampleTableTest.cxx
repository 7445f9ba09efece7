// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTable.h"

#include "WidgetTestSupport.h"

#include <QHeaderView>
#include <QScrollBar>
#include <QSignalSpy>
#include <QTableView>
#include <QToolButton>
#include <QUndoStack>

#include <algorithm>
#include <stdexcept>

using namespace handeye;

namespace
{

using Model = SampleTableModel;

QVector<SampleRow> fiveRows()
{
  QVector<SampleRow> rows;
  for (int id = 0; id < 5; ++id)
  {
    SampleRow row;
    row.id = id;
    row.used = true;
    row.status = QStringLiteral("ok");
    row.level = Level::Good;
    row.thumbnail = QImage(64, 48, QImage::Format_RGB32);
    row.thumbnail.fill(Qt::red);
    row.residualPx = 0.1 * ((id * 3) % 5 + 1);
    row.distanceMm = 200 + 10 * id;
    rows.append(row);
  }
  return rows;
}

void setResidual(QVector<SampleRow>& rows, int id, const std::optional<double>& residualPx)
{
  for (SampleRow& row : rows)
  {
    row.residualPx = row.id == id ? residualPx : row.residualPx;
  }
}

/// What an engine does with the table's requests: applies them to its own list and shows it again.
class Owner
{
public:
  explicit Owner(SampleTable& table)
    : table_(table)
    , rows_(fiveRows())
  {
    table.setRows(rows_);
    QObject::connect(&table, &SampleTable::excludeRequested, &table,
      [this](const QVector<int>& ids, bool excluded)
      {
        for (SampleRow& row : rows_)
        {
          row.excluded = ids.contains(row.id) ? excluded : row.excluded;
        }
        table_.setRows(rows_);
      });
    QObject::connect(&table, &SampleTable::deleteRequested, &table,
      [this](const QVector<int>& ids)
      {
        for (const int id : ids)
        {
          const auto row = std::find_if(rows_.begin(), rows_.end(), [id](const SampleRow& one) { return one.id == id; });
          gone_.append(*row);
          rows_.erase(row);
        }
        table_.setRows(rows_);
      });
    QObject::connect(&table, &SampleTable::restoreRequested, &table,
      [this](const QVector<int>& ids)
      {
        for (const int id : ids)
        {
          const auto row = std::find_if(gone_.begin(), gone_.end(), [id](const SampleRow& one) { return one.id == id; });
          rows_.append(*row);
          gone_.erase(row);
        }
        table_.setRows(rows_);
      });
  }

private:
  SampleTable& table_;
  QVector<SampleRow> rows_, gone_;
};

QVector<int> idsOf(const SampleTable& table)
{
  QVector<int> ids;
  for (int row = 0; row < table.view()->model()->rowCount(); ++row)
  {
    ids.append(table.view()->model()->index(row, Model::Id).data(Model::SortRole).toInt());
  }
  return ids;
}

bool isExcluded(const SampleTable& table, int id)
{
  const auto found = std::find_if(table.rows().begin(), table.rows().end(), [id](const SampleRow& row) { return row.id == id; });
  return found->excluded;
}

void showWithKeyboard(SampleTable& table)
{
  testing_widgets::show(table, { 640, 400 });
  table.view()->setFocus();
  QTRY_VERIFY(table.view()->hasFocus());
}

QToolButton* buttonOf(SampleTable& table, const QString& name)
{
  for (QToolButton* button : table.findChildren<QToolButton*>())
  {
    if (button->accessibleName() == name)
    {
      return button;
    }
  }
  return nullptr;
}

}  // namespace

class SampleTableTest : public QObject
{
  Q_OBJECT

private slots:
  void TheCheckBox_ExcludesAndUndoBringsBack()
  {
    SampleTable table;
    const Owner owner(table);
    showWithKeyboard(table);
    const QModelIndex box = table.view()->model()->index(2, Model::Use);
    QSignalSpy requests(&table, &SampleTable::excludeRequested);
    // A click on the box itself, as a person does it.
    const QRect cell = table.view()->visualRect(box);
    QTest::mouseClick(table.view()->viewport(), Qt::LeftButton, {}, { cell.left() + 10, cell.center().y() });
    QCOMPARE(requests.count(), 1);
    QCOMPARE(requests[0][0].value<QVector<int>>(), QVector<int>{ 2 });
    QCOMPARE(requests[0][1].toBool(), true);
    QVERIFY(isExcluded(table, 2));
    QCOMPARE(box.data(Qt::CheckStateRole).toInt(), int(Qt::Unchecked));
    QTest::keyClick(table.view(), Qt::Key_Z, Qt::ControlModifier);
    QVERIFY(!isExcluded(table, 2));
    QTest::keyClick(table.view(), Qt::Key_Y, Qt::ControlModifier);
    QVERIFY(isExcluded(table, 2));
  }

  void Delete_UndoRedo_ByKeysAndButtons()
  {
    SampleTable table;
    const Owner owner(table);
    showWithKeyboard(table);
    QVERIFY(!buttonOf(table, QStringLiteral("Undo"))->isEnabled());
    table.selectSample(1);
    QTest::keyClick(table.view(), Qt::Key_Delete);
    QCOMPARE(idsOf(table), (QVector<int>{ 0, 2, 3, 4 }));
    QTest::mouseClick(buttonOf(table, QStringLiteral("Undo")), Qt::LeftButton);
    QCOMPARE(idsOf(table), (QVector<int>{ 0, 1, 2, 3, 4 }));
    QTest::mouseClick(buttonOf(table, QStringLiteral("Redo")), Qt::LeftButton);
    QCOMPARE(idsOf(table), (QVector<int>{ 0, 2, 3, 4 }));
    QVERIFY(!buttonOf(table, QStringLiteral("Redo"))->isEnabled());
  }

  void AHistoryOfSeveralSteps_IsUndoneInReverse()
  {
    SampleTable table;
    const Owner owner(table);
    showWithKeyboard(table);
    table.selectSample(0);
    table.excludeSelected(true);
    table.selectSample(4);
    table.deleteSelected();
    table.selectSample(0);
    table.excludeSelected(false);
    QCOMPARE(table.undoStack()->count(), 3);
    table.undo();
    QVERIFY(isExcluded(table, 0));
    table.undo();
    QCOMPARE(idsOf(table).size(), 5);
    table.undo();
    QVERIFY(!isExcluded(table, 0));
    table.undo();
    QCOMPARE(idsOf(table).size(), 5);
    table.redo();
    table.redo();
    QCOMPARE(idsOf(table), (QVector<int>{ 0, 1, 2, 3 }));
    table.clearHistory();
    QVERIFY(!table.undoStack()->canUndo() && !table.undoStack()->canRedo());
  }

  void Numbers_BeginWithOne_AndTheTooltipHasTheFilesNumber()
  {
    SampleTable table;
    table.setRows(fiveRows());
    const QModelIndex first = table.view()->model()->index(0, Model::Id);
    QCOMPARE(first.data().toString(), QStringLiteral("1"));
    QVERIFY2(first.data(Qt::ToolTipRole).toString().contains(QStringLiteral("frame 0")),
      qPrintable(first.data(Qt::ToolTipRole).toString()));
  }

  void ASampleThatIsLeftOut_SaysWhatItWasBefore_IfThatIsKnown()
  {
    SampleTableModel model;
    QVector<SampleRow> rows = fiveRows();
    rows[1].excluded = rows[2].excluded = true;
    rows[1].status = QStringLiteral("disagrees with the others");
    rows[2].status.clear();
    model.setRows(rows);
    const auto tip = [&model](int row) { return model.index(row, Model::Status).data(Qt::ToolTipRole).toString(); };
    QCOMPARE(tip(0), QStringLiteral("ok"));
    QCOMPARE(tip(1), QStringLiteral("Left out on request. Before: disagrees with the others"));
    QCOMPARE(tip(2), QStringLiteral("Left out on request"));
    QCOMPARE(model.index(2, Model::Status).data().toString(), QStringLiteral("left out"));
  }

  void InANarrowPanel_TheStatusKeepsItsHeadingAndItsWords()
  {
    SampleTable table;
    table.setRows(fiveRows());
    testing_widgets::show(table, { 374, 240 });
    auto* header = table.view()->horizontalHeader();
    QVERIFY(table.view()->isColumnHidden(Model::ResidualMm));
    const int left = header->sectionViewportPosition(Model::Status);
    const int words = table.fontMetrics().horizontalAdvance(QStringLiteral("Status"));
    QVERIFY2(left >= 0 && left + words < table.view()->viewport()->width(), qPrintable(QString::number(left)));
    QVERIFY(!table.view()->horizontalScrollBar()->isVisible());
    table.resize(640, 240);
    QTRY_VERIFY(!table.view()->isColumnHidden(Model::ResidualMm));
  }

  void SeveralRows_AreOneStep()
  {
    SampleTable table;
    const Owner owner(table);
    showWithKeyboard(table);
    table.view()->selectAll();
    table.excludeSelected(true);
    QCOMPARE(table.undoStack()->count(), 1);
    QVERIFY(isExcluded(table, 0) && isExcluded(table, 4));
    table.excludeSelected(true);  // nothing is left to exclude
    QCOMPARE(table.undoStack()->count(), 1);
    table.undo();
    QVERIFY(!isExcluded(table, 0) && !isExcluded(table, 4));
  }

  void Sorting_IsByNumbers_AndWhatIsMissingComesLast()
  {
    SampleTable table;
    QVector<SampleRow> rows = fiveRows();
    setResidual(rows, 0, 10.5);  // as text it would come before 2
    setResidual(rows, 1, 2);
    setResidual(rows, 2, std::nullopt);
    table.setRows(rows);
    table.view()->sortByColumn(Model::ResidualPx, Qt::AscendingOrder);
    QCOMPARE(idsOf(table), (QVector<int>{ 4, 3, 1, 0, 2 }));
    table.view()->sortByColumn(Model::Id, Qt::DescendingOrder);
    QCOMPARE(idsOf(table), (QVector<int>{ 4, 3, 2, 1, 0 }));
  }

  void SelectionAndSorting_OutliveNewRows()
  {
    SampleTable table;
    QVector<SampleRow> rows = fiveRows();
    table.setRows(rows);
    showWithKeyboard(table);
    table.view()->sortByColumn(Model::ResidualPx, Qt::DescendingOrder);
    table.selectSample(3);
    SampleRow another = rows[0];
    another.id = 17;
    rows.removeAt(1);
    rows.append(another);
    table.setRows(rows);
    QCOMPARE(table.selectedIds(), QVector<int>{ 3 });
    QVERIFY(idsOf(table).contains(17) && !idsOf(table).contains(1));
    QCOMPARE(table.view()->horizontalHeader()->sortIndicatorSection(), int(Model::ResidualPx));
  }

  void AHugeResidual_HasColourAndIcon()
  {
    SampleTableModel model;
    QVector<SampleRow> rows = fiveRows();
    setResidual(rows, 1, 41.3);
    rows[1].residualLevel = Level::Error;
    model.setRows(rows);
    const QModelIndex bad = model.index(1, Model::ResidualPx), good = model.index(0, Model::ResidualPx);
    QVERIFY(!bad.data(Qt::DecorationRole).value<QIcon>().isNull());
    QCOMPARE(bad.data(Qt::ForegroundRole).value<QColor>(), levelColor(Level::Error, QApplication::palette()));
    QVERIFY(good.data(Qt::DecorationRole).isNull());
    QVERIFY(bad.data(Qt::ToolTipRole).toString().contains(QStringLiteral("px")));
  }

  void ReadOnly_ChangesNothing()
  {
    SampleTable table;
    const Owner owner(table);
    table.setEditable(false);
    showWithKeyboard(table);
    QSignalSpy excluded(&table, &SampleTable::excludeRequested), deleted(&table, &SampleTable::deleteRequested);
    table.selectSample(1);
    QTest::keyClick(table.view(), Qt::Key_Delete);
    QTest::keyClick(table.view(), Qt::Key_X);
    table.deleteSelected();
    QCOMPARE(excluded.count() + deleted.count(), 0);
    QVERIFY(table.view()->isColumnHidden(Model::Use));
  }

  void ASampleTwice_IsRefusedByName()
  {
    SampleTableModel model;
    QVector<SampleRow> rows = fiveRows();
    rows[4].id = 3;
    try
    {
      model.setRows(rows);
      QFAIL("taken");
    }
    catch (const std::invalid_argument& error)
    {
      QVERIFY(QString::fromUtf8(error.what()).contains(QStringLiteral("3")));
    }
  }

  void CurrentAndActivated_NameTheSample()
  {
    SampleTable table;
    table.setRows(fiveRows());
    showWithKeyboard(table);
    QSignalSpy current(&table, &SampleTable::currentSampleChanged), activated(&table, &SampleTable::sampleActivated);
    table.view()->sortByColumn(Model::Id, Qt::DescendingOrder);
    table.selectSample(1);
    QCOMPARE(current.last()[0].toInt(), 1);
    QTest::keyClick(table.view(), Qt::Key_Return);
    QCOMPARE(activated.count(), 1);
    QCOMPARE(activated[0][0].toInt(), 1);
  }
};

HANDEYE_WIDGET_TEST_MAIN(SampleTableTest)
#include "SampleTableTest.moc"
