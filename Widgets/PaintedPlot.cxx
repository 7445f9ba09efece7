// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PaintedPlot.h"

#include "PlotChart.h"
#include "vtkHandEyePainterDevice.h"

#include <QFont>
#include <QFontMetricsF>
#include <QImage>
#include <QPainter>
#include <opencv2/imgproc.hpp>
#include <vtkChartXY.h>
#include <vtkContext2D.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace handeye
{

cv::Mat paintPlot(const report::Plot& plot)
{
  QImage image(plot.width, plot.height, QImage::Format_RGB888);
  image.fill(Qt::white);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  const auto widthOf = [&painter](const std::string& line, vtkTextProperty* look)
  {
    QFont font = painter.font();
    font.setPixelSize(std::max(1, look->GetFontSize()));
    font.setBold(look->GetBold() != 0);
    return int(std::ceil(QFontMetricsF(font, painter.device()).horizontalAdvance(QString::fromStdString(line))));
  };
  vtkNew<vtkContextScene> scene;
  scene->AddItem(report::plotChart(plot, widthOf));
  scene->SetGeometry(plot.width, plot.height);
  vtkNew<vtkHandEyePainterDevice> device;
  vtkNew<vtkContext2D> context;
  device->SetPainter(&painter, image.size());
  context->Begin(device);
  scene->Paint(context);
  context->End();
  device->SetPainter(nullptr, image.size());
  painter.end();
  const cv::Mat rgb(image.height(), image.width(), CV_8UC3, image.bits(), std::size_t(image.bytesPerLine()));
  cv::Mat picture;
  cv::cvtColor(rgb, picture, cv::COLOR_RGB2BGR);
  return picture;
}

report::PlotDrawer paintUnless(std::function<bool()> isUnwanted)
{
  return [isUnwanted = std::move(isUnwanted)](const report::Plot& plot)
  {
    if (isUnwanted())
    {
      throw std::runtime_error("the report was cancelled");
    }
    return paintPlot(plot);
  };
}

}  // namespace handeye
