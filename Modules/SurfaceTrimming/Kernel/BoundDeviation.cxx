// SPDX-License-Identifier: BSD-3-Clause
#include "DeviationSearch.h"
#include "FaceCertificate.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace knotwork
{
namespace
{
/// Points of the Gauss rule a direction: integrands of degree 4 exactly, a rounded sixth digit for
/// cubic surfaces over parts of an element's size.
constexpr int RulePoints = 3;
/// A triangle is cut into the square of so many for quadrature at most.
constexpr int MaxCuts = 64;

/// Rule on the triangle (0, 0), (1, 0), (0, 1): the square's, collapsed. Weights add up to 1.
struct TriangleRule
{
  std::vector<RealArray<2>> Points;
  std::vector<double> Weights;
};
TriangleRule MakeTriangleRule()
{
  const QuadratureRule line = GaussLegendre(RulePoints);
  TriangleRule rule;
  for (std::size_t j = 0; j < line.Nodes.size(); ++j)
  {
    for (std::size_t i = 0; i < line.Nodes.size(); ++i)
    {
      const double left = 1.0 - line.Nodes[j];
      rule.Points.push_back({ line.Nodes[i] * left, line.Nodes[j] });
      rule.Weights.push_back(2.0 * line.Weights[i] * line.Weights[j] * left);
    }
  }
  return rule;
}

/// Integrals over one triangle.
struct TriangleIntegrals
{
  double Square = 0.0; ///< of |S - X|^2, by area in space
  double Area = 0.0;   ///< of S
  double MeshArea = 0.0;
};

/// Quadrature over triangles, with its buffers.
class TriangleQuadrature
{
public:
  TriangleQuadrature(const BezierForm<2>& surface, const TriangleRule& rule)
    : Surface(surface), Rule(rule)
  {
  }

  TriangleIntegrals Integrate(const ChartTriangle& triangle)
  {
    const int cuts = this->NumCuts(triangle);
    const auto n = static_cast<Eigen::Index>(this->Rule.Weights.size());
    this->Barycentric.resize(n * cuts * cuts, 2);
    this->Parameters.resize(n * cuts * cuts, 2);
    Eigen::Index row = 0;
    for (int j = 0; j < cuts; ++j)
    {
      for (int i = 0; i < cuts - j; ++i)
      {
        row = this->AddCut(i, j, 1.0, cuts, row);
        if (i + j + 1 < cuts)
        {
          row = this->AddCut(i + 1, j + 1, -1.0, cuts, row); // upside down
        }
      }
    }
    const auto& uv = triangle.UV;
    for (Eigen::Index k = 0; k < row; ++k)
    {
      for (std::size_t d = 0; d < 2; ++d)
      {
        this->Parameters(k, static_cast<Eigen::Index>(d)) = uv[0][d] +
          this->Barycentric(k, 0) * (uv[1][d] - uv[0][d]) +
          this->Barycentric(k, 1) * (uv[2][d] - uv[0][d]);
      }
    }
    // corners are in the domain, so these are too
    EvaluateParameters<2>(this->Surface, this->Parameters, { 1, 1 }, this->Batch);
    return this->Sum(triangle, cuts);
  }

private:
  /// Cuts of the sides so that parts are not larger than the elements around.
  int NumCuts(const ChartTriangle& triangle) const
  {
    const auto& uv = triangle.UV;
    int cuts = 1;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const KnotVector& knots = this->Surface.Space->Knots[d];
      const int first = knots.FindElement(std::min({ uv[0][d], uv[1][d], uv[2][d] }));
      const int last = knots.FindElement(std::max({ uv[0][d], uv[1][d], uv[2][d] }));
      cuts = std::max(cuts, last - first + 1);
    }
    return std::min(cuts, MaxCuts);
  }

  Eigen::Index AddCut(int i, int j, double sign, int cuts, Eigen::Index row)
  {
    for (const RealArray<2>& point : this->Rule.Points)
    {
      this->Barycentric.row(row++) << (i + sign * point[0]) / cuts, (j + sign * point[1]) / cuts;
    }
    return row;
  }

  TriangleIntegrals Sum(const ChartTriangle& triangle, int cuts) const
  {
    using Vector = Eigen::RowVector3d;
    const Eigen::Map<const Vector> x0(triangle.Points[0].data());
    const Vector p = Eigen::Map<const Vector>(triangle.Points[1].data()) - x0;
    const Vector q = Eigen::Map<const Vector>(triangle.Points[2].data()) - x0;
    const auto& uv = triangle.UV;
    const double planeArea = 0.5 *
      ((uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
        (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]));
    TriangleIntegrals sums;
    sums.MeshArea = 0.5 * p.cross(q).norm();
    for (Eigen::Index k = 0; k < this->Barycentric.rows(); ++k)
    {
      const double weight =
        this->Rule.Weights[static_cast<std::size_t>(k) % this->Rule.Weights.size()] /
        (static_cast<double>(cuts) * cuts);
      const Vector x = x0 + this->Barycentric(k, 0) * p + this->Barycentric(k, 1) * q;
      const Vector s = this->Batch.Values.row(k);
      const Vector su = this->Batch.First.row(k).head<3>();
      const Vector sv = this->Batch.First.row(k).tail<3>();
      sums.Square += weight * (s - x).squaredNorm();
      sums.Area += weight * su.cross(sv).norm();
    }
    sums.Square *= sums.MeshArea;
    sums.Area *= planeArea;
    return sums;
  }

  const BezierForm<2>& Surface;
  const TriangleRule& Rule;
  PointMatrix Barycentric; ///< of the second and third corner
  PointMatrix Parameters;
  EvaluationBatch Batch;
};

Status CheckInput(const ChartMesh& chart, const Spline<2>& surface, const DeviationParams& params)
{
  if (const Status status = chart.Check(); !status)
  {
    return status;
  }
  if (const Status status = surface.Check(); !status)
  {
    return status;
  }
  if (surface.NumComponents() != 3 || surface.Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "the surface must be a tensor product in space" };
  }
  if (!(params.RelativeGap > 0.0 && params.RelativeGap <= 1.0))
  {
    return { ErrorCode::InvalidParameter, "the relative gap must be in (0, 1]" };
  }
  if (!(params.Enough >= 0.0 && std::isfinite(params.Enough)))
  {
    return { ErrorCode::InvalidParameter, "a bound that is enough must be 0 or more" };
  }
  if (params.Threads < 0)
  {
    return { ErrorCode::InvalidParameter, "the number of threads must not be negative" };
  }
  return {};
}
}

Result<ChartDeviation> BoundDeviation(
  const ChartMesh& chart, const Spline<2>& surface, const DeviationParams& params)
{
  if (const Status status = CheckInput(chart, surface, params); !status)
  {
    return status;
  }
  const BezierForm<2> form = MakeBezierForm<2>(surface, params.Threads);
  ChartDeviation result;
  {
    EvaluationBatch batch;
    if (const Status status = EvaluateParameters<2>(form, chart.UV, { 0, params.Threads }, batch);
        !status)
    {
      return status;
    }
    result.PointDeviation = (batch.Values - chart.Points).rowwise().norm();
  }

  const std::size_t n = chart.Triangles.size();
  const TriangleRule rule = MakeTriangleRule();
  result.TriangleBound.resize(static_cast<Eigen::Index>(n));
  result.TriangleFound.resize(static_cast<Eigen::Index>(n));
  std::vector<TriangleIntegrals> integrals(n);
  // The progress callback belongs to this thread: between slices.
  constexpr std::size_t slice = std::size_t(1) << 15;
  const DeviationSearch prototype(form, params.RelativeGap, params.Enough);
  for (std::size_t first = 0; first < n; first += slice)
  {
    const std::size_t last = std::min(n, first + slice);
    ParallelFor(last - first, 256, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        DeviationSearch search = prototype;
        TriangleQuadrature quadrature(form, rule);
        for (std::size_t t = first + begin; t < first + end; ++t)
        {
          const auto& corners = chart.Triangles[t];
          const ChartTriangle triangle = CornersOf(chart, t);
          const TriangleDeviation deviation = search.Bound(triangle,
            std::max({ result.PointDeviation[corners[0]], result.PointDeviation[corners[1]],
              result.PointDeviation[corners[2]] }));
          result.TriangleBound[static_cast<Eigen::Index>(t)] = deviation.Bound;
          result.TriangleFound[static_cast<Eigen::Index>(t)] = deviation.Found;
          integrals[t] = quadrature.Integrate(triangle);
        }
      });
    if (params.Progress && !params.Progress(static_cast<double>(last) / static_cast<double>(n)))
    {
      return { ErrorCode::Aborted, "while bounding deviations" };
    }
  }
  result.MaxBound = result.TriangleBound.maxCoeff();
  result.MaxFound = result.TriangleFound.maxCoeff();
  double square = 0.0;
  for (const TriangleIntegrals& t : integrals)
  {
    square += t.Square;
    result.Area += t.Area;
    result.MeshArea += t.MeshArea;
  }
  // triangles without area in space have no deviation by area
  result.Rms = result.MeshArea > 0.0 ? std::sqrt(square / result.MeshArea) : 0.0;
  return result;
}
}
