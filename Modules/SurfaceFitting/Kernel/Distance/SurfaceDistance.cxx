// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceDistance.h"

#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Distance in the plane up to which a point is above the surface: relative to the diagonal of the
/// surfaces' box, and to the largest coordinate where that is rounding.
constexpr double OnSurface = 1e-9;
constexpr double Rounding = 64.0 * std::numeric_limits<double>::epsilon();
constexpr Eigen::Index ChunkSize = 65536; // points between two reports of progress

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Status Check(const PointMatrixView& points, const std::vector<Spline<2>>& surfaces,
  const SurfaceDistanceParams& params)
{
  if (points.rows() == 0 || surfaces.empty())
  {
    return { ErrorCode::EmptyInput,
      points.rows() == 0 ? "there are no points" : "there is no surface" };
  }
  if (points.cols() != 3)
  {
    return { ErrorCode::SizeMismatch, "points need three coordinates" };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
    if (!AllWithinLimit(points.row(i)))
    {
      return { ErrorCode::TooLarge, "point " + std::to_string(i) + ": " + BeyondLimit() };
    }
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s)
  {
    if (const Status status = surfaces[s].Check(); !status)
    {
      return { status.Code, "surface " + std::to_string(s) + ": " + status.Detail };
    }
    if (surfaces[s].NumComponents() < 3)
    {
      return { ErrorCode::SizeMismatch,
        "surface " + std::to_string(s) + " has fewer than three components" };
    }
  }
  double last = 0.0;
  for (const double tolerance : params.Tolerances)
  {
    if (!(tolerance > last && std::isfinite(tolerance)))
    {
      return { ErrorCode::InvalidParameter, "tolerances must be positive and ascend" };
    }
    last = tolerance;
  }
  return {};
}

class Measure
{
public:
  Measure(const PointMatrixView& points, const std::vector<Spline<2>>& surfaces,
    const SurfaceDistanceParams& params)
    : Points(points), Params(params)
  {
    bool heights = true;
    for (const Spline<2>& surface : surfaces)
    {
      Spline<2> geometry = surface;
      geometry.ControlPoints = surface.ControlPoints.leftCols(3);
      const auto plane = surface.ControlPoints.leftCols(2);
      this->Low = this->Low.cwiseMin(plane.colwise().minCoeff());
      this->High = this->High.cwiseMax(plane.colwise().maxCoeff());
      this->Forms.push_back(MakeBezierForm(geometry, params.Threads));
      this->AreHeights.push_back(IsHeightField(this->Forms.back()));
      heights = heights && this->AreHeights.back();
    }
    SurfaceDistances& result = this->Result;
    const auto n = static_cast<std::size_t>(points.rows());
    const double none = std::numeric_limits<double>::quiet_NaN();
    result.Kind = params.Kind != DistanceKind::Automatic ? params.Kind
      : heights                                          ? DistanceKind::Vertical
                                                         : DistanceKind::Closest;
    result.Distances.assign(n, none);
    result.Surfaces.assign(n, -1);
    result.Elements.assign(n, -1);
    result.Local = PointMatrix::Constant(points.rows(), 2, none);
    result.Feet = PointMatrix::Constant(points.rows(), 3, none);
  }

  Status Run()
  {
    const bool vertical = this->Result.Kind == DistanceKind::Vertical;
    Status status;
    if (vertical &&
      std::find(this->AreHeights.begin(), this->AreHeights.end(), false) == this->AreHeights.end())
    {
      this->LocateInDomains();
    }
    else
    {
      status = this->Find(vertical);
    }
    status = status ? this->Evaluate(vertical) : status;
    if (status)
    {
      this->Classify();
    }
    return status;
  }

  SurfaceDistances Result;

private:
  /// The first height field whose domain holds a point.
  void LocateInDomains()
  {
    const PointMatrix plane = this->Points.leftCols(2);
    const auto n = static_cast<std::size_t>(plane.rows());
    std::vector<int> elements(n);
    PointMatrix local(plane.rows(), 2);
    for (std::size_t s = 0; s < this->Forms.size(); ++s)
    {
      this->Forms[s].Space->Locate(plane.data(), 2, n, elements.data(), local.data());
      for (std::size_t i = 0; i < n; ++i)
      {
        if (this->Result.Surfaces[i] < 0 && elements[i] >= 0)
        {
          this->Result.Surfaces[i] = static_cast<int>(s);
          this->Result.Elements[i] = elements[i];
          this->Result.Local.row(static_cast<Eigen::Index>(i)) =
            local.row(static_cast<Eigen::Index>(i));
        }
      }
    }
  }

  /// Closest points in space, or in the plane (inverse of the surfaces' plane maps).
  Status Find(bool vertical)
  {
    const int components = vertical ? 2 : 3;
    std::vector<BezierForm<2>> patches = this->Forms;
    if (vertical)
    {
      std::transform(patches.begin(), patches.end(), patches.begin(), PlaneForm);
    }
    const double diagonal = (this->High - this->Low).norm();
    const double largest = this->Low.cwiseAbs().cwiseMax(this->High.cwiseAbs()).maxCoeff();
    const double above = std::max(OnSurface * diagonal, Rounding * largest);
    ClosestPointParams params;
    params.Threads = this->Params.Threads;
    const auto search = ClosestPointSearch<2>::Create(std::move(patches), params);
    if (!search)
    {
      return search.Status;
    }
    const Eigen::Index n = this->Points.rows();
    for (Eigen::Index begin = 0; begin < n; begin += ChunkSize)
    {
      if (!this->Report(static_cast<double>(begin) / static_cast<double>(n)))
      {
        return { ErrorCode::Aborted, "" };
      }
      const Eigen::Index count = std::min(ChunkSize, n - begin);
      ClosestPoints found;
      const PointMatrix queries = this->Points.block(begin, 0, count, components);
      if (const Status status = search.Value.Find(queries, found); !status)
      {
        return status;
      }
      for (Eigen::Index i = 0; i < count; ++i)
      {
        const auto to = static_cast<std::size_t>(begin + i);
        if (vertical && !(found.Distances[i] <= above))
        {
          continue;
        }
        this->Result.Surfaces[to] = found.Patches[static_cast<std::size_t>(i)];
        this->Result.Elements[to] = found.Elements[static_cast<std::size_t>(i)];
        this->Result.Local.row(begin + i) = found.Local.row(i);
      }
    }
    return {};
  }

  /// The form of x and y alone.
  static BezierForm<2> PlaneForm(const BezierForm<2>& form)
  {
    BezierForm<2> plane;
    plane.Space = form.Space;
    plane.NumComponents = 2;
    plane.Rational = form.Rational;
    plane.Offsets.push_back(0);
    for (int e = 0; e < form.Space->NumElements(); ++e)
    {
      const int n = NumTensorFunctions<2>(form.Space->Elements[At(e)].Degree);
      const double* block = form.Block(e);
      plane.Data.insert(plane.Data.end(), block, block + 2 * n);
      if (form.Rational)
      {
        plane.Data.insert(plane.Data.end(), block + 3 * n, block + 4 * n);
      }
      plane.Offsets.push_back(plane.Data.size());
    }
    return plane;
  }

  Status Evaluate(bool vertical)
  {
    for (std::size_t s = 0; s < this->Forms.size(); ++s)
    {
      std::vector<Eigen::Index> rows;
      std::vector<int> elements;
      for (Eigen::Index i = 0; i < this->Points.rows(); ++i)
      {
        if (this->Result.Surfaces[static_cast<std::size_t>(i)] == static_cast<int>(s))
        {
          rows.push_back(i);
          elements.push_back(this->Result.Elements[static_cast<std::size_t>(i)]);
        }
      }
      PointMatrix local(static_cast<Eigen::Index>(rows.size()), 2);
      for (std::size_t k = 0; k < rows.size(); ++k)
      {
        local.row(static_cast<Eigen::Index>(k)) = this->Result.Local.row(rows[k]);
      }
      EvaluationBatch batch;
      EvaluationParams params;
      params.Derivatives = vertical ? 0 : 1;
      params.Threads = this->Params.Threads;
      const Status status = EvaluateElements(this->Forms[s], elements, local, params, batch);
      if (!status)
      {
        return status;
      }
      if (!this->Report(static_cast<double>(s + 1) / static_cast<double>(this->Forms.size())))
      {
        return { ErrorCode::Aborted, "" };
      }
      for (std::size_t k = 0; k < rows.size(); ++k)
      {
        const auto from = static_cast<Eigen::Index>(k);
        const Eigen::RowVector3d foot = batch.Values.row(from);
        const Eigen::RowVector3d point = this->Points.row(rows[k]);
        double& distance = this->Result.Distances[static_cast<std::size_t>(rows[k])];
        this->Result.Feet.row(rows[k]) = foot;
        if (vertical)
        {
          distance = point[2] - foot[2];
          continue;
        }
        const Eigen::RowVector3d u = batch.First.row(from).head<3>();
        const Eigen::RowVector3d v = batch.First.row(from).tail<3>();
        const Eigen::RowVector3d offset = point - foot;
        distance = (offset.dot(u.cross(v)) < 0.0 ? -1.0 : 1.0) * offset.norm();
      }
    }
    return {};
  }

  void Classify()
  {
    const std::vector<double>& limits = this->Params.Tolerances;
    const auto k = static_cast<int>(limits.size());
    std::vector<DistanceStatistics>& classes = this->Result.ByClass;
    classes.resize(At(2 * k + 1));
    for (int c = -k; c <= k; ++c)
    {
      classes[At(c + k)].Class = c;
    }
    for (const double distance : this->Result.Distances)
    {
      if (std::isnan(distance))
      {
        this->Result.Classes.push_back(0);
        ++this->Result.NumWithout;
        continue;
      }
      const auto place = std::lower_bound(limits.begin(), limits.end(), std::fabs(distance));
      const int c = static_cast<int>(place - limits.begin()) * (distance < 0.0 ? -1 : 1);
      this->Result.Classes.push_back(c);
      Add(distance, classes[At(c + k)]);
      Add(distance, this->Result.All);
    }
    Finish(this->Result.All);
    std::for_each(classes.begin(), classes.end(), Finish);
  }

  static void Add(double distance, DistanceStatistics& s)
  {
    s.Min = s.NumPoints == 0 ? distance : std::min(s.Min, distance);
    s.Max = s.NumPoints == 0 ? distance : std::max(s.Max, distance);
    ++s.NumPoints;
    s.Mean += distance;
    s.MeanAbsolute += std::fabs(distance);
    s.Rms += distance * distance;
  }

  static void Finish(DistanceStatistics& s)
  {
    const auto n = static_cast<double>(std::max<std::size_t>(s.NumPoints, 1));
    s.Mean /= n;
    s.MeanAbsolute /= n;
    s.Rms = std::sqrt(s.Rms / n);
  }

  bool Report(double share) { return !this->Params.Progress || this->Params.Progress(share); }

  const PointMatrixView& Points;
  const SurfaceDistanceParams& Params;
  std::vector<BezierForm<2>> Forms;
  std::vector<bool> AreHeights;
  /// Box around x and y of all control points.
  Eigen::RowVector2d Low = Eigen::RowVector2d::Constant(HUGE_VAL);
  Eigen::RowVector2d High = Eigen::RowVector2d::Constant(-HUGE_VAL);
};
}

Result<SurfaceDistances> MeasureSurfaceDistances(const PointMatrixView& points,
  const std::vector<Spline<2>>& surfaces, const SurfaceDistanceParams& params)
{
  Status status = Check(points, surfaces, params);
  if (!status)
  {
    return status;
  }
  Measure measure(points, surfaces, params);
  status = measure.Run();
  return status ? Result<SurfaceDistances>(std::move(measure.Result)) : status;
}
}
