// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the overlay draws a point is compared with plain arithmetic, written out here and independent of the code under test.
#include "CameraModel.h"
#include "EigenVtk.h"
#include "OffscreenRendering.h"
#include "vtkHandEyeOverlayPipeline.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkSphereSource.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace
{

/// A lens, and what it does to a point: OpenCV's documented formulas.
struct Lens
{
  std::string name;
  int width, height;
  double fx, fy, cx, cy;
  std::vector<double> k;

  double at(std::size_t i) const { return i < this->k.size() ? this->k[i] : 0; }

  double radial(double r2) const
  {
    return (1 + at(0) * r2 + at(1) * r2 * r2 + at(4) * r2 * r2 * r2) / (1 + at(5) * r2 + at(6) * r2 * r2 + at(7) * r2 * r2 * r2);
  }

  /// x, y = X/Z, Y/Z to pixels.
  Eigen::Vector2d pixel(double x, double y) const
  {
    const double r2 = x * x + y * y;
    const double bentX = x * radial(r2) + 2 * at(2) * x * y + at(3) * (r2 + 2 * x * x) + at(8) * r2 + at(9) * r2 * r2;
    const double bentY = y * radial(r2) + at(2) * (r2 + 2 * y * y) + 2 * at(3) * x * y + at(10) * r2 + at(11) * r2 * r2;
    // R(tauX, tauY), and the projection of the tilted plane onto the untilted one.
    const double cX = std::cos(at(12)), sX = std::sin(at(12)), cY = std::cos(at(13)), sY = std::sin(at(13));
    const double r[3][3] = { { cY, sY * sX, -sY * cX }, { 0, cX, sX }, { sY, -cY * sX, cY * cX } };
    const double v[3] = { r[0][0] * bentX + r[0][1] * bentY + r[0][2], r[1][0] * bentX + r[1][1] * bentY + r[1][2],
      r[2][0] * bentX + r[2][1] * bentY + r[2][2] };
    const double tiltedX = (r[2][2] * v[0] - r[0][2] * v[2]) / v[2];
    const double tiltedY = (r[2][2] * v[1] - r[1][2] * v[2]) / v[2];
    return { fx * tiltedX + cx, fy * tiltedY + cy };
  }

  /// Undistorted radius beyond which the distorted one falls again.
  double foldRadius() const
  {
    double r = 0;
    while (r < 10 && (r + 0.001) * radial((r + 0.001) * (r + 0.001)) > r * radial(r * r))
    {
      r += 0.001;
    }
    return r;
  }

  /// The x, y seen at a pixel, by walking there; false if the lens never sees that pixel.
  bool seenAt(const Eigen::Vector2d& wanted, Eigen::Vector2d& point_Normalized) const
  {
    const double largestRadius = 0.97 * foldRadius();
    Eigen::Vector2d point(0, 0);
    for (int i = 0; i < 400; ++i)
    {
      const Eigen::Vector2d error = pixel(point.x(), point.y()) - wanted;
      if (error.norm() < 1e-5)
      {
        break;
      }
      point -= 0.7 * Eigen::Vector2d(error.x() / fx, error.y() / fy);
      if (!(point.norm() < 20))
      {
        return false;
      }
    }
    point_Normalized = point;
    return (pixel(point.x(), point.y()) - wanted).norm() < 1e-3 && point.norm() < largestRadius;
  }

  handeye::CameraModel camera() const
  {
    Eigen::Matrix3d matrix;
    matrix << fx, 0, cx, 0, fy, cy, 0, 0, 1;
    return handeye::CameraModel(width, height, matrix, k);
  }
};

std::ostream& operator<<(std::ostream& stream, const Lens& lens)
{
  return stream << lens.name;
}

const Lens webcam{ "Webcam", 640, 480, 601.7, 602.9, 316.2, 244.8, { 0.041, -0.112, -0.0007, 0.0011, 0.02 } };
const Lens laparoscope{ "Laparoscope", 720, 576, 812.3, 826, 366.9, 281.4, { -0.251, 0.094, 0.0008, -0.001, 0.011 } };
const Lens barrel{ "StrongBarrel", 640, 480, 600, 600, 319.5, 239.5, { -0.4, 0, 0, 0 } };
const std::vector<Lens> lenses = { webcam, laparoscope, barrel, { "Wide", 960, 720, 571, 571, 479.5, 359.5, { -0.19, 0, 0, 0 } },
  { "OffCentre", 640, 480, 560, 640, 359.5, 199.5, { -0.15, 0.05, 0.002, -0.003 } },
  { "Rational", 1280, 720, 900, 905, 650, 350, { 0.3, -0.1, 0.0005, -0.0004, 0.01, 0.45, -0.05, 0.005 } },
  { "Tilted", 800, 600, 700, 690, 410, 290,
    { -0.2, 0.05, 0.001, -0.002, 0.01, 0.02, 0.01, 0.001, 0.002, -0.001, -0.0015, 0.0005, 0.03, -0.02 } },
  { "NoDistortion", 640, 480, 600, 610, 300, 250, {} } };

Eigen::Isometry3d somePose()
{
  Eigen::Isometry3d modelToCamera = Eigen::Isometry3d::Identity();
  modelToCamera.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  modelToCamera.translation() << 40, -70, 210;
  return modelToCamera;
}

constexpr int DiscCorners = 24;

/// A mesh put together from points in the Camera frame, stored in the Model frame of somePose().
class MeshInCamera
{
public:
  MeshInCamera() { this->Points->SetDataTypeToDouble(); }
  vtkIdType add(const Eigen::Vector3d& point_Camera)
  {
    const Eigen::Vector3d point_Model = somePose().inverse() * point_Camera;
    return this->Points->InsertNextPoint(point_Model.data());
  }
  void face(std::initializer_list<vtkIdType> ids) { this->Faces->InsertNextCell(ids); }

  /// A flat disc facing along the axis: its outline's centroid is the image of its centre, but for the lens' curvature.
  void disc(const Eigen::Vector3d& centre_Camera, double radiusMm)
  {
    constexpr int corners = DiscCorners;
    const vtkIdType first = this->Points->GetNumberOfPoints();
    for (int i = 0; i < corners; ++i)
    {
      const double angle = 2 * M_PI * i / corners;
      this->add(centre_Camera + radiusMm * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    }
    for (int i = 1; i + 1 < corners; ++i)
    {
      this->face({ first, first + i, first + i + 1 });
    }
  }

  vtkSmartPointer<vtkPolyData> mesh()
  {
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(this->Points);
    mesh->SetPolys(this->Faces);
    return mesh;
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Faces;
};

/// What the straightened picture of this lens is: the same camera without its distortion.
Lens straightened(const Lens& lens)
{
  Lens plain = lens;
  plain.k.clear();
  return plain;
}

vtkSmartPointer<vtkHandEyeOverlayPipeline> maskPipeline(const Lens& lens, vtkPolyData* mesh)
{
  handeye::registerOffscreenRendering();
  auto pipeline = vtkSmartPointer<vtkHandEyeOverlayPipeline>::New();
  pipeline->SetCameraModel(lens.camera());
  pipeline->SetModel(mesh);
  pipeline->SetModelToCamera(handeye::toVtk(somePose()));
  pipeline->SetMaskMode(true);
  return pipeline;
}

constexpr double MarkerRadiusPx = 5;

struct MarkerField
{
  vtkSmartPointer<vtkPolyData> mesh;
  std::vector<Eigen::Vector2d> expected_Image;
};

/// Where plain arithmetic sees the middle of a disc's image: the centroid of its bent outline, which near the end of a lens model
/// is not the image of the disc's middle.
Eigen::Vector2d discCentroid(const Lens& lens, const Eigen::Vector2d& centre_Normalized, double radius_Normalized)
{
  constexpr int pointsOfAnEdge = 8;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < DiscCorners * pointsOfAnEdge; ++i)
  {
    const auto corner = [&](int index)
    {
      const double angle = 2 * M_PI * index / DiscCorners;
      return Eigen::Vector2d(centre_Normalized + radius_Normalized * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    };
    const double share = double(i % pointsOfAnEdge) / pointsOfAnEdge;
    const Eigen::Vector2d point = (1 - share) * corner(i / pointsOfAnEdge) + share * corner(i / pointsOfAnEdge + 1);
    outline.push_back(lens.pixel(point.x(), point.y()));
  }
  double area = 0;
  Eigen::Vector2d moment(0, 0);
  const Eigen::Vector2d origin = outline.front();
  for (std::size_t i = 0; i + 1 < outline.size(); ++i)
  {
    const Eigen::Vector2d a = outline[i] - origin, b = outline[i + 1] - origin;
    const double part = a.x() * b.y() - a.y() * b.x();
    area += part;
    moment += part * (a + b) / 3;
  }
  return origin + moment / area;
}

/// Markers over the whole picture, the corners included, at depths from 60 to 700 mm; and where plain arithmetic sees their
/// centres.
/// @param largestRadius points beyond it (X/Z, Y/Z) are left out
MarkerField markers(const Lens& lens, double radiusPx, int columns = 13, int rows = 10, double largestRadius = 1e9)
{
  constexpr std::array<double, 4> depths = { 60, 150, 300, 700 };
  const double margin = radiusPx + 4;
  MarkerField field;
  MeshInCamera mesh;
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      const Eigen::Vector2d wanted(margin + (lens.width - 1 - 2 * margin) * column / (columns - 1.0),
        margin + (lens.height - 1 - 2 * margin) * row / (rows - 1.0));
      Eigen::Vector2d seen;
      if (lens.seenAt(wanted, seen) && seen.norm() < 0.97 * largestRadius)
      {
        const double z = depths[std::size_t(row + 3 * column) % depths.size()];
        mesh.disc(z * seen.homogeneous(), radiusPx * z / lens.fx);
        field.expected_Image.push_back(discCentroid(lens, seen, radiusPx / lens.fx));
      }
    }
  }
  field.mesh = mesh.mesh();
  return field;
}

cv::Mat grey(const cv::Mat& bgr)
{
  cv::Mat single;
  cv::cvtColor(bgr, single, cv::COLOR_BGR2GRAY);
  return single;
}

struct Deviation
{
  double meanPx = 0;
  double maxPx = 0;
};

/// Each expected place has one marker near it, and there are no others. Markers touching the border (clipped) are an error too.
Deviation deviation(const cv::Mat& mask, const std::vector<Eigen::Vector2d>& expected)
{
  cv::Mat labels, statistics, centroids;
  const int found = cv::connectedComponentsWithStats(mask, labels, statistics, centroids, 8, CV_32S) - 1;
  EXPECT_EQ(found, int(expected.size()));
  Deviation result;
  for (const Eigen::Vector2d& place : expected)
  {
    double nearest = 1e9;
    for (int label = 1; label <= found; ++label)
    {
      nearest = std::min(nearest, (Eigen::Vector2d(centroids.at<double>(label, 0), centroids.at<double>(label, 1)) - place).norm());
    }
    result.meanPx += nearest / double(expected.size());
    result.maxPx = std::max(result.maxPx, nearest);
  }
  return result;
}

/// The same by centres of brightness, for pictures with smooth edges: whole components, and nothing but components.
Deviation weightedDeviation(const cv::Mat& picture, const std::vector<Eigen::Vector2d>& expected)
{
  cv::Mat labels;
  const int found = cv::connectedComponents(picture > 0, labels, 8, CV_32S) - 1;
  EXPECT_EQ(found, int(expected.size()));
  std::vector<Eigen::Vector3d> sums(std::size_t(found + 1), Eigen::Vector3d::Zero());
  for (int v = 0; v < picture.rows; ++v)
  {
    for (int u = 0; u < picture.cols; ++u)
    {
      sums[std::size_t(labels.at<int>(v, u))] += picture.at<uchar>(v, u) * Eigen::Vector3d(u, v, 1);
    }
  }
  Deviation result;
  for (const Eigen::Vector2d& place : expected)
  {
    double nearest = 1e9;
    for (std::size_t label = 1; label < sums.size(); ++label)
    {
      nearest = std::min(nearest, (sums[label].hnormalized() - place).norm());
    }
    result.meanPx += nearest / double(expected.size());
    result.maxPx = std::max(result.maxPx, nearest);
  }
  return result;
}

/// A round spot with a Gaussian profile (sigma 1.5 px), cut off where it would round to nothing.
void drawDot(cv::Mat& picture, const Eigen::Vector2d& centre)
{
  for (int v = int(centre.y()) - 6; v <= int(centre.y()) + 7; ++v)
  {
    for (int u = int(centre.x()) - 6; u <= int(centre.x()) + 7; ++u)
    {
      const double value = 250 * std::exp(-(Eigen::Vector2d(u, v) - centre).squaredNorm() / (2 * 1.5 * 1.5));
      picture.at<cv::Vec3b>(v, u) = cv::Vec3b::all(uchar(std::lround(value)));
    }
  }
}

cv::Mat renderedWindow(vtkRenderWindow* window, int width, int height)
{
  window->SetSize(width, height);
  window->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
  cv::Mat upright;
  cv::flip(cv::Mat(height, width, CV_8UC3, pixels->GetPointer(0)), upright, 0);
  return grey(upright);
}

class OverlayOracle : public testing::TestWithParam<Lens>
{
};

}  // namespace

TEST_P(OverlayOracle, Markers_AreWhereArithmeticPutsThem)
{
  const Lens lens = GetParam();
  const MarkerField field = markers(lens, MarkerRadiusPx);
  ASSERT_GT(field.expected_Image.size(), 90u);
  cv::Mat picture;
  maskPipeline(lens, field.mesh)->RenderToImage(picture);
  ASSERT_EQ(picture.size(), cv::Size(lens.width, lens.height));
  const Deviation off = deviation(grey(picture), field.expected_Image);
  std::cout << lens.name << ": " << field.expected_Image.size() << " markers, mean " << off.meanPx << " px, max " << off.maxPx
            << " px\n";
  // The centroid of a disc that consists of 80 whole pixels scatters by about 0.1 px; the test below looks closer.
  EXPECT_LT(off.meanPx, 0.12);
  EXPECT_LT(off.maxPx, 0.4);
}

TEST_P(OverlayOracle, MarkersMagnified_AreWhereArithmeticPutsThem)
{
  // Six window pixels for one of the video: what is left of the deviation is the lens' bending of a disc of 3 px, and our error.
  constexpr int magnification = 6;
  const Lens lens = GetParam();
  const MarkerField field = markers(lens, 3);
  const auto pipeline = maskPipeline(lens, field.mesh);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  const cv::Mat mask = renderedWindow(window, magnification * lens.width, magnification * lens.height);
  std::vector<Eigen::Vector2d> expected_Window;
  for (const Eigen::Vector2d& point : field.expected_Image)
  {
    expected_Window.emplace_back(magnification * (point.array() + 0.5) - 0.5);
  }
  const Deviation off = deviation(mask, expected_Window);
  std::cout << lens.name << ": " << field.expected_Image.size() << " markers, mean " << off.meanPx / magnification << " px, max "
            << off.maxPx / magnification << " px of the video\n";
  EXPECT_LT(off.meanPx / magnification, 0.02);
  EXPECT_LT(off.maxPx / magnification, 0.05);
}

TEST_P(OverlayOracle, Windows_OfAnySizeAndAspect_KeepTheMarkersInPlace)
{
  const Lens lens = GetParam();
  const MarkerField field = markers(lens, lens.width > 700 ? 9 : 6);  // large enough for a small window
  const auto pipeline = maskPipeline(lens, field.mesh);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  pipeline->AttachTo(window);
  for (const auto& [width, height] : { std::pair(500, 900), std::pair(1280, 720), std::pair(431, 1201), std::pair(2000, 1001) })
  {
    const cv::Mat mask = renderedWindow(window, width, height);
    const double scale = std::min(double(width) / lens.width, double(height) / lens.height);
    const int pictureWidth = int(std::lround(lens.width * scale)), pictureHeight = int(std::lround(lens.height * scale));
    const int left = (width - pictureWidth) / 2, top = height - pictureHeight - (height - pictureHeight) / 2;
    std::vector<Eigen::Vector2d> expected_Window;
    for (const Eigen::Vector2d& point : field.expected_Image)
    {
      expected_Window.emplace_back(
        left + (point.x() + 0.5) / lens.width * pictureWidth - 0.5, top + (point.y() + 0.5) / lens.height * pictureHeight - 0.5);
    }
    const Deviation off = deviation(mask, expected_Window);
    // In px of the window: again the whole pixels that a disc consists of, fewer in a small window.
    EXPECT_LT(off.meanPx, 0.2) << width << " x " << height;
    EXPECT_LT(off.maxPx, 0.6) << width << " x " << height;

    double point_Image[2], point_Display[2];
    const double point_Window[2] = { expected_Window[7].x(), height - 1 - expected_Window[7].y() };
    ASSERT_TRUE(pipeline->DisplayToImage(point_Window, point_Image));
    EXPECT_NEAR(point_Image[0], field.expected_Image[7].x(), 1e-9);
    EXPECT_NEAR(point_Image[1], field.expected_Image[7].y(), 1e-9);
    ASSERT_TRUE(pipeline->ImageToDisplay(point_Image, point_Display));
    EXPECT_NEAR(point_Display[0], point_Window[0], 1e-9);
    EXPECT_NEAR(point_Display[1], point_Window[1], 1e-9);
  }
}

TEST_P(OverlayOracle, FloorOfTwoTriangles_FromBehindTheCameraToFar_IsBentAndNotSmeared)
{
  // The largest triangles there can be: a floor 40 mm under the camera that begins behind it.
  constexpr double floorY = 40, halfWidth = 45, behind = -200, far = 500, nearPlane = 1;
  const Lens lens = GetParam();
  MeshInCamera floor;
  const vtkIdType a = floor.add({ -halfWidth, floorY, behind }), b = floor.add({ halfWidth, floorY, behind }),
                  c = floor.add({ halfWidth, floorY, far }), d = floor.add({ -halfWidth, floorY, far });
  floor.face({ a, b, c });
  floor.face({ a, c, d });
  const auto pipeline = maskPipeline(lens, floor.mesh());
  cv::Mat picture;
  pipeline->RenderToImage(picture);
  // Promised for a distance of 50 mm; the floor begins nearer, and for some lenses a million triangles do not suffice for 0.05 px.
  EXPECT_LT(pipeline->GetEdgeErrorPx(), 0.25);
  const cv::Mat mask = grey(picture);
  int wrong = 0, inside = 0;
  for (int v = 0; v < lens.height; v += 3)
  {
    for (int u = 0; u < lens.width; u += 3)
    {
      Eigen::Vector2d seen;
      if (!lens.seenAt({ double(u), double(v) }, seen))
      {
        continue;
      }
      const double z = floorY / seen.y();
      const double x = seen.x() * z;
      // Pixels whose centre is within 0.1 px or so of the floor's outline may be either.
      const double border = 0.15 * std::max(z, 1.0) / lens.fx;
      const double farBorder = 0.15 * z * z / floorY / lens.fy;
      if (std::abs(std::abs(x) - halfWidth) < border || std::abs(z - far) < farBorder)
      {
        continue;
      }
      const bool expected = z > nearPlane && z < far && std::abs(x) < halfWidth;
      inside += expected;
      wrong += expected != (mask.at<uchar>(v, u) != 0);
    }
  }
  std::cout << lens.name << ": " << inside << " pixels of the floor looked at, " << wrong << " wrong\n";
  EXPECT_GT(inside, 1000);
  EXPECT_EQ(wrong, 0);
}

TEST_P(OverlayOracle, FiveHundredMarkers_AreWhereArithmeticPutsThem_BothWays)
{
  // 25 x 20 over the whole picture, through the anti-aliased picture itself and not through a mask.
  const Lens lens = GetParam();
  for (const bool undistorted : { false, true })
  {
    const Lens shown = undistorted ? straightened(lens) : lens;
    // Within 0.92 of the radius where the lens model ends: beyond, a marker is squeezed to less than a pixel's width.
    const MarkerField field = markers(shown, 4, 25, 20, 0.92 / 0.97 * lens.foldRadius());
    ASSERT_GT(field.expected_Image.size(), lens.name == "Wide" || lens.name == "StrongBarrel" ? 400u : 499u);
    const auto pipeline = maskPipeline(lens, field.mesh);
    pipeline->SetMaskMode(false);
    pipeline->SetModelOpacity(1);
    pipeline->SetVideoFrame(cv::Mat(lens.height, lens.width, CV_8UC3, cv::Scalar(0, 0, 0)));
    handeye::OverlayLook look;
    look.undistorted = undistorted;
    pipeline->SetLook(look);
    cv::Mat picture;
    pipeline->RenderToImage(picture);
    const Deviation off = weightedDeviation(grey(picture), field.expected_Image);
    std::cout << lens.name << (undistorted ? ", undistorted video: " : ", raw video: ") << field.expected_Image.size()
              << " markers, mean " << off.meanPx << " px, max " << off.maxPx << " px\n";
    EXPECT_LT(off.meanPx, 0.1);
    EXPECT_LT(off.maxPx, 0.3);
  }
}

TEST_P(OverlayOracle, UndistortedVideo_ShowsWhatTheLensSawThere)
{
  // Blurred dots in the raw video, drawn with plain arithmetic, are to be found where a pinhole camera would see them: what fits
  // the model in the undistorted picture must be the video as well.
  const Lens lens = GetParam();
  cv::Mat raw(lens.height, lens.width, CV_8UC3, cv::Scalar(0, 0, 0));
  std::vector<Eigen::Vector2d> expected;
  constexpr int columns = 25, rows = 20;
  for (int i = 0; i < columns * rows; ++i)
  {
    const Eigen::Vector2d wanted(
      12 + (lens.width - 25.0) * (i % columns) / (columns - 1), 12 + (lens.height - 25.0) * int(i / columns) / (rows - 1));
    Eigen::Vector2d seen;
    if (straightened(lens).seenAt(wanted, seen) && seen.norm() < 0.97 * lens.foldRadius())
    {
      const Eigen::Vector2d dot = lens.pixel(seen.x(), seen.y());
      if (dot.x() > 8 && dot.y() > 8 && dot.x() < lens.width - 9 && dot.y() < lens.height - 9)
      {
        drawDot(raw, dot);
        expected.push_back(wanted);
      }
    }
  }
  ASSERT_GT(expected.size(), 350u);
  vtkNew<vtkPolyData> nothing;
  const auto pipeline = maskPipeline(lens, nothing);
  pipeline->SetMaskMode(false);
  pipeline->SetVideoFrame(raw);
  handeye::OverlayLook look;
  look.undistorted = true;
  pipeline->SetLook(look);
  cv::Mat picture;
  pipeline->RenderToImage(picture);
  const Deviation off = weightedDeviation(grey(picture), expected);
  std::cout << lens.name << ", undistorted video: " << expected.size() << " dots of the video, mean " << off.meanPx << " px, max "
            << off.maxPx << " px\n";
  EXPECT_LT(off.meanPx, 0.05);
  EXPECT_LT(off.maxPx, 0.3);
}

TEST_P(OverlayOracle, UndistortedWindow_KnowsThePixelsOfTheRecordedVideo)
{
  const Lens lens = GetParam();
  vtkNew<vtkPolyData> nothing;
  const auto pipeline = maskPipeline(lens, nothing);
  handeye::OverlayLook look;
  look.undistorted = true;
  pipeline->SetLook(look);
  vtkNew<vtkRenderWindow> window;
  pipeline->AttachTo(window);
  window->SetSize(lens.width, lens.height);
  window->Render();
  const double x = 0.21, y = -0.17;
  const double display[2] = { lens.fx * x + lens.cx, lens.height - 1 - (lens.fy * y + lens.cy) };
  double image[2], back[2];
  ASSERT_TRUE(pipeline->DisplayToImage(display, image));
  EXPECT_NEAR(image[0], lens.pixel(x, y).x(), 1e-9);
  EXPECT_NEAR(image[1], lens.pixel(x, y).y(), 1e-9);
  ASSERT_TRUE(pipeline->ImageToDisplay(image, back));
  EXPECT_NEAR(back[0], display[0], 1e-6);
  EXPECT_NEAR(back[1], display[1], 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Lenses, OverlayOracle, testing::ValuesIn(lenses), [](const auto& lens) { return lens.param.name; });

TEST(OverlayOracle, FarOffTheAxis_NothingFoldsBackIntoThePicture)
{
  for (const Lens& lens : { barrel, laparoscope, lenses[3] })
  {
    int foldedByArithmetic = 0;
    for (double angle = 0; angle < 6.2; angle += 0.26)
    {
      for (const double radius : { 1.35, 1.45, 1.58, 1.7, 2.2, 4.0, 15.0 })
      {
        const double x = radius * std::cos(angle), y = radius * std::sin(angle);
        const Eigen::Vector2d naive = lens.pixel(x, y);
        foldedByArithmetic += naive.x() > 0 && naive.y() > 0 && naive.x() < lens.width && naive.y() < lens.height;
        MeshInCamera mesh;
        mesh.disc(200 * Eigen::Vector3d(x, y, 1), 4);
        cv::Mat picture;
        maskPipeline(lens, mesh.mesh())->RenderToImage(picture);
        ASSERT_EQ(cv::countNonZero(grey(picture)), 0) << lens.name << " at " << x << ", " << y;
      }
      angle += 0.7;
    }
    std::cout << lens.name << ": " << foldedByArithmetic << " of the markers would have folded back\n";
    EXPECT_TRUE(lens.name != "StrongBarrel" || foldedByArithmetic > 0);
  }
}

TEST(OverlayOracle, LargeMeshAroundTheView_LeavesThePictureFree)
{
  // A ring around the axis, from just outside the picture to beside the camera: every vertex is outside, at folding radii too.
  for (const Lens& lens : { barrel, laparoscope, webcam, lenses[3] })
  {
    MeshInCamera ring;
    constexpr int sides = 12;
    for (int i = 0; i < sides; ++i)
    {
      const double angle = 2 * M_PI * i / sides;
      const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0);
      ring.add(400 * outward + Eigen::Vector3d(0, 0, 200));
      ring.add(2000 * outward + Eigen::Vector3d(0, 0, 5));
    }
    for (int i = 0; i < sides; ++i)
    {
      const vtkIdType here = 2 * i, next = 2 * ((i + 1) % sides);
      ring.face({ here, here + 1, next + 1 });
      ring.face({ here, next + 1, next });
    }
    cv::Mat picture;
    maskPipeline(lens, ring.mesh())->RenderToImage(picture);
    EXPECT_EQ(cv::countNonZero(grey(picture)), 0) << lens.name;
  }
}

TEST(OverlayOracle, BehindTheCamera_NothingIsDrawn)
{
  for (const Lens& lens : lenses)
  {
    for (const Eigen::Vector3d& centre :
      { Eigen::Vector3d(0, 0, -200), Eigen::Vector3d(60, -40, -300), Eigen::Vector3d(0, 0, -31) })
    {
      vtkNew<vtkSphereSource> sphere;
      sphere->SetRadius(30);
      sphere->SetThetaResolution(40);
      sphere->SetPhiResolution(40);
      const Eigen::Vector3d centre_Model = somePose().inverse() * centre;
      sphere->SetCenter(centre_Model.x(), centre_Model.y(), centre_Model.z());
      sphere->Update();
      cv::Mat picture;
      maskPipeline(lens, sphere->GetOutput())->RenderToImage(picture);
      EXPECT_EQ(cv::countNonZero(grey(picture)), 0) << lens.name << " at Z = " << centre.z();
    }
  }
}

TEST(OverlayOracle, AroundTheCamera_EverythingIsCovered)
{
  // The camera is inside of the mesh: wherever the lens model reaches, there is wall.
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(120);
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(60);
  const Eigen::Vector3d centre_Model = somePose().inverse() * Eigen::Vector3d(10, -5, 20);
  sphere->SetCenter(centre_Model.x(), centre_Model.y(), centre_Model.z());
  sphere->Update();
  for (const Lens& lens : { webcam, laparoscope })
  {
    cv::Mat picture;
    maskPipeline(lens, sphere->GetOutput())->RenderToImage(picture);
    EXPECT_EQ(cv::countNonZero(grey(picture)), lens.width * lens.height) << lens.name;
  }
}
