// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame of the overlay costs at 1920 x 1080, by software rendering (OSMesa), against a bare VTK scene that draws the same
// video square and the same mesh, opaque, with no lens: ratio_to_bare_vtk is our time over theirs. Both take turns in one process.
// Ours is given the frame as it comes from a camera (BGR, top row first), the bare scene one that is ready for VTK.
//
// latency_periods_30Hz: from the frame's arrival until its picture is finished, in periods of a video at 30 Hz. All are medians;
// the cpu ratio, of the processor time of all threads, is what to look at on a machine that has other things to do.
#include "EigenVtk.h"
#include "MeshReader.h"
#include "OffscreenRendering.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <vtkActor.h>
#include <vtkAppendPolyData.h>
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
#include <cmath>
#include <ctime>
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

/// A vertebra of 24,000 triangles, or each of them divided into 16, and a ball that makes up the number.
vtkSmartPointer<vtkPolyData> mesh(int triangles)
{
  vtkSmartPointer<vtkPolyData> vertebra = readMesh(std::string(HANDEYE_RESOURCES_DIR) + "/Meshes/Vertebra.ply");
  if (triangles > 400000)
  {
    vtkNew<vtkLinearSubdivisionFilter> finer;
    finer->SetInputData(vertebra);
    finer->SetNumberOfSubdivisions(2);
    finer->Update();
    vertebra = finer->GetOutput();
  }
  // A sphere source has 2 * theta * (phi - 2) triangles.
  const int resolution = int(std::lround(std::sqrt((triangles - double(vertebra->GetNumberOfPolys())) / 2))) + 1;
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(18);
  ball->SetThetaResolution(resolution);
  ball->SetPhiResolution(resolution);
  vtkNew<vtkAppendPolyData> both;
  both->AddInputData(vertebra);
  both->AddInputConnection(ball->GetOutputPort());
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputConnection(both->GetOutputPort());
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

struct Cost
{
  double sec = 0;     ///< on the clock
  double cpuSec = 0;  ///< of all threads of this process
};

template<class Scene> Cost costOf(Scene& scene, std::size_t frame)
{
  const auto start = Clock::now();
  const std::clock_t cpuStart = std::clock();
  scene.draw(frame);
  const double cpuSec = double(std::clock() - cpuStart) / CLOCKS_PER_SEC;
  return { std::chrono::duration<double>(Clock::now() - start).count(), cpuSec };
}

double median(const std::vector<Cost>& costs, double Cost::*part)
{
  std::vector<double> values;
  for (const Cost& cost : costs)
  {
    values.push_back(cost.*part);
  }
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void overlayFrame(benchmark::State& state)
{
  registerOffscreenRendering();
  const vtkSmartPointer<vtkPolyData> model = mesh(int(state.range(0)));
  OurScene ours(model, state.range(1) != 0);
  BareScene bare(model);
  std::size_t frame = 0;
  for (; frame < 3; ++frame)
  {
    ours.draw(frame);
    bare.draw(frame);
  }
  std::vector<Cost> ourCosts, bareCosts;
  for (auto _ : state)
  {
    ourCosts.push_back(costOf(ours, frame));
    bareCosts.push_back(costOf(bare, frame));
    state.SetIterationTime(ourCosts.back().sec);
    ++frame;
  }
  state.counters["triangles"] = double(model->GetNumberOfPolys());
  state.counters["bare_vtk_ms"] = 1000 * median(bareCosts, &Cost::sec);
  state.counters["ratio_to_bare_vtk"] = median(ourCosts, &Cost::sec) / median(bareCosts, &Cost::sec);
  state.counters["cpu_ratio_to_bare_vtk"] = median(ourCosts, &Cost::cpuSec) / median(bareCosts, &Cost::cpuSec);
  state.counters["latency_periods_30Hz"] = median(ourCosts, &Cost::sec) / PeriodSec;
}

BENCHMARK(overlayFrame)
  ->ArgNames({ "triangles", "undistorted" })
  ->Args({ 25000, 0 })
  ->Args({ 25000, 1 })
  ->Args({ 500000, 0 })
  ->Args({ 500000, 1 })
  ->UseManualTime()
  ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
