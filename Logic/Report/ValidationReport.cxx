// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationReport.h"

#include "ComparisonFiles.h"
#include "FileError.h"
#include "ImageFile.h"
#include "MarkedPicture.h"
#include "NumberWords.h"
#include "ReportDocument.h"
#include "ReportPlots.h"
#include "ReportWords.h"

#include <algorithm>
#include <cstdio>
#include <system_error>

namespace handeye
{

namespace
{

constexpr std::size_t MostPictures = 12;

std::string frameName(int frame)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%04d.png", frame);
  return text;
}

const Eigen::Vector2d* projectedOf(const ValidatedFrame& frame)
{
  const bool ok = frame.validated && frame.validated->status == CameraModel::Status::Ok;
  return ok ? &frame.validated->projected_Image : nullptr;
}

report::Table summaryTable(const ValidationStepResult& result)
{
  report::Table table;
  table.caption = "Distance between the projected and the segmented centre of the ball, px";
  table.headings = { "mean", "standard deviation", "least", "greatest", "RMS", "frames", "of" };
  table.textColumns = 0;
  const Summary& error = result.projectionErrorPx;
  table.rows.push_back({ fixedDigits(error.mean, 2), fixedDigits(error.standardDeviation, 2), fixedDigits(error.minimum, 2),
    fixedDigits(error.maximum, 2), fixedDigits(error.rms, 2), std::to_string(error.count), std::to_string(result.frames.size()) });
  return table;
}

report::Table framesTable(const ValidationStepResult& result)
{
  report::Table table;
  table.caption = "Every frame; those without an error were not used";
  table.headings = { "frame", "status", "error (px)", "to the right (px)", "upwards (px)", "distance (mm)", "why not" };
  table.textColumns = 2;
  table.endsWithText = true;
  for (const ValidatedFrame& frame : result.frames)
  {
    std::vector<std::string> row = { std::to_string(frame.captured.frame), frame.status, "", "", "", "", "" };
    if (frame.status == "ok")
    {
      const Eigen::Vector2d error = frame.validated->projected_Image - frame.captured.ball.ball_Image;
      row = { row[0], row[1], fixedDigits(frame.validated->errorPx, 2), fixedDigits(error.x(), 2), fixedDigits(-error.y(), 2),
        fixedDigits(frame.validated->distanceMm, 0), "" };
    }
    else
    {
      row.back() = frame.captured.isSample() ? "the calibration does not put the ball into view" : frame.captured.message;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Frames with a picture, by their error: the worst first, those without one last.
std::vector<const ValidatedFrame*> framesToShow(const ValidationStepResult& result, const io::Recording& recording)
{
  std::vector<const ValidatedFrame*> frames;
  for (const ValidatedFrame& frame : result.frames)
  {
    if (recording.hasImage(frame.captured.frame))
    {
      frames.push_back(&frame);
    }
  }
  const auto errorOf = [](const ValidatedFrame* frame) { return frame->status == "ok" ? frame->validated->errorPx : -1.0; };
  std::stable_sort(
    frames.begin(), frames.end(), [&](const ValidatedFrame* a, const ValidatedFrame* b) { return errorOf(a) > errorOf(b); });
  return report::spreadOut(frames, MostPictures);
}

report::Gallery pictures(const std::vector<const ValidatedFrame*>& frames, const io::Recording& recording)
{
  report::Gallery gallery;
  for (const ValidatedFrame* frame : frames)
  {
    std::vector<report::PredictedCenter> predicted;
    if (const Eigen::Vector2d* place = projectedOf(*frame))
    {
      predicted.push_back({ *place, { 255, 220, 0 }, "" });
    }
    report::Figure figure;
    figure.picture = report::drawMarkedPicture(recording.image(frame->captured.frame), frame->captured.ball, predicted);
    figure.isPhotograph = true;
    figure.caption = "frame " + std::to_string(frame->captured.frame) + ": " +
      (frame->status == "ok"
          ? fixedDigits(frame->validated->errorPx, 2) + " px at " + fixedDigits(frame->validated->distanceMm, 0) + " mm"
          : frame->status);
    gallery.figures.push_back(std::move(figure));
  }
  return gallery;
}

std::string errorsOf(const ValidationStepResult& result)
{
  std::string text = "frame,status,distance_mm,error_px,segmented_u_px,segmented_v_px,projected_u_px,projected_v_px\r\n";
  for (const ValidatedFrame& frame : result.frames)
  {
    text += std::to_string(frame.captured.frame) + "," + csvField(frame.status) + ",";
    if (frame.status == "ok")
    {
      text += csvNumber(frame.validated->distanceMm) + "," + csvNumber(frame.validated->errorPx) + ",";
    }
    else
    {
      text += ",,";
    }
    const Eigen::Vector2d* projected = projectedOf(frame);
    const Eigen::Vector2d& seen = frame.captured.ball.ball_Image;
    text += frame.captured.ball.isFound() ? csvNumber(seen.x()) + "," + csvNumber(seen.y()) + "," : ",,";
    text += projected != nullptr ? csvNumber(projected->x()) + "," + csvNumber(projected->y()) : ",";
    text += "\r\n";
  }
  return text;
}

/// A sentence each: which calibration, camera, ball and capture the figures are of.
std::vector<std::string> subjectOf(const ValidationSubject& subject, const io::Recording& recording)
{
  std::vector<std::string> facts;
  if (!subject.calibrationFile.empty())
  {
    facts.push_back("Calibration: " + subject.calibrationFile);
  }
  if (subject.camera)
  {
    const CameraModel& camera = *subject.camera;
    const std::string size =
      camera.hasImageSize() ? std::to_string(camera.width()) + " x " + std::to_string(camera.height()) + " px, " : std::string();
    facts.push_back("Camera: " + size + "focal lengths " + fixedDigits(camera.fx(), 1) + " and " + fixedDigits(camera.fy(), 1) +
      " px, principal point (" + fixedDigits(camera.cx(), 1) + ", " + fixedDigits(camera.cy(), 1) + ") px, " +
      std::to_string(camera.distortionCoefficients().size()) + " distortion coefficients");
  }
  if (subject.ballRadiusMm > 0)
  {
    facts.push_back("Ball: radius " + significantDigits(subject.ballRadiusMm, 4) + " mm");
  }
  facts.push_back("Capture: " + recording.path().string());
  return facts;
}

report::ReportDocument makeDocument(
  const ValidationStepResult& result, const io::Recording& recording, const report::PlotDrawer& draw)
{
  report::ReportDocument document;
  document.title = "Validation of a hand-eye calibration";
  document.verdict = report::verdictOf(result.projectionErrorPx);
  document.verdictText = result.message;
  for (const std::string& fact : subjectOf(result.subject, recording))
  {
    document.blocks.push_back(report::Paragraph{ fact });
  }
  if (result.isUsable())
  {
    document.blocks.push_back(summaryTable(result));
    report::addPlot(document, report::errorAgainstDistance(result),
      "Each dot is a frame. Tracking noise, in mm, grows towards the camera.", draw);
    report::addPlot(document, report::errorDirections(result),
      "Each dot is a frame. Dots around the cross are noise; a cloud beside it is a bias of calibration, lens, tip or latency.",
      draw);
  }
  document.blocks.push_back(report::Heading{ "Frames" });
  document.blocks.push_back(framesTable(result));
  const std::vector<const ValidatedFrame*> shown = framesToShow(result, recording);
  if (!shown.empty())
  {
    document.blocks.push_back(report::Heading{ "Pictures" });
    document.blocks.push_back(report::Paragraph{
      "Green: the segmented ball's outline and centre. Yellow: where the calibration puts the tracked ball. Right: the framed "
      "part, "
      "enlarged; the arrow is the error. The worst frames first. All frames are beside this page, one PNG each." });
    document.blocks.push_back(pictures(shown, recording));
  }
  document.data.push_back(
    { "errors.csv", "one line a frame: status, distance (mm), error, segmented and projected centre (px)", errorsOf(result) });
  return document;
}

}  // namespace

void writeValidationReport(const std::filesystem::path& folder, const ValidationStepResult& result, const io::Recording& recording,
  const report::PlotDrawer& drawPlot)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
  {
    throw io::FileError(folder, "the folder cannot be made: " + error.message());
  }
  for (const ValidatedFrame& frame : result.frames)
  {
    if (recording.hasImage(frame.captured.frame))
    {
      io::writePng(folder / frameName(frame.captured.frame),
        report::drawFrame(recording.image(frame.captured.frame), frame.captured.ball, projectedOf(frame)));
    }
  }
  report::writeReport(folder, makeDocument(result, recording, drawPlot));
}

}  // namespace handeye
