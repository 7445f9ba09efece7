// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EigenVtk.h"

#include "RigidTransform.h"

#include <opencv2/imgproc.hpp>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <stdexcept>
#include <string>

namespace handeye
{

namespace
{

void requirePointer(const void* pointer, const char* what)
{
  if (!pointer)
  {
    throw std::invalid_argument(std::string("no ") + what + " given");
  }
}

}  // namespace

void toVtk(const Eigen::Matrix4d& aToB, vtkMatrix4x4* matrix)
{
  requirePointer(matrix, "matrix");
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = aToB;
  matrix->DeepCopy(rows.data());
}

void toVtk(const Eigen::Isometry3d& aToB, vtkMatrix4x4* matrix)
{
  toVtk(aToB.matrix(), matrix);
}

vtkSmartPointer<vtkMatrix4x4> toVtk(const Eigen::Isometry3d& aToB)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  toVtk(aToB, matrix);
  return matrix;
}

Eigen::Matrix4d toEigen(const vtkMatrix4x4* matrix)
{
  requirePointer(matrix, "matrix");
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(&matrix->Element[0][0]);
}

Eigen::Isometry3d toIsometry(const vtkMatrix4x4* matrix)
{
  const std::optional<Eigen::Isometry3d> rigid = toRigid(toEigen(matrix));
  if (!rigid)
  {
    throw std::invalid_argument("the matrix is not a rigid transform (rotation and translation only)");
  }
  return *rigid;
}

std::vector<Eigen::Vector3d> toEigen(vtkPoints* points)
{
  requirePointer(points, "points");
  std::vector<Eigen::Vector3d> coordinates(std::size_t(points->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    points->GetPoint(i, coordinates[std::size_t(i)].data());
  }
  return coordinates;
}

void toVtk(const cv::Mat& picture, vtkImageData* image)
{
  requirePointer(image, "image");
  if (picture.empty() || picture.dims != 2 || picture.depth() != CV_8U || picture.channels() == 2 || picture.channels() > 4)
  {
    throw std::invalid_argument("a picture must have 8 bits a channel and be grey, BGR or BGRA");
  }
  image->SetOrigin(0, 0, 0);
  image->SetSpacing(1, 1, 1);
  image->SetExtent(0, picture.cols - 1, 0, picture.rows - 1, 0, 0);
  if (image->GetScalarType() != VTK_UNSIGNED_CHAR || image->GetNumberOfScalarComponents() != 3 || !image->GetScalarPointer() ||
    image->GetPointData()->GetScalars()->GetNumberOfTuples() != vtkIdType(picture.cols) * picture.rows)
  {
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  }
  cv::Mat target(picture.rows, picture.cols, CV_8UC3, image->GetScalarPointer());
  const int conversion =
    picture.channels() == 1 ? cv::COLOR_GRAY2RGB : (picture.channels() == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGB);
  cv::Mat upright;
  cv::flip(picture, upright, 0);
  cv::cvtColor(upright, target, conversion);
  image->GetPointData()->GetScalars()->Modified();
  image->Modified();
}

cv::Mat toOpenCV(vtkImageData* image)
{
  requirePointer(image, "image");
  int size[3];
  image->GetDimensions(size);
  const int components = image->GetNumberOfScalarComponents();
  if (size[0] < 1 || size[1] < 1 || size[2] != 1 || !image->GetScalarPointer() || image->GetScalarType() != VTK_UNSIGNED_CHAR ||
    components == 2 || components > 4)
  {
    throw std::invalid_argument("an image must be one slice with 8 bits a component and 1, 3 or 4 components");
  }
  const cv::Mat source(size[1], size[0], CV_8UC(components), image->GetScalarPointer());
  const int conversion = components == 1 ? cv::COLOR_GRAY2BGR : (components == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGR);
  cv::Mat upright, picture;
  cv::flip(source, upright, 0);
  cv::cvtColor(upright, picture, conversion);
  return picture;
}

}  // namespace handeye
