// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame of the overlay costs at 1920 x 1080, by software rendering (OSMesa), against a bare VTK scene that draws the same
// video square and the same mesh, opaque, with no lens: ratio_to_bare_vtk is our time over theirs. Both take turns in one process.
// Ours is given the frame as it comes from a camera (BGR, top row first), the bare scene one that is ready for VTK.
//
// Latency: from the frame's arrival until the picture can be read, in periods of a video at 30 Hz; `periods` is the mean, `worst`
// the slowest of them.
#include "EigenVtk.h"
#include "MeshReader.h"
#include "OffscreenRendering.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkLinearSubdivisionFilter.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkTexture.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace
{

using namespace handeye;
using Clock = std::chrono::steady_clock;

constexpr int Width = 1920, Height = 1080;
constexpr double PeriodSec = 1 / 30.0;

CameraModel camera()
{
  Eigen::Matrix3d matrix;
  matrix << 1400, 0, 961.3, 0, 1402, 537.2, 0, 0, 1;
  return CameraModel(Width, Height, matrix, { -0.19, 0.05, 0.0006, -0.0008, 0.004 });
}

vtkSmartPointer<vtkMatrix4x4> modelToCamera()
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 0.3, -0.2).normalized()).toRotationMatrix();
  pose.translation() << 8, -5, 230;
  return toVtk(pose);
}

/// About 25,000 triangles: a vertebra; 500,000: the same shape of meshes, finer.
vtkSmartPointer<vtkPolyData> mesh(int triangles)
{
  vtkSmartPointer<vtkPolyData> vertebra = readMesh(std::string(HANDEYE_RESOURCES_DIR) + "/Meshes/Vertebra.ply");
  if (triangles > 100000)
  {
    // Each of 24,000 triangles becomes 16, and a ball of 116,000 stands in the vertebra's place as well.
    vtkNew<vtkLinearSubdivisionFilter> finer;
    finer->SetInputData(vertebra);
    finer->SetNumberOfSubdivisions(2);
    finer->Update();
    vertebra = finer->GetOutput();
  }
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(vertebra);
  normals->SplittingOff();
  normals->Update();
  return normals->GetOutput();
}

std::vector<cv::Mat> frames()
{
  std::vector<cv::Mat> result(2, cv::Mat(Height, Width, CV_8UC3));
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    result[i] = cv::Mat(Height, Width, CV_8UC3);
    cv::RNG(i + 1).fill(result[i], cv::RNG::UNIFORM, 0, 256);
  }
  return result;
}

/// The peer: what one would write with VTK if there were no lens.
class BareScene
{
public:
  explicit BareScene(vtkPolyData* model)
  {
    for (const cv::Mat& frame : frames())
    {
      images_.emplace_back(vtkSmartPointer<vtkImageData>::New());
      toVtk(frame, images_.back());
    }
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(-1, -1, 0);
    plane->SetPoint1(1, -1, 0);
    plane->SetPoint2(-1, 1, 0);
    vtkNew<vtkPolyDataMapper> planeMapper;
    planeMapper->SetInputConnection(plane->GetOutputPort());
    vtkNew<vtkActor> video;
    video->SetMapper(planeMapper);
    video->GetProperty()->LightingOff();
    texture_->SetColorModeToDirectScalars();
    video->SetTexture(texture_);
    background_->AddActor(video);
    background_->GetActiveCamera()->ParallelProjectionOn();
    background_->GetActiveCamera()->SetParallelScale(1);
    background_->GetActiveCamera()->SetExplicitAspectRatio(1);
    background_->GetActiveCamera()->UseExplicitAspectRatioOn();

    vtkNew<vtkPolyDataMapper> modelMapper;
    modelMapper->SetInputData(model);
    vtkNew<vtkActor> actor;
    actor->SetMapper(modelMapper);
    actor->SetUserMatrix(modelToCamera());
    foreground_->AddActor(actor);
    foreground_->GetActiveCamera()->SetPosition(0, 0, 0);
    foreground_->GetActiveCamera()->SetFocalPoint(0, 0, 1);
    foreground_->GetActiveCamera()->SetViewUp(0, -1, 0);
    foreground_->GetActiveCamera()->SetViewAngle(42.1);
    foreground_->SetLayer(1);
    window_->SetMultiSamples(0);
    window_->SetNumberOfLayers(2);
    window_->AddRenderer(background_);
    window_->AddRenderer(foreground_);
    window_->SetSize(Width, Height);
    texture_->SetInputData(images_[0]);
    foreground_->ResetCameraClippingRange();
  }

  void draw(std::size_t frame)
  {
    texture_->SetInputData(images_[frame % 2]);
    images_[frame % 2]->Modified();
    window_->Render();
    window_->WaitForCompletion();
  }

private:
  std::vector<vtkSmartPointer<vtkImageData>> images_;
  vtkNew<vtkTexture> texture_;
  vtkNew<vtkRenderer> background_, foreground_;
  vtkNew<vtkRenderWindow> window_;
};

class OurScene
{
public:
  OurScene(vtkPolyData* model, bool undistorted)
    : frames_(frames())
  {
    pipeline_->SetCameraModel(camera());
    pipeline_->SetModel(model);
    pipeline_->SetModelToCamera(modelToCamera());
    OverlayLook look;
    look.undistorted = undistorted;
    pipeline_->SetLook(look);
    window_->SetMultiSamples(0);
    window_->SetSize(Width, Height);
    pipeline_->AttachTo(window_);
  }

  void draw(std::size_t frame)
  {
    pipeline_->SetVideoFrame(frames_[frame % 2]);
    window_->Render();
    window_->WaitForCompletion();
  }

private:
  std::vector<cv::Mat> frames_;
  vtkNew<vtkHandEyeOverlayPipeline> pipeline_;
  vtkNew<vtkRenderWindow> window_;
};

template <class Scene>
double secondsFor(Scene& scene, std::size_t frame)
{
  const auto start = Clock::now();
  scene.draw(frame);
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void overlayFrame(benchmark::State& state)
{
  registerOffscreenRendering();
  const vtkSmartPointer<vtkPolyData> model = mesh(int(state.range(0)));
  OurScene ours(model, state.range(1) != 0);
  BareScene bare(model);
  std::size_t frame = 0;
  double oursSec = 0, bareSec = 0, worstSec = 0;
  for (int warm = 0; warm < 3; ++warm)
  {
    ours.draw(frame);
    bare.draw(frame++);
  }
  for (auto _ : state)
  {
    const double sec = secondsFor(ours, frame);
    bareSec += secondsFor(bare, frame);
    state.SetIterationTime(sec);
    oursSec += sec;
    worstSec = std::max(worstSec, sec);
    ++frame;
  }
  state.counters["triangles"] = double(model->GetNumberOfPolys());
  state.counters["bare_vtk_ms"] = 1000 * bareSec / double(state.iterations());
  state.counters["ratio_to_bare_vtk"] = oursSec / bareSec;
  state.counters["periods_30Hz"] = oursSec / double(state.iterations()) / PeriodSec;
  state.counters["worst_periods_30Hz"] = worstSec / PeriodSec;
}

BENCHMARK(overlayFrame)
  ->ArgNames({ "triangles", "undistorted" })
  ->Args({ 25000, 0 })
  ->Args({ 25000, 1 })
  ->Args({ 500000, 0 })
  ->Args({ 500000, 1 })
  ->UseManualTime()
  ->MinTime(3)
  ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
