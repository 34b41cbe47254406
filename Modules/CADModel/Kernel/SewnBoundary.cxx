// SPDX-License-Identifier: BSD-3-Clause
#include "SewnBoundary.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/MultiPatch.h>
#include <knotwork/SplineCore/PointClusters.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <map>

namespace knotwork
{
namespace
{
constexpr int SamplesOfSide = 17;

/// The straight pcurve of a side.
Spline<1> SideParameters(const Spline<2>& surface, int side)
{
  const KnotVector& along = surface.Space->Knots[SideDirections<2>(side)[0]];
  Spline<1> line;
  line.Space = MakeTensorSpace<1>({ KnotVector::Uniform(1, 1, along.Begin(), along.End()) }).Value;
  const Eigen::Index fixed = side / 2;
  line.ControlPoints.resize(2, 2);
  line.ControlPoints.col(fixed).setConstant(SideValue<2>(surface.Space->Domain(), side));
  line.ControlPoints(0, 1 - fixed) = along.Begin();
  line.ControlPoints(1, 1 - fixed) = along.End();
  return line;
}

/// Points at equal shares of the domain.
SideSamples SampleSide(const Spline<1>& curve)
{
  const KnotVector& knots = curve.Space->Knots[0];
  PointMatrix parameters(SamplesOfSide, 1);
  for (int i = 0; i < SamplesOfSide; ++i)
  {
    const double s = static_cast<double>(i) / (SamplesOfSide - 1);
    parameters(i, 0) = (1.0 - s) * knots.Begin() + s * knots.End();
  }
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<1>(MakeBezierForm<1>(curve, 1), parameters, params, batch);
  SideSamples samples;
  samples.Count[0] = SamplesOfSide;
  samples.Points = std::move(batch.Values);
  return samples;
}

bool IsPoint(const PointMatrix& points, double tolerance)
{
  return (points.rowwise() - points.row(0)).rowwise().norm().maxCoeff() <= tolerance;
}

/// Numbers what the sides of faces without loops have in common.
class SideSewing
{
public:
  SideSewing(double tolerance, SewnBoundary& result) : Tolerance(tolerance), Result(result) {}

  BoundaryLoop NaturalLoop(const TrimmedFace& face);

private:
  struct Side
  {
    SideSamples Samples;
    Spline<1> Curve;
    std::array<int, 2> Vertices{};
    int Edge = 0;
  };
  int VertexNumber(int body, const PointMatrix& samples, Eigen::Index row);
  BoundaryCurve UseOfSide(const TrimmedFace& face, int number);

  double Tolerance;
  SewnBoundary& Result;
  std::map<int, PointClusters> Corners;          ///< of a body
  std::map<std::pair<int, int>, int> Vertices;   ///< of body and number within it
  std::multimap<std::array<int, 2>, Side> Sides; ///< by the lower and the higher vertex
};

int SideSewing::VertexNumber(int body, const PointMatrix& samples, Eigen::Index row)
{
  PointClusters& clusters = this->Corners.try_emplace(body, 3, this->Tolerance).first->second;
  const Eigen::Vector3d point = samples.row(row);
  const auto found =
    this->Vertices.try_emplace({ body, clusters.Number(point.data()) }, this->Result.NumVertices);
  this->Result.NumVertices += found.second ? 1 : 0;
  return found.first->second;
}

BoundaryCurve SideSewing::UseOfSide(const TrimmedFace& face, int number)
{
  BoundaryCurve use;
  use.Curve = SideSpline<2>(face.Surface, number).Value;
  use.Parameters = SideParameters(face.Surface, number);
  use.Degenerate = IsPoint(use.Curve.ControlPoints, this->Tolerance);
  Side side;
  side.Samples = SampleSide(use.Curve);
  use.Vertices = { this->VertexNumber(face.Body, side.Samples.Points, 0),
    this->VertexNumber(face.Body, side.Samples.Points, SamplesOfSide - 1) };
  const std::array<int, 2> key{ std::min(use.Vertices[0], use.Vertices[1]),
    std::max(use.Vertices[0], use.Vertices[1]) };
  if (!use.Degenerate)
  {
    const auto range = this->Sides.equal_range(key);
    for (auto it = range.first; it != range.second; ++it)
    {
      const Side& other = it->second;
      const auto fitting = FittingOrientations(side.Samples, other.Samples, this->Tolerance);
      if (fitting.empty())
      {
        continue;
      }
      const bool same = !fitting.front().Reversed[0];
      // this side's pcurve on the domain, and in the sense, of the edge
      use.Curve = other.Curve;
      const KnotVector& knots = use.Curve.Space->Knots[0];
      use.Parameters.Space =
        MakeTensorSpace<1>({ KnotVector::Uniform(1, 1, knots.Begin(), knots.End()) }).Value;
      if (!same)
      {
        use.Parameters.ControlPoints = use.Parameters.ControlPoints.colwise().reverse().eval();
      }
      use.Reversed = !same;
      use.Vertices = other.Vertices;
      use.Edge = other.Edge;
      return use;
    }
  }
  use.Edge = this->Result.NumEdges++;
  side.Curve = use.Curve;
  side.Vertices = use.Vertices;
  side.Edge = use.Edge;
  this->Sides.emplace(key, std::move(side));
  return use;
}

BoundaryLoop SideSewing::NaturalLoop(const TrimmedFace& face)
{
  BoundaryLoop loop;
  loop.push_back(this->UseOfSide(face, 2));
  loop.push_back(this->UseOfSide(face, 1));
  loop.push_back(this->UseOfSide(face, 3));
  loop.push_back(this->UseOfSide(face, 0));
  for (std::size_t s = 2; s < 4; ++s) // counterclockwise: against the parameter
  {
    loop[s].Reversed = !loop[s].Reversed;
  }
  return loop;
}
}

SewnBoundary SewBoundary(const TrimmedModel& model, double tolerance)
{
  SewnBoundary result;
  result.NumVertices = model.NumVertices;
  std::map<std::pair<int, int>, int> edges; // of body and number in the model
  SideSewing sewing(tolerance, result);
  for (const TrimmedFace& face : model.Faces)
  {
    std::vector<BoundaryLoop> loops;
    for (const TrimmedLoop& loop : face.Loops)
    {
      BoundaryLoop uses;
      for (const TrimmingCurve& curve : loop.Curves)
      {
        BoundaryCurve use;
        use.Curve = curve.Curve;
        use.Parameters = curve.ParameterCurve();
        const auto found = edges.try_emplace({ face.Body, curve.Edge }, result.NumEdges);
        result.NumEdges += found.second ? 1 : 0;
        use.Edge = found.first->second;
        use.Vertices = curve.Vertices;
        use.Reversed = curve.Reversed;
        use.Degenerate = IsPoint(use.Curve.ControlPoints, tolerance);
        uses.push_back(std::move(use));
      }
      loops.push_back(std::move(uses));
    }
    if (loops.empty())
    {
      loops.push_back(sewing.NaturalLoop(face));
    }
    result.Faces.push_back(std::move(loops));
  }
  return result;
}
}
