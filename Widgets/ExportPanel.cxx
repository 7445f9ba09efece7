// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ExportPanel.h"

#include "CalibrationExport.h"
#include "Look.h"
#include "ui_ExportPanel.h"

#include <QCheckBox>
#include <QDesktopServices>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QMap>
#include <QUrl>

#include <algorithm>
#include <vector>

namespace handeye
{

namespace
{

QString fromPath(const std::filesystem::path& path)
{
  return QString::fromStdString(path.string());
}

/// What stands for the colour of links, until it is shown.
const QLatin1String LinkColor("{link}");

QString listItem(const QString& path, const QString& what)
{
  const QString link = QString::fromUtf8(QUrl::fromLocalFile(path).toEncoded());
  return QStringLiteral("<p style=\"margin:2px 0\"><a href=\"%1\" style=\"color:%4\">%2</a> – %3</p>")
    .arg(link, QFileInfo(path).fileName().toHtmlEscaped(), what.toHtmlEscaped(), LinkColor);
}

}  // namespace

class ExportPanel::Private
{
public:
  explicit Private(ExportPanel& panel)
    : q(panel)
  {
  }

  void addFormats();
  void arrangeFormats();
  void updateButtons();
  void list(const QString& html);
  void show(const QString& html);
  void showMessage(const QString& text, Level level);
  bool exportOne(const ExportFormat& format, const QDir& target, QStringList& problems, QMap<QString, QStringList>& warnings);
  bool hasCalibration() const { return !sources.calibration.empty(); }
  QString folder() const { return ui.folderEdit->text().trimmed(); }

  ExportPanel& q;
  Ui::ExportPanel ui;
  std::vector<QCheckBox*> boxes;  ///< one per exportFormats()
  ExportSources sources;
  QStringList written;
  QStringList listed;  ///< HTML, one item each
  QString message;
  Level messageLevel = Level::Info;
  bool reportEnabled = false;
  int columns = 0;
};

void ExportPanel::Private::addFormats()
{
  for (const ExportFormat& format : exportFormats())
  {
    // Names of programs and formats are not translated.
    auto* box = new QCheckBox(QString::fromStdString(format.name), ui.formatsBox);
    box->setToolTip(ExportPanel::tr("Writes %1").arg(QString::fromStdString(format.fileName)) +
      (format.isOneCamera ? QString() : ExportPanel::tr("; with the stylus, the phantom and both eyes where they are known")));
    box->setChecked(true);
    // The columns follow from the width, not the other way round.
    box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    connect(box, &QCheckBox::toggled, &q, [this] { this->updateButtons(); });
    boxes.push_back(box);
  }
  this->arrangeFormats();
}

/// In two columns where they have room, else in one.
void ExportPanel::Private::arrangeFormats()
{
  int widest[2] = { 0, 0 };
  for (std::size_t index = 0; index < boxes.size(); ++index)
  {
    widest[index % 2] = std::max(widest[index % 2], boxes[index]->sizeHint().width());
  }
  const QMargins margins = ui.formatsLayout->contentsMargins();
  const int roomPx = ui.formatsBox->contentsRect().width() - margins.left() - margins.right();
  const int wanted = roomPx >= widest[0] + widest[1] + ui.formatsLayout->horizontalSpacing() ? 2 : 1;
  if (wanted == columns)
  {
    return;
  }
  columns = wanted;
  for (std::size_t index = 0; index < boxes.size(); ++index)
  {
    ui.formatsLayout->removeWidget(boxes[index]);
  }
  for (std::size_t index = 0; index < boxes.size(); ++index)
  {
    ui.formatsLayout->addWidget(boxes[index], int(index) / columns, int(index) % columns);
  }
  // Each as wide as its names, in proportion.
  ui.formatsLayout->setColumnStretch(0, widest[0]);
  ui.formatsLayout->setColumnStretch(1, columns == 2 ? widest[1] : 0);
}

void ExportPanel::Private::updateButtons()
{
  const bool anyFormat = !q.formats().isEmpty();
  ui.exportButton->setEnabled(this->hasCalibration() && anyFormat && !this->folder().isEmpty());
  ui.reportButton->setEnabled(reportEnabled && !this->folder().isEmpty());
}

void ExportPanel::Private::list(const QString& html)
{
  listed += html;
  this->show(html);
}

void ExportPanel::Private::show(const QString& html)
{
  ui.writtenBrowser->append(QString(html).replace(LinkColor, linkColor(q.palette()).name()));
}

void ExportPanel::Private::showMessage(const QString& text, Level level)
{
  const int side = q.fontMetrics().height() + 2;
  ui.messageIcon->setVisible(!text.isEmpty());
  ui.messageLabel->setVisible(!text.isEmpty());
  ui.messageIcon->setPixmap(levelIcon(level).pixmap(q.window()->windowHandle(), QSize(side, side)));
  ui.messageLabel->setText(text);
  message = text;
  messageLevel = level;
  // Of the palette only this role: the rest follows the application's.
  QPalette palette;
  palette.setColor(QPalette::WindowText, levelColor(level, q.palette()));
  ui.messageLabel->setPalette(palette);
}

/// One format that cannot hold this camera does not keep the others from being written.
bool ExportPanel::Private::exportOne(
  const ExportFormat& format, const QDir& target, QStringList& problems, QMap<QString, QStringList>& warnings)
{
  try
  {
    const std::filesystem::path file = target.filePath(QString::fromStdString(format.fileName)).toStdString();
    const ExportResult result = exportCalibration(sources, format.word, file);
    for (const std::filesystem::path& path : result.files)
    {
      q.addWrittenFile(fromPath(path), QString::fromStdString(format.name));
    }
    for (const std::string& warning : result.warnings)
    {
      warnings[QString::fromStdString(warning)] += QString::fromStdString(format.name);
    }
    return true;
  }
  catch (const std::exception& error)
  {
    problems += QStringLiteral("%1: %2").arg(QString::fromStdString(format.name), QString::fromUtf8(error.what()));
    return false;
  }
}

ExportPanel::ExportPanel(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>(*this))
{
  d->ui.setupUi(this);
  d->addFormats();
  d->ui.folderButton->setIcon(icon(QStringLiteral("open")));
  d->ui.exportButton->setIcon(icon(QStringLiteral("export")));
  d->ui.reportButton->setIcon(icon(QStringLiteral("report")));
  connect(d->ui.folderEdit, &QLineEdit::textChanged, this, [this] { d->updateButtons(); });
  connect(d->ui.folderButton, &QPushButton::clicked, this,
    [this]
    {
      const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder to export to"), this->folder());
      if (!folder.isEmpty())
      {
        this->setFolder(folder);
      }
    });
  connect(d->ui.exportButton, &QPushButton::clicked, this, &ExportPanel::exportNow);
  connect(d->ui.reportButton, &QPushButton::clicked, this, [this] { emit reportRequested(this->folder()); });
  connect(d->ui.allButton, &QPushButton::clicked, this,
    [this]
    {
      for (QCheckBox* box : d->boxes)
      {
        box->setChecked(true);
      }
    });
  connect(d->ui.noneButton, &QPushButton::clicked, this, [this] { this->setFormats({}); });
  connect(d->ui.writtenBrowser, &QTextBrowser::anchorClicked, this, [](const QUrl& link) { QDesktopServices::openUrl(link); });
  d->ui.writtenBrowser->setPlaceholderText(tr("Files that were written are listed here."));
  this->setReportEnabled(false);
  this->setSources({});
}

ExportPanel::~ExportPanel() = default;

void ExportPanel::resizeEvent(QResizeEvent* event)
{
  QWidget::resizeEvent(event);
  d->arrangeFormats();
}

void ExportPanel::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && d->columns > 0)
  {
    // Links keep the colour that they were shown with.
    d->ui.writtenBrowser->clear();
    for (const QString& html : d->listed)
    {
      d->show(html);
    }
    d->showMessage(d->message, d->messageLevel);
  }
}

void ExportPanel::setSources(const ExportSources& sources)
{
  d->sources = sources;
  if (d->hasCalibration())
  {
    d->showMessage(QString(), Level::Info);
  }
  else
  {
    d->showMessage(tr("There is no calibration to export yet."), Level::Info);
  }
  d->updateButtons();
}

void ExportPanel::setFolder(const QString& folder)
{
  d->ui.folderEdit->setText(QDir::toNativeSeparators(folder));
}

QString ExportPanel::folder() const
{
  return d->folder();
}

QStringList ExportPanel::formats() const
{
  QStringList words;
  for (std::size_t index = 0; index < d->boxes.size(); ++index)
  {
    if (d->boxes[index]->isChecked())
    {
      words += QString::fromStdString(exportFormats()[index].word);
    }
  }
  return words;
}

void ExportPanel::setFormats(const QStringList& formats)
{
  for (std::size_t index = 0; index < d->boxes.size(); ++index)
  {
    d->boxes[index]->setChecked(formats.contains(QString::fromStdString(exportFormats()[index].word)));
  }
}

QStringList ExportPanel::writtenFiles() const
{
  return d->written;
}

void ExportPanel::setReportEnabled(bool enabled, const QString& reason)
{
  d->reportEnabled = enabled;
  d->ui.reportButton->setToolTip(enabled ? tr("Writes the report of the validation (HTML) into the folder")
      : reason.isEmpty()                 ? tr("A report needs a validation")
                                         : reason);
  d->updateButtons();
}

void ExportPanel::addWrittenFile(const QString& path, const QString& what)
{
  d->written += path;
  d->list(listItem(path, what));
}

void ExportPanel::showError(const QString& sentence)
{
  d->showMessage(sentence, Level::Error);
}

bool ExportPanel::exportNow()
{
  d->written.clear();
  d->listed.clear();
  d->ui.writtenBrowser->clear();
  const QDir target(this->folder());
  if (!d->hasCalibration())
  {
    d->showMessage(tr("There is no calibration to export yet."), Level::Error);
    return false;
  }
  if (this->folder().isEmpty() || !QDir().mkpath(target.absolutePath()))
  {
    d->showMessage(tr("The folder %1 cannot be made.").arg(target.absolutePath()), Level::Error);
    return false;
  }
  QStringList problems;
  QMap<QString, QStringList> warnings;  // a sentence, and the formats that it is about
  int count = 0;
  const QStringList wanted = this->formats();
  for (const ExportFormat& format : exportFormats())
  {
    if (wanted.contains(QString::fromStdString(format.word)))
    {
      count += d->exportOne(format, target, problems, warnings) ? 1 : 0;
    }
  }
  const QString what = counted(count, tr("1 format"), tr("%1 formats"));
  const QString done = tr("%1 written to %2.").arg(what, QDir::toNativeSeparators(target.absolutePath()));
  if (!problems.isEmpty())
  {
    d->showMessage((problems + QStringList(done)).join(QLatin1Char('\n')), Level::Error);
  }
  else
  {
    d->showMessage(done, Level::Good);
  }
  if (!warnings.isEmpty())
  {
    QString notes = tr("Notes:");
    for (auto warning = warnings.cbegin(); warning != warnings.cend(); ++warning)
    {
      const QString formats = warning.value().join(QStringLiteral(", "));
      notes += QStringLiteral("<br>• %1: %2").arg(formats.toHtmlEscaped(), warning.key().toHtmlEscaped());
    }
    d->list(QStringLiteral("<p style=\"margin-top:8px\">%1</p>").arg(notes));
  }
  d->ui.writtenBrowser->moveCursor(QTextCursor::Start);
  emit exported(d->written);
  return problems.isEmpty();
}

}  // namespace handeye
