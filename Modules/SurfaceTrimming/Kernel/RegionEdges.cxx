// SPDX-License-Identifier: BSD-3-Clause
#include "RegionEdges.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/CurveInterpolation.h>
#include <knotwork/SplineCore/SurfaceProfile.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int Degree = 5;

double GapOf(const PointMatrix& points, const std::vector<AnalyticSurface>& surfaces)
{
  double gap = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    for (const AnalyticSurface& surface : surfaces)
    {
      gap = std::max(gap, std::abs(surface.Distance(points.row(i).transpose())));
    }
  }
  return gap;
}

PointMatrix EvenParameters(int count)
{
  PointMatrix t(count + 1, 1);
  for (int i = 0; i <= count; ++i)
  {
    t(i, 0) = static_cast<double>(i) / count;
  }
  return t;
}

/// Points of the chain and between them, on the surfaces.
std::vector<Eigen::Vector3d> PointsOnSurfaces(const std::vector<Eigen::Vector3d>& points,
  const std::vector<AnalyticSurface>& surfaces, double farthest)
{
  constexpr std::size_t few = 24;
  const std::size_t parts = 1 + few / points.size();
  std::vector<Eigen::Vector3d> dense{ points.front() };
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
  {
    for (std::size_t k = 1; k <= parts; ++k)
    {
      const double s = static_cast<double>(k) / static_cast<double>(parts);
      const Eigen::Vector3d point = (1.0 - s) * points[i] + s * points[i + 1];
      const bool isEnd = i + 2 == points.size() && k == parts;
      dense.push_back(isEnd ? points.back() : MoveOnto(surfaces, point, farthest));
    }
  }
  return dense;
}

/// Piecewise cubic through points with tangents of parabolas through three: a first guess.
class CubicThroughPoints
{
public:
  CubicThroughPoints(const std::vector<Eigen::Vector3d>& points, bool closed) : Points(points)
  {
    this->T.assign(1, 0.0);
    for (std::size_t i = 1; i < points.size(); ++i)
    {
      this->T.push_back(this->T.back() + (points[i] - points[i - 1]).norm());
    }
    for (double& t : this->T)
    {
      t /= this->T.back();
    }
    const std::size_t last = points.size() - 1;
    for (std::size_t i = 0; i <= last; ++i)
    {
      const bool isEnd = i == 0 || i == last;
      if (isEnd && !closed)
      {
        const std::size_t at = i == 0 ? 1 : last;
        this->Tangents.push_back((points[at] - points[at - 1]) / (this->T[at] - this->T[at - 1]));
        continue;
      }
      const std::size_t before = isEnd ? last : i;
      const std::size_t after = isEnd ? 1 : i + 1;
      const double a = this->T[before] - this->T[before - 1];
      const double b = this->T[after] - this->T[after - 1];
      const Eigen::Vector3d in = (points[before] - points[before - 1]) / a;
      const Eigen::Vector3d out = (points[after] - points[after - 1]) / b;
      this->Tangents.emplace_back((b * in + a * out) / (a + b));
    }
  }
  Eigen::Vector3d operator()(double t) const
  {
    const auto after = std::upper_bound(this->T.begin() + 1, this->T.end() - 1, t);
    const auto i = static_cast<std::size_t>(after - this->T.begin()) - 1;
    const double length = this->T[i + 1] - this->T[i];
    const double s = (t - this->T[i]) / length;
    const double h = s * s * (3.0 - 2.0 * s);
    return (1.0 - h) * this->Points[i] + h * this->Points[i + 1] +
      length * s * (1.0 - s) * ((1.0 - s) * this->Tangents[i] - s * this->Tangents[i + 1]);
  }

private:
  const std::vector<Eigen::Vector3d>& Points;
  std::vector<double> T;
  std::vector<Eigen::Vector3d> Tangents;
};

/// The spline of so many spans through points on surfaces; the ends are those of a chain.
Spline<1> InterpolateOn(const std::vector<Eigen::Vector3d>& chain, int spans,
  const std::function<PointMatrix(const PointMatrix&)>& points)
{
  Spline<1> spline;
  spline.Space = MakeTensorSpace<1>({ KnotVector::Uniform(Degree, spans) }).Value;
  CurveInterpolation interpolation;
  if (!interpolation.Prepare(*spline.Space))
  {
    return {};
  }
  PointMatrix values = points(interpolation.Points());
  values.row(0) = chain.front().transpose();
  values.row(values.rows() - 1) = chain.back().transpose();
  spline.ControlPoints = interpolation.Solve(values);
  return spline;
}

/// How far the points of the chain are from a shape, 0 where that is near enough; splines, which
/// can, come nearer.
double DistanceAlong(
  const EdgeShape& shape, const std::vector<Eigen::Vector3d>& chain, const EdgeShapeParams& params)
{
  if (params.Along == HUGE_VAL)
  {
    return 0.0;
  }
  const double share = shape.Kind == EdgeShapeKind::Spline ? 0.25 : 1.0;
  const double distance = shape.DistanceOf(chain);
  return distance <= share * params.Along ? 0.0 : distance;
}

/// Interpolates points on the surfaces that are next to a guess, on ever more spans, each time next
/// to the spline before where surfaces say where the curve is; when that is near enough, its points
/// on as few spans as suffice.
Spline<1> FitSpline(const std::vector<Eigen::Vector3d>& chain,
  const std::vector<Eigen::Vector3d>& dense, const std::vector<AnalyticSurface>& surfaces,
  const EdgeShapeParams& params)
{
  constexpr int FewSpans = 4;
  constexpr int MaxSpans = 512;
  constexpr int Samples = 5;
  const CubicThroughPoints first(dense, dense.front() == dense.back());
  const bool isFree = params.Along < HUGE_VAL; // surfaces do not say where the curve is
  const auto gapOf = [&](const Spline<1>& spline)
  {
    EdgeShape shape;
    shape.Kind = EdgeShapeKind::Spline;
    shape.Curve = spline;
    return std::max(DistanceAlong(shape, chain, params),
      GapOf(CurvePoints(spline, ParametersInSpans(spline.Space->Knots[0], Samples)), surfaces));
  };
  Spline<1> best;
  Spline<1> last;
  double gap = HUGE_VAL;
  const auto next = [&](const PointMatrix& t)
  {
    const bool isOnLast = last.Space && !isFree;
    PointMatrix values = isOnLast ? CurvePoints(last, t) : PointMatrix(t.rows(), 3);
    for (Eigen::Index i = 0; i < t.rows(); ++i)
    {
      const Eigen::Vector3d along = first(t(i, 0));
      const Eigen::Vector3d from = isOnLast ? Eigen::Vector3d(values.row(i).transpose()) : along;
      // a coarse spline before may be farther away
      const double farthest = params.Farthest > 0.0 ? params.Farthest + (from - along).norm() : 0.0;
      values.row(i) = MoveOnto(surfaces, from, farthest).transpose();
    }
    return values;
  };
  for (int spans = FewSpans; spans <= MaxSpans; spans *= 2)
  {
    last = InterpolateOn(dense, spans, next);
    if (!last.Space)
    {
      break;
    }
    const double found = gapOf(last);
    const bool isWorthIt = found < 0.5 * gap;
    if (found < gap)
    {
      gap = found;
      best = last;
    }
    if (gap <= params.Exact ||
      (!isWorthIt && spans >= static_cast<int>((isFree ? 4 : 1) * dense.size())))
    {
      break;
    }
  }
  last = best;
  for (int spans = FewSpans; best.Space && spans < best.Space->NumElements(); spans *= 2)
  {
    Spline<1> shorter = InterpolateOn(dense, spans, next);
    if (shorter.Space && gapOf(shorter) <= std::max(params.Exact, 1.5 * gap))
    {
      return shorter;
    }
  }
  return best;
}

/// @param parallel  singular values below this share of the largest one count as 0.
Eigen::Vector3d StepOnto(
  const std::vector<AnalyticSurface>& surfaces, const Eigen::Vector3d& point, double parallel)
{
  constexpr int MaxSteps = 30;
  constexpr double Rounding = 1e-15; // of the first step, or the coordinates
  Eigen::Vector3d at = point;
  const auto n = static_cast<Eigen::Index>(surfaces.size());
  Eigen::MatrixXd normals(n, 3);
  Eigen::VectorXd distances(n);
  for (int step = 0; step < MaxSteps; ++step)
  {
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const AnalyticSurface& surface = surfaces[static_cast<std::size_t>(i)];
      normals.row(i) = surface.Normal(at).transpose();
      distances[i] = surface.Distance(at);
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(normals, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(parallel);
    const Eigen::Vector3d move = svd.solve(distances);
    at -= move;
    if (move.norm() <= Rounding * point.norm())
    {
      break;
    }
  }
  return at;
}
}

Eigen::Vector3d MoveOnto(
  const std::vector<AnalyticSurface>& surfaces, const Eigen::Vector3d& point, double farthest)
{
  const Eigen::Vector3d met = StepOnto(surfaces, point, 0.05);
  return (met - point).norm() <= farthest ? met : StepOnto(surfaces, point, 0.999);
}

PointMatrix EdgeShape::Points(const PointMatrix& t) const
{
  if (this->Kind == EdgeShapeKind::Spline)
  {
    return CurvePoints(this->Curve, t);
  }
  PointMatrix points(t.rows(), 3);
  const bool isLine = this->Kind == EdgeShapeKind::Line;
  const Eigen::Vector3d first = this->Ends[0] - (isLine ? this->Ends[0] : this->Arc.Point(0.0));
  const Eigen::Vector3d last = this->Ends[1] - (isLine ? this->Ends[1] : this->Arc.Point(1.0));
  for (Eigen::Index i = 0; i < t.rows(); ++i)
  {
    const double s = t(i, 0);
    const Eigen::Vector3d point =
      isLine ? Eigen::Vector3d((1.0 - s) * this->Ends[0] + s * this->Ends[1]) : this->Arc.Point(s);
    points.row(i) = (point + (1.0 - s) * first + s * last).transpose();
  }
  return points;
}

std::vector<double> EdgeShape::SharesOf(const std::vector<Eigen::Vector3d>& points) const
{
  constexpr double Apart = 1e-6;
  constexpr int Steps = 5;
  std::vector<double> shares{ 0.0 };
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    length += (points[i] - points[i - 1]).norm();
    shares.push_back(length);
  }
  for (double& share : shares)
  {
    share /= length;
  }
  if (this->Kind == EdgeShapeKind::Spline) // by length they are near already
  {
    const BezierForm<1> form = MakeBezierForm<1>(this->Curve, 1);
    EvaluationParams params;
    params.Derivatives = 1;
    params.Threads = 1;
    EvaluationBatch batch;
    PointMatrix at =
      Eigen::Map<const Eigen::VectorXd>(shares.data(), static_cast<Eigen::Index>(shares.size()));
    for (int step = 0; step < Steps; ++step)
    {
      EvaluateParameters<1>(form, at, params, batch);
      for (Eigen::Index i = 0; i < at.rows(); ++i)
      {
        const Eigen::Vector3d tangent = batch.First.row(i).transpose();
        const Eigen::Vector3d offset =
          points[static_cast<std::size_t>(i)] - batch.Values.row(i).transpose();
        at(i, 0) += offset.dot(tangent) / tangent.squaredNorm();
        at(i, 0) = std::min(std::max(at(i, 0), 0.0), 1.0);
      }
    }
    shares.assign(at.data(), at.data() + at.size());
  }
  for (std::size_t i = 1; i + 1 < points.size() && this->Kind != EdgeShapeKind::Spline; ++i)
  {
    if (this->Kind == EdgeShapeKind::Line)
    {
      const Eigen::Vector3d along = this->Ends[1] - this->Ends[0];
      shares[i] = (points[i] - this->Ends[0]).dot(along) / along.squaredNorm();
      continue;
    }
    const double turn = 2.0 * Pi / std::abs(this->Arc.Sweep);
    const double share = (this->Arc.AngleOf(points[i]) - this->Arc.Begin) / this->Arc.Sweep;
    shares[i] = share + turn * std::round((shares[i] - share) / turn);
  }
  shares.front() = 0.0;
  for (std::size_t i = 1; i < shares.size(); ++i)
  {
    shares[i] = std::max(shares[i], shares[i - 1] + Apart);
  }
  shares.back() = 1.0;
  for (std::size_t i = shares.size() - 1; i-- > 0;)
  {
    shares[i] = std::min(shares[i], shares[i + 1] - Apart);
  }
  shares.front() = 0.0;
  return shares;
}

double EdgeShape::DistanceOf(const std::vector<Eigen::Vector3d>& points) const
{
  const std::vector<double> shares = this->SharesOf(points);
  const PointMatrix at = this->Points(
    Eigen::Map<const Eigen::VectorXd>(shares.data(), static_cast<Eigen::Index>(shares.size())));
  double distance = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    distance =
      std::max(distance, (points[i] - at.row(static_cast<Eigen::Index>(i)).transpose()).norm());
  }
  return distance;
}

namespace
{
/// The curve over [0, 1] whose knots and control points are given, or its reverse.
Spline<1> OverUnit(const KnotVector& own, PointMatrix points, bool reversed)
{
  std::vector<double> knots = own.Knots();
  const double first = knots.front();
  const double length = knots.back() - first;
  for (double& knot : knots)
  {
    const double share = (knot - first) / length;
    knot = reversed ? 1.0 - share : share;
  }
  if (reversed)
  {
    std::reverse(knots.begin(), knots.end());
    points = points.colwise().reverse().eval();
  }
  Spline<1> curve;
  curve.Space = MakeTensorSpace<1>({ KnotVector::Create(own.Degree(), knots).Value }).Value;
  curve.ControlPoints = std::move(points);
  return curve;
}

/// Where a plane cuts an extrusion: its profile, each control point moved along the axis.
/// @return without a space: surfaces are others, or ends do not lie on the curve.
Spline<1> PlaneSection(const std::array<Eigen::Vector3d, 2>& ends,
  const std::vector<AnalyticSurface>& surfaces, double exact)
{
  constexpr double Parallel = 0.1; // of plane and axis
  if (surfaces.size() != 2 || ends[0] == ends[1])
  {
    return {};
  }
  const std::size_t first = surfaces[0].Type == SurfaceType::Extrusion ? 0 : 1;
  const AnalyticSurface& extrusion = surfaces[first];
  const AnalyticSurface& plane = surfaces[1 - first];
  const double across = plane.Axis.dot(extrusion.Axis);
  if (extrusion.Type != SurfaceType::Extrusion || plane.Type != SurfaceType::Plane ||
    std::abs(across) < Parallel)
  {
    return {};
  }
  const double begin = extrusion.Profile->Nearest(extrusion.InProfile(ends[0]));
  const double end = extrusion.Profile->Nearest(extrusion.InProfile(ends[1]));
  if (begin == end)
  {
    return {};
  }
  const Spline<1> part = extrusion.Profile->Part(std::min(begin, end), std::max(begin, end));
  const Eigen::Vector3d x = extrusion.Profile->Across();
  const Eigen::Vector3d y = extrusion.Axis.cross(x);
  PointMatrix points(part.ControlPoints.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const Eigen::Vector3d at =
      extrusion.Point + part.ControlPoints(i, 0) * x + part.ControlPoints(i, 1) * y;
    points.row(i) = (at - plane.Distance(at) / across * extrusion.Axis).transpose();
  }
  Spline<1> curve = OverUnit(part.Space->Knots[0], std::move(points), begin > end);
  const Eigen::Index last = curve.ControlPoints.rows() - 1;
  const double away = std::max((curve.ControlPoints.row(0).transpose() - ends[0]).norm(),
    (curve.ControlPoints.row(last).transpose() - ends[1]).norm());
  return away <= exact ? curve : Spline<1>();
}
}

EdgeShape FindEdgeShape(const std::vector<Eigen::Vector3d>& points,
  const std::vector<AnalyticSurface>& surfaces, const EdgeShapeParams& params)
{
  constexpr int Samples = 64;
  EdgeShape line;
  line.Ends = { points.front(), points.back() };
  const bool closed = points.front() == points.back();
  const PointMatrix even = EvenParameters(Samples);
  const double gapOfLine = closed ? HUGE_VAL : GapOf(line.Points(even), surfaces);
  const bool isLineAlong = !closed && DistanceAlong(line, points, params) == 0.0;
  if (gapOfLine <= params.Exact && isLineAlong)
  {
    return line;
  }
  EdgeShape circle = line;
  circle.Kind = EdgeShapeKind::Circle;
  const std::vector<Eigen::Vector3d> dense = PointsOnSurfaces(points, surfaces, params.Farthest);
  double gapOfCircle = HUGE_VAL;
  if (FitCircle(dense, circle.Arc))
  {
    gapOfCircle = GapOf(circle.Points(even), surfaces);
    for (const Eigen::Vector3d& point : dense)
    {
      gapOfCircle = std::max(gapOfCircle, circle.Arc.Distance(point));
    }
  }
  const double limit = gapOfCircle <= params.Exact ? params.Exact : params.Loose;
  if ((gapOfLine <= limit && isLineAlong) || gapOfCircle <= limit)
  {
    return gapOfLine <= limit && isLineAlong ? line : circle;
  }
  EdgeShape spline = line;
  spline.Kind = EdgeShapeKind::Spline;
  if (params.Farthest > 0.0)
  {
    spline.Curve = PlaneSection(spline.Ends, surfaces, params.Exact);
  }
  if (!spline.Curve.Space)
  {
    spline.Curve = FitSpline(points, dense, surfaces, params);
  }
  return spline.Curve.Space ? spline : line;
}

namespace
{
/// The profile of a revolution at an angle, over [0, 1].
Spline<1> ProfileOnPatch(const AnalyticPatch& patch, const std::array<Eigen::Vector2d, 2>& ends)
{
  const AnalyticSurface& surface = patch.Surface();
  const Eigen::Vector3d along = patch.Point(ends[0]) - surface.Point;
  const Eigen::Vector3d out = (along - along.dot(surface.Axis) * surface.Axis).normalized();
  const bool reversed = ends[1][1] < ends[0][1];
  const double begin = ends[reversed ? 1 : 0][1];
  const double end = ends[reversed ? 0 : 1][1];
  const Spline<1> part = surface.Profile->Part(begin, end);
  PointMatrix points(part.ControlPoints.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const auto at = part.ControlPoints.row(i);
    points.row(i) = (surface.Point + at[0] * out + at[1] * surface.Axis).transpose();
  }
  return OverUnit(part.Space->Knots[0], std::move(points), reversed);
}
}

EdgeShape IsoparametricShape(
  const AnalyticPatch& patch, const std::array<Eigen::Vector2d, 2>& ends, int fixed)
{
  EdgeShape shape;
  shape.Ends = { patch.Point(ends[0]), patch.Point(ends[1]) };
  const int runs = 1 - fixed;
  const bool isCircle = runs == 0 || patch.Surface().Type == SurfaceType::Sphere ||
    patch.Surface().Type == SurfaceType::Torus;
  if (patch.Surface().Type == SurfaceType::Revolution && runs == 1)
  {
    shape.Kind = EdgeShapeKind::Spline;
    shape.Curve = ProfileOnPatch(patch, ends);
    return shape;
  }
  if (!isCircle)
  {
    return shape;
  }
  shape.Kind = EdgeShapeKind::Circle;
  const auto at = [&](double angle)
  {
    Eigen::Vector2d place = ends[0];
    place[runs] = angle;
    return patch.Point(place);
  };
  shape.Arc.Centre = 0.5 * (at(0.0) + at(Pi));
  shape.Arc.X = at(0.0) - shape.Arc.Centre;
  shape.Arc.Y = at(0.5 * Pi) - shape.Arc.Centre;
  shape.Arc.Begin = ends[0][runs];
  shape.Arc.Sweep = ends[1][runs] - ends[0][runs];
  return shape;
}

namespace
{
/// Parameters of the surface along the shape, at rising shares.
PointMatrix ParametersAlong(
  const EdgeOnPatch& image, const PointMatrix& t, const PointMatrix& points)
{
  PointMatrix parameters(t.rows(), 2);
  Eigen::Vector2d last = image.Ends[0];
  for (Eigen::Index i = 0; i < t.rows(); ++i)
  {
    last = t(i, 0) <= 0.0 ? image.Ends[0]
      : t(i, 0) >= 1.0    ? image.Ends[1]
                          : image.Patch->ParametersNear(points.row(i).transpose(), last);
    if (image.Fixed >= 0)
    {
      last[image.Fixed] = image.Ends[0][image.Fixed];
    }
    parameters.row(i) = last.transpose();
  }
  return parameters;
}

PointMatrix OnSpline(const EdgeOnPatch& image, const PointMatrix& parameters)
{
  PointMatrix mapped(parameters.rows(), 2);
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    mapped.row(i) = image.Patch->SplineParameters(parameters.row(i).transpose()).transpose();
  }
  return mapped;
}

/// Where pcurves cross lines between spans of their patches.
std::vector<double> Crossings(const EdgeShape& shape, const std::vector<EdgeOnPatch>& images)
{
  constexpr int Samples = 256;
  constexpr int Bisections = 50;
  constexpr double Near = 1e-6; // of the edge
  std::vector<double> all;
  const PointMatrix t = EvenParameters(Samples);
  const PointMatrix points = shape.Points(t);
  for (const EdgeOnPatch& image : images)
  {
    const PointMatrix at = ParametersAlong(image, t, points);
    for (int d = 0; d < 2; ++d)
    {
      for (const double place : image.Patch->Breaks(d))
      {
        for (Eigen::Index i = 0; i < Samples; ++i)
        {
          const bool isBelow = at(i, d) < place;
          if (isBelow == (at(i + 1, d) < place) || image.Fixed == d)
          {
            continue;
          }
          double lower = t(i, 0);
          double upper = t(i + 1, 0);
          for (int k = 0; k < Bisections; ++k)
          {
            PointMatrix middle(1, 1);
            middle(0, 0) = 0.5 * (lower + upper);
            const Eigen::Vector2d found = image.Patch->ParametersNear(
              shape.Points(middle).row(0).transpose(), at.row(i).transpose());
            ((found[d] < place) == isBelow ? lower : upper) = middle(0, 0);
          }
          all.push_back(0.5 * (lower + upper));
        }
      }
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<double> apart;
  for (const double place : all)
  {
    if (place > Near && place < 1.0 - Near && (apart.empty() || place > apart.back() + Near))
    {
      apart.push_back(place);
    }
  }
  return apart;
}

/// Each span between the corners halved until there are so many.
Result<KnotVector> KnotsOf(int degree, const std::vector<double>& corners, int parts)
{
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  double last = 0.0;
  std::vector<double> ends = corners;
  ends.push_back(1.0);
  for (const double end : ends)
  {
    // as many in the whole edge as asked for, shared out by length
    const int own = std::max(1, static_cast<int>(std::ceil(parts * (end - last))));
    for (int k = 1; k < own; ++k)
    {
      knots.push_back(last + (end - last) * k / own);
    }
    const int multiplicity = end == 1.0 ? degree + 1 : degree - 1;
    knots.insert(knots.end(), static_cast<std::size_t>(multiplicity), end);
    last = end;
  }
  return KnotVector::Create(degree, std::move(knots));
}

/// Largest distance of the curve's points to the images', at samples.
double GapOfImages(const EdgeSpline& edge, const std::vector<EdgeOnPatch>& images)
{
  constexpr int Samples = 5;
  const PointMatrix t = ParametersInSpans(edge.Curve.Space->Knots[0], Samples);
  const PointMatrix points = CurvePoints(edge.Curve, t);
  double gap = 0.0;
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    const PointMatrix uv = CurvePoints({ edge.Curve.Space, edge.UV[i], {} }, t);
    for (Eigen::Index k = 0; k < t.rows(); ++k)
    {
      const Eigen::Vector2d at = images[i].Patch->SurfaceParameters(uv.row(k).transpose());
      gap = std::max(gap, (images[i].Patch->Point(at) - points.row(k).transpose()).norm());
    }
  }
  return gap;
}
}

Result<EdgeSpline> MakeEdgeSpline(
  const EdgeShape& shape, const std::vector<EdgeOnPatch>& images, double exact)
{
  constexpr int MaxParts = 512;
  if (shape.Ends[0] == shape.Ends[1] && shape.Kind == EdgeShapeKind::Line) // a pole
  {
    EdgeSpline pole;
    pole.Curve.Space = MakeTensorSpace<1>({ KnotVector() }).Value;
    pole.Curve.ControlPoints = shape.Ends[0].transpose().replicate(2, 1);
    for (const EdgeOnPatch& image : images)
    {
      PointMatrix& uv = pole.UV.emplace_back(2, 2);
      uv.row(0) = image.Patch->SplineParameters(image.Ends[0]).transpose();
      uv.row(1) = image.Patch->SplineParameters(image.Ends[1]).transpose();
    }
    return pole;
  }
  const std::vector<double> corners = Crossings(shape, images);
  std::vector<AnalyticSurface> surfaces;
  for (const EdgeOnPatch& image : images)
  {
    surfaces.push_back(image.Patch->Surface());
  }
  constexpr int Samples = 64;
  const double own = GapOf(shape.Points(EvenParameters(Samples)), surfaces);
  EdgeSpline best;
  best.Gap = HUGE_VAL;
  // a line first as such, a spline with its own knots
  const bool hasKnots = shape.Kind == EdgeShapeKind::Spline;
  for (int parts = (shape.Kind == EdgeShapeKind::Line || hasKnots) && corners.empty() ? 0 : 4;
       parts <= MaxParts && best.Gap > own + exact; parts = std::max(4, 2 * parts))
  {
    auto knots = parts == 0 && hasKnots
      ? Result<KnotVector>(shape.Curve.Space->Knots[0])
      : KnotsOf(parts == 0 ? 1 : Degree, corners, std::max(parts, 1));
    if (!knots)
    {
      return knots.Status;
    }
    EdgeSpline edge;
    edge.Curve.Space = MakeTensorSpace<1>({ std::move(knots.Value) }).Value;
    CurveInterpolation interpolation;
    if (Status status = interpolation.Prepare(*edge.Curve.Space); !status)
    {
      return status;
    }
    const PointMatrix& t = interpolation.Points();
    const PointMatrix points = shape.Points(t);
    edge.Curve.ControlPoints = interpolation.Solve(points);
    for (const EdgeOnPatch& image : images)
    {
      PointMatrix uv = interpolation.Solve(OnSpline(image, ParametersAlong(image, t, points)));
      for (Eigen::Index d = 0; d < 2; ++d) // interpolation may leave the patch by rounding
      {
        uv.col(d) = uv.col(d).array().max(image.Patch->Lower()[d]).min(image.Patch->Upper()[d]);
      }
      edge.UV.push_back(std::move(uv));
    }
    edge.Gap = GapOfImages(edge, images);
    if (edge.Gap < best.Gap)
    {
      best = std::move(edge);
    }
  }
  // ends are exact
  const Eigen::Index last = best.Curve.ControlPoints.rows() - 1;
  best.Curve.ControlPoints.row(0) = shape.Ends[0].transpose();
  best.Curve.ControlPoints.row(last) = shape.Ends[1].transpose();
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    best.UV[i].row(0) = images[i].Patch->SplineParameters(images[i].Ends[0]).transpose();
    best.UV[i].row(last) = images[i].Patch->SplineParameters(images[i].Ends[1]).transpose();
  }
  return best;
}

namespace
{
/// Inserts knots into a curve and its images.
Status InsertInto(EdgeSpline& edge, const std::vector<double>& knots)
{
  const auto space = edge.Curve.Space;
  auto curve = InsertKnots<1>(edge.Curve, 0, knots);
  if (!curve)
  {
    return curve.Status;
  }
  for (PointMatrix& uv : edge.UV)
  {
    auto image = InsertKnots<1>({ space, uv, {} }, 0, knots);
    if (!image)
    {
      return image.Status;
    }
    uv = std::move(image->ControlPoints);
  }
  edge.Curve = std::move(curve.Value);
  return {};
}
}

namespace
{
/// Halfway between the curve and the mean of its images; ends stay.
Status MoveHalfway(const std::vector<EdgeOnPatch>& images, EdgeSpline& edge)
{
  CurveInterpolation interpolation;
  if (Status status = interpolation.Prepare(*edge.Curve.Space); !status)
  {
    return status;
  }
  const PointMatrix& t = interpolation.Points();
  PointMatrix moves = -CurvePoints(edge.Curve, t);
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    const PointMatrix uv = CurvePoints({ edge.Curve.Space, edge.UV[i], {} }, t);
    for (Eigen::Index k = 0; k < t.rows(); ++k)
    {
      const Eigen::Vector2d at = images[i].Patch->SurfaceParameters(uv.row(k).transpose());
      moves.row(k) += images[i].Patch->Point(at).transpose() / static_cast<double>(images.size());
    }
  }
  moves *= 0.5;
  moves.row(0).setZero();
  moves.row(moves.rows() - 1).setZero();
  const PointMatrix change = interpolation.Solve(moves);
  edge.Curve.ControlPoints += change;
  edge.Gap = GapOfImages(edge, images);
  return {};
}
}

Result<EdgeSpline> FollowCurve(const Spline<1>& curve, const std::vector<EdgeOnPatch>& images,
  const std::vector<PointMatrix>& given, double exact)
{
  constexpr int MaxHalvings = 7;
  EdgeSpline followed;
  followed.Curve = curve;
  followed.UV = given;
  if (images.empty())
  {
    return followed;
  }
  EdgeShape shape;
  shape.Kind = EdgeShapeKind::Spline;
  shape.Curve = curve;
  const int degree = curve.Space->Knots[0].Degree();
  std::vector<double> corners;
  for (const double corner : Crossings(shape, images))
  {
    corners.insert(corners.end(), static_cast<std::size_t>(std::max(1, degree - 1)), corner);
  }
  if (Status status = InsertInto(followed, corners); !status)
  {
    return status;
  }
  EdgeSpline best;
  best.Gap = HUGE_VAL;
  for (int pass = 0; pass <= MaxHalvings; ++pass)
  {
    CurveInterpolation interpolation;
    if (Status status = interpolation.Prepare(*followed.Curve.Space); !status)
    {
      return status;
    }
    const PointMatrix& t = interpolation.Points();
    const PointMatrix points = CurvePoints(followed.Curve, t);
    EdgeSpline edge;
    edge.Curve = followed.Curve;
    double own = 0.0; // of the curve from the surfaces
    for (const EdgeOnPatch& image : images)
    {
      own = std::max(own, GapOf(points, { image.Patch->Surface() }));
      PointMatrix uv = interpolation.Solve(OnSpline(image, ParametersAlong(image, t, points)));
      for (Eigen::Index d = 0; d < 2; ++d)
      {
        uv.col(d) = uv.col(d).array().max(image.Patch->Lower()[d]).min(image.Patch->Upper()[d]);
      }
      uv.row(0) = image.Patch->SplineParameters(image.Ends[0]).transpose();
      uv.row(uv.rows() - 1) = image.Patch->SplineParameters(image.Ends[1]).transpose();
      edge.UV.push_back(std::move(uv));
    }
    edge.Gap = GapOfImages(edge, images);
    edge.UV.insert(edge.UV.end(), followed.UV.begin(), followed.UV.end());
    if (edge.Gap < best.Gap)
    {
      best = std::move(edge);
    }
    if (best.Gap <= own + exact || pass == MaxHalvings)
    {
      break;
    }
    const PointMatrix middles = ParametersInSpans(followed.Curve.Space->Knots[0], 1);
    if (Status status = InsertInto(
          followed, std::vector<double>(middles.data(), middles.data() + middles.size()));
        !status)
    {
      return status;
    }
  }
  const Status moved = MoveHalfway(images, best);
  return moved ? Result<EdgeSpline>(std::move(best)) : Result<EdgeSpline>(moved);
}
}
