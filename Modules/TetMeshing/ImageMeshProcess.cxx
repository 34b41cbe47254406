// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMeshProcess.h"

#include "MesherProcess.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <Eigen/LU>

#include <algorithm>
#include <climits>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr MesherProgram Program = { "knotwork-mesh3", "CGAL's mesher", "the image",
  "give the array and the level that make the solid, or other sizes" };

Result<vtkDataArray*> FindValues(vtkImageData* data, const std::string& name)
{
  std::vector<vtkDataArray*> found;
  vtkPointData* arrays = data->GetPointData();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = arrays->GetArray(i);
    const char* own = array ? array->GetName() : nullptr; // images of VTK's sources have none
    if (array && array->GetNumberOfComponents() == 1 && (name.empty() || (own && name == own)))
    {
      found.push_back(array);
    }
  }
  const auto active = std::find(found.begin(), found.end(), arrays->GetScalars());
  if (active != found.end() || found.size() == 1)
  {
    return active != found.end() ? *active : found.front();
  }
  return { ErrorCode::InvalidParameter,
    (name.empty() ? "the image has " + std::to_string(found.size()) + " point arrays"
                  : "the image has no point array '" + name + "'") +
      " of one component; name the one that tells what is solid (ImageArray)" };
}

std::vector<std::string> Encode(const VolumeImage& image, const ImageMeshParams& params)
{
  const TetrahedraParams& asked = params.Tetrahedra;
  const Eigen::Matrix3d inverse = image.Axes.inverse();
  const auto inImage = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d
  { return inverse * (point - image.Origin); };
  std::vector<double> bounds(static_cast<std::size_t>(ImageMeshBound::Count));
  const auto bound = [&](ImageMeshBound which) -> double&
  { return bounds[static_cast<std::size_t>(which)]; };
  bound(ImageMeshBound::Solid) = static_cast<double>(params.Solid);
  bound(ImageMeshBound::Level) = params.Level;
  bound(ImageMeshBound::Distance) = params.Distance;
  bound(ImageMeshBound::RadiusEdgeRatio) = asked.RadiusEdgeRatio;
  bound(ImageMeshBound::MinDihedralAngle) = asked.MinDihedralAngle;
  bound(ImageMeshBound::EdgeLength) = EdgeOfVolume(asked.MaxVolume);
  bound(ImageMeshBound::MaxPoints) = asked.MaxSteinerPoints;
  std::vector<double> regions;
  for (const RegionSize& size : asked.RegionSizes)
  {
    const Eigen::Vector3d at = inImage(size.Point);
    regions.insert(regions.end(), at.data(), at.data() + at.size());
    regions.push_back(size.Length);
  }
  PointMatrix points = asked.Sizes.Points;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    points.row(i) = inImage(points.row(i).transpose()).transpose();
  }
  std::vector<std::string> parts(static_cast<std::size_t>(ImageMeshInput::Count));
  const auto part = [&](ImageMeshInput which) -> std::string&
  { return parts[static_cast<std::size_t>(which)]; };
  part(ImageMeshInput::Size) = PackNumbers(image.Size.data(), image.Size.size());
  part(ImageMeshInput::Spacing) = PackNumbers(image.Spacing.data(), 3);
  part(ImageMeshInput::Values) = PackNumbers(image.Values.data(), image.Values.size());
  part(ImageMeshInput::Bounds) = PackNumbers(bounds.data(), bounds.size());
  part(ImageMeshInput::Regions) = PackNumbers(regions.data(), regions.size());
  part(ImageMeshInput::SizePoints) =
    PackNumbers(points.data(), static_cast<std::size_t>(points.size()));
  part(ImageMeshInput::SizeCells) = PackGroups(asked.Sizes.Cells);
  part(ImageMeshInput::Sizes) = PackGroups(asked.Sizes.Lengths);
  return parts;
}

Result<ImageTetrahedra> Decode(const VolumeImage& image, const std::vector<std::string>& parts)
{
  const auto part = [&](ImageMeshAnswer which) -> const std::string&
  { return parts[static_cast<std::size_t>(which)]; };
  if (parts.size() != static_cast<std::size_t>(ImageMeshAnswer::Count))
  {
    return { ErrorCode::LibraryError, std::string(Program.File) + " is of another version" };
  }
  ImageTetrahedra found;
  Tetrahedra& solid = found.Solid;
  const std::vector<double> points = UnpackNumbers<double>(part(ImageMeshAnswer::Points));
  solid.Points.resize(static_cast<Eigen::Index>(points.size() / 3), 3);
  for (Eigen::Index i = 0; i < solid.Points.rows(); ++i)
  {
    const Eigen::Map<const Eigen::Vector3d> at(points.data() + 3 * i);
    solid.Points.row(i) = (image.Origin + image.Axes * at).transpose();
  }
  solid.Cells = UnpackGroups<4>(part(ImageMeshAnswer::Tetrahedra));
  solid.Labels = UnpackNumbers<int>(part(ImageMeshAnswer::Labels));
  solid.Triangles = UnpackGroups<3>(part(ImageMeshAnswer::Triangles));
  // of the surface the points that it uses alone
  std::vector<int> numbers(static_cast<std::size_t>(solid.Points.rows()), -1);
  std::vector<int> used;
  for (std::size_t t = 0; t < solid.Triangles.size(); ++t)
  {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      int& number = numbers[static_cast<std::size_t>(solid.Triangles[t][k])];
      if (number < 0)
      {
        number = static_cast<int>(used.size());
        used.push_back(solid.Triangles[t][k]);
      }
      corners[k] = number;
    }
    found.Surface.Triangles.push_back(corners);
    solid.Sources.push_back(static_cast<int>(t));
  }
  found.Surface.Points.resize(static_cast<Eigen::Index>(used.size()), 3);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    found.Surface.Points.row(static_cast<Eigen::Index>(i)) = solid.Points.row(used[i]);
  }
  return found;
}
}

double VolumeImage::Diagonal() const
{
  Eigen::Vector3d box;
  for (Eigen::Index d = 0; d < 3; ++d)
  {
    box[d] = (this->Size[static_cast<std::size_t>(d)] - 1) * this->Spacing[d];
  }
  return box.norm();
}

Result<VolumeImage> DecodeImage(vtkImageData* data, const std::string& name, bool areLabels)
{
  VolumeImage image;
  data->GetDimensions(image.Size.data());
  if (*std::min_element(image.Size.begin(), image.Size.end()) < 2)
  {
    return { ErrorCode::InvalidTopology,
      "the image has no volume: " + std::to_string(image.Size[0]) + " x " +
        std::to_string(image.Size[1]) + " x " + std::to_string(image.Size[2]) +
        " points; give two at least in each direction" };
  }
  const auto array = FindValues(data, name);
  if (!array)
  {
    return array.Status;
  }
  data->GetPoint(0, image.Origin.data());
  vtkIdType stride = 1;
  for (Eigen::Index d = 0; d < 3; ++d)
  {
    Eigen::Vector3d next;
    data->GetPoint(stride, next.data());
    image.Spacing[d] = (next - image.Origin).norm();
    image.Axes.col(d) = (next - image.Origin) / image.Spacing[d];
    stride *= image.Size[static_cast<std::size_t>(d)];
  }
  const char* own = array.Value->GetName();
  const auto place = [own](vtkIdType p)
  {
    return (own ? "the array '" + std::string(own) + "'" : std::string("the value")) +
      " at point " + std::to_string(p);
  };
  image.Values.reserve(static_cast<std::size_t>(array.Value->GetNumberOfTuples()));
  for (vtkIdType p = 0; p < array.Value->GetNumberOfTuples(); ++p)
  {
    const double value = array.Value->GetComponent(p, 0);
    if (!std::isfinite(value))
    {
      return { ErrorCode::NonFiniteInput,
        place(p) + " is no number; give one outside of the solid" };
    }
    if (areLabels && (value != std::floor(value) || std::abs(value) > INT_MAX))
    {
      return { ErrorCode::InvalidParameter,
        place(p) + " is no whole number; give labels, or solids by a level" };
    }
    image.Values.push_back(value);
  }
  return image;
}

Result<ImageTetrahedra> RunImageMesher(const VolumeImage& image, const ImageMeshParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn)
{
  const auto parts = RunMesher(Program, {}, Encode(image, params), limits, goOn);
  return parts ? Decode(image, parts.Value) : Result<ImageTetrahedra>(parts.Status);
}
}
