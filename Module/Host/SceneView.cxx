// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SceneView.h"

#include "Icons.h"
#include "SceneFloor.h"
#include "Theme.h"

#include <QVTKOpenGLNativeWidget.h>
#include <vtkAxesActor.h>
#include <vtkCamera.h>
#include <vtkCaptionActor2D.h>
#include <vtkCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkTextProperty.h>

#include <QActionGroup>
#include <QElapsedTimer>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QSettings>
#include <QToolButton>
#include <QVBoxLayout>

#include <functional>

namespace desktop
{

namespace
{

// A trackball with one key, R. VTK's other keys (wireframe, stereo, quit...) are not for a room in which somebody leans on the keyboard.
class TrackballStyle : public vtkInteractorStyleTrackballCamera
{
public:
  static TrackballStyle* New();
  vtkTypeMacro(TrackballStyle, vtkInteractorStyleTrackballCamera)

  void OnChar() override
  {
    const char key = this->GetInteractor()->GetKeyCode();
    if ((key == 'r' || key == 'R') && this->Reset)
    {
      this->Reset();
    }
  }

  std::function<void()> Reset;
};

vtkStandardNewMacro(TrackballStyle);

}  // namespace

static constexpr int shortestIntervalMs = 16;
static constexpr int longestIntervalMs = 300;

static const QString floorKey = QStringLiteral("Desktop/floor");

SceneView::SceneView(QWidget* parent)
  : QWidget(parent)
  , View(new QVTKOpenGLNativeWidget(this))
  , Bar(new QWidget)
  , Floor(std::make_unique<SceneFloor>(this->Renderer))
{
  this->setObjectName(QStringLiteral("SceneView"));
  this->View->setAccessibleName(tr("Three-dimensional view"));
  // Dropped files are the window's.
  this->View->setAcceptDrops(false);
  this->View->setMinimumSize(160, 120);
  this->View->setRenderWindow(this->Window.Get());
  this->Window->AddRenderer(this->Renderer);
  this->Window->SetMultiSamples(0);
  this->Renderer->SetUseFXAA(true);
  vtkNew<TrackballStyle> style;
  style->Reset = [this] { this->resetCamera(); };
  style->AddObserver(vtkCommand::StartInteractionEvent, this, &SceneView::stopFitting);
  this->View->interactor()->SetInteractorStyle(style);

  vtkNew<vtkAxesActor> axes;
  this->Axes->SetOrientationMarker(axes);
  this->Axes->SetInteractor(this->View->interactor());
  this->Axes->SetViewport(0, 0, 0.18, 0.24);
  this->Axes->EnabledOn();
  this->Axes->InteractiveOff();

  this->makeBar();
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(this->Bar);
  layout->addWidget(this->View, 1);

  this->RenderTimer.setSingleShot(true);
  this->RenderTimer.setInterval(shortestIntervalMs);
  connect(&this->RenderTimer, &QTimer::timeout, this, &SceneView::render);
  this->setFloor(QSettings().value(floorKey, int(SceneFloor::Plane::AcrossY)).toInt());
  this->applyTheme();
  this->resetCamera();
}

SceneView::~SceneView()
{
  // While there is still an interactor to take it out of.
  this->Axes->EnabledOff();
  this->Axes->SetInteractor(nullptr);
}

void SceneView::makeBar()
{
  auto* const title = new QLabel(tr("3D"));
  title->setToolTip(tr("The scene in the tracker's frame, mm"));
  this->Reset = new QToolButton;
  this->Reset->setObjectName(QStringLiteral("SceneReset"));
  this->Reset->setAutoRaise(true);
  this->Reset->setToolTip(tr("Shows everything (R in the view)"));
  this->Reset->setAccessibleName(tr("Show the whole scene"));
  connect(this->Reset, &QToolButton::clicked, this, &SceneView::resetCamera);
  this->Sides = new QToolButton;
  this->Sides->setAutoRaise(true);
  this->Sides->setPopupMode(QToolButton::InstantPopup);
  this->Sides->setToolTip(tr("Look from a side; where the floor lies"));
  this->Sides->setAccessibleName(tr("Look from a side"));
  auto* const menu = new QMenu(this->Sides);
  const QString names[3] = { tr("X"), tr("Y"), tr("Z") };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const bool positive : { true, false })
    {
      const QString text = positive ? tr("From +%1").arg(names[axis]) : tr("From -%1").arg(names[axis]);
      connect(menu->addAction(text), &QAction::triggered, this, [this, axis, positive] { this->lookAlong(axis, positive); });
    }
  }
  QMenu* const floor = menu->addMenu(tr("Floor"));
  auto* const group = new QActionGroup(this);
  const QStringList planes = { tr("None"), tr("Across X"), tr("Across Y"), tr("Across Z") };
  const int chosen = QSettings().value(floorKey, int(SceneFloor::Plane::AcrossY)).toInt();
  for (int plane = 0; plane < planes.size(); ++plane)
  {
    QAction* const action = group->addAction(floor->addAction(planes[plane]));
    action->setCheckable(true);
    action->setChecked(plane == chosen);
    connect(action, &QAction::triggered, this, [this, plane] { this->setFloor(plane); });
  }
  this->Sides->setMenu(menu);
  this->Scale = new QLabel;
  this->Scale->setToolTip(tr("The distance between two lines of the floor, mm"));

  auto* const row = new QHBoxLayout(this->Bar);
  row->setContentsMargins(6, 1, 6, 1);
  row->addWidget(title);
  row->addWidget(this->Reset);
  row->addWidget(this->Sides);
  row->addStretch(1);
  row->addWidget(this->Scale);
}

vtkRenderer* SceneView::renderer() const
{
  return this->Renderer;
}

void SceneView::requestRender()
{
  if (!this->RenderTimer.isActive())
  {
    this->RenderTimer.start();
  }
}

void SceneView::render()
{
  if (!this->isVisible())
  {
    return;
  }
  ++this->RenderCount;
  if (this->IsFitting)
  {
    this->fitIfOutgrown();
  }
  // A module's props moved: what is near and far has changed with them.
  this->Renderer->ResetCameraClippingRange();
  QElapsedTimer clock;
  clock.start();
  this->Window->Render();
  // Where drawing is slow (OpenGL in software), two thirds of the time are left to everything else.
  this->RenderTimer.setInterval(qBound(shortestIntervalMs, 2 * int(clock.elapsed()), longestIntervalMs));
}

void SceneView::showEvent(QShowEvent* event)
{
  this->QWidget::showEvent(event);
  this->requestRender();
}

void SceneView::setFloor(int plane)
{
  this->Floor->setPlane(SceneFloor::Plane(qBound(0, plane, int(SceneFloor::Plane::AcrossZ))));
  QSettings().setValue(floorKey, int(this->Floor->plane()));
  double bounds[6];
  this->measureScene(bounds);
  this->requestRender();
}

void SceneView::measureScene(double bounds[6])
{
  this->Floor->setCounted(false);
  this->Renderer->ComputeVisiblePropBounds(bounds);
  this->Floor->setCounted(true);
  this->Floor->placeUnder(bounds);
  const bool hasFloor = this->Floor->plane() != SceneFloor::Plane::None;
  this->Scale->setText(hasFloor ? tr("floor: %1 mm").arg(this->Floor->spacingMm()) : QString());
}

void SceneView::stopFitting()
{
  this->IsFitting = false;
}

void SceneView::fitIfOutgrown()
{
  double bounds[6];
  this->Floor->setCounted(false);
  this->Renderer->ComputeVisiblePropBounds(bounds);
  this->Floor->setCounted(true);
  const vtkBoundingBox now(bounds);
  if (!now.IsValid() || (this->Shown.IsValid() && this->Shown.Contains(now) != 0))
  {
    return;
  }
  // With some room, so that a tool that moves does not push the view at every step.
  vtkBoundingBox grown = this->Shown;
  grown.AddBox(now);
  grown.Inflate(grown.GetMaxLength() * 0.05);
  this->Shown = grown;
  this->Shown.GetBounds(bounds);
  this->Floor->placeUnder(bounds);
  this->Scale->setText(
    this->Floor->plane() != SceneFloor::Plane::None ? tr("floor: %1 mm").arg(this->Floor->spacingMm()) : QString());
  this->fitCamera(bounds);
}

void SceneView::fitCamera(const double bounds[6])
{
  constexpr double viewAngleDeg = 30;
  this->Renderer->GetActiveCamera()->SetViewAngle(viewAngleDeg);
  this->Renderer->ResetCamera(bounds);
  const int* const size = this->Window->GetSize();
  if (this->isVisible() && size[0] > 1 && size[1] > 1)
  {
    // Closer than the sphere about the bounds, which leaves much of a narrow view empty.
    this->Renderer->ResetCameraScreenSpace(bounds);
  }
}

void SceneView::resetCamera()
{
  double bounds[6];
  this->measureScene(bounds);
  this->IsFitting = true;
  this->Shown.SetBounds(bounds);
  if (bounds[0] > bounds[1])
  {
    vtkCamera* const camera = this->Renderer->GetActiveCamera();
    camera->SetFocalPoint(0, 0, 0);
    camera->SetPosition(700, 600, 1200);
    camera->SetViewUp(0, 1, 0);
  }
  else
  {
    this->fitCamera(bounds);
  }
  this->requestRender();
}

void SceneView::lookAlong(int axis, bool fromPositive)
{
  vtkCamera* const camera = this->Renderer->GetActiveCamera();
  double position[3] = {};
  position[axis] = fromPositive ? 1000 : -1000;
  double viewUp[3] = {};
  viewUp[axis == 1 ? 2 : 1] = axis == 1 ? -1 : 1;
  camera->SetFocalPoint(0, 0, 0);
  camera->SetPosition(position);
  camera->SetViewUp(viewUp);
  this->resetCamera();
}

void SceneView::changeEvent(QEvent* event)
{
  this->QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && this->Floor)
  {
    this->applyTheme();
  }
}

void SceneView::applyTheme()
{
  const bool dark = isDark();
  const double bottom = dark ? 0.10 : 0.80;
  const double top = dark ? 0.22 : 0.95;
  this->Renderer->GradientBackgroundOn();
  this->Renderer->SetBackground(bottom, bottom + 0.01, bottom + 0.03);
  this->Renderer->SetBackground2(top, top + 0.01, top + 0.02);
  const double line = dark ? 0.55 : 0.45;
  this->Floor->setColor(line, line, line);
  auto* const axes = vtkAxesActor::SafeDownCast(this->Axes->GetOrientationMarker());
  for (vtkCaptionActor2D* const caption :
    { axes->GetXAxisCaptionActor2D(), axes->GetYAxisCaptionActor2D(), axes->GetZAxisCaptionActor2D() })
  {
    const double text = dark ? 0.9 : 0.1;
    caption->GetCaptionTextProperty()->SetColor(text, text, text);
    caption->GetCaptionTextProperty()->ShadowOff();
    caption->GetCaptionTextProperty()->ItalicOff();
  }
  this->Reset->setIcon(icon(QStringLiteral("reset-view")));
  this->Sides->setIcon(icon(QStringLiteral("sides")));
  this->requestRender();
}

}  // namespace desktop
