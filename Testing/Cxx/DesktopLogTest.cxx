// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DesktopFixture.h"
#include "LogWindow.h"

#include <vtkOutputWindow.h>

#include <QClipboard>
#include <QToolButton>

#include <thread>

namespace
{

QByteArray contents(const QString& path)
{
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

}  // namespace

/// The desktop's log, and what is caught for it of Qt's and VTK's messages.
class DesktopLogTest : public DesktopFixture
{
  Q_OBJECT

private slots:
  void init() { this->setUp(); }
  void cleanup() { this->tearDown(); }

  void log_FiltersCopiesAndSaves()
  {
    using Level = NavigationHost::LogLevel;
    this->Window->logModel()->clear();
    this->Window->log(Level::Info, "first");
    this->Window->log(Level::Warning, "second");
    this->Window->log(Level::Error, "third");
    qWarning("from Qt");
    std::thread thread([this] { this->Window->logModel()->append(Level::Info, "from a thread"); });
    thread.join();
    QTRY_COMPARE(this->Window->logModel()->rowCount(), 5);
    auto* const log = this->Window->findChild<desktop::LogWindow*>();
    QCOMPARE(log->text().count('\n'), 5);
    log->setLowestLevel(1);
    QCOMPARE(log->text().count('\n'), 3);
    QVERIFY(!log->text().contains("first") && log->text().contains("Warning  second") && log->text().contains("from Qt"));
    log->copy();
    QCOMPARE(QApplication::clipboard()->text(), log->text());
    QVERIFY(log->save(this->Folder->filePath("log.txt")));
    QCOMPARE(QString::fromUtf8(contents(this->Folder->filePath("log.txt"))), log->text());
    QVERIFY(!log->save(this->Folder->filePath("no/such/folder/log.txt")));
    QVERIFY(log->text().contains("could not be saved"));
    QCOMPARE(this->Window->findChild<QToolButton*>("LogButton")->text(), QString("2 errors"));
  }

  /// A warning from a slot that listens to the log, while VTK's message is being written: both come, nothing hangs, nothing goes round.
  void log_TakesWhatItsListenersSay()
  {
    desktop::LogModel* const log = this->Window->logModel();
    log->clear();
    int answers = 0;
    const auto listening = connect(log, &desktop::LogModel::appended, this,
      [&answers]
      {
        ++answers;
        qWarning("a listener's own warning");
      });
    vtkOutputWindow::GetInstance()->DisplayWarningText("from VTK");
    QTRY_COMPARE(log->rowCount(), 2);
    QTest::qWait(50);
    QCOMPARE(log->rowCount(), 2);
    QCOMPARE(answers, 2);
    disconnect(listening);
    qWarning("and afterwards");
    QCOMPARE(log->rowCount(), 3);
  }

  void log_DoesNotGrowWithoutEnd()
  {
    this->Window->logModel()->clear();
    this->Window->logModel()->setMaximumCount(100);
    for (int i = 0; i < 250; ++i)
    {
      this->Window->log(NavigationHost::LogLevel::Info, QString::number(i));
    }
    QCOMPARE(this->Window->logModel()->rowCount(), 100);
    QCOMPARE(this->Window->logModel()->index(0, desktop::LogModel::TextColumn).data().toString(), QString("150"));
  }
};

DESKTOP_TEST_MAIN(DesktopLogTest)
#include "DesktopLogTest.moc"
