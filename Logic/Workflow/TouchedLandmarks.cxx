// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TouchedLandmarks.h"

#include "NumberWords.h"
#include "PivotCalibration.h"
#include "Statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace handeye
{

namespace
{

using Status = TouchedLandmarksResult::Status;

/// From this many landmarks on that were pivoted on, pivoting is how the recording was made: three fix a registration.
constexpr std::size_t LandmarksOfAHabit = 3;
/// Where no rest is known yet, pivoting is looked for in windows of this length, so many of which begin in each second.
constexpr double PivotWindowSec = 3;
constexpr double PivotWindowStepSec = 0.5;
/// A frame rate for recordings without timestamps, which PLUS always writes.
constexpr double AssumedFramesPerSec = 20;

/// The stylus in the frame of the phantom's marker.
struct StylusStream
{
  std::vector<int> frames;
  std::vector<double> timesSec;
  std::vector<Eigen::Isometry3d> stylusToPhantom;
};

std::string targetFrame(const std::string& transform)
{
  return transform.substr(transform.find("To") + 2);
}

/// The marker on what is touched, of the name that users give it.
std::string choosePhantom(const io::Recording& recording, const TouchedLandmarksOptions& options)
{
  const std::string target = targetFrame(options.stylusToTracker);
  std::vector<std::string> others;
  for (const std::string& name : recording.transformNames())
  {
    if (name != options.stylusToTracker && name.find("To") != std::string::npos && targetFrame(name) == target)
    {
      others.push_back(name);
    }
  }
  for (const char* marker : { "Phantom", "Reference" })
  {
    const auto found = std::find(others.begin(), others.end(), std::string(marker) + "To" + target);
    if (found != others.end())
    {
      return *found;
    }
  }
  return others.size() == 1 ? others.front() : std::string();
}

StylusStream readStream(const io::Recording& recording, TouchedLandmarksResult& names)
{
  StylusStream stream;
  if (recording.frameCount() > 0 && !recording.timestampSec(0))
  {
    names.warnings.push_back(
      "the recording has no timestamps: " + fixedDigits(AssumedFramesPerSec, 0) + " frames a second are assumed");
  }
  for (int frame = 0; frame < recording.frameCount(); ++frame)
  {
    const io::TransformSample stylus = recording.transform(frame, names.stylusToTracker);
    if (!stylus.isUsable())
    {
      continue;
    }
    Eigen::Isometry3d stylusToPhantom = stylus.transform;
    if (!names.phantomToTracker.empty())
    {
      const io::TransformSample phantom = recording.transform(frame, names.phantomToTracker);
      if (!phantom.isUsable())
      {
        continue;
      }
      stylusToPhantom = phantom.transform.inverse() * stylus.transform;
    }
    stream.frames.push_back(frame);
    stream.timesSec.push_back(recording.timestampSec(frame).value_or(frame / AssumedFramesPerSec));
    stream.stylusToPhantom.push_back(stylusToPhantom);
  }
  return stream;
}

/// The tip as the stream has it between two samples, if the stylus was pivoted then.
std::optional<Eigen::Vector3d> tipBetween(const StylusStream& stream, std::size_t begin, std::size_t end)
{
  PivotCalibrationOptions options;
  options.minimumPoses = 12;
  options.maximumRmsMm = 1.5;
  options.maximumTipMotionMm = 1;
  const PivotCalibrationResult pivot = calibratePivot(
    { stream.stylusToPhantom.begin() + std::ptrdiff_t(begin), stream.stylusToPhantom.begin() + std::ptrdiff_t(end) }, options);
  return pivot.isUsable() ? std::optional<Eigen::Vector3d>(pivot.tip_Stylus) : std::nullopt;
}

/// The middle of several estimates of the tip; nothing of fewer than two, or if they do not agree.
std::optional<Eigen::Vector3d> agreeOn(const std::vector<Eigen::Vector3d>& tips, double withinMm)
{
  if (tips.size() < 2)
  {
    return std::nullopt;
  }
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<double> values;
    for (const Eigen::Vector3d& tip : tips)
    {
      values.push_back(tip(axis));
    }
    middle(axis) = median(values);
  }
  const auto agreeing =
    std::count_if(tips.begin(), tips.end(), [&](const Eigen::Vector3d& tip) { return (tip - middle).norm() < withinMm; });
  return 2 * std::size_t(agreeing) > tips.size() ? std::optional<Eigen::Vector3d>(middle) : std::nullopt;
}

/// The tip about which the stylus turned anywhere in the stream.
std::optional<Eigen::Vector3d> tipOfStream(const StylusStream& stream, double withinMm)
{
  std::vector<Eigen::Vector3d> tips;
  double nextSec = stream.timesSec.empty() ? 0 : stream.timesSec.front();
  for (std::size_t begin = 0, end = 0; begin < stream.timesSec.size(); ++begin)
  {
    if (stream.timesSec[begin] < nextSec)
    {
      continue;
    }
    nextSec = stream.timesSec[begin] + PivotWindowStepSec;
    while (end < stream.timesSec.size() && stream.timesSec[end] < stream.timesSec[begin] + PivotWindowSec)
    {
      ++end;
    }
    if (const auto tip = tipBetween(stream, begin, end))
    {
      tips.push_back(*tip);
    }
  }
  return agreeOn(tips, withinMm);
}

std::vector<Rest> findRests(const StylusStream& stream, const Eigen::Vector3d& tip_Stylus, const StillnessOptions& options)
{
  StillnessDetector detector(tip_Stylus, options);
  std::vector<Rest> rests;
  const auto keep = [&](const std::optional<Rest>& rest)
  {
    if (rest)
    {
      rests.push_back(*rest);
    }
  };
  for (std::size_t k = 0; k < stream.frames.size(); ++k)
  {
    keep(detector.add(stream.timesSec[k], stream.stylusToPhantom[k]));
  }
  keep(detector.finish());
  return rests;
}

/// Two rests as one, averaged over the samples of both.
Rest joined(const Rest& a, const Rest& b)
{
  Rest both = a.count >= b.count ? a : b;
  const double count = double(a.count + b.count), shareA = a.count / count, shareB = b.count / count;
  const Eigen::Vector3d apart = a.tip_World - b.tip_World;
  both.tip_World = shareA * a.tip_World + shareB * b.tip_World;
  both.tipCovariance = shareA * a.tipCovariance + shareB * b.tipCovariance + shareA * shareB * (apart * apart.transpose());
  both.rmsMm = std::sqrt(both.tipCovariance.trace());
  both.kind = a.kind == Rest::Kind::Pivoted || b.kind == Rest::Kind::Pivoted ? Rest::Kind::Pivoted : Rest::Kind::Held;
  both.turn = std::max(a.turn, b.turn);
  both.beginSec = a.beginSec;
  both.endSec = b.endSec;
  both.firstSample = a.firstSample;
  both.lastSample = b.lastSample;
  both.count = a.count + b.count;
  both.leftOut = int(b.lastSample - a.firstSample + 1) - both.count;
  return both;
}

std::vector<Rest> joinSamePlaces(const std::vector<Rest>& rests, double samePlaceMm)
{
  std::vector<Rest> places;
  for (const Rest& rest : rests)
  {
    if (!places.empty() && (places.back().tip_World - rest.tip_World).norm() < samePlaceMm)
    {
      places.back() = joined(places.back(), rest);
    }
    else
    {
      places.push_back(rest);
    }
  }
  return places;
}

/// Sorts the rests into landmarks and others; samples become frames.
void sortRests(const std::vector<Rest>& rests, const StylusStream& stream, TouchedLandmarksResult& result)
{
  const auto isPivoted = [](const Rest& rest) { return rest.kind == Rest::Kind::Pivoted; };
  const bool pivotedOnly = std::size_t(std::count_if(rests.begin(), rests.end(), isPivoted)) >= LandmarksOfAHabit;
  for (const Rest& rest : rests)
  {
    TouchedLandmark landmark{ rest, rest.tip_World };
    landmark.rest.firstSample = stream.frames[std::size_t(rest.firstSample)];
    landmark.rest.lastSample = stream.frames[std::size_t(rest.lastSample)];
    (pivotedOnly && !isPivoted(rest) ? result.setAside : result.landmarks).push_back(landmark);
  }
}

std::string inWords(const Eigen::Vector3d& point)
{
  return "(" + fixedDigits(point.x(), 1) + ", " + fixedDigits(point.y(), 1) + ", " + fixedDigits(point.z(), 1) + ")";
}

/// What the recording says of the tip: from the rests that pivoted or, if there are none, from anywhere in it.
std::optional<Eigen::Vector3d> tipInRecording(const StylusStream& stream, const std::vector<Rest>& rests, double withinMm)
{
  std::vector<Eigen::Vector3d> tips;
  for (const Rest& rest : rests)
  {
    if (rest.kind == Rest::Kind::Pivoted)
    {
      if (const auto tip = tipBetween(stream, std::size_t(rest.firstSample), std::size_t(rest.lastSample) + 1))
      {
        tips.push_back(*tip);
      }
    }
  }
  const auto agreed = agreeOn(tips, withinMm);
  return agreed ? agreed : tipOfStream(stream, withinMm);
}

}  // namespace

void TouchedLandmarksOptions::check() const
{
  stillness.check();
  if (!(samePlaceMm >= 0) || !(largestTipErrorMm > 0))
  {
    throw std::invalid_argument("touched landmarks options: distances (mm) that are not negative are expected");
  }
}

std::vector<Eigen::Vector3d> TouchedLandmarksResult::points_Phantom() const
{
  std::vector<Eigen::Vector3d> points;
  for (const TouchedLandmark& landmark : landmarks)
  {
    points.push_back(landmark.point_Phantom);
  }
  return points;
}

TouchedLandmarksResult landmarksFromRecording(
  const io::Recording& recording, const std::optional<Eigen::Vector3d>& tip_Stylus, const TouchedLandmarksOptions& options)
{
  options.check();
  TouchedLandmarksResult result;
  result.stylusToTracker = options.stylusToTracker;
  recording.requireTransform(result.stylusToTracker);
  result.phantomToTracker = options.phantomToTracker.empty() ? choosePhantom(recording, options) : options.phantomToTracker;
  if (result.phantomToTracker.empty())
  {
    result.warnings.push_back("the recording has no marker on what is touched: the points are in the frame " +
      targetFrame(result.stylusToTracker) + ", and are good for as long as nothing moves");
  }
  else
  {
    recording.requireTransform(result.phantomToTracker);
  }
  const StylusStream stream = readStream(recording, result);
  const bool isTipKnown = tip_Stylus && !tip_Stylus->isZero(0);
  const auto tipOfRecording = isTipKnown ? std::nullopt : tipOfStream(stream, options.largestTipErrorMm);
  if (!tip_Stylus && !tipOfRecording)
  {
    result.status = Status::WrongTip;
    result.message = "the stylus was not pivoted in this recording, so that its tip is not known: give its calibration";
    return result;
  }
  result.tip_Stylus = tipOfRecording && !isTipKnown ? *tipOfRecording : *tip_Stylus;
  if (tip_Stylus && tipOfRecording && tipOfRecording->norm() > options.largestTipErrorMm)
  {
    result.warnings.push_back("the tip that was given is the marker's origin, but the stylus in this recording turns about " +
      inWords(result.tip_Stylus) + ", which is taken");
  }
  else if (tip_Stylus)
  {
    result.tip_Stylus = *tip_Stylus;
  }
  const std::vector<Rest> rests = joinSamePlaces(findRests(stream, result.tip_Stylus, options.stillness), options.samePlaceMm);
  sortRests(rests, stream, result);
  result.tipInRecording_Stylus = tipInRecording(stream, rests, options.largestTipErrorMm);
  const double tipErrorMm = result.tipInRecording_Stylus ? (*result.tipInRecording_Stylus - result.tip_Stylus).norm() : 0;
  if (tipErrorMm > options.largestTipErrorMm)
  {
    result.status = Status::WrongTip;
    result.message = "the stylus in this recording turns about " + inWords(*result.tipInRecording_Stylus) + ", which is " +
      fixedDigits(tipErrorMm, 1) + " mm from the tip that was given, " + inWords(result.tip_Stylus) + ": is this its calibration?";
    return result;
  }
  if (tipErrorMm > options.noticedTipErrorMm)
  {
    result.warnings.push_back("the stylus in this recording turns about " + inWords(*result.tipInRecording_Stylus) + ", " +
      fixedDigits(tipErrorMm, 1) + " mm from its tip: the touched points may be off by as much");
  }
  if (result.landmarks.empty())
  {
    result.message = "the tip rests nowhere within " + fixedDigits(options.stillness.maximumMotionMm, 1) + " mm for " +
      fixedDigits(options.stillness.minimumDurationSec, 1) + " s: hold the stylus on each landmark, or pivot it there, for longer";
    return result;
  }
  result.status = Status::Ok;
  result.message = std::to_string(result.landmarks.size()) + " landmarks found, " + std::to_string(result.setAside.size()) +
    " other rests set aside";
  return result;
}

std::string toString(Status status)
{
  switch (status)
  {
    case Status::Ok:
      return "ok";
    case Status::NoRests:
      return "no_rests";
    case Status::WrongTip:
      return "wrong_tip";
  }
  return "unknown";
}

}  // namespace handeye
