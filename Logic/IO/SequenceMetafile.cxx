// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SequenceMetafile.h"

#include "FileError.h"
#include "NumberText.h"
#include "RigidTransform.h"
#include "SequenceHeader.h"
#include "SequencePixels.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <stdexcept>

namespace handeye::io
{

namespace
{

TransformSample sampleOf(const SequenceTransform& transform)
{
  TransformSample sample;
  sample.status = TransformSample::Status::Invalid;
  if (!transform.status.empty() && !equalsIgnoreCase(transform.status, "OK"))
  {
    sample.reason = "the tracker reported the status " + inQuotes(transform.status);
    return sample;
  }
  if (!transform.matrix->allFinite())
  {
    sample.reason = "its matrix has a number that is not finite";
    return sample;
  }
  const std::optional<Eigen::Isometry3d> rigid = toRigid(*transform.matrix);
  if (!rigid)
  {
    sample.reason = "its matrix is not a rigid motion (a rotation, a translation and the last row 0 0 0 1)";
    return sample;
  }
  sample.status = TransformSample::Status::Ok;
  sample.transform = *rigid;
  return sample;
}

/// Rows from the top, columns from the left: the order MF.
void orient(const SequenceHeader& header, cv::Mat& image)
{
  const std::string orientation = header.orientation.substr(0, 2);  // a third letter is for volumes
  if (orientation == "MF" || orientation == "XX")
  {
    return;
  }
  if (orientation != "MN" && orientation != "UF" && orientation != "UN")
  {
    throw FileError(
      header.path, "'UltrasoundImageOrientation' is " + inQuotes(header.orientation) + "; expected MF, MN, UF, UN or XX");
  }
  const int flipCode = orientation == "MN" ? 0 : orientation == "UF" ? 1 : -1;
  cv::Mat flipped;
  cv::flip(image, flipped, flipCode);
  image = flipped;
}

void swapBytes(cv::Mat& image)
{
  for (int row = 0; row < image.rows; ++row)
  {
    std::uint8_t* bytes = image.ptr(row);
    for (std::size_t i = 0; i + 1 < image.cols * image.elemSize(); i += 2)
    {
      std::swap(bytes[i], bytes[i + 1]);
    }
  }
}

}  // namespace

std::string withoutTransformSuffix(const std::string& name)
{
  constexpr std::string_view suffix = "Transform";
  const bool hasSuffix = name.size() > suffix.size() && name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
  return hasSuffix ? name.substr(0, name.size() - suffix.size()) : name;
}

SequenceMetafile::SequenceMetafile() = default;
SequenceMetafile::SequenceMetafile(SequenceMetafile&&) noexcept = default;
SequenceMetafile& SequenceMetafile::operator=(SequenceMetafile&&) noexcept = default;
SequenceMetafile::~SequenceMetafile() = default;

SequenceMetafile SequenceMetafile::open(const std::filesystem::path& path)
{
  SequenceMetafile metafile;
  metafile.header_ = std::make_unique<SequenceHeader>(readSequenceHeader(path));
  if (metafile.header_->hasImages())
  {
    metafile.pixels_ = SequencePixels::open(*metafile.header_);
  }
  return metafile;
}

const std::filesystem::path& SequenceMetafile::path() const
{
  return header_->path;
}
int SequenceMetafile::frameCount() const
{
  return header_->frameCount;
}
bool SequenceMetafile::hasImages() const
{
  return header_->hasImages();
}
int SequenceMetafile::width() const
{
  return header_->width;
}
int SequenceMetafile::height() const
{
  return header_->height;
}
const std::vector<std::string>& SequenceMetafile::transformNames() const
{
  return header_->transformNames;
}
const std::map<std::string, std::string>& SequenceMetafile::fields() const
{
  return header_->fields;
}
const std::vector<std::string>& SequenceMetafile::warnings() const
{
  return header_->warnings;
}

const SequenceFrame& SequenceMetafile::frame(int index) const
{
  if (index < 0 || index >= header_->frameCount)
  {
    throw std::out_of_range("frame " + std::to_string(index) + " of " + std::to_string(header_->frameCount));
  }
  static const SequenceFrame nothing;
  const auto found = header_->frames.find(index);
  return found == header_->frames.end() ? nothing : found->second;
}

TransformSample SequenceMetafile::transform(int index, const std::string& name) const
{
  const auto& transforms = frame(index).transforms;
  const auto found = transforms.find(withoutTransformSuffix(name));
  if (found == transforms.end() || !found->second.matrix)
  {
    TransformSample sample;
    sample.reason = "the frame has no transform '" + withoutTransformSuffix(name) + "'";
    return sample;
  }
  return sampleOf(found->second);
}

cv::Mat SequenceMetafile::image(int index) const
{
  frame(index);  // throws where there is none
  if (!pixels_)
  {
    throw FileError(header_->path, "the file has transforms only; images were expected");
  }
  cv::Mat image(header_->height, header_->width, CV_MAKETYPE(header_->bytesPerSample == 2 ? CV_16U : CV_8U, header_->channels));
  pixels_->read(index, image.data);
  if (header_->bytesPerSample == 2 && header_->isBigEndian)
  {
    swapBytes(image);
  }
  if (header_->channels > 1)
  {
    cv::Mat reordered;
    cv::cvtColor(image, reordered, header_->channels == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
    image = reordered;
  }
  orient(*header_, image);
  return image;
}

}  // namespace handeye::io
