// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Letters: they keep their size whatever the scales of the axes are.
#include "vtkHandEyePainterDevice.h"

#include <QFont>
#include <QFontMetricsF>
#include <QPainter>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#if __has_include(<vtkUnicodeString.h>)  // up to VTK 9.1
#include <vtkUnicodeString.h>
#endif

#include <algorithm>

QFont vtkHandEyePainterDevice::TextFont() const
{
  QFont font = this->Painter->font();
  font.setPixelSize(std::max(1, this->TextProp->GetFontSize()));
  font.setBold(this->TextProp->GetBold() != 0);
  font.setItalic(this->TextProp->GetItalic() != 0);
  return font;
}

QRectF vtkHandEyePainterDevice::TextBox(const QString& text) const
{
  const QSizeF size = QFontMetricsF(this->TextFont(), this->Painter->device()).size(0, text);
  const int across = this->TextProp->GetJustification(), along = this->TextProp->GetVerticalJustification();
  const double left = across == VTK_TEXT_CENTERED ? size.width() / 2 : across == VTK_TEXT_RIGHT ? size.width() : 0;
  const double below = along == VTK_TEXT_CENTERED ? size.height() / 2 : along == VTK_TEXT_TOP ? size.height() : 0;
  return { -left, -below, size.width(), size.height() };
}

void vtkHandEyePainterDevice::DrawText(float* point, const QString& text)
{
  const QRectF box = this->TextBox(text);
  const QTransform modelToPainter = this->ModelToDevice * this->DeviceToPainter;
  double rgb[3];
  this->TextProp->GetColor(rgb);
  QColor color = QColor::fromRgbF(rgb[0], rgb[1], rgb[2]);
  color.setAlphaF(this->TextProp->GetOpacity());
  const QFont before = this->Painter->font();
  const QFont font = this->TextFont();
  QTransform placed;
  const QPointF anchor = modelToPainter.map(QPointF(point[0], point[1]));
  placed.translate(anchor.x(), anchor.y());
  placed.rotate(-this->TextProp->GetOrientation());
  this->Painter->setWorldTransform(placed);
  this->Painter->setFont(font);
  this->Painter->setPen(color);
  this->Painter->drawText(QRectF(box.left(), -box.bottom(), box.width(), box.height()), Qt::AlignCenter | Qt::TextDontClip, text);
  this->Painter->setFont(before);
  this->Painter->setWorldTransform(modelToPainter);
}

void vtkHandEyePainterDevice::DrawString(float* point, const vtkStdString& string)
{
  this->DrawText(point, QString::fromStdString(string));
}

void vtkHandEyePainterDevice::DrawMathTextString(float* point, const vtkStdString& string)
{
  this->DrawString(point, string);
}

/// The turned text's size; VTK's axes place it themselves.
void vtkHandEyePainterDevice::ComputeStringBounds(const vtkStdString& string, float bounds[4])
{
  this->ComputeJustifiedStringBounds(string.c_str(), bounds);
  bounds[0] = bounds[1] = 0;
}

void vtkHandEyePainterDevice::ComputeJustifiedStringBounds(const char* string, float bounds[4])
{
  QTransform turned;
  turned.rotate(this->TextProp->GetOrientation());
  const QRectF box = turned.mapRect(this->TextBox(QString::fromUtf8(string)));
  bounds[0] = float(box.left());
  bounds[1] = float(box.top());
  bounds[2] = float(box.width());
  bounds[3] = float(box.height());
}

#if __has_include(<vtkUnicodeString.h>)
void vtkHandEyePainterDevice::DrawString(float* point, const vtkUnicodeString& string)
{
  this->DrawText(point, QString::fromUtf8(string.utf8_str()));
}

void vtkHandEyePainterDevice::ComputeStringBounds(const vtkUnicodeString& string, float bounds[4])
{
  this->ComputeStringBounds(vtkStdString(string.utf8_str()), bounds);
}
#endif
