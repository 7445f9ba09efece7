// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QStringList>
#include <QWidget>

#include <filesystem>
#include <memory>

namespace handeye
{

struct ExportSources;

/// The last page's work: writes a calibration into a folder in the formats of other programs, says what was written, and where not,
/// why.
class ExportPanel : public QWidget
{
  Q_OBJECT

public:
  explicit ExportPanel(QWidget* parent = nullptr);
  ~ExportPanel() override;

  /// The result files that are exported; without a calibration the panel says that there is nothing to export.
  void setSources(const ExportSources& sources);
  void setFolder(const QString& folder);
  QString folder() const;

  /// The words of the formats that are ticked ("plus", "tfm", ...), see exportFormats().
  QStringList formats() const;
  void setFormats(const QStringList& formats);

  /// Files that were written by the last export.
  QStringList writtenFiles() const;

  /// Whether a report can be asked for.
  void setReportEnabled(bool enabled, const QString& reason = {});
  /// Adds a file that someone else wrote (session, report) to the list, with a link.
  void addWrittenFile(const QString& path, const QString& what);
  /// A sentence where the panel says what went wrong.
  void showError(const QString& sentence);

public slots:
  /// Writes the ticked formats. @return whether all of them were written
  bool exportNow();

signals:
  void exported(QStringList files);
  /// "Report" was pressed, to be written into this folder.
  void reportRequested(QString folder);

protected:
  void resizeEvent(QResizeEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
