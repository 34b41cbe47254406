// SPDX-License-Identifier: BSD-3-Clause
#include "CADEdge.h"

#include "CADGeometry.h"
#include <knotwork/SplineCore/CurveInterpolation.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <GeomConvert.hxx>
#include <Geom_Circle.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <functional>
#include <set>

namespace knotwork
{
namespace
{
constexpr double Same = 1e-9; ///< relative: what differs by rounding
constexpr int SamplesOfSpan = 8;
constexpr int MaxSpans = 4096;
constexpr int DegreeOfFit = 3;
constexpr int MaxIterations = 30;

/// What is known of an edge as functions of the parameter of its spline.
struct EdgeFunctions
{
  Spline<1> Curve; ///< empty: there is none of a degree that knot vectors can have
  double First = 0.0;
  double Last = 1.0;
  std::function<gp_Pnt(double)> Point;
  std::vector<std::function<gp_XY(double)>> Parameters; ///< of the uses
  std::vector<double> Breaks;                           ///< where pieces of the curve meet
  bool SameParameters = true;                           ///< that of the spline is that of the edge
};

/// The parameter of the point of another parametrization of the same curve, near to it.
double InvertCurve(
  const Handle(Geom_Curve) & curve, const gp_Pnt& target, double guess, double first, double last)
{
  double best = guess;
  double next = guess;
  double distance = HUGE_VAL;
  for (int i = 0; i < MaxIterations; ++i)
  {
    next = std::min(std::max(next, first), last);
    gp_Pnt point;
    gp_Vec tangent;
    curve->D1(next, point, tangent);
    const gp_Vec residual(point, target);
    if (residual.Magnitude() >= distance || tangent.SquareMagnitude() == 0.0)
    {
      break;
    }
    distance = residual.Magnitude();
    best = next;
    next += residual.Dot(tangent) / tangent.SquareMagnitude();
  }
  return best;
}

double SizeOf(const Handle(Geom_BSplineCurve) & curve)
{
  double size = 0.0;
  for (int i = 1; i <= curve->NbPoles(); ++i)
  {
    size = std::max(size, curve->Pole(1).Distance(curve->Pole(i)));
  }
  return size;
}

/// Lets a periodic spline begin at the parameter of a point.
void BeginAt(Geom_BSplineCurve& curve, const gp_Pnt& point, double guess)
{
  const double lower = curve.FirstParameter();
  const double period = curve.LastParameter() - lower;
  const double rounding = Same * period;
  const Handle(Geom_Curve) whole(&curve);
  double place = InvertCurve(whole, point, guess, -HUGE_VAL, HUGE_VAL);
  place -= period * std::floor((place - lower + rounding) / period);
  if (std::abs(place - lower) <= rounding)
  {
    return;
  }
  curve.InsertKnot(place, 1, rounding);
  for (int k = 1; k <= curve.NbKnots(); ++k)
  {
    if (std::abs(curve.Knot(k) - place) <= rounding)
    {
      curve.SetOrigin(k);
      return;
    }
  }
}

Handle(Geom_BSplineCurve) PlainSpline(Handle(Geom_Curve) curve, double first, double last)
{
  const Handle(Geom_BSplineCurve) own = Handle(Geom_BSplineCurve)::DownCast(curve);
  const double rounding = Same * (last - first);
  if (!own.IsNull() && !own->IsPeriodic() && std::abs(own->FirstParameter() - first) <= rounding &&
    std::abs(own->LastParameter() - last) <= rounding)
  {
    return own;
  }
  // The spline of a whole circle begins at its angle 0, and its knots are angles nowhere between:
  // angles are counted from where the edge begins.
  double shift = 0.0;
  const Handle(Geom_Circle) circle = Handle(Geom_Circle)::DownCast(curve);
  if (!circle.IsNull() && std::abs(last - first - circle->Period()) <= rounding)
  {
    shift = first;
    curve = Handle(Geom_Curve)::DownCast(curve->Copy());
    curve->Rotate(circle->Axis(), shift);
  }
  const Handle(Geom_BSplineCurve) converted =
    GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(curve, first - shift, last - shift));
  if (converted->IsPeriodic())
  {
    BeginAt(*converted, curve->Value(first - shift), first - shift);
    converted->SetNotPeriodic();
  }
  shift = first - converted->FirstParameter();
  if (std::abs(shift) > rounding)
  {
    TColStd_Array1OfReal knots = converted->Knots();
    for (double& knot : knots)
    {
      knot += shift;
    }
    converted->SetKnots(knots);
  }
  return converted;
}

/// Parameters of a use at a parameter of the edge.
gp_XY ParametersAt(const CADPcurve& use, double share)
{
  const double t = share == 1.0 ? use.Last : (1.0 - share) * use.First + share * use.Last;
  return use.Surface->Map(use.Curve->Value(t).XY());
}

/// Where a pcurve crosses lines of knots of its surface, the parameters may bend.
void AddCrossings(
  const CADPcurve& use, const std::function<gp_XY(double)>& parameters, std::vector<double>& breaks)
{
  constexpr int Samples = 64; // a piece
  constexpr int Bisections = 60;
  const Handle(Geom_BSplineSurface)& surface = use.Surface->Surface();
  const std::vector<double> pieces = breaks;
  const double rounding = Same * (pieces.back() - pieces.front());
  for (int d = 1; d <= 2; ++d)
  {
    const TColStd_Array1OfReal& knots = d == 1 ? surface->UKnots() : surface->VKnots();
    const auto at = [&](double s) { return parameters(s).Coord(d); };
    for (std::size_t b = 0; knots.Length() > 2 && b + 1 < pieces.size(); ++b)
    {
      double begin = pieces[b];
      double before = at(begin);
      for (int i = 1; i <= Samples; ++i)
      {
        const double end = pieces[b] + i * (pieces[b + 1] - pieces[b]) / Samples;
        const double after = at(end);
        for (int k = knots.Lower() + 1; k < knots.Upper(); ++k)
        {
          double lower = begin;
          double upper = end;
          for (int j = 0; (before < knots(k)) != (after < knots(k)) && j < Bisections; ++j)
          {
            const double middle = 0.5 * (lower + upper);
            ((at(middle) < knots(k)) == (before < knots(k)) ? lower : upper) = middle;
          }
          const bool known = std::any_of(breaks.begin(), breaks.end(),
            [&](double other) { return std::abs(other - upper) <= rounding; });
          if ((before < knots(k)) != (after < knots(k)) && !known)
          {
            breaks.push_back(upper);
          }
        }
        begin = end;
        before = after;
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
}

EdgeFunctions Describe(const TopoDS_Edge& edge, const std::vector<CADPcurve>& uses)
{
  EdgeFunctions result;
  double first = 0.0;
  double last = 0.0;
  const Handle(Geom_Curve) original = BRep_Tool::Curve(edge, first, last);
  std::function<double(double)> share; // of the edge, by the parameter of the spline
  if (original.IsNull())
  {
    result.First = uses.front().First;
    result.Last = uses.front().Last;
    const auto begin = result.First;
    const auto length = result.Last - result.First;
    share = [=](double s) { return (s - begin) / length; };
    if (BRep_Tool::Degenerated(edge))
    {
      const TopoDS_Vertex vertex = TopExp::FirstVertex(edge);
      const gp_Pnt point = BRep_Tool::Pnt(vertex);
      result.Point = [point](double) { return point; };
      result.Curve.Space =
        MakeTensorSpace<1>({ KnotVector::Uniform(1, 1, result.First, result.Last) }).Value;
      result.Curve.ControlPoints.resize(2, 3);
      result.Curve.ControlPoints.rowwise() = Eigen::RowVector3d(point.X(), point.Y(), point.Z());
    }
    else
    {
      const CADPcurve use = uses.front();
      result.Point = [use, share](double s)
      {
        const gp_XY uv = ParametersAt(use, share(s));
        return use.Surface->Surface()->Value(uv.X(), uv.Y());
      };
    }
    result.Breaks = { result.First, result.Last };
  }
  else
  {
    const Handle(Geom_BSplineCurve) spline = PlainSpline(original, first, last);
    result.First = spline->FirstParameter();
    result.Last = spline->LastParameter();
    for (int k = 1; k <= spline->NbKnots(); ++k)
    {
      result.Breaks.push_back(spline->Knot(k));
    }
    if (spline->Degree() <= MaxDegree)
    {
      if (auto curve = FromOpenCASCADE(spline))
      {
        result.Curve = std::move(curve.Value);
      }
    }
    result.Point = [spline](double s) { return spline->Value(s); };
    constexpr int Checks = 16;
    const double size = SizeOf(spline);
    for (int i = 0; i <= Checks && result.SameParameters; ++i)
    {
      const double s = result.First + i * (result.Last - result.First) / Checks;
      result.SameParameters = original->Value(s).Distance(spline->Value(s)) <= Same * size;
    }
    const bool same = result.SameParameters;
    share = [=](double s)
    {
      const double t = same ? s : InvertCurve(original, spline->Value(s), s, first, last);
      return (t - first) / (last - first);
    };
  }
  for (const CADPcurve& use : uses)
  {
    result.Parameters.emplace_back(
      [use, share, ends = std::array<double, 2>{ result.First, result.Last }](double s) {
        return ParametersAt(use, s == ends[0] ? 0.0 : s == ends[1] ? 1.0 : share(s));
      });
  }
  return result;
}

/// Knots of pcurves over the curve's domain with their continuity, for a spline of some degree.
Result<Spline<1>> InsertKnotsOfPcurves(const Spline<1>& curve, const std::vector<CADPcurve>& uses)
{
  Spline<1> result = curve;
  for (const CADPcurve& use : uses)
  {
    const Handle(Geom2d_BSplineCurve) spline = Handle(Geom2d_BSplineCurve)::DownCast(use.Curve);
    if (spline.IsNull() || spline->IsPeriodic())
    {
      continue;
    }
    const KnotVector knots = result.Space->Knots[0];
    const double scale = (knots.End() - knots.Begin()) / (use.Last - use.First);
    const double rounding = Same * (knots.End() - knots.Begin());
    std::vector<double> missing;
    for (int k = 1; k <= spline->NbKnots(); ++k)
    {
      const double t = knots.Begin() + scale * (spline->Knot(k) - use.First);
      if (t <= knots.Begin() + rounding || t >= knots.End() - rounding)
      {
        continue;
      }
      const int wanted = knots.Degree() - (spline->Degree() - spline->Multiplicity(k));
      double place = t;
      int there = 0;
      for (int b = 1; b < knots.NumElements(); ++b)
      {
        const double u = knots.Breaks()[static_cast<std::size_t>(b)];
        if (std::abs(u - t) <= rounding)
        {
          place = u;
          there = knots.Multiplicity(b);
        }
      }
      missing.insert(missing.end(), static_cast<std::size_t>(std::max(wanted - there, 0)), place);
    }
    if (!missing.empty())
    {
      auto inserted = InsertKnots<1>(result, 0, missing);
      if (!inserted)
      {
        return inserted;
      }
      result = std::move(inserted.Value);
    }
  }
  return result;
}

PointMatrix ParametersAtAll(const std::function<gp_XY(double)>& function, const PointMatrix& at)
{
  PointMatrix values(at.rows(), 2);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    const gp_XY uv = function(at(i, 0));
    values.row(i) << uv.X(), uv.Y();
  }
  return values;
}

/// The pcurves in the space, and with the weights, of a curve; false when one is not in it.
bool ExactPcurves(const Spline<1>& curve, const EdgeFunctions& edge, std::vector<CADPcurve>& uses)
{
  CurveInterpolation collocation;
  if (!collocation.Prepare(*curve.Space))
  {
    return false;
  }
  const bool rational = curve.IsRational();
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(collocation.Points().rows());
  if (rational)
  {
    weights = collocation.Matrix() * curve.Weights;
  }
  const PointMatrix samples = ParametersInSpans(curve.Space->Knots[0], SamplesOfSpan);
  for (std::size_t i = 0; i < uses.size(); ++i)
  {
    PointMatrix values = ParametersAtAll(edge.Parameters[i], collocation.Points());
    PointMatrix solved = collocation.Solve(weights.asDiagonal() * values);
    if (rational)
    {
      solved = curve.Weights.cwiseInverse().asDiagonal() * solved;
    }
    uses[i].UV = solved;
    const PointMatrix found = CurvePoints({ curve.Space, solved, curve.Weights }, samples);
    const PointMatrix wanted = ParametersAtAll(edge.Parameters[i], samples);
    double bounds[4];
    uses[i].Surface->Surface()->Bounds(bounds[0], bounds[1], bounds[2], bounds[3]);
    const Eigen::Array2d worst =
      (found - wanted).cwiseAbs().colwise().maxCoeff().transpose().array();
    if (!(worst[0] <= Same * (bounds[1] - bounds[0]) && worst[1] <= Same * (bounds[3] - bounds[2])))
    {
      return false;
    }
  }
  return true;
}

/// Poles as the file has them when the pcurve is in the curve's space already.
void KeepPoles(const Spline<1>& curve, std::vector<CADPcurve>& uses)
{
  for (CADPcurve& use : uses)
  {
    const Handle(Geom2d_BSplineCurve) spline = Handle(Geom2d_BSplineCurve)::DownCast(use.Curve);
    if (!use.Surface->IsIdentity() || spline.IsNull() || spline->IsPeriodic())
    {
      continue;
    }
    const auto own = FromOpenCASCADE(spline);
    if (own && own->Space->Knots == curve.Space->Knots &&
      own->Weights.size() == curve.Weights.size() && own->Weights == curve.Weights &&
      (own->ControlPoints - use.UV).norm() <= Same * use.UV.norm())
    {
      use.UV = own->ControlPoints;
    }
  }
}

bool FindExact(const EdgeFunctions& edge, std::vector<CADPcurve>& uses, Spline<1>& result)
{
  if (!edge.Curve.Space)
  {
    return false;
  }
  const int degree = edge.Curve.Space->Knots[0].Degree();
  int highest = 1;
  for (const CADPcurve& use : uses)
  {
    const Handle(Geom2d_BSplineCurve) spline = Handle(Geom2d_BSplineCurve)::DownCast(use.Curve);
    highest = std::max(highest, spline.IsNull() ? 1 : spline->Degree());
  }
  for (int d : std::set<int>{ degree, std::max(degree, highest), degree + 1 })
  {
    if (d > MaxDegree)
    {
      continue;
    }
    auto elevated = ElevateDegree<1>(edge.Curve, 0, d - degree);
    if (!elevated)
    {
      continue;
    }
    auto refined = InsertKnotsOfPcurves(elevated.Value, uses);
    if (refined && ExactPcurves(refined.Value, edge, uses))
    {
      KeepPoles(refined.Value, uses);
      result = std::move(refined.Value);
      return true;
    }
  }
  return false;
}

/// Largest distances at samples, in space, of the interpolated curve and pcurves.
double DeviationOf(
  const Spline<1>& curve, const EdgeFunctions& edge, const std::vector<CADPcurve>& uses)
{
  const PointMatrix samples = ParametersInSpans(curve.Space->Knots[0], SamplesOfSpan);
  const PointMatrix points = CurvePoints(curve, samples);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < samples.rows(); ++i)
  {
    worst = std::max(
      worst, edge.Point(samples(i, 0)).Distance(gp_Pnt(points(i, 0), points(i, 1), points(i, 2))));
  }
  for (std::size_t u = 0; u < uses.size(); ++u)
  {
    const Handle(Geom_BSplineSurface)& surface = uses[u].Surface->Surface();
    const PointMatrix found = CurvePoints({ curve.Space, uses[u].UV, {} }, samples);
    for (Eigen::Index i = 0; i < samples.rows(); ++i)
    {
      const gp_XY wanted = edge.Parameters[u](samples(i, 0));
      worst = std::max(worst,
        surface->Value(found(i, 0), found(i, 1)).Distance(surface->Value(wanted.X(), wanted.Y())));
    }
  }
  return worst;
}

/// Control points that interpolation puts beyond the surface's domain by rounding come back to it:
/// a pcurve along a side of its surface does not leave it.
void KeepWithinDomain(CADPcurve& use)
{
  constexpr double Slack = 1e-7; // of the domain
  double lower[2];
  double upper[2];
  use.Surface->Surface()->Bounds(lower[0], upper[0], lower[1], upper[1]);
  for (Eigen::Index i = 0; i < use.UV.rows(); ++i)
  {
    for (Eigen::Index d = 0; d < 2; ++d)
    {
      double& u = use.UV(i, d);
      const double within = std::min(std::max(u, lower[d]), upper[d]);
      u = std::abs(u - within) <= Slack * (upper[d] - lower[d]) ? within : u;
    }
  }
}

Status Fit(EdgeFunctions& edge, std::vector<CADPcurve>& uses, double tolerance, CADEdge& result)
{
  for (std::size_t u = 0; u < uses.size(); ++u)
  {
    AddCrossings(uses[u], edge.Parameters[u], edge.Breaks);
  }
  result.Refitted = true;
  result.Deviation = HUGE_VAL;
  std::vector<CADPcurve> trial = uses;
  int parts = 1;
  while (parts * (edge.Breaks.size() - 1) < 4)
  {
    parts *= 2;
  }
  for (; parts == 1 || parts * (edge.Breaks.size() - 1) <= MaxSpans; parts *= 2)
  {
    std::vector<double> knots(DegreeOfFit + 1, edge.First);
    for (std::size_t b = 0; b + 1 < edge.Breaks.size(); ++b)
    {
      for (int k = 1; k <= parts; ++k)
      {
        const double s = static_cast<double>(k) / parts;
        knots.push_back((1.0 - s) * edge.Breaks[b] + s * edge.Breaks[b + 1]);
      }
      // where pieces meet there may be corners
      knots.insert(knots.end(), DegreeOfFit - 1, edge.Breaks[b + 1]);
    }
    knots.push_back(edge.Last);
    auto vector = KnotVector::Create(DegreeOfFit, knots);
    if (!vector)
    {
      return vector.Status;
    }
    Spline<1> curve;
    curve.Space = MakeTensorSpace<1>({ vector.Value }).Value;
    CurveInterpolation collocation;
    if (Status status = collocation.Prepare(*curve.Space); !status)
    {
      return status;
    }
    PointMatrix points(collocation.Points().rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const gp_Pnt point = edge.Point(collocation.Points()(i, 0));
      points.row(i) << point.X(), point.Y(), point.Z();
    }
    curve.ControlPoints = collocation.Solve(points);
    for (std::size_t u = 0; u < trial.size(); ++u)
    {
      trial[u].UV = collocation.Solve(ParametersAtAll(edge.Parameters[u], collocation.Points()));
      KeepWithinDomain(trial[u]);
    }
    const double deviation = DeviationOf(curve, edge, trial);
    if (deviation < result.Deviation)
    {
      result.Deviation = deviation;
      result.Curve = std::move(curve);
      uses = trial;
    }
    if (result.Deviation <= tolerance)
    {
      return {};
    }
  }
  return result.Curve.Space ? Status() : Status(ErrorCode::NotConverged, "an edge of the file");
}
}

Result<CADEdge> UnifyEdge(const TopoDS_Edge& edge, std::vector<CADPcurve>& uses, double tolerance)
{
  CADEdge result;
  EdgeFunctions functions = Describe(edge, uses);
  if (FindExact(functions, uses, result.Curve))
  {
    return result;
  }
  const Status status = Fit(functions, uses, tolerance, result);
  return status ? Result<CADEdge>(std::move(result)) : Result<CADEdge>(status);
}
}
