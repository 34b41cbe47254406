// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaces.h"

#include "ClampedSpline.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/PointClusters.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>
#include <map>

namespace knotwork
{
namespace
{
constexpr int Samples = 5; ///< of a side, in a direction

struct Side
{
  std::size_t Patch = 0;
  Spline<2> Surface;
  bool Outward = true;  ///< S_u x S_v
  PointMatrix Points;   ///< Samples x Samples, first direction fastest
  bool Covered = false; ///< by another side
};

/// A side of a volume with clamped knots; its parameters are the two others in their order.
Spline<2> SideSurface(const Spline<3>& volume, std::size_t direction, bool upper)
{
  const auto& knots = volume.Space->Knots;
  const std::size_t along[2] = { direction == 0 ? std::size_t(1) : 0,
    direction == 2 ? std::size_t(1) : 2 };
  int stride[3] = { 1, knots[0].NumFunctions(), 0 };
  stride[2] = stride[1] * knots[1].NumFunctions();
  const int first = upper ? (knots[direction].NumFunctions() - 1) * stride[direction] : 0;
  Spline<2> side;
  side.Space = MakeTensorSpace<2>({ knots[along[0]], knots[along[1]] }).Value;
  side.ControlPoints.resize(side.Space->NumFunctions, volume.ControlPoints.cols());
  side.Weights.resize(volume.IsRational() ? side.ControlPoints.rows() : 0);
  int row = 0;
  for (int j = 0; j < knots[along[1]].NumFunctions(); ++j)
  {
    for (int i = 0; i < knots[along[0]].NumFunctions(); ++i, ++row)
    {
      const int from = first + i * stride[along[0]] + j * stride[along[1]];
      side.ControlPoints.row(row) = volume.ControlPoints.row(from);
      if (volume.IsRational())
      {
        side.Weights[row] = volume.Weights[from];
      }
    }
  }
  return side;
}

template <int Dim>
PointMatrix Grid(const Spline<Dim>& spline, int samples)
{
  const ParametricBox<Dim> box = spline.Space->Domain();
  Eigen::Index count = 1;
  for (int d = 0; d < Dim; ++d)
  {
    count *= samples;
  }
  PointMatrix places(count, Dim);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    Eigen::Index rest = i;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double s = static_cast<double>(rest % samples) / (samples - 1);
      places(i, static_cast<Eigen::Index>(d)) = (1.0 - s) * box.Lower[d] + s * box.Upper[d];
      rest /= samples;
    }
  }
  return places;
}

template <int Dim>
EvaluationBatch Evaluated(const Spline<Dim>& spline, const PointMatrix& places, int derivatives)
{
  EvaluationParams params;
  params.Derivatives = derivatives;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<Dim>(MakeBezierForm<Dim>(spline, 1), places, params, batch);
  return batch;
}

/// Whether det J is positive in the mean over a grid inside.
bool IsRightHanded(const Spline<3>& volume)
{
  const PointMatrix all = Grid<3>(volume, 4);
  const ParametricBox<3> box = volume.Space->Domain();
  PointMatrix inside = all;
  for (Eigen::Index i = 0; i < all.rows(); ++i)
  {
    for (Eigen::Index d = 0; d < 3; ++d)
    {
      const auto direction = static_cast<std::size_t>(d);
      const double middle = 0.5 * (box.Lower[direction] + box.Upper[direction]);
      inside(i, d) = middle + 0.8 * (all(i, d) - middle);
    }
  }
  const EvaluationBatch batch = Evaluated<3>(volume, inside, 1);
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

/// Row of the samples of a side that lies at place (i, j) after one of the eight ways to lay a
/// square on itself.
Eigen::Index RowOf(int way, int i, int j)
{
  const int u = (way & 1) ? Samples - 1 - i : i;
  const int v = (way & 2) ? Samples - 1 - j : j;
  return (way & 4) ? u * Samples + v : v * Samples + u;
}

bool Cover(const PointMatrix& a, const PointMatrix& b, int way, double tolerance)
{
  for (int j = 0; j < Samples; ++j)
  {
    for (int i = 0; i < Samples; ++i)
    {
      if ((a.row(j * Samples + i) - b.row(RowOf(way, i, j))).norm() > tolerance)
      {
        return false;
      }
    }
  }
  return true;
}

bool Cover(const PointMatrix& a, const PointMatrix& b, double tolerance)
{
  for (int way = 0; way < 8; ++way)
  {
    if (Cover(a, b, way, tolerance))
    {
      return true;
    }
  }
  return false;
}

/// A point, or a curve: all rows or all columns of samples are one, or the side is folded.
bool IsCollapsed(const PointMatrix& points, double tolerance)
{
  bool rows = true;
  bool columns = true;
  for (int j = 0; j < Samples; ++j)
  {
    for (int i = 0; i < Samples; ++i)
    {
      const auto& point = points.row(j * Samples + i);
      rows = rows && (point - points.row(j * Samples)).norm() <= tolerance;
      columns = columns && (point - points.row(i)).norm() <= tolerance;
    }
  }
  return rows || columns;
}
/// The six sides of a volume.
Status AddSides(const Spline<3>& patch, std::size_t number, std::vector<Side>& sides)
{
  if (Status status = patch.Check(); !status)
  {
    return status;
  }
  if (patch.Space->Kind != SpaceKind::Tensor || patch.NumComponents() != 3)
  {
    return { ErrorCode::DimensionMismatch, "no tensor product in space" };
  }
  const auto volume = Clamped<3>(patch);
  if (!volume)
  {
    return volume.Status;
  }
  const bool rightHanded = IsRightHanded(volume.Value);
  for (std::size_t d = 0; d < 3; ++d)
  {
    for (int upper = 0; upper < 2; ++upper)
    {
      Side& side = sides.emplace_back();
      side.Patch = number;
      side.Surface = SideSurface(volume.Value, d, upper == 1);
      // d_0 x d_1 = d_2 and its cyclic shifts, but the sides of d_1 have the order d_0, d_2
      side.Outward = ((upper == 1) == (d != 1)) == rightHanded;
      side.Points = Evaluated<2>(side.Surface, Grid<2>(side.Surface, Samples), 0).Values;
    }
  }
  return {};
}

/// Diagonal of the box around the samples.
double SizeOf(const std::vector<Side>& sides)
{
  Eigen::RowVector3d lower = sides.front().Points.colwise().minCoeff();
  Eigen::RowVector3d upper = sides.front().Points.colwise().maxCoeff();
  for (const Side& side : sides)
  {
    lower = lower.cwiseMin(side.Points.colwise().minCoeff());
    upper = upper.cwiseMax(side.Points.colwise().maxCoeff());
  }
  return (upper - lower).norm();
}

/// Marks the sides that cover each other. @return patches that hang together.
DisjointSets CoverSides(std::vector<Side>& sides, std::size_t numPatches, double tolerance)
{
  DisjointSets bodies(static_cast<int>(numPatches));
  PointClusters centers(3, tolerance);
  std::multimap<int, std::size_t> sidesAt; // the samples' means tell most sides apart
  for (std::size_t s = 0; s < sides.size(); ++s)
  {
    const Eigen::RowVector3d mean = sides[s].Points.colwise().mean();
    const int center = centers.Number(mean.data());
    const auto range = sidesAt.equal_range(center);
    for (auto it = range.first; it != range.second; ++it)
    {
      Side& other = sides[it->second];
      if (!other.Covered && Cover(sides[s].Points, other.Points, tolerance))
      {
        sides[s].Covered = true;
        other.Covered = true;
        bodies.Unite(static_cast<int>(sides[s].Patch), static_cast<int>(other.Patch));
        break;
      }
    }
    sidesAt.emplace(center, s);
  }
  return bodies;
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
  std::vector<Side> sides;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    if (Status status = AddSides(patches[p], p, sides); !status)
    {
      return { status.Code, "volume " + std::to_string(p) + ": " + status.Detail };
    }
  }
  const double allowed = tolerance * SizeOf(sides);
  const DisjointSets bodies = CoverSides(sides, patches.size(), allowed);
  TrimmedModel model;
  for (Side& side : sides)
  {
    if (!side.Covered && !IsCollapsed(side.Points, allowed))
    {
      TrimmedFace face;
      face.Surface = std::move(side.Surface);
      face.Reversed = !side.Outward;
      face.Body = bodies.Find(static_cast<int>(side.Patch));
      model.Faces.push_back(std::move(face));
    }
  }
  return model;
}
}
