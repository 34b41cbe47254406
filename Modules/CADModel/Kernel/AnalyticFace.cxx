// SPDX-License-Identifier: BSD-3-Clause
#include "AnalyticFace.h"

#include "CADGeometry.h"
#include <knotwork/SplineCore/CurveInterpolation.h>
#include <knotwork/SplineCore/FitAnalyticSurface.h>
#include <knotwork/SplineCore/FitCircle.h>
#include <knotwork/SplineCore/SurfaceProfile.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Ax3.hxx>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Same = 1e-9;     ///< of the surface's size
constexpr double NearAxis = 1e-9; ///< the same: there is no angle
constexpr int Samples = 64;       ///< of an edge
constexpr double Turn = 2.0 * 3.14159265358979323846;
constexpr double Rounding = 1e-9; ///< of angles

gp_Pnt PointOf(const Eigen::Vector3d& point)
{
  return { point.x(), point.y(), point.z() };
}

gp_Dir DirectionOf(const Eigen::Vector3d& direction)
{
  return { direction.x(), direction.y(), direction.z() };
}

Eigen::Vector3d ValueAt(const AnalyticCurve& curve, double share)
{
  const gp_Pnt point = curve.Curve->Value((1.0 - share) * curve.First + share * curve.Last);
  return { point.X(), point.Y(), point.Z() };
}

/// Equally spaced places of a domain, ends included, first direction fastest.
PointMatrix GridOf(const ParametricBox<2>& domain, int count)
{
  PointMatrix grid((count + 1) * (count + 1), 2);
  for (Eigen::Index i = 0; i < grid.rows(); ++i)
  {
    const std::array<Eigen::Index, 2> at{ i % (count + 1), i / (count + 1) };
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double share = static_cast<double>(at[d]) / count;
      grid(i, static_cast<Eigen::Index>(d)) =
        (1.0 - share) * domain.Lower[d] + share * domain.Upper[d];
    }
  }
  return grid;
}

/// Equally spaced places of a curve's domain, ends included.
PointMatrix PlacesOn(const KnotVector& knots)
{
  PointMatrix at(Samples + 1, 1);
  for (int i = 0; i <= Samples; ++i)
  {
    const double share = static_cast<double>(i) / Samples;
    at(i, 0) = (1.0 - share) * knots.Begin() + share * knots.End();
  }
  return at;
}

EvaluationBatch EvaluateAt(const BezierForm<2>& form, const PointMatrix& at, int derivatives)
{
  EvaluationParams params;
  params.Derivatives = derivatives;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<2>(form, at, params, batch);
  return batch;
}
}

namespace
{
/// Readers take parameters of periodic surfaces modulo turns: faces that are wound around, or lie
/// on both sides of where the turning angle of a torus begins, stay splines.
bool IsWithinPeriods(
  SurfaceType type, const Eigen::RowVector2d& first, const Eigen::RowVector2d& last)
{
  const Eigen::RowVector2d length = last - first;
  const double begin = first[1] - Turn * std::floor((first[1] + Rounding) / Turn);
  return length[0] <= Turn + Rounding &&
    (type != SurfaceType::Torus || begin + length[1] <= Turn + Rounding);
}

/// Places on the border of a face, which may be a part of its spline only.
/// @param whole  those of the whole spline, for a face without loops.
PointMatrix BorderOf(const TrimmedFace& face, const PointMatrix& whole)
{
  if (face.Loops.empty())
  {
    return whole;
  }
  std::vector<PointMatrix> pieces;
  Eigen::Index rows = 0;
  for (const TrimmedLoop& loop : face.Loops)
  {
    for (const TrimmingCurve& use : loop.Curves)
    {
      const Spline<1> curve = use.ParameterCurve();
      pieces.push_back(CurvePoints(curve, PlacesOn(curve.Space->Knots[0])));
      rows += pieces.back().rows();
    }
  }
  PointMatrix border(rows, 2);
  rows = 0;
  for (const PointMatrix& piece : pieces)
  {
    border.middleRows(rows, piece.rows()) = piece;
    rows += piece.rows();
  }
  return border;
}

/// The axis about which a spline of a sphere turns: parallels lie in planes across it.
/// @param points  on a grid of count + 1 places a direction.
bool FindAxis(const std::vector<Eigen::Vector3d>& points, int count, Eigen::Vector3d& axis)
{
  constexpr double Parallel = 1e-6;
  for (int direction = 0; direction < 2; ++direction)
  {
    const auto normalOf = [&](int line)
    {
      const auto at = [&](int i)
      {
        const int k = direction == 0 ? line * (count + 1) + i : i * (count + 1) + line;
        return points[static_cast<std::size_t>(k)];
      };
      const Eigen::Vector3d middle = at(count / 3);
      return (middle - at(0)).cross(at(2 * count / 3) - middle).normalized();
    };
    const Eigen::Vector3d first = normalOf(count / 3);
    const Eigen::Vector3d second = normalOf(2 * count / 3);
    const Eigen::Vector3d third = normalOf(count / 2);
    if (first.cross(second).norm() <= Parallel && first.cross(third).norm() <= Parallel)
    {
      axis = first;
      return true;
    }
  }
  return false;
}
}

std::optional<AnalyticCurve> FindAnalyticCurve(const Spline<1>& curve, double tolerance)
{
  const PointMatrix values = CurvePoints(curve, PlacesOn(curve.Space->Knots[0]));
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    points.emplace_back(values.row(i).transpose());
  }
  AnalyticCurve found;
  const Eigen::Vector3d along = points.back() - points.front();
  const double length = along.norm();
  const auto onLine = [&](const Eigen::Vector3d& point)
  { return (point - points.front()).cross(along).norm() <= tolerance * length; };
  if (length > tolerance && std::all_of(points.begin(), points.end(), onLine))
  {
    found.Curve = new Geom_Line(PointOf(points.front()), DirectionOf(along));
    found.Last = length;
    return found;
  }
  if (length <= tolerance)
  {
    points.back() = points.front();
  }
  CircularArc arc;
  if (!FitCircle(points, arc) ||
    !std::all_of(points.begin(), points.end(),
      [&](const Eigen::Vector3d& point) { return arc.Distance(point) <= tolerance; }))
  {
    return {};
  }
  const double sense = arc.Sweep < 0.0 ? -1.0 : 1.0;
  const gp_Ax2 axes(PointOf(arc.Centre), DirectionOf(sense * arc.X.cross(arc.Y)),
    DirectionOf(arc.Point(0.0) - arc.Centre));
  found.Curve = new Geom_Circle(axes, arc.Radius());
  found.Last = std::abs(arc.Sweep);
  return found;
}

namespace
{
double SizeOf(const std::vector<Eigen::Vector3d>& points)
{
  double size = 0.0;
  for (const Eigen::Vector3d& point : points)
  {
    size = std::max(size, (point - points.front()).norm());
  }
  return size;
}

/// The profile and axis of a spline that is an extrusion, u along the profile across the axis, or a
/// revolution, u around the axis. Whether the spline is that surface everywhere is not looked at.
bool FindProfile(const Spline<2>& spline, const std::vector<Eigen::Vector3d>& points,
  const std::vector<FlatPiece>& pieces, AnalyticSurface& surface)
{
  const bool isExtrusion = surface.Type == SurfaceType::Extrusion;
  const std::size_t along = isExtrusion ? 0 : 1;
  const Eigen::Index across = spline.Space->Knots[0].NumFunctions();
  const Eigen::Index count = spline.Space->Knots[along].NumFunctions();
  const Eigen::Index step = isExtrusion ? 1 : across;
  const auto control = [&](Eigen::Index i) -> Eigen::Vector3d
  { return spline.ControlPoints.row(i * step).transpose(); };
  AnalyticSurface found;
  Eigen::Vector3d first = Eigen::Vector3d::UnitX();
  if (isExtrusion)
  {
    found.Axis = (spline.ControlPoints.row(across) - spline.ControlPoints.row(0)).transpose();
    if (!(found.Axis.norm() > 0.0) || spline.IsRational() || spline.Space->Knots[1].Degree() != 1)
    {
      return false;
    }
    found.Axis.normalize();
    found.Point = control(0);
    first = found.Axis.unitOrthogonal();
  }
  else if (!GuessAxis(points, pieces, found))
  {
    return false;
  }
  found.Type = surface.Type;
  Spline<1> profile;
  profile.Space = MakeTensorSpace<1>({ spline.Space->Knots[along] }).Value;
  profile.ControlPoints.resize(count, 2);
  double tilt = 0.0;
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const Eigen::Vector3d offset = control(i) - found.Point;
    const double height = offset.dot(found.Axis);
    tilt = isExtrusion ? std::max(tilt, std::abs(height)) : 0.0; // of lines where heights are alike
    profile.ControlPoints.row(i) = isExtrusion
      ? Eigen::RowVector2d(offset.dot(first), offset.dot(found.Axis.cross(first)))
      : Eigen::RowVector2d((offset - height * found.Axis).norm(), height);
  }
  if (profile.Space->Knots[0].Degree() < 2 || tilt > Same * SizeOf(points))
  {
    return false;
  }
  found.Profile = std::make_shared<const SurfaceProfile>(std::move(profile), first);
  surface = std::move(found);
  return true;
}
}

std::optional<AnalyticFace> AnalyticFace::Find(const TrimmedFace& face)
{
  constexpr int Fine = 12;
  if (face.Type == SurfaceType::FreeForm)
  {
    return {};
  }
  AnalyticFace found;
  found.Form = MakeBezierForm<2>(face.Surface, 1);
  const ParametricBox<2> domain = found.Form.Space->Domain();
  const PointMatrix grid = GridOf(domain, Fine);
  const EvaluationBatch batch = EvaluateAt(found.Form, grid, 1);
  std::vector<Eigen::Vector3d> points;
  std::vector<FlatPiece> pieces;
  Eigen::Vector3d normalOfMiddle = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < grid.rows(); ++i)
  {
    points.emplace_back(batch.Values.row(i).transpose());
    const Eigen::Vector3d u = batch.First.row(i).head(3).transpose();
    const Eigen::Vector3d v = batch.First.row(i).tail(3).transpose();
    const Eigen::Vector3d normal = u.cross(v);
    if (normal.norm() > NearAxis * u.norm() * v.norm() && normal.norm() > 0.0)
    {
      pieces.push_back({ points.back(), normal.normalized() });
    }
    normalOfMiddle = 2 * i + 1 == grid.rows() ? normal : normalOfMiddle;
  }
  found.Size = (batch.Values.colwise().maxCoeff() - batch.Values.colwise().minCoeff()).norm();
  AnalyticSurface surface;
  surface.Type = face.Type;
  const bool isFound = HasProfile(face.Type)
    ? FindProfile(face.Surface, points, pieces, surface)
    : GuessSurface(face.Type, points, pieces, surface) && FitSurface(points, surface);
  if (!isFound || !(MaxDistance(points, surface) <= Same * found.Size))
  {
    return {};
  }
  if (surface.Type == SurfaceType::Sphere && !FindAxis(points, Fine, surface.Axis))
  {
    return {};
  }
  const Eigen::Vector3d middle = points[points.size() / 2];
  found.Start = grid.row(grid.rows() / 2);
  found.Turned = surface.Normal(middle).dot(normalOfMiddle) < 0.0;
  if (surface.Type == SurfaceType::Plane && found.Turned)
  {
    surface.Axis = -surface.Axis;
    found.Turned = false;
  }
  // u begins at 0
  found.Patch = AnalyticPatch(surface, middle - surface.Point);
  found.StartPlace = found.Patch.Parameters(middle);
  if (surface.Type != SurfaceType::Plane && surface.Type != SurfaceType::Extrusion)
  {
    const PointMatrix lifted = found.Lift(BorderOf(face, grid));
    const Eigen::RowVector2d first = lifted.colwise().minCoeff();
    const Eigen::RowVector2d last = lifted.colwise().maxCoeff();
    if (!IsWithinPeriods(surface.Type, first, last))
    {
      return {};
    }
    const Eigen::Vector3d onAxis =
      surface.Point + (middle - surface.Point).dot(surface.Axis) * surface.Axis;
    const Eigen::Vector3d reference =
      Eigen::AngleAxisd(first[0] - found.StartPlace[0], surface.Axis) * (middle - onAxis);
    found.Patch = AnalyticPatch(surface, reference);
    found.StartPlace[0] -= first[0];
    if (surface.Type == SurfaceType::Torus) // from 0 on
    {
      found.StartPlace[1] -= Turn * std::floor((first[1] + Rounding) / Turn);
    }
  }
  return found;
}

Handle(Geom_Surface) AnalyticFace::Surface() const
{
  const AnalyticSurface& s = this->Patch.Surface();
  if (HasProfile(s.Type))
  {
    return this->SurfaceOfProfile();
  }
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  const Eigen::Vector3d x = s.Type == SurfaceType::Plane
    ? Eigen::Vector3d(this->Patch.Point({ 1.0, 0.0 }) - s.Point)
    : Eigen::Vector3d(this->Patch.Point(zero) - s.Point);
  const gp_Ax3 axes(PointOf(s.Point), DirectionOf(s.Axis), DirectionOf(x));
  switch (s.Type)
  {
    case SurfaceType::Cylinder:
      return new Geom_CylindricalSurface(axes, s.Radius);
    case SurfaceType::Sphere:
      return new Geom_SphericalSurface(axes, s.Radius);
    case SurfaceType::Cone:
      return new Geom_ConicalSurface(axes, s.Angle, s.Radius);
    case SurfaceType::Torus:
      return new Geom_ToroidalSurface(axes, s.Radius, s.MinorRadius);
    case SurfaceType::Plane:
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      break;
  }
  return new Geom_Plane(axes);
}

Handle(Geom_Surface) AnalyticFace::SurfaceOfProfile() const
{
  const AnalyticSurface& s = this->Patch.Surface();
  const bool isExtrusion = s.Type == SurfaceType::Extrusion;
  Spline<1> curve = s.Profile->Curve();
  const PointMatrix plane = curve.ControlPoints;
  Eigen::Vector3d out = s.Profile->Across();
  if (!isExtrusion) // where u = 0
  {
    const Eigen::Vector3d offset = this->Patch.Point({ 0.0, s.Profile->Begin() }) - s.Point;
    out = (offset - offset.dot(s.Axis) * s.Axis).normalized();
  }
  const Eigen::Vector3d second = isExtrusion ? s.Axis.cross(out) : s.Axis;
  curve.ControlPoints.resize(plane.rows(), 3);
  for (Eigen::Index i = 0; i < plane.rows(); ++i)
  {
    curve.ControlPoints.row(i) = (s.Point + plane(i, 0) * out + plane(i, 1) * second).transpose();
  }
  if (isExtrusion)
  {
    return new Geom_SurfaceOfLinearExtrusion(ToOpenCASCADE(curve), DirectionOf(s.Axis));
  }
  return new Geom_SurfaceOfRevolution(
    ToOpenCASCADE(curve), gp_Ax1(PointOf(s.Point), DirectionOf(s.Axis)));
}

/// Parameters of the surface at places of the spline, followed from the start on.
PointMatrix AnalyticFace::Lift(const PointMatrix& splineParameters) const
{
  constexpr int Steps = 16;
  constexpr double Aside = 1e-3; // of the way to the start, from a pole
  const Eigen::Index n = splineParameters.rows();
  PointMatrix lifted(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    lifted.row(i) = this->StartPlace.transpose();
  }
  const ParametricBox<2> domain = this->Form.Space->Domain();
  PointMatrix at(n, 2);
  for (int step = 1; step <= Steps; ++step)
  {
    const double share = static_cast<double>(step) / Steps;
    for (Eigen::Index i = 0; i < n; ++i)
    {
      at.row(i) = (1.0 - share) * this->Start + share * splineParameters.row(i);
      for (Eigen::Index d = 0; d < 2; ++d) // pcurves may leave the domain by rounding
      {
        const auto k = static_cast<std::size_t>(d);
        at(i, d) = std::min(std::max(at(i, d), domain.Lower[k]), domain.Upper[k]);
      }
    }
    const EvaluationBatch batch = EvaluateAt(this->Form, at, 0);
    PointMatrix beside = at; // at a pole the angle is that of a place before it
    beside.col(1).array() += Aside * (this->Start[1] - at.col(1).array());
    const EvaluationBatch other = EvaluateAt(this->Form, beside, 0);
    const AnalyticSurface& surface = this->Patch.Surface();
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const Eigen::Vector3d point = batch.Values.row(i).transpose();
      const Eigen::Vector3d offset = point - surface.Point;
      const bool isPole = surface.Type != SurfaceType::Plane &&
        surface.Type != SurfaceType::Extrusion &&
        offset.cross(surface.Axis).norm() <= NearAxis * this->Size;
      const Eigen::Vector2d last = lifted.row(i).transpose();
      Eigen::Vector2d place = this->Patch.ParametersNear(point, last);
      if (isPole)
      {
        place[0] = this->Patch.ParametersNear(other.Values.row(i).transpose(), last)[0];
      }
      lifted.row(i) = place.transpose();
    }
  }
  return lifted;
}

double AnalyticFace::GapOf(const AnalyticCurve& curve) const
{
  double gap = 0.0;
  for (int i = 0; i <= Samples; ++i)
  {
    const Eigen::Vector3d point = ValueAt(curve, static_cast<double>(i) / Samples);
    gap = std::max(gap, std::abs(this->Patch.Surface().Distance(point)));
  }
  return gap;
}

Handle(Geom2d_Curve) AnalyticFace::ParameterCurve(
  const AnalyticCurve& curve, const Spline<1>& parameters) const
{
  constexpr int Degree = 5;
  constexpr int MaxSpans = 64;
  const AnalyticSurface& surface = this->Patch.Surface();
  if (surface.Type == SurfaceType::Extrusion &&
    !Handle(Geom_BSplineCurve)::DownCast(curve.Curve).IsNull())
  {
    // the spline's own parameters, but for where heights begin and their unit
    const ParametricBox<2> domain = this->Form.Space->Domain();
    PointMatrix corners(2, 2);
    corners << domain.Lower[0], domain.Lower[1], domain.Lower[0], domain.Upper[1];
    const EvaluationBatch batch = EvaluateAt(this->Form, corners, 0);
    const double height = (batch.Values.row(1) - batch.Values.row(0)).dot(surface.Axis);
    Spline<1> moved = parameters;
    moved.ControlPoints.col(1) = (moved.ControlPoints.col(1).array() - domain.Lower[1]) * height /
      (domain.Upper[1] - domain.Lower[1]);
    return ToOpenCASCADEPlane(moved);
  }
  const KnotVector& knots = parameters.Space->Knots[0];
  // heights of a cone run along its rulings there
  const double stretch = surface.Type == SurfaceType::Cone ? 1.0 / std::cos(surface.Angle) : 1.0;
  const auto along = [&](const PointMatrix& shares)
  {
    PointMatrix at(shares.rows(), 1);
    at.array() = (1.0 - shares.array()) * knots.Begin() + shares.array() * knots.End();
    PointMatrix places = this->Lift(CurvePoints(parameters, at));
    for (Eigen::Index i = 0; i < places.rows(); ++i)
    {
      const Eigen::Vector2d near = places.row(i).transpose();
      const Eigen::Vector3d point =
        curve.Curve.IsNull() ? this->Patch.Point(near) : ValueAt(curve, shares(i, 0));
      const Eigen::Vector3d offset = point - surface.Point;
      Eigen::Vector2d place = this->Patch.ParametersNear(point, near);
      const bool isPole = offset.cross(surface.Axis).norm() <= NearAxis * this->Size;
      const bool hasPole = !this->IsPlane() && surface.Type != SurfaceType::Extrusion;
      place[0] = isPole && hasPole ? near[0] : place[0];
      places.row(i) << place[0], stretch * place[1];
    }
    return places;
  };
  const double length = curve.Last - curve.First;
  Spline<1> result;
  for (int spans = 0; spans <= MaxSpans; spans = std::max(4, 2 * spans))
  {
    const KnotVector shares = KnotVector::Uniform(spans == 0 ? 1 : Degree, std::max(spans, 1));
    Spline<1> trial;
    trial.Space = MakeTensorSpace<1>({ shares }).Value;
    CurveInterpolation interpolation;
    if (!interpolation.Prepare(*trial.Space))
    {
      break;
    }
    trial.ControlPoints = interpolation.Solve(along(interpolation.Points()));
    const PointMatrix at = ParametersInSpans(shares, spans == 0 ? Samples : 5);
    const PointMatrix wanted = along(at);
    const PointMatrix found = CurvePoints(trial, at);
    double worst = 0.0;
    for (Eigen::Index i = 0; i < at.rows(); ++i)
    {
      const Eigen::Vector2d a(wanted(i, 0), wanted(i, 1) / stretch);
      const Eigen::Vector2d b(found(i, 0), found(i, 1) / stretch);
      worst = std::max(worst, (this->Patch.Point(a) - this->Patch.Point(b)).norm());
    }
    result = std::move(trial);
    if (worst <= Same * this->Size)
    {
      break;
    }
  }
  if (result.Space->Knots[0].Degree() == 1)
  {
    constexpr double rounding = 1e-12;
    const Eigen::RowVector2d way =
      (result.ControlPoints.row(1) - result.ControlPoints.row(0)) / length;
    if (std::abs(way.norm() - 1.0) <= rounding) // as fast as the curve
    {
      const Eigen::RowVector2d origin = result.ControlPoints.row(0) - curve.First * way;
      return new Geom2d_Line(gp_Pnt2d(origin[0], origin[1]), gp_Dir2d(way[0], way[1]));
    }
  }
  // over the parameters of the curve
  std::vector<double> own = result.Space->Knots[0].Knots();
  for (double& knot : own)
  {
    knot = knot == 1.0 ? curve.Last : curve.First + length * knot;
  }
  result.Space =
    MakeTensorSpace<1>({ KnotVector::Create(result.Space->Knots[0].Degree(), own).Value }).Value;
  return ToOpenCASCADEPlane(result);
}
}
