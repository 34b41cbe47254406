// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaces.h"

#include "SewnBoundary.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ClampedSpline.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/PatchFaces.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>

#include <Eigen/Geometry>

#include <algorithm>

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

/// Sides of tensor products that no other covers.
/// @pre volumes are clamped.
Result<TrimmedModel> UncoveredSides(const std::vector<Spline<3>>& volumes, double tolerance)
{
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

/// Edges that have not just two faces.
int NumLooseEdges(const TrimmedModel& model, double tolerance)
{
  const SewnBoundary boundary = SewBoundary(model, tolerance * SizeOf(model));
  std::vector<int> uses(static_cast<std::size_t>(boundary.NumEdges), 0);
  for (const auto& loops : boundary.Faces)
  {
    for (const BoundaryLoop& loop : loops)
    {
      for (const BoundaryCurve& use : loop)
      {
        uses[static_cast<std::size_t>(use.Edge)] += use.Degenerate ? 2 : 1;
      }
    }
  }
  return static_cast<int>(
    std::count_if(uses.begin(), uses.end(), [](int count) { return count != 2; }));
}

/// Collects the boundary of volumes of both kinds.
class BoundaryMaker
{
public:
  /// Of one on a mesh.
  Status AddFaces(const Spline<3>& volume, const std::string& place)
  {
    auto faces = FacesOfPatches(volume, 1);
    if (faces)
    {
      this->Warnings.push_back(place + " lies on an unstructured mesh, its boundary becomes " +
        std::to_string(faces->Faces.size()) + " faces");
      AppendFaces(this->Model, std::move(faces.Value));
      return {};
    }
    if (faces.Status.Code != ErrorCode::InvalidTopology &&
      faces.Status.Code != ErrorCode::NotInSpace)
    {
      return faces.Status;
    }
    auto split = SplitIntoPatches(volume, 1);
    if (!split)
    {
      return split.Status;
    }
    this->Warnings.push_back(place + " lies on an unstructured mesh and counts as " +
      std::to_string(split->Patches.size()) +
      " tensor products: its boundary is no surface: " + faces.Status.Detail);
    std::move(split->Patches.begin(), split->Patches.end(), std::back_inserter(this->Boxes));
    return {};
  }

  Status Add(const Spline<3>& volume, const std::string& place)
  {
    if (volume.Space && volume.Space->Kind == SpaceKind::Unstructured)
    {
      return this->AddFaces(volume, place);
    }
    auto clamped = ClampedVolume(volume);
    if (clamped)
    {
      this->Boxes.push_back(std::move(clamped.Value));
    }
    return clamped.Status;
  }

  Status Finish(double tolerance)
  {
    if (this->Boxes.empty())
    {
      return {};
    }
    auto sides = UncoveredSides(this->Boxes, tolerance);
    if (sides)
    {
      AppendFaces(this->Model, std::move(sides.Value));
    }
    return sides.Status;
  }

  TrimmedModel Model;
  std::vector<std::string> Warnings;

private:
  std::vector<Spline<3>> Boxes;
};
}

Result<TrimmedModel> BoundaryFaces(
  const std::vector<Spline<3>>& patches, double tolerance, std::vector<std::string>* warnings)
{
  if (patches.empty())
  {
    return { ErrorCode::EmptyInput, "there is no volume" };
  }
  if (!(tolerance > 0.0 && tolerance <= 0.1))
  {
    return { ErrorCode::InvalidParameter, "the tolerance must lie in (0, 0.1]" };
  }
  BoundaryMaker maker;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const std::string place = "volume " + std::to_string(p);
    if (Status status = maker.Add(patches[p], place); !status)
    {
      return { status.Code, place + ": " + status.Detail };
    }
  }
  if (Status status = maker.Finish(tolerance); !status)
  {
    return status;
  }
  if (warnings)
  {
    if (const int loose = NumLooseEdges(maker.Model, tolerance); loose > 0)
    {
      maker.Warnings.push_back(std::to_string(loose) +
        " edges of the boundary have not just two faces, so that it encloses no solid: volumes "
        "meet along edges only, or by parts of sides");
    }
    *warnings = std::move(maker.Warnings);
  }
  return std::move(maker.Model);
}
}
