// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportDocument.h"

#include <QAbstractEventDispatcher>
#include <QAbstractTextDocumentLayout>
#include <QBuffer>
#include <QGuiApplication>
#include <QImage>
#include <QPageLayout>
#include <QPdfWriter>
#include <QTextBlock>
#include <QTextCursor>
#include <QTextDocument>
#include <QTextTable>
#include <QThread>
#include <QUrl>

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>

namespace handeye::report
{

namespace
{

constexpr int PageWidthPx = 622;  ///< of an A4 page within margins of 2 cm, at 96 dots an inch, less what lines keep free

/// In a program that is not Qt's, what Qt finds remarkable about its surroundings is nobody's business; what fails is.
void passOnFailures(QtMsgType type, const QMessageLogContext&, const QString& message)
{
  if (type == QtCriticalMsg || type == QtFatalMsg)
  {
    std::fprintf(stderr, "%s\n", qPrintable(message));
  }
}

/// Qt lays text out only in an application that has fonts.
void needGuiApplication()
{
  if (QCoreApplication::instance() == nullptr)
  {
    static int count = 3;
    static char name[] = "handeye", option[] = "-platform", value[] = "offscreen";
    static char* arguments[] = { name, option, value, nullptr };
    qInstallMessageHandler(passOnFailures);
    static QGuiApplication* application = new QGuiApplication(count, arguments);  // for good, as Qt wants it
    application->setQuitOnLastWindowClosed(false);
    // Qt has just taken the user's language for numbers, too; our files are written with points.
    std::setlocale(LC_NUMERIC, "C");
  }
  if (qobject_cast<QGuiApplication*>(QCoreApplication::instance()) == nullptr)
  {
    throw std::logic_error("a PDF needs a QGuiApplication, this program has a QCoreApplication only");
  }
}

QString toText(const std::string& text)
{
  return QString::fromStdString(escapeHtml(text));
}

QImage toImage(const cv::Mat& picture)
{
  return QImage(picture.data, picture.cols, picture.rows, int(picture.step), QImage::Format_BGR888).copy();
}

const char* verdictColor(ReportDocument::Verdict verdict)
{
  switch (verdict)
  {
    case ReportDocument::Verdict::Good:
      return "#eaf6ee";
    case ReportDocument::Verdict::Fair:
      return "#fdf4e3";
    case ReportDocument::Verdict::Poor:
      return "#fcebea";
    case ReportDocument::Verdict::None:
      break;
  }
  return "#f3f3f3";
}

/// The part of HTML that Qt's text documents understand.
class Writer
{
public:
  explicit Writer(QTextDocument& document)
    : document_(document)
  {
  }
  void operator()(const Heading& heading) { html_ += "<h2>" + toText(heading.text) + "</h2>\n"; }
  void operator()(const Paragraph& paragraph) { html_ += "<p>" + toText(paragraph.text) + "</p>\n"; }
  void operator()(const Table& table)
  {
    html_ += table.caption.empty() ? QString() : "<p><i>" + toText(table.caption) + "</i></p>\n";
    // Wide tables are set smaller, so that they stay on the page.
    const int size = table.headings.size() > 8 ? 6 : 8;
    html_ += "<table width='100%' border='1' cellspacing='0' cellpadding='2' "
             "style='border-collapse:collapse; border-style:solid; border-color:#bbbbbb'><thead>";
    addRow(table, table.headings, "th", size);
    html_ += "</thead><tbody>";
    for (const std::vector<std::string>& row : table.rows)
    {
      addRow(table, row, "td", size);
    }
    html_ += "</tbody></table>\n";
  }
  void operator()(const Figure& figure) { addFigure(figure, PageWidthPx); }
  void operator()(const Gallery& gallery)
  {
    html_ += "<table width='100%' border='0' cellspacing='0' cellpadding='4'>";
    for (std::size_t i = 0; i < gallery.figures.size(); i += 2)
    {
      html_ += "<tr><td width='50%'>";
      addFigure(gallery.figures[i], PageWidthPx / 2 - 8);
      html_ += "</td><td width='50%'>";
      if (i + 1 < gallery.figures.size())
      {
        addFigure(gallery.figures[i + 1], PageWidthPx / 2 - 8);
      }
      html_ += "</td></tr>";
    }
    html_ += "</table>\n";
  }
  void addTitle(const ReportDocument& document)
  {
    html_ += "<h1>" + toText(document.title) + "</h1>\n<table width='100%' cellpadding='8' cellspacing='0' bgcolor='" +
      verdictColor(document.verdict) + "'><tr><td><b>" + toText(document.verdictText) + "</b></td></tr></table>\n";
  }
  void addData(const ReportDocument& document)
  {
    html_ += document.data.empty() ? "" : "<h2>Data</h2>\n";
    for (const DataFile& file : document.data)
    {
      html_ += "<p><b>" + toText(file.name) + "</b>: " + toText(file.description) + "</p>\n";
    }
    html_ += "<p>" + toText(document.madeBy) + "</p>\n";
  }
  const QString& html() const { return html_; }

private:
  void addRow(const Table& table, const std::vector<std::string>& cells, const QString& tag, int size)
  {
    html_ += "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      const bool isText = int(i) < table.textColumns || (table.endsWithText && i + 1 == cells.size());
      html_ += "<" + tag + (isText ? " align='left'" : " align='right'") + "><span style='font-size:" + QString::number(size) +
        "pt'>" + toText(cells[i]) + "</span></" + tag + ">";
    }
    html_ += "</tr>";
  }
  void addFigure(const Figure& figure, int roomPx)
  {
    const QString name = QString("figure%1").arg(figureCount_++);
    document_.addResource(QTextDocument::ImageResource, QUrl(name), toImage(figure.picture));
    const int width = std::min(roomPx, figure.picture.cols);
    html_ += "<p><img src='" + name + "' width='" + QString::number(width) + "' height='" +
      QString::number(width * figure.picture.rows / figure.picture.cols) + "'><br><span style='font-size:8pt'>" +
      toText(figure.caption) + "</span></p>\n";
  }

  QTextDocument& document_;
  QString html_;
  int figureCount_ = 0;
};

bool isHeading(const QTextBlock& block)
{
  return block.blockFormat().headingLevel() > 0;
}

/// A heading, what it says of pictures or a table that follow, and the line in italics above a table: nothing that may stand alone
/// at the foot of a page.
bool belongsToNext(const QTextBlock& block)
{
  const bool isCaption = block.length() > 1 && block.begin().fragment().charFormat().fontItalic();
  const bool isIntroduction = isHeading(block.previous()) && block.next().isValid() &&
    QTextCursor(block).currentTable() == nullptr && QTextCursor(block.next()).currentTable() != nullptr;
  return isHeading(block) || isCaption || isIntroduction;
}

void breakPageBefore(const QTextBlock& block)
{
  QTextCursor cursor(block);
  QTextBlockFormat format = cursor.blockFormat();
  format.setPageBreakPolicy(QTextFormat::PageBreak_AlwaysBefore);
  cursor.setBlockFormat(format);
}

/// Lays the pages out as QTextDocument::print() does, which knows of no such rule, and breaks them earlier where it is needed.
void keepHeadingsWithWhatFollows(QTextDocument& text, QPagedPaintDevice& device)
{
  const std::unique_ptr<QTextDocument> printed(text.clone());
  printed->setUndoRedoEnabled(false);
  printed->documentLayout()->setPaintDevice(&device);
  QTextFrameFormat frame = printed->rootFrame()->frameFormat();
  frame.setMargin(int(2 / 2.54 * QImage(1, 1, QImage::Format_RGB32).logicalDpiX()));  // 2 cm, of the document's own pixels
  printed->rootFrame()->setFrameFormat(frame);
  printed->setPageSize(QSizeF(device.width(), device.height()));
  const auto pageOf = [&](const QTextBlock& block)
  { return int(printed->documentLayout()->blockBoundingRect(block).top() / device.height()); };
  for (QTextBlock first = printed->begin().next(); first.isValid(); first = first.next())
  {
    if (!belongsToNext(first) || belongsToNext(first.previous()))
    {
      continue;
    }
    QTextBlock next = first.next();
    while (next.isValid() && belongsToNext(next))
    {
      next = next.next();
    }
    if (next.isValid() && pageOf(first) != pageOf(next))
    {
      breakPageBefore(first);
      breakPageBefore(text.findBlockByNumber(first.blockNumber()));
    }
  }
}

std::string writePdf(const ReportDocument& document)
{
  QTextDocument text;
  text.setUndoRedoEnabled(false);
  text.setDefaultFont(QFont("DejaVu Sans", 9));
  Writer writer(text);
  writer.addTitle(document);
  for (const Block& block : document.blocks)
  {
    std::visit(writer, block);
  }
  writer.addData(document);
  text.setHtml(writer.html());
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  {
    QPdfWriter pdf(&buffer);
    pdf.setPageSize(QPageSize(QPageSize::A4));
    pdf.setPageMargins(QMarginsF(0, 0, 0, 0));  // printing sets margins of 2 cm and numbers the pages
    pdf.setResolution(300);
    pdf.setTitle(QString::fromStdString(document.title));
    pdf.setCreator("HandEyeCalibration " HANDEYE_VERSION);
    keepHeadingsWithWhatFollows(text, pdf);
    text.print(&pdf);
  }
  return bytes.toStdString();
}

}  // namespace

std::string toPdf(const ReportDocument& document)
{
  needGuiApplication();
  if (QAbstractEventDispatcher::instance() != nullptr)
  {
    return writePdf(document);
  }
  // The layout of a text starts timers, which Qt has in its own threads only.
  std::string bytes;
  std::exception_ptr problem;
  const std::unique_ptr<QThread> thread(QThread::create(
    [&]
    {
      try
      {
        bytes = writePdf(document);
      }
      catch (...)
      {
        problem = std::current_exception();
      }
    }));
  thread->start();
  thread->wait();
  if (problem)
  {
    std::rethrow_exception(problem);
  }
  return bytes;
}

}  // namespace handeye::report
