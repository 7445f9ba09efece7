// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyePainterDevice.h"

#include <QPainter>
#include <QPainterPath>
#include <QPolygonF>
#include <vtkBrush.h>
#include <vtkMatrix3x3.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>

#include <algorithm>

vtkStandardNewMacro(vtkHandEyePainterDevice);

namespace
{

QColor toQt(const unsigned char color[4])
{
  return { color[0], color[1], color[2], color[3] };
}

/// VTK multiplies columns, Qt rows.
QTransform toQt(vtkMatrix3x3* matrix)
{
  const auto at = [matrix](int row, int column) { return matrix->GetElement(row, column); };
  return { at(0, 0), at(1, 0), at(2, 0), at(0, 1), at(1, 1), at(2, 1), at(0, 2), at(1, 2), at(2, 2) };
}

QPointF pointAt(const float* points, int i)
{
  return { points[2 * i], points[2 * i + 1] };
}

QPolygonF polygonOf(const float* points, int n)
{
  QPolygonF polygon;
  for (int i = 0; i < n; ++i)
  {
    polygon << pointAt(points, i);
  }
  return polygon;
}

Qt::PenStyle styleOf(int lineType)
{
  switch (lineType)
  {
    case vtkPen::NO_PEN:
      return Qt::NoPen;
    case vtkPen::DASH_LINE:
      return Qt::DashLine;
    case vtkPen::DOT_LINE:
      return Qt::DotLine;
    case vtkPen::DASH_DOT_LINE:
    case vtkPen::DENSE_DOT_LINE:
      return Qt::DashDotLine;
    case vtkPen::DASH_DOT_DOT_LINE:
      return Qt::DashDotDotLine;
    default:
      return Qt::SolidLine;
  }
}

/// A colour of an array of one colour per point.
QColor colorAt(const unsigned char* colors, int components, int i, const QColor& otherwise)
{
  if (!colors || components < 3)
  {
    return otherwise;
  }
  const unsigned char* color = colors + i * components;
  return { color[0], color[1], color[2], components > 3 ? color[3] : 255 };
}

QPainterPath markerPath(int shape, double size)
{
  const double half = size / 2;
  QPainterPath path;
  switch (shape)
  {
    case vtkPlotPoints::CROSS:
      path.moveTo(-half, -half);
      path.lineTo(half, half);
      path.moveTo(-half, half);
      path.lineTo(half, -half);
      break;
    case vtkPlotPoints::PLUS:
      path.moveTo(-half, 0);
      path.lineTo(half, 0);
      path.moveTo(0, -half);
      path.lineTo(0, half);
      break;
    case vtkPlotPoints::SQUARE:
      path.addRect(-half, -half, size, size);
      break;
    case vtkPlotPoints::DIAMOND:
      path.addPolygon(QPolygonF({ { 0, half }, { half, 0 }, { 0, -half }, { -half, 0 }, { 0, half } }));
      break;
    default:
      path.addEllipse(QPointF(0, 0), half, half);
      break;
  }
  return path;
}

}  // namespace

void vtkHandEyePainterDevice::SetPainter(QPainter* painter, const QSize& size)
{
  this->Painter = painter;
  this->DeviceToPainter = QTransform(1, 0, 0, -1, 0, size.height());
  this->ModelToDevice = {};
  this->Stack.clear();
  this->Geometry[0] = size.width();
  this->Geometry[1] = size.height();
  if (painter)
  {
    painter->setWorldTransform(this->DeviceToPainter);
  }
}

void vtkHandEyePainterDevice::UsePen()
{
  QPen pen(toQt(this->Pen->GetColor()), std::max(1.0F, this->Pen->GetWidth()), styleOf(this->Pen->GetLineType()), Qt::FlatCap,
    Qt::MiterJoin);
  pen.setCosmetic(true);
  this->Painter->setPen(pen);
  this->Painter->setBrush(Qt::NoBrush);
}

void vtkHandEyePainterDevice::UseBrush()
{
  this->Painter->setPen(Qt::NoPen);
  this->Painter->setBrush(toQt(this->Brush->GetColor()));
}

void vtkHandEyePainterDevice::DrawPoly(float* points, int n, unsigned char* colors, int components)
{
  this->UsePen();
  if (!colors)
  {
    this->Painter->drawPolyline(polygonOf(points, n));
    return;
  }
  for (int i = 0; i + 1 < n; ++i)
  {
    QPen pen = this->Painter->pen();
    pen.setColor(colorAt(colors, components, i, pen.color()));
    this->Painter->setPen(pen);
    this->Painter->drawLine(pointAt(points, i), pointAt(points, i + 1));
  }
}

void vtkHandEyePainterDevice::DrawLines(float* points, int n, unsigned char* colors, int components)
{
  this->UsePen();
  for (int i = 0; i + 1 < n; i += 2)
  {
    QPen pen = this->Painter->pen();
    pen.setColor(colorAt(colors, components, i, pen.color()));
    this->Painter->setPen(pen);
    this->Painter->drawLine(pointAt(points, i), pointAt(points, i + 1));
  }
}

void vtkHandEyePainterDevice::DrawPoints(float* points, int n, unsigned char* colors, int components)
{
  this->DrawMarkers(vtkPlotPoints::CIRCLE, false, points, n, colors, components);
}

void vtkHandEyePainterDevice::DrawPointSprites(
  vtkImageData* vtkNotUsed(sprite), float* points, int n, unsigned char* colors, int components)
{
  this->DrawPoints(points, n, colors, components);
}

void vtkHandEyePainterDevice::DrawMarkers(
  int shape, bool vtkNotUsed(highlight), float* points, int n, unsigned char* colors, int components)
{
  // Marks keep their size whatever the axes' scales are: they are drawn in px.
  const QPainterPath path = markerPath(shape, this->Pen->GetWidth());
  const bool isFilled = shape != vtkPlotPoints::CROSS && shape != vtkPlotPoints::PLUS;
  const QTransform modelToPainter = this->ModelToDevice * this->DeviceToPainter;
  this->Painter->resetTransform();
  for (int i = 0; i < n; ++i)
  {
    const QPointF place = modelToPainter.map(pointAt(points, i));
    this->Painter->setPen(QPen(colorAt(colors, components, i, toQt(this->Pen->GetColor())), isFilled ? 1 : 2));
    this->Painter->setBrush(isFilled ? QBrush(colorAt(colors, components, i, toQt(this->Brush->GetColor()))) : QBrush(Qt::NoBrush));
    this->Painter->drawPath(path.translated(place));
  }
  this->Painter->setWorldTransform(modelToPainter);
}

void vtkHandEyePainterDevice::DrawQuad(float* points, int n)
{
  this->UseBrush();
  for (int i = 0; i + 3 < n; i += 4)
  {
    this->Painter->drawPolygon(polygonOf(points + 2 * i, 4));
  }
}

void vtkHandEyePainterDevice::DrawQuadStrip(float* points, int n)
{
  this->UseBrush();
  for (int i = 0; i + 3 < n; i += 2)
  {
    this->Painter->drawPolygon(
      QPolygonF({ pointAt(points, i), pointAt(points, i + 1), pointAt(points, i + 3), pointAt(points, i + 2) }));
  }
}

void vtkHandEyePainterDevice::DrawColoredPolygon(float* points, int n, unsigned char* colors, int components)
{
  this->UseBrush();
  this->Painter->setBrush(colorAt(colors, components, 0, this->Painter->brush().color()));
  this->Painter->drawPolygon(polygonOf(points, n));
}

void vtkHandEyePainterDevice::DrawEllipseWedge(
  float x, float y, float outRx, float outRy, float inRx, float inRy, float startAngle, float stopAngle)
{
  // Qt counts angles with y downwards.
  const auto box = [&](float rX, float rY) { return QRectF(x - rX, y - rY, 2 * rX, 2 * rY); };
  QPainterPath path;
  path.arcMoveTo(box(outRx, outRy), -startAngle);
  path.arcTo(box(outRx, outRy), -startAngle, startAngle - stopAngle);
  path.arcTo(box(inRx, inRy), -stopAngle, stopAngle - startAngle);
  path.closeSubpath();
  this->UseBrush();
  this->Painter->drawPath(path);
}

void vtkHandEyePainterDevice::DrawEllipticArc(float x, float y, float rX, float rY, float startAngle, float stopAngle)
{
  this->UsePen();
  const QRectF box(x - rX, y - rY, 2 * rX, 2 * rY);
  QPainterPath path;
  path.arcMoveTo(box, -startAngle);
  path.arcTo(box, -startAngle, startAngle - stopAngle);
  this->Painter->drawPath(path);
}

void vtkHandEyePainterDevice::DrawImage(float*, float, vtkImageData*)
{
  vtkWarningMacro("pictures in charts are not drawn");
}

void vtkHandEyePainterDevice::DrawImage(const vtkRectf&, vtkImageData*)
{
  vtkWarningMacro("pictures in charts are not drawn");
}

void vtkHandEyePainterDevice::DrawPolyData(float*, float, vtkPolyData*, vtkUnsignedCharArray*, int)
{
  vtkWarningMacro("polygon data in charts are not drawn");
}

void vtkHandEyePainterDevice::SetColor4(unsigned char color[4])
{
  this->Pen->SetColor(color[0], color[1], color[2], color[3]);
  this->Brush->SetColor(color[0], color[1], color[2], color[3]);
}

void vtkHandEyePainterDevice::SetTexture(vtkImageData* image, int vtkNotUsed(properties))
{
  if (image)
  {
    vtkWarningMacro("textures in charts are not drawn");
  }
}

void vtkHandEyePainterDevice::SetPointSize(float size)
{
  this->Pen->SetWidth(size);
}

void vtkHandEyePainterDevice::SetLineWidth(float width)
{
  this->Pen->SetWidth(width);
}

void vtkHandEyePainterDevice::SetLineType(int type)
{
  this->Pen->SetLineType(type);
}

void vtkHandEyePainterDevice::SetMatrix(vtkMatrix3x3* matrix)
{
  this->ModelToDevice = toQt(matrix);
  this->Painter->setWorldTransform(this->ModelToDevice * this->DeviceToPainter);
}

void vtkHandEyePainterDevice::GetMatrix(vtkMatrix3x3* matrix)
{
  const QTransform& m = this->ModelToDevice;
  const double elements[9] = { m.m11(), m.m21(), m.m31(), m.m12(), m.m22(), m.m32(), m.m13(), m.m23(), m.m33() };
  matrix->DeepCopy(elements);
}

void vtkHandEyePainterDevice::MultiplyMatrix(vtkMatrix3x3* matrix)
{
  this->ModelToDevice = toQt(matrix) * this->ModelToDevice;
  this->Painter->setWorldTransform(this->ModelToDevice * this->DeviceToPainter);
}

void vtkHandEyePainterDevice::PushMatrix()
{
  this->Stack.push_back(this->ModelToDevice);
}

void vtkHandEyePainterDevice::PopMatrix()
{
  if (!this->Stack.empty())
  {
    this->ModelToDevice = this->Stack.back();
    this->Stack.pop_back();
    this->Painter->setWorldTransform(this->ModelToDevice * this->DeviceToPainter);
  }
}

void vtkHandEyePainterDevice::SetClipping(int* rectangle)
{
  this->Painter->setWorldTransform(this->DeviceToPainter);
  this->Painter->setClipRect(QRectF(rectangle[0], rectangle[1], rectangle[2], rectangle[3]));
  this->Painter->setWorldTransform(this->ModelToDevice * this->DeviceToPainter);
}

void vtkHandEyePainterDevice::EnableClipping(bool enable)
{
  this->Painter->setClipping(enable);
}
