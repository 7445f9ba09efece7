// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "SampleTableModel.h"

#include <QVector>
#include <QWidget>

#include <memory>

class QTableView;
class QUndoStack;

namespace handeye
{

/// The samples of a capture: thumbnail, status, residuals in px and mm, distance; exclude, delete, undo and redo.
///
/// The table decides nothing: what a person does is put on an undo stack and asked for by a signal, and undoing asks for the
/// contrary.
/// Whoever owns the samples applies it and calls setRows() (directly in the slot, or later when a calibration is renewed).
class SampleTable : public QWidget
{
  Q_OBJECT

public:
  explicit SampleTable(QWidget* parent = nullptr);
  ~SampleTable() override;

  /// The samples as they are now. Selection, current row, sorting and scrolling stay. Follows the newest row if the last one was in
  /// view.
  void setRows(const QVector<SampleRow>& rows);
  const QVector<SampleRow>& rows() const;

  /// Without it there is nothing to exclude, delete or undo: a table of validation samples. On until set.
  void setEditable(bool editable);
  /// Title of the residual's columns, where they are none of a fit: tr("Error").
  void setResidualTitle(const QString& title);

  /// These samples were added at once, by a recording: undoing asks for them to be deleted. @param text of what was done: "take 12
  /// samples"
  void addUndoableSamples(const QVector<int>& ids, const QString& text);
  /// Forgets what can be undone: another session.
  void clearHistory();
  QUndoStack* undoStack() const;
  QTableView* view() const;
  QVector<int> selectedIds() const;
  void selectSample(int id);

  QSize minimumSizeHint() const override;

public slots:
  /// Excludes (or takes in again) the selected samples; deletes them; as the buttons, the menu and the keys do.
  void excludeSelected(bool excluded);
  void deleteSelected();
  void undo();
  void redo();

signals:
  /// To be applied: these samples are (not) to be used.
  void excludeRequested(QVector<int> ids, bool excluded);
  /// To be applied: these samples are to disappear, but can be brought back.
  void deleteRequested(QVector<int> ids);
  /// To be applied: samples that were deleted are to be there again.
  void restoreRequested(QVector<int> ids);
  /// The current sample; -1 for none. For showing its picture.
  void currentSampleChanged(int id);
  /// A double click or Return on a sample.
  void sampleActivated(int id);

protected:
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
