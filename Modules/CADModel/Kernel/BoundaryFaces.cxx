// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaces.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ClampedSpline.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/MultiPatch.h>

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
constexpr int Samples = 5; ///< of a side, in a direction

/// Whether det J is positive in the mean over a grid of 4 x 4 x 4 points inside.
bool IsRightHanded(const Spline<3>& volume)
{
  const ParametricBox<3> box = volume.Space->Domain();
  PointMatrix inside(64, 3);
  for (Eigen::Index i = 0; i < inside.rows(); ++i)
  {
    Eigen::Index rest = i;
    for (std::size_t d = 0; d < 3; ++d)
    {
      const double s = static_cast<double>(rest % 4) / 3;
      const double middle = 0.5 * (box.Lower[d] + box.Upper[d]);
      const double at = (1.0 - s) * box.Lower[d] + s * box.Upper[d];
      inside(i, static_cast<Eigen::Index>(d)) = middle + 0.8 * (at - middle);
      rest /= 4;
    }
  }
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<3>(MakeBezierForm<3>(volume, 1), inside, params, batch);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < inside.rows(); ++i)
  {
    const Eigen::Vector3d du = batch.First.row(i).segment<3>(0);
    const Eigen::Vector3d dv = batch.First.row(i).segment<3>(3);
    const Eigen::Vector3d dw = batch.First.row(i).segment<3>(6);
    sum += du.cross(dv).dot(dw);
  }
  return sum > 0.0;
}

Result<Spline<3>> ClampedVolume(const Spline<3>& patch)
{
  if (Status status = patch.Check(); !status)
  {
    return status;
  }
  if (patch.Space->Kind != SpaceKind::Tensor || patch.NumComponents() != 3)
  {
    return { ErrorCode::DimensionMismatch, "no tensor product in space" };
  }
  return Clamped<3>(patch);
}

/// Diagonal of the box around the samples.
double SizeOf(const std::vector<SideSamples>& sides)
{
  Eigen::RowVector3d lower = sides.front().Points.colwise().minCoeff();
  Eigen::RowVector3d upper = sides.front().Points.colwise().maxCoeff();
  for (const SideSamples& side : sides)
  {
    lower = lower.cwiseMin(side.Points.colwise().minCoeff());
    upper = upper.cwiseMax(side.Points.colwise().maxCoeff());
  }
  return (upper - lower).norm();
}
}

Result<TrimmedModel> BoundaryFaces(const std::vector<Spline<3>>& patches, double tolerance)
{
  if (patches.empty())
  {
    return { ErrorCode::EmptyInput, "there is no volume" };
  }
  if (!(tolerance > 0.0 && tolerance <= 0.1))
  {
    return { ErrorCode::InvalidParameter, "the tolerance must lie in (0, 0.1]" };
  }
  std::vector<Spline<3>> volumes;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    auto clamped = ClampedVolume(patches[p]);
    if (!clamped)
    {
      return { clamped.Status.Code, "volume " + std::to_string(p) + ": " + clamped.Status.Detail };
    }
    volumes.push_back(std::move(clamped.Value));
  }
  const auto sides = SampleSides<3>(volumes, Samples, 1);
  if (!sides)
  {
    return sides.Status;
  }
  const double allowed = tolerance * SizeOf(sides.Value);
  DisjointSets bodies(static_cast<int>(volumes.size()));
  std::vector<bool> covered(sides->size(), false);
  for (const PatchInterface& interface : FindInterfaces(sides.Value, allowed))
  {
    const auto& [a, b] = interface.Sides;
    const auto at = [](const PatchSide& side)
    { return static_cast<std::size_t>(6 * side.Patch + side.Side); };
    if (!(a == b) && !covered[at(a)] && !covered[at(b)])
    {
      covered[at(a)] = covered[at(b)] = true;
      bodies.Unite(a.Patch, b.Patch);
    }
  }
  TrimmedModel model;
  for (std::size_t p = 0; p < volumes.size(); ++p)
  {
    const int orientation = IsRightHanded(volumes[p]) ? 1 : -1;
    for (int side = 0; side < 6; ++side)
    {
      const std::size_t at = 6 * p + static_cast<std::size_t>(side);
      if (!covered[at] && !IsCollapsed(sides.Value[at], allowed))
      {
        TrimmedFace face;
        face.Surface = SideSpline<3>(volumes[p], side).Value;
        face.Reversed = SideSign(side) != orientation;
        face.Body = bodies.Find(static_cast<int>(p));
        model.Faces.push_back(std::move(face));
      }
    }
  }
  return model;
}
}
