// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WindowPlots.h"

#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

namespace handeye
{

report::PlotDrawer drawInWindowThread(QObject& inWindowThread, std::function<bool()> isEnding)
{
  return [object = &inWindowThread, isEnding = std::move(isEnding)](const report::Plot& plot)
  {
    const auto promise = std::make_shared<std::promise<cv::Mat>>();
    std::future<cv::Mat> picture = promise->get_future();
    QMetaObject::invokeMethod(
      object,
      [promise, plot]
      {
        try
        {
          promise->set_value(report::drawPlot(plot));
        }
        catch (...)
        {
          promise->set_exception(std::current_exception());
        }
      },
      Qt::QueuedConnection);
    while (picture.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
    {
      if (isEnding())
      {
        throw std::runtime_error("the window was closed");
      }
    }
    return picture.get();
  };
}

}  // namespace handeye
