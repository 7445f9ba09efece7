// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHandEyeStereoOverlay.h"

#include "vtkHandEyeOverlayPipeline.h"
#include "vtkHandEyeOverlayPipelineInternals.h"

#include <opencv2/imgproc.hpp>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

vtkStandardNewMacro(vtkHandEyeStereoOverlay);

namespace
{

using Layout = vtkHandEyeStereoOverlay::Layout;
using Eye = vtkHandEyeOverlayScene::Eye;

constexpr int SuperSampling = 2;

/// Both eyes' scenes in one window.
struct Pair
{
  vtkNew<vtkHandEyeOverlayScene> Left, Right;

  void AttachTo(vtkRenderWindow* window)
  {
    this->Left->AttachTo(window);
    this->Right->AttachTo(window);
  }

  void Arrange(Layout layout, bool squeezed, bool swapped);
};

void Pair::Arrange(Layout layout, bool squeezed, bool swapped)
{
  vtkHandEyeOverlayScene* const first = swapped ? this->Right : this->Left;
  vtkHandEyeOverlayScene* const second = swapped ? this->Left : this->Right;
  std::array<double, 4> firstArea{ 0, 0, 1, 1 }, secondArea{ 0, 0, 1, 1 };
  std::array<double, 2> squeeze{ 1, 1 };
  Eye firstEye = Eye::Both, secondEye = Eye::Both;
  switch (layout)
  {
    case Layout::SideBySide:
      firstArea = { 0, 0, 0.5, 1 };
      secondArea = { 0.5, 0, 0.5, 1 };
      squeeze[0] = squeezed ? 0.5 : 1;
      break;
    case Layout::TopBottom:
      firstArea = { 0, 0.5, 1, 0.5 };
      secondArea = { 0, 0, 1, 0.5 };
      squeeze[1] = squeezed ? 0.5 : 1;
      break;
    case Layout::Interlaced:
      firstEye = Eye::LeftRows;
      secondEye = Eye::RightRows;
      break;
    case Layout::Anaglyph:
      firstEye = Eye::RedOfLeft;
      secondEye = Eye::CyanOfRight;
      break;
  }
  const auto place = [&squeeze](vtkHandEyeOverlayScene* scene, const std::array<double, 4>& area, Eye eye)
  {
    scene->SetArea(area);
    scene->SetSqueeze(squeeze);
    scene->SetEye(eye);
  };
  place(first, firstArea, firstEye);
  place(second, secondArea, secondEye);
}

}  // namespace

class vtkHandEyeStereoOverlay::Internals
{
public:
  vtkNew<vtkHandEyeOverlayPipeline> Left, Right;
  Pair WindowScenes, ImageScenes;
  vtkSmartPointer<vtkRenderWindow> ImageWindow;
  vtkNew<vtkUnsignedCharArray> Pixels;
  Layout Arrangement = Layout::SideBySide;
  bool Squeezed = false;
  bool Swapped = false;

  void Arrange()
  {
    this->WindowScenes.Arrange(this->Arrangement, this->Squeezed, this->Swapped);
    this->ImageScenes.Arrange(this->Arrangement, this->Squeezed, this->Swapped);
  }
};

vtkHandEyeStereoOverlay::vtkHandEyeStereoOverlay()
  : Internal(std::make_unique<Internals>())
{
  for (Pair* pair : { &this->Internal->WindowScenes, &this->Internal->ImageScenes })
  {
    this->Internal->Left->ConnectScene(pair->Left);
    this->Internal->Right->ConnectScene(pair->Right);
  }
  this->Internal->Arrange();
}

vtkHandEyeStereoOverlay::~vtkHandEyeStereoOverlay()
{
  // The scenes outlive the eyes only as long as their windows keep their renderers.
  this->Internal->WindowScenes.AttachTo(nullptr);
  this->Internal->ImageScenes.AttachTo(nullptr);
}

void vtkHandEyeStereoOverlay::PrintSelf(std::ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Layout: " << int(this->Internal->Arrangement) << "\n";
  os << indent << "Squeezed: " << this->Internal->Squeezed << "\n";
  os << indent << "Swapped: " << this->Internal->Swapped << "\n";
}

void vtkHandEyeStereoOverlay::SetLayout(Layout layout)
{
  this->Internal->Arrangement = layout;
  this->Internal->Arrange();
  this->Modified();
}

vtkHandEyeStereoOverlay::Layout vtkHandEyeStereoOverlay::GetLayout()
{
  return this->Internal->Arrangement;
}

void vtkHandEyeStereoOverlay::SetSqueezed(bool squeezed)
{
  this->Internal->Squeezed = squeezed;
  this->Internal->Arrange();
  this->Modified();
}

bool vtkHandEyeStereoOverlay::GetSqueezed()
{
  return this->Internal->Squeezed;
}

void vtkHandEyeStereoOverlay::SetSwapped(bool swapped)
{
  this->Internal->Swapped = swapped;
  this->Internal->Arrange();
  this->Modified();
}

bool vtkHandEyeStereoOverlay::GetSwapped()
{
  return this->Internal->Swapped;
}

vtkHandEyeOverlayPipeline* vtkHandEyeStereoOverlay::GetLeft()
{
  return this->Internal->Left;
}

vtkHandEyeOverlayPipeline* vtkHandEyeStereoOverlay::GetRight()
{
  return this->Internal->Right;
}

bool vtkHandEyeStereoOverlay::HandleKey(char key)
{
  switch (std::tolower(static_cast<unsigned char>(key)))
  {
    case 's':
      this->SetLayout(Layout((int(this->Internal->Arrangement) + 1) % (int(Layout::Anaglyph) + 1)));
      return true;
    case 'e':
      this->SetSwapped(!this->Internal->Swapped);
      return true;
    default:
      break;
  }
  const bool left = this->Internal->Left->HandleKey(key), right = this->Internal->Right->HandleKey(key);
  return left || right;
}

std::string vtkHandEyeStereoOverlay::GetProblem()
{
  const std::string left = this->Internal->Left->GetProblem(), right = this->Internal->Right->GetProblem();
  std::string problem = left.empty() ? std::string() : "left eye: " + left;
  if (!right.empty())
  {
    problem += (problem.empty() ? "right eye: " : "; right eye: ") + right;
  }
  return problem;
}

void vtkHandEyeStereoOverlay::AttachTo(vtkRenderWindow* window)
{
  this->Internal->WindowScenes.AttachTo(window);
  this->Modified();
}

bool vtkHandEyeStereoOverlay::ReadShown(cv::Mat& bgr)
{
  const auto read = [this](bool right, cv::Mat& picture)
  {
    vtkHandEyeOverlayPipeline* eye = right ? this->Internal->Right : this->Internal->Left;
    vtkHandEyeOverlayScene* scene = right ? this->Internal->WindowScenes.Right : this->Internal->WindowScenes.Left;
    // Rows that are averaged would belong to both eyes.
    const bool asItIs = this->Internal->Arrangement == Layout::Interlaced;
    const std::array<int, 2> size = asItIs ? std::array<int, 2>{ 0, 0 } : eye->Internal->State.ImageSize;
    return handeye::readShown(scene, size, this->Internal->Pixels, picture);
  };
  const Layout layout = this->Internal->Arrangement;
  cv::Mat first, second;
  if (layout == Layout::Interlaced || layout == Layout::Anaglyph)
  {
    return read(false, bgr);
  }
  if (!read(this->Internal->Swapped, first) || !read(!this->Internal->Swapped, second))
  {
    return false;
  }
  bgr = cv::Mat();
  if (second.size() != first.size())
  {
    cv::resize(second, second, first.size(), 0, 0, cv::INTER_AREA);
  }
  layout == Layout::SideBySide ? cv::hconcat(first, second, bgr) : cv::vconcat(first, second, bgr);
  return true;
}

void vtkHandEyeStereoOverlay::RenderToImage(cv::Mat& bgr)
{
  const std::string problem = this->GetProblem();
  if (!problem.empty())
  {
    throw std::runtime_error(problem);
  }
  const std::array<int, 2> left = this->Internal->Left->Internal->Update().ImageSize;
  const std::array<int, 2> right = this->Internal->Right->Internal->Update().ImageSize;
  int width = std::max(left[0], right[0]), height = std::max(left[1], right[1]);
  if (std::min({ left[0], left[1], right[0], right[1] }) < 1)
  {
    throw std::runtime_error("an eye has neither a video nor a camera, so the picture's size is not known");
  }
  const Layout layout = this->Internal->Arrangement;
  width *= layout == Layout::SideBySide && !this->Internal->Squeezed ? 2 : 1;
  height *= layout == Layout::TopBottom && !this->Internal->Squeezed ? 2 : 1;
  if (!this->Internal->ImageWindow)
  {
    this->Internal->ImageWindow = vtkSmartPointer<vtkRenderWindow>::New();
    this->Internal->ImageWindow->SetShowWindow(false);
    this->Internal->ImageWindow->SetOffScreenRendering(1);
    this->Internal->ImageWindow->SetMultiSamples(0);
    this->Internal->ImageScenes.AttachTo(this->Internal->ImageWindow);
  }
  // Rows that are averaged would belong to both eyes; masks are not averaged either.
  const bool mask = this->Internal->Left->GetMaskMode() || this->Internal->Right->GetMaskMode();
  const int scale = layout == Layout::Interlaced || mask ? 1 : SuperSampling;
  this->Internal->ImageWindow->SetSize(scale * width, scale * height);
  this->Internal->ImageWindow->Render();
  cv::Mat large;
  handeye::readPixels(this->Internal->ImageWindow, this->Internal->Pixels, { 0, 0, scale * width, scale * height }, large);
  cv::resize(large, bgr, cv::Size(width, height), 0, 0, cv::INTER_AREA);
}
