// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QSize>
#include <QTransform>
#include <vtkContextDevice2D.h>

#include <vector>

class QFont;
class QPainter;
class QRectF;

/// Draws VTK's charts with Qt's painter instead of OpenGL. No shader is compiled in the thread of the window (which without a graphics card
/// takes tenths of a second at the first chart), and letters are Qt's own, sharp at any pixel ratio.
///
/// Coordinates are VTK's: logical px from the lower left corner. A text property's font size is taken as px; the family is the painter's.
/// What charts of points, lines and axes draw is drawn; pictures and vtkPolyData are not, with a warning.
class vtkHandEyePainterDevice : public vtkContextDevice2D
{
public:
  static vtkHandEyePainterDevice* New();
  vtkTypeMacro(vtkHandEyePainterDevice, vtkContextDevice2D)

  /// To be called before each drawing. @param painter lives until the drawing is done; null after it. @param size of what it paints on
  void SetPainter(QPainter* painter, const QSize& size);

  void DrawPoly(float* points, int n, unsigned char* colors = nullptr, int components = 0) override;
  void DrawLines(float* points, int n, unsigned char* colors = nullptr, int components = 0) override;
  void DrawPoints(float* points, int n, unsigned char* colors = nullptr, int components = 0) override;
  void DrawPointSprites(vtkImageData* sprite, float* points, int n, unsigned char* colors = nullptr, int components = 0) override;
  /// The pen's width is the size of a mark, its colour the outline; the brush fills it.
  void DrawMarkers(int shape, bool highlight, float* points, int n, unsigned char* colors = nullptr, int components = 0) override;
  void DrawQuad(float* points, int n) override;
  void DrawQuadStrip(float* points, int n) override;
  void DrawColoredPolygon(float* points, int n, unsigned char* colors = nullptr, int components = 0) override;
  void DrawEllipseWedge(
    float x, float y, float outRx, float outRy, float inRx, float inRy, float startAngle, float stopAngle) override;
  void DrawEllipticArc(float x, float y, float rX, float rY, float startAngle, float stopAngle) override;

  void DrawString(float* point, const vtkStdString& string) override;
  void ComputeStringBounds(const vtkStdString& string, float bounds[4]) override;
#if __has_include(<vtkUnicodeString.h>)  // up to VTK 9.1
  void DrawString(float* point, const vtkUnicodeString& string) override;
  void ComputeStringBounds(const vtkUnicodeString& string, float bounds[4]) override;
#endif
  void ComputeJustifiedStringBounds(const char* string, float bounds[4]) override;
  /// As plain text.
  void DrawMathTextString(float* point, const vtkStdString& string) override;

  void DrawImage(float p[2], float scale, vtkImageData* image) override;
  void DrawImage(const vtkRectf& position, vtkImageData* image) override;
  void DrawPolyData(float p[2], float scale, vtkPolyData* polyData, vtkUnsignedCharArray* colors, int scalarMode) override;

  void SetColor4(unsigned char color[4]) override;
  void SetTexture(vtkImageData* image, int properties) override;
  void SetPointSize(float size) override;
  void SetLineWidth(float width) override;
  void SetLineType(int type) override;

  void SetMatrix(vtkMatrix3x3* matrix) override;
  void GetMatrix(vtkMatrix3x3* matrix) override;
  void MultiplyMatrix(vtkMatrix3x3* matrix) override;
  void PushMatrix() override;
  void PopMatrix() override;
  void SetClipping(int* rectangle) override;
  void EnableClipping(bool enable) override;

protected:
  vtkHandEyePainterDevice() = default;
  ~vtkHandEyePainterDevice() override = default;

private:
  vtkHandEyePainterDevice(const vtkHandEyePainterDevice&) = delete;
  void operator=(const vtkHandEyePainterDevice&) = delete;

  void UsePen();
  void UseBrush();
  QFont TextFont() const;
  /// The text about its anchor, before it is turned: to the right and upwards is positive.
  QRectF TextBox(const QString& text) const;
  void DrawText(float* point, const QString& text);

  QPainter* Painter = nullptr;
  QTransform DeviceToPainter;  ///< y upwards to y downwards
  QTransform ModelToDevice;
  std::vector<QTransform> Stack;
};
