// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VideoView.h"

#include "VideoMarks.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QTimer>
#include <QVTKInteractor.h>
#include <QVTKOpenGLNativeWidget.h>
#include <QVariantAnimation>
#include <opencv2/core.hpp>
#include <vtkCallbackCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

#include <algorithm>

namespace handeye
{

class VideoView::Private
{
public:
  explicit Private(VideoView& view)
    : gl(new QVTKOpenGLNativeWidget(&view))
    , marks(new VideoMarks([this](const QPointF& point_Image_Px) { return this->toWidget(point_Image_Px); }, &view))
  {
  }

  std::optional<QPointF> toWidget(const QPointF& point_Image_Px) const
  {
    const double image[2] = { point_Image_Px.x(), point_Image_Px.y() };
    double display[2];
    if (this->layout || !this->pipeline->ImageToDisplay(image, display))
    {
      return {};
    }
    // A display pixel's coordinate is its centre's; rows count from below.
    const double ratio = this->gl->devicePixelRatioF();
    const double height = this->window->GetSize()[1];
    return QPointF((display[0] + 0.5) / ratio, (height - display[1] - 0.5) / ratio);
  }

  std::optional<QPointF> toImage(const QPointF& point_Widget) const
  {
    const double ratio = this->gl->devicePixelRatioF();
    const double height = this->window->GetSize()[1];
    const double display[2] = { point_Widget.x() * ratio - 0.5, height - point_Widget.y() * ratio - 0.5 };
    double image[2];
    return !this->layout && this->pipeline->DisplayToImage(display, image) ? std::optional<QPointF>(QPointF(image[0], image[1]))
                                                                           : std::nullopt;
  }

  /// Marks are drawn again when the picture has moved below them. Not after every rendering: that would ask for the next one.
  void followPicture()
  {
    const std::optional<QPointF> first = this->toWidget({ 0, 0 });
    const std::optional<QPointF> second = this->toWidget({ 1000, 1000 });
    if (first != this->mappedFirst || second != this->mappedSecond)
    {
      this->mappedFirst = first;
      this->mappedSecond = second;
      this->marks->update();
    }
  }

  QVTKOpenGLNativeWidget* gl;
  VideoMarks* marks;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkHandEyeStereoOverlay> stereo;
  vtkHandEyeOverlayPipeline* pipeline = stereo->GetLeft();
  std::optional<vtkHandEyeStereoOverlay::Layout> layout;  ///< nothing: one eye
  vtkNew<vtkCallbackCommand> rendered;
  QTimer renderTimer;
  QVariantAnimation flash;
  /// A mark belongs to its picture, and is not seen before that.
  void applyDetection()
  {
    if (this->nextDetection)
    {
      this->marks->detection = *this->nextDetection;
      this->nextDetection.reset();
      this->marks->update();
    }
  }

  std::optional<QPointF> mappedFirst, mappedSecond;
  std::optional<std::optional<VideoView::DetectionMark>> nextDetection;  ///< of the picture that is about to be drawn
};

VideoView::VideoView(QWidget* parent)
  : QWidget(parent)
  , d(std::make_unique<Private>(*this))
{
  qRegisterMetaType<Qt::KeyboardModifiers>("Qt::KeyboardModifiers");
  this->setAccessibleName(tr("Video"));
  this->setMinimumSize(160, 120);
  d->gl->setRenderWindow(d->window);
  // Mouse and keys are the view's: nothing turns the video's camera.
  d->window->GetInteractor()->SetInteractorStyle(nullptr);
  d->gl->setFocusPolicy(Qt::StrongFocus);
  d->gl->installEventFilter(this);
  d->gl->setAccessibleName(tr("Video"));
  this->setFocusProxy(d->gl);
  d->pipeline->AttachTo(d->window);

  d->rendered->SetClientData(d.get());
  d->rendered->SetCallback(
    [](vtkObject*, unsigned long, void* self, void*)
    {
      static_cast<Private*>(self)->followPicture();
      static_cast<Private*>(self)->applyDetection();
    });
  d->window->AddObserver(vtkCommand::EndEvent, d->rendered);

  d->renderTimer.setSingleShot(true);
  d->renderTimer.setInterval(0);
  connect(&d->renderTimer, &QTimer::timeout, this,
    [this]
    {
      if (this->isVisible() && d->gl->isValid())
      {
        d->window->Render();
        emit this->rendered();
      }
      d->applyDetection();
    });

  d->flash.setDuration(450);
  d->flash.setStartValue(1.0);
  d->flash.setEndValue(0.0);
  connect(&d->flash, &QVariantAnimation::valueChanged, this,
    [this](const QVariant& value)
    {
      d->marks->flash = value.toDouble();
      d->marks->update();
    });
  this->setPlaceholderText(tr("No video"));
  d->marks->raise();
}

VideoView::~VideoView()
{
  d->window->RemoveObserver(d->rendered);
  d->stereo->AttachTo(nullptr);
  d->pipeline->AttachTo(nullptr);
}

vtkHandEyeOverlayPipeline* VideoView::rightPipeline() const
{
  return d->stereo->GetRight();
}

void VideoView::setStereo(const std::optional<vtkHandEyeStereoOverlay::Layout>& layout, bool isSwapped)
{
  if (layout)
  {
    d->stereo->SetLayout(*layout);
    d->stereo->SetSwapped(isSwapped);
  }
  if (layout.has_value() == d->layout.has_value())
  {
    d->layout = layout;
    return;
  }
  // The one that goes out first: both have the window's layers for themselves.
  d->layout = layout;
  if (layout)
  {
    d->pipeline->AttachTo(nullptr);
    d->stereo->AttachTo(d->window);
  }
  else
  {
    d->stereo->AttachTo(nullptr);
    d->pipeline->AttachTo(d->window);
  }
  d->marks->update();
}

std::optional<vtkHandEyeStereoOverlay::Layout> VideoView::stereo() const
{
  return d->layout;
}

bool VideoView::readShown(cv::Mat& bgr) const
{
  return d->layout ? d->stereo->ReadShown(bgr) : d->pipeline->ReadShown(bgr);
}

double VideoView::shownScale() const
{
  using Layout = vtkHandEyeStereoOverlay::Layout;
  const int columns = d->layout == Layout::SideBySide ? 2 : 1, rows = d->layout == Layout::TopBottom ? 2 : 1;
  const int* const size = d->window->GetActualSize();
  const QSize frame = this->frameSize();
  return frame.isEmpty() ? 0 : std::min(double(size[0]) / (columns * frame.width()), double(size[1]) / (rows * frame.height()));
}

void VideoView::setFrame(const cv::Mat& bgr)
{
  d->pipeline->SetVideoFrame(bgr);
  const QSize size(bgr.cols, bgr.rows);
  if (size != d->marks->frameSize)
  {
    d->marks->frameSize = size;
    d->marks->update();
  }
  this->requestRender();
}

bool VideoView::hasFrame() const
{
  return !d->marks->frameSize.isEmpty();
}

QSize VideoView::frameSize() const
{
  return d->marks->frameSize;
}

void VideoView::setPlaceholderText(const QString& text)
{
  d->marks->placeholder = text;
  d->marks->update();
}

vtkHandEyeOverlayPipeline* VideoView::pipeline() const
{
  return d->pipeline;
}

vtkRenderWindow* VideoView::renderWindow() const
{
  return d->window;
}

void VideoView::requestRender()
{
  if (!d->renderTimer.isActive())
  {
    d->renderTimer.start();
  }
}

void VideoView::setDetection(const std::optional<DetectionMark>& detection)
{
  d->nextDetection = detection;
  if (!d->renderTimer.isActive())
  {
    d->applyDetection();
  }
}

void VideoView::setGhostBall(const std::optional<GhostBall>& ghost)
{
  d->marks->ghost = ghost;
  d->marks->update();
}

void VideoView::setBanner(const QString& text, Level level)
{
  if (text == d->marks->banner && level == d->marks->bannerLevel)
  {
    return;
  }
  d->marks->banner = text;
  d->marks->bannerLevel = level;
  d->gl->setAccessibleDescription(text);
  d->marks->update();
}

QString VideoView::banner() const
{
  return d->marks->banner;
}

void VideoView::flash()
{
  d->flash.stop();
  d->flash.start();
}

std::optional<QPointF> VideoView::imageToWidget(const QPointF& point_Image_Px) const
{
  return this->hasFrame() ? d->toWidget(point_Image_Px) : std::nullopt;
}

std::optional<QPointF> VideoView::widgetToImage(const QPointF& point_Widget) const
{
  return this->hasFrame() ? d->toImage(point_Widget) : std::nullopt;
}

QImage VideoView::snapshot()
{
  QImage image = d->gl->grabFramebuffer();
  image.setDevicePixelRatio(d->gl->devicePixelRatioF());
  QPainter painter(&image);
  d->marks->draw(painter);
  return image;
}

QSize VideoView::sizeHint() const
{
  return { 640, 480 };
}

bool VideoView::eventFilter(QObject* watched, QEvent* event)
{
  if (watched != d->gl)
  {
    return QWidget::eventFilter(watched, event);
  }
  switch (event->type())
  {
    case QEvent::MouseButtonPress:
    {
      const auto* mouse = static_cast<QMouseEvent*>(event);
      const std::optional<QPointF> point = this->widgetToImage(mouse->localPos());
      // Pixel centres are whole numbers: the picture begins half a pixel before the first.
      const QRectF picture(QPointF(-0.5, -0.5), QSizeF(this->frameSize()));
      if (mouse->button() == Qt::LeftButton && point && picture.contains(*point))
      {
        emit imageClicked(*point);
      }
      return true;
    }
    case QEvent::KeyPress:
    {
      const auto* key = static_cast<QKeyEvent*>(event);
      switch (key->key())
      {
        case Qt::Key_Tab:
        case Qt::Key_Backtab:
          return false;
        case Qt::Key_Shift:
        case Qt::Key_Control:
        case Qt::Key_Alt:
        case Qt::Key_AltGr:
        case Qt::Key_Meta:
          return true;  // no key by itself
        default:
          emit keyPressed(key->key(), key->modifiers());
          return true;
      }
    }
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
    case QEvent::KeyRelease:
      return true;
    case QEvent::Wheel:
      event->ignore();  // the page around scrolls
      return true;
    default:
      return false;
  }
}

void VideoView::resizeEvent(QResizeEvent* event)
{
  QWidget::resizeEvent(event);
  d->gl->setGeometry(this->rect());
  d->marks->setGeometry(this->rect());
}

void VideoView::changeEvent(QEvent* event)
{
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange)
  {
    d->marks->update();
  }
}

void VideoView::showEvent(QShowEvent* event)
{
  QWidget::showEvent(event);
  this->requestRender();
}

}  // namespace handeye
