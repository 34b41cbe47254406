// SPDX-License-Identifier: BSD-3-Clause
#include "CADSurface.h"

#include <knotwork/SplineCore/Types.h>

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxSurface.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <array>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Same = 1e-9;  ///< of the surface's size: two maps are one
constexpr int GridOfCheck = 9; ///< parameters a direction at which maps are compared
constexpr int MaxIterations = 30;

using Range = std::array<double, 2>;

/// How many periods the pcurves of a face need in each direction: a helical strip is wound around
/// its cylinder, and goes over itself in parameters alone. Not more than can be meant.
/// @param ranges  of the face; where it needs several, they become those of the pcurves.
std::array<int, 2> TurnsOf(
  const TopoDS_Face& face, const std::array<double, 2>& periods, std::array<Range, 2>& ranges)
{
  constexpr int Samples = 64;
  constexpr double Slack = 1e-6;   // of a period, which pcurves may go beyond it
  constexpr double Between = 0.01; // of a period: what they may reach between samples
  constexpr double MaxTurns = 1000.0;
  std::array<Range, 2> reach{ Range{ HUGE_VAL, -HUGE_VAL }, Range{ HUGE_VAL, -HUGE_VAL } };
  for (TopExp_Explorer edges(face, TopAbs_EDGE); edges.More(); edges.Next())
  {
    double first = 0.0;
    double last = 0.0;
    const Handle(Geom2d_Curve) pcurve =
      BRep_Tool::CurveOnSurface(TopoDS::Edge(edges.Current()), face, first, last);
    for (int i = 0; i <= Samples && !pcurve.IsNull(); ++i)
    {
      const double share = static_cast<double>(i) / Samples;
      const gp_XY at = pcurve->Value((1.0 - share) * first + share * last).XY();
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double u = at.Coord(static_cast<int>(d) + 1);
        reach[d] = { std::min(reach[d][0], u), std::max(reach[d][1], u) };
      }
    }
  }
  std::array<int, 2> turns{ 1, 1 };
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double needed = (reach[d][1] - reach[d][0]) / periods[d];
    if (needed > 1.0 + Slack && needed <= MaxTurns)
    {
      ranges[d] = { reach[d][0] - Between * periods[d], reach[d][1] + Between * periods[d] };
      turns[d] = static_cast<int>(std::ceil(needed + 2.0 * Between));
    }
  }
  return turns;
}

/// The range of parameters of a face within the surface's own, where they differ by rounding.
/// @param turns  periods at most.
void FitRange(Range& range, const Range& natural, bool periodic, int turns)
{
  const double rounding = Same * std::abs(range[1] - range[0]);
  for (double& end : range)
  {
    for (double bound : natural)
    {
      end = std::abs(end - bound) <= rounding ? bound : end;
    }
  }
  if (periodic)
  {
    range[1] = std::min(range[1], range[0] + turns * (natural[1] - natural[0]));
  }
  else
  {
    range[0] = std::max(range[0], natural[0]);
    range[1] = std::min(range[1], natural[1]);
  }
}

double SizeOf(const Handle(Geom_BSplineSurface) & surface)
{
  double size = 0.0;
  const gp_Pnt& first = surface->Pole(1, 1);
  for (int i = 1; i <= surface->NbUPoles(); ++i)
  {
    for (int j = 1; j <= surface->NbVPoles(); ++j)
    {
      size = std::max(size, first.Distance(surface->Pole(i, j)));
    }
  }
  return size;
}

/// Gauss-Newton on the distance to a point that lies on the surface, within ranges of parameters.
/// @param size  of the surface.
gp_XY NearestPlace(const Handle(Geom_BSplineSurface) & surface, double size, const gp_Pnt& target,
  const gp_XY& guess, const Range& u, const Range& v)
{
  gp_XY best = guess;
  double distance = HUGE_VAL;
  gp_XY next = guess;
  for (int i = 0; i < MaxIterations; ++i)
  {
    next.SetX(std::min(std::max(next.X(), u[0]), u[1]));
    next.SetY(std::min(std::max(next.Y(), v[0]), v[1]));
    gp_Pnt point;
    gp_Vec du;
    gp_Vec dv;
    surface->D1(next.X(), next.Y(), point, du, dv);
    const gp_Vec residual(point, target);
    if (residual.Magnitude() >= distance)
    {
      break;
    }
    distance = residual.Magnitude();
    best = next;
    // a direction in which the surface stands still (a pole) is left alone
    const double tiny = 1e-20 * size * size;
    const double uu = du.Dot(du) + tiny;
    const double vv = dv.Dot(dv) + tiny;
    const double uv = du.Dot(dv);
    const double determinant = uu * vv - uv * uv;
    const double ru = residual.Dot(du);
    const double rv = residual.Dot(dv);
    next = best + gp_XY((ru * vv - rv * uv) / determinant, (rv * uu - ru * uv) / determinant);
  }
  return best;
}

/// Without periods, the domain beginning at (or a period from) the given parameters.
Handle(Geom_BSplineSurface)
  CutOpen(const Handle(Geom_BSplineSurface) & surface, double beginU, double beginV)
{
  if (!surface->IsUPeriodic() && !surface->IsVPeriodic())
  {
    return surface;
  }
  const auto open = Handle(Geom_BSplineSurface)::DownCast(surface->Copy());
  const auto indexOf = [](const TColStd_Array1OfReal& knots, double begin)
  {
    const double period = knots.Last() - knots.First();
    const double moved = begin - period * std::floor((begin - knots.First()) / period + Same);
    int best = knots.Lower();
    for (int k = knots.Lower(); k <= knots.Upper(); ++k)
    {
      best = std::abs(knots(k) - moved) < std::abs(knots(best) - moved) ? k : best;
    }
    return std::make_pair(
      std::abs(knots(best) - moved) <= Same * period, std::make_pair(best, moved));
  };
  if (open->IsUPeriodic())
  {
    auto place = indexOf(open->UKnots(), beginU);
    if (!place.first)
    {
      open->InsertUKnot(place.second.second, 1, 0.0);
      place = indexOf(open->UKnots(), beginU);
    }
    if (place.second.first > 1 && place.second.first < open->NbUKnots())
    {
      open->SetUOrigin(place.second.first);
    }
    open->SetUNotPeriodic();
  }
  if (open->IsVPeriodic())
  {
    auto place = indexOf(open->VKnots(), beginV);
    if (!place.first)
    {
      open->InsertVKnot(place.second.second, 1, 0.0);
      place = indexOf(open->VKnots(), beginV);
    }
    if (place.second.first > 1 && place.second.first < open->NbVKnots())
    {
      open->SetVOrigin(place.second.first);
    }
    open->SetVNotPeriodic();
  }
  return open;
}

/// Without the bounds that a file gives a surface: a whole turn between bounds has a period too,
/// and pcurves may lie in another one than the bounds do.
Handle(Geom_Surface) Unbounded(Handle(Geom_Surface) surface)
{
  for (auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull();
       trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface))
  {
    surface = trimmed->BasisSurface();
  }
  return surface;
}

constexpr double WholeTurn = 6.28318530717958647692;

/// Angles of a surface of revolution, counted from another meridian; null for others. The spline of
/// a whole turn begins at its angle 0, and its knots are angles nowhere between.
Handle(Geom_Surface) CountedFrom(const Handle(Geom_Surface) & surface, double angle)
{
  const auto elementary = Handle(Geom_ElementarySurface)::DownCast(surface);
  const auto revolution = Handle(Geom_SurfaceOfRevolution)::DownCast(surface);
  if (elementary.IsNull() && revolution.IsNull())
  {
    return {};
  }
  const auto turned = Handle(Geom_Surface)::DownCast(surface->Copy());
  if (revolution.IsNull())
  {
    const gp_Ax3& position = elementary->Position();
    turned->Rotate(position.Axis(), position.Direct() ? angle : -angle);
  }
  else
  {
    turned->Rotate(revolution->Axis(), angle);
  }
  return turned;
}

/// The spline of a part of a surface.
Handle(Geom_BSplineSurface)
  Converted(const Handle(Geom_Surface) & surface, const Range& u, const Range& v)
{
  const bool isWholeTurn = surface->IsUPeriodic() &&
    std::abs(u[1] - u[0] - WholeTurn) <= Same * WholeTurn && std::abs(u[0]) > Same * WholeTurn;
  const Handle(Geom_Surface) turned =
    isWholeTurn ? CountedFrom(surface, u[0]) : Handle(Geom_Surface)();
  if (turned.IsNull())
  {
    return GeomConvert::SurfaceToBSplineSurface(
      new Geom_RectangularTrimmedSurface(surface, u[0], u[1], v[0], v[1]));
  }
  const auto spline = GeomConvert::SurfaceToBSplineSurface(
    new Geom_RectangularTrimmedSurface(turned, 0.0, WholeTurn, v[0], v[1]));
  TColStd_Array1OfReal knots = spline->UKnots();
  for (double& knot : knots)
  {
    knot += u[0];
  }
  spline->SetUKnots(knots);
  return spline;
}

/// A closed spline repeated in a direction: it goes around several times.
Handle(Geom_BSplineSurface) Repeated(Handle(Geom_BSplineSurface) surface, bool alongU, int turns)
{
  if (turns == 1)
  {
    return surface;
  }
  surface = Handle(Geom_BSplineSurface)::DownCast(surface->Copy());
  if (!alongU)
  {
    surface->ExchangeUV();
  }
  Range u{};
  Range v{};
  surface->Bounds(u[0], u[1], v[0], v[1]);
  surface->Segment(u[0], u[1], v[0], v[1]); // clamps it
  const int n = surface->NbUPoles();
  const int numAcross = surface->NbVPoles();
  const int pieces = surface->NbUKnots() - 1;
  const int degree = surface->UDegree();
  TColgp_Array2OfPnt poles(1, turns * (n - 1) + 1, 1, numAcross);
  TColStd_Array2OfReal weights(1, poles.ColLength(), 1, numAcross);
  for (int i = 0; i < poles.ColLength(); ++i)
  {
    for (int j = 1; j <= numAcross; ++j)
    {
      poles.SetValue(i + 1, j, surface->Pole(i % (n - 1) + 1, j));
      weights.SetValue(i + 1, j, surface->Weight(i % (n - 1) + 1, j));
    }
  }
  const double period = surface->UKnot(pieces + 1) - surface->UKnot(1);
  TColStd_Array1OfReal knots(1, turns * pieces + 1);
  TColStd_Array1OfInteger multiplicities(1, knots.Length());
  for (int k = 0; k < knots.Length(); ++k)
  {
    const bool isJoint = k % pieces == 0;
    knots.SetValue(k + 1, surface->UKnot(k % pieces + 1) + k / pieces * period);
    multiplicities.SetValue(k + 1, isJoint ? degree : surface->UMultiplicity(k % pieces + 1));
  }
  multiplicities.SetValue(1, degree + 1);
  multiplicities.SetValue(knots.Length(), degree + 1);
  Handle(Geom_BSplineSurface) repeated = new Geom_BSplineSurface(poles, weights, knots,
    surface->VKnots(), multiplicities, surface->VMultiplicities(), degree, surface->VDegree());
  if (!alongU)
  {
    repeated->ExchangeUV();
  }
  return repeated;
}

/// Degrees that knot vectors can have.
Handle(Geom_BSplineSurface) WithLowDegree(const Handle(Geom_BSplineSurface) & surface)
{
  if (surface->UDegree() <= MaxDegree && surface->VDegree() <= MaxDegree)
  {
    return surface;
  }
  const GeomConvert_ApproxSurface approximation(
    surface, 1e-7 * SizeOf(surface), GeomAbs_C1, GeomAbs_C1, MaxDegree, MaxDegree, 1000, 1);
  return approximation.HasResult() ? approximation.Surface() : Handle(Geom_BSplineSurface)();
}
}

CADSurface::CADSurface(const TopoDS_Face& face) : From(Unbounded(BRep_Tool::Surface(face)))
{
  Range u{};
  Range v{};
  BRepTools::UVBounds(TopoDS::Face(face.Oriented(TopAbs_FORWARD)), u[0], u[1], v[0], v[1]);
  Range naturalU{};
  Range naturalV{};
  this->From->Bounds(naturalU[0], naturalU[1], naturalV[0], naturalV[1]);
  const std::array<double, 2> lengths{ this->From->IsUPeriodic() ? naturalU[1] - naturalU[0]
                                                                 : HUGE_VAL,
    this->From->IsVPeriodic() ? naturalV[1] - naturalV[0] : HUGE_VAL };
  std::array<Range, 2> ranges{ u, v };
  const std::array<int, 2> turns =
    TurnsOf(TopoDS::Face(face.Oriented(TopAbs_FORWARD)), lengths, ranges);
  u = ranges[0];
  v = ranges[1];
  FitRange(u, naturalU, this->From->IsUPeriodic(), turns[0]);
  FitRange(v, naturalV, this->From->IsVPeriodic(), turns[1]);
  const Range onceU{ u[0], turns[0] > 1 ? u[0] + lengths[0] : u[1] };
  const Range onceV{ v[0], turns[1] > 1 ? v[0] + lengths[1] : v[1] };
  gp_XY begin(u[0], v[0]);
  Handle(Geom_BSplineSurface) own = Handle(Geom_BSplineSurface)::DownCast(this->From);
  if (own.IsNull())
  {
    own = Converted(this->From, onceU, onceV);
    if (own->IsUPeriodic() || own->IsVPeriodic())
    {
      // parameters of the spline are not those of the surface: where does it begin?
      const double size = SizeOf(own);
      const Range all{ -HUGE_VAL, HUGE_VAL };
      const gp_XY middle(0.5 * (onceU[0] + onceU[1]), 0.5 * (onceV[0] + onceV[1]));
      begin = gp_XY(
        NearestPlace(own, size, this->From->Value(u[0], middle.Y()), { u[0], middle.Y() }, all, all)
          .X(),
        NearestPlace(own, size, this->From->Value(middle.X(), v[0]), { middle.X(), v[0] }, all, all)
          .Y());
    }
  }
  own = CutOpen(own, begin.X(), begin.Y());
  own = Repeated(Repeated(own, true, turns[0]), false, turns[1]);
  this->To = WithLowDegree(own);
  if (this->To.IsNull())
  {
    return;
  }
  this->To->Bounds(this->Lower[0], this->Upper[0], this->Lower[1], this->Upper[1]);
  const auto periods = [](bool periodic, const Range& natural, double lower, const Range& range)
  {
    const double period = natural[1] - natural[0];
    return periodic ? period * std::round((lower - range[0]) / period) : 0.0;
  };
  this->Shift = gp_XY(periods(this->From->IsUPeriodic(), naturalU, this->Lower[0], u),
    periods(this->From->IsVPeriodic(), naturalV, this->Lower[1], v));
  this->Size = SizeOf(this->To);
  double best = HUGE_VAL;
  for (Transfer kind : { Transfer::Identity, Transfer::Separate, Transfer::General })
  {
    const double residual = this->WorstResidual(kind, u, v);
    if (residual < best)
    {
      best = residual;
      this->Kind = kind;
    }
    if (best <= Same * this->Size)
    {
      break;
    }
  }
}

gp_XY CADSurface::Invert(const gp_XY& parameters, const gp_XY& guess) const
{
  return NearestPlace(this->To, this->Size, this->From->Value(parameters.X(), parameters.Y()),
    guess, { this->Lower[0], this->Upper[0] }, { this->Lower[1], this->Upper[1] });
}

gp_XY CADSurface::MapAs(Transfer kind, const gp_XY& parameters) const
{
  gp_XY result = parameters;
  if (kind == Transfer::Separate)
  {
    // away from poles, where one parameter means nothing
    const double u = 0.5 * (this->Lower[0] + this->Upper[0]);
    const double v = 0.5 * (this->Lower[1] + this->Upper[1]);
    const gp_XY alongU(parameters.X(), v);
    const gp_XY alongV(u, parameters.Y());
    result = gp_XY(this->Invert(alongU, alongU).X(), this->Invert(alongV, alongV).Y());
  }
  else if (kind == Transfer::General)
  {
    result = this->Invert(parameters, parameters);
  }
  result.SetX(std::min(std::max(result.X(), this->Lower[0]), this->Upper[0]));
  result.SetY(std::min(std::max(result.Y(), this->Lower[1]), this->Upper[1]));
  return result;
}

gp_XY CADSurface::Map(const gp_XY& parameters) const
{
  return this->MapAs(this->Kind, parameters + this->Shift);
}

double CADSurface::WorstResidual(
  Transfer kind, const std::array<double, 2>& u, const std::array<double, 2>& v) const
{
  double worst = 0.0;
  for (int i = 0; i < GridOfCheck; ++i)
  {
    for (int j = 0; j < GridOfCheck; ++j)
    {
      const gp_XY old(
        u[0] + i * (u[1] - u[0]) / (GridOfCheck - 1), v[0] + j * (v[1] - v[0]) / (GridOfCheck - 1));
      const gp_XY mapped = this->MapAs(kind, old + this->Shift);
      worst = std::max(worst,
        this->From->Value(old.X(), old.Y()).Distance(this->To->Value(mapped.X(), mapped.Y())));
    }
  }
  return worst;
}
}
