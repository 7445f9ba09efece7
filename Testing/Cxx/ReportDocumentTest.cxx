// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportDocument.h"

#include "IoTestSupport.h"

#include <QGuiApplication>
#include <gtest/gtest.h>

#include <clocale>
#include <cstdio>
#include <thread>

using namespace handeye;
using namespace handeye::report;
using handeye::io::test::expectFileError;
using handeye::io::test::readBytes;
using handeye::io::test::TemporaryFolder;

namespace
{

cv::Mat picture(const cv::Scalar& color)
{
  return cv::Mat(40, 60, CV_8UC3, color);
}

ReportDocument document()
{
  ReportDocument result;
  result.title = "Errors of <b>methods</b> & \"tools\"";
  result.verdict = ReportDocument::Verdict::Fair;
  result.verdictText = "fair: 1.50 px";
  result.blocks = { Heading{ "Tables" }, Paragraph{ "What follows is a table." },
    Table{ "Two rows", { "method", "px" }, { { "ml", "0.50" }, { "park", "1.50" } } },
    Figure{ "a plot", picture({ 0, 0, 255 }), false }, Gallery{ { { "frame 1", picture({ 0, 255, 0 }), true } } } };
  result.data = { { "errors.csv", "the errors", "a,b\r\n1,2\r\n" } };
  return result;
}

int countOf(const std::string& text, const std::string& word)
{
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
  {
    ++count;
  }
  return count;
}

QStringList saidByQt;

void keepMessage(QtMsgType, const QMessageLogContext&, const QString& message)
{
  saidByQt << message;
}

}  // namespace

TEST(ReportDocument, Html_IsOneFile)
{
  const std::string html = toHtml(document());
  EXPECT_EQ(countOf(html, "<img src='data:image/png;base64,"), 1);
  EXPECT_EQ(countOf(html, "<img src='data:image/jpeg;base64,"), 1);
  EXPECT_EQ(countOf(html, "src="), 2) << "nothing else is loaded";
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(countOf(html, "<td class='text'>ml</td><td>0.50</td>"), 1);
  EXPECT_LT(html.find("fair: 1.50 px"), html.find("<table>")) << "the verdict first";
}

TEST(ReportDocument, Html_ShowsTextsAsTheyAreWritten)
{
  const std::string html = toHtml(document());
  EXPECT_EQ(html.find("<b>methods"), std::string::npos);
  EXPECT_NE(html.find("&lt;b&gt;methods&lt;/b&gt; &amp; &quot;tools&quot;"), std::string::npos);
}

TEST(ReportDocument, Base64_IsThatOfThePicture)
{
  const std::string html = toHtml(document());
  // Every PNG begins with the same eight bytes.
  EXPECT_NE(html.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
}

TEST(ReportDocument, Pdf_HasPagesAndPictures)
{
  const std::string pdf = toPdf(document());
  EXPECT_EQ(pdf.rfind("%PDF-", 0), 0U);
  EXPECT_GE(countOf(pdf, "/Type /Page\n") + countOf(pdf, "/Type /Page\r"), 1);
  EXPECT_GE(countOf(pdf, "/Subtype /Image"), 2);
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
}

TEST(ReportDocument, Pdf_LongTablesGoOnOnMorePages)
{
  ReportDocument lengthy = document();
  Table& table = std::get<Table>(lengthy.blocks[2]);
  for (int i = 0; i < 200; ++i)
  {
    table.rows.push_back({ "row", std::to_string(i) });
  }
  const auto pages = [](const std::string& pdf) { return countOf(pdf, "/Type /Page\n"); };
  EXPECT_GT(pages(toPdf(lengthy)), pages(toPdf(document())) + 2);
}

TEST(ReportDocument, Pdf_LeavesDecimalPointsAlone)
{
  (void)toPdf(document());
  char text[16];
  std::snprintf(text, sizeof(text), "%.1f", 0.5);
  EXPECT_STREQ(text, "0.5");
  EXPECT_STREQ(std::setlocale(LC_NUMERIC, nullptr), "C");
}

// As the wizard has it done.
TEST(ReportDocument, Pdf_InAThreadThatIsNotQts_IsMadeWithoutComplaint)
{
  ReportDocument lengthy = document();  // a short one is laid out in one step, without a timer
  lengthy.blocks.insert(
    lengthy.blocks.end(), 100, Paragraph{ "As many words as a report has, and more than Qt lays out at once." });
  (void)toPdf(lengthy);  // makes the application, for good
  saidByQt.clear();
  const QtMessageHandler before = qInstallMessageHandler(keepMessage);
  std::string pdf;
  std::thread([&] { pdf = toPdf(lengthy); }).join();
  qInstallMessageHandler(before);
  EXPECT_EQ(pdf.rfind("%PDF-", 0), 0U);
  EXPECT_EQ(saidByQt.join("; ").toStdString(), "");
}

TEST(ReportDocument, WriteReport_WritesPagePdfAndData)
{
  const TemporaryFolder folder;
  writeReport(folder.path() / "a" / "b", document());
  EXPECT_EQ(readBytes(folder.path() / "a" / "b" / "errors.csv"), "a,b\r\n1,2\r\n");
  const std::string html = readBytes(folder.path() / "a" / "b" / "report.html");
  EXPECT_NE(html.find("href='errors.csv'"), std::string::npos);
  EXPECT_NE(html.find("<footer>HandEyeCalibration "), std::string::npos) << "who made it and when";
  EXPECT_EQ(readBytes(folder.path() / "a" / "b" / "report.pdf").rfind("%PDF-", 0), 0U);
}

TEST(ReportDocument, WhatIsNoReport_IsRefused)
{
  const TemporaryFolder folder;
  ReportDocument wrong = document();
  std::get<Table>(wrong.blocks[2]).rows[1].pop_back();
  EXPECT_THROW(writeReport(folder.path(), wrong), std::invalid_argument);
  wrong = document();
  std::get<Figure>(wrong.blocks[3]).picture = cv::Mat();
  EXPECT_THROW(writeReport(folder.path(), wrong), std::invalid_argument);
  const auto inTheWay = folder.write("file", "in the way");
  expectFileError([&] { writeReport(inTheWay / "report", document()); }, { "file" });
}
