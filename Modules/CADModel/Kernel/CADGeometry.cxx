// SPDX-License-Identifier: BSD-3-Clause
#include "CADGeometry.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>

namespace knotwork
{
namespace
{
struct DistinctKnots
{
  explicit DistinctKnots(const KnotVector& knots)
    : Values(1, static_cast<int>(knots.Breaks().size())), Multiplicities(1, Values.Length())
  {
    for (int b = 0; b < this->Values.Length(); ++b)
    {
      this->Values.SetValue(b + 1, knots.Breaks()[static_cast<std::size_t>(b)]);
      this->Multiplicities.SetValue(b + 1, knots.Multiplicity(b));
    }
  }
  TColStd_Array1OfReal Values;
  TColStd_Array1OfInteger Multiplicities;
};

/// OpenCASCADE leaves the outermost knots of a spline that was periodic where they were; they are
/// without influence when the others make a clamped end.
Result<KnotVector> KnotsFrom(int degree, const TColStd_Array1OfReal& flat)
{
  std::vector<double> knots(flat.begin(), flat.end());
  const auto p = static_cast<std::size_t>(degree);
  const std::size_t n = knots.size();
  if (n > 2 * p + 1)
  {
    knots[0] = knots[1] == knots[p] ? knots[1] : knots[0];
    knots[n - 1] = knots[n - 2] == knots[n - 1 - p] ? knots[n - 2] : knots[n - 1];
  }
  return KnotVector::Create(degree, std::move(knots));
}

template <class Handle>
Result<SplineSpacePtr<1>> CurveSpace(const Handle& curve)
{
  TColStd_Array1OfReal flat(1, curve->NbPoles() + curve->Degree() + 1);
  curve->KnotSequence(flat);
  auto knots = KnotsFrom(curve->Degree(), flat);
  return knots ? MakeTensorSpace<1>({ knots.Value }) : Result<SplineSpacePtr<1>>(knots.Status);
}

/// @param dimension  of the curve's poles.
template <class Handle>
Result<Spline<1>> CurveFrom(const Handle& curve, int dimension)
{
  auto space = CurveSpace(curve);
  if (!space)
  {
    return space.Status;
  }
  Spline<1> result;
  result.Space = space.Value;
  result.ControlPoints.resize(curve->NbPoles(), dimension);
  result.Weights.resize(curve->IsRational() ? curve->NbPoles() : 0);
  for (int i = 0; i < curve->NbPoles(); ++i)
  {
    for (int d = 0; d < dimension; ++d)
    {
      result.ControlPoints(i, d) = curve->Pole(i + 1).Coord(d + 1);
    }
    if (curve->IsRational())
    {
      result.Weights[i] = curve->Weight(i + 1);
    }
  }
  return result;
}

gp_Pnt PointOfRow(const PointMatrix& points, Eigen::Index i)
{
  return { points(i, 0), points(i, 1), points(i, 2) };
}
}

Handle(Geom_BSplineSurface) ToOpenCASCADE(const Spline<2>& surface)
{
  const auto& knots = surface.Space->Knots;
  const int nu = knots[0].NumFunctions();
  const int nv = knots[1].NumFunctions();
  TColgp_Array2OfPnt poles(1, nu, 1, nv);
  TColStd_Array2OfReal weights(1, nu, 1, nv);
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      poles.SetValue(i + 1, j + 1, PointOfRow(surface.ControlPoints, j * nu + i));
      weights.SetValue(i + 1, j + 1, surface.IsRational() ? surface.Weights[j * nu + i] : 1.0);
    }
  }
  const DistinctKnots u(knots[0]);
  const DistinctKnots v(knots[1]);
  return new Geom_BSplineSurface(poles, weights, u.Values, v.Values, u.Multiplicities,
    v.Multiplicities, knots[0].Degree(), knots[1].Degree());
}

Handle(Geom_BSplineCurve) ToOpenCASCADE(const Spline<1>& curve)
{
  const int n = curve.Space->NumFunctions;
  TColgp_Array1OfPnt poles(1, n);
  TColStd_Array1OfReal weights(1, n);
  for (int i = 0; i < n; ++i)
  {
    poles.SetValue(i + 1, PointOfRow(curve.ControlPoints, i));
    weights.SetValue(i + 1, curve.IsRational() ? curve.Weights[i] : 1.0);
  }
  const DistinctKnots t(curve.Space->Knots[0]);
  return new Geom_BSplineCurve(
    poles, weights, t.Values, t.Multiplicities, curve.Space->Knots[0].Degree());
}

Handle(Geom2d_BSplineCurve) ToOpenCASCADEPlane(const Spline<1>& curve)
{
  const int n = curve.Space->NumFunctions;
  TColgp_Array1OfPnt2d poles(1, n);
  TColStd_Array1OfReal weights(1, n);
  for (int i = 0; i < n; ++i)
  {
    poles.SetValue(i + 1, gp_Pnt2d(curve.ControlPoints(i, 0), curve.ControlPoints(i, 1)));
    weights.SetValue(i + 1, curve.IsRational() ? curve.Weights[i] : 1.0);
  }
  const DistinctKnots t(curve.Space->Knots[0]);
  return new Geom2d_BSplineCurve(
    poles, weights, t.Values, t.Multiplicities, curve.Space->Knots[0].Degree());
}

Result<Spline<2>> FromOpenCASCADE(const Handle(Geom_BSplineSurface) & surface)
{
  const int nu = surface->NbUPoles();
  const int nv = surface->NbVPoles();
  TColStd_Array1OfReal u(1, nu + surface->UDegree() + 1);
  TColStd_Array1OfReal v(1, nv + surface->VDegree() + 1);
  surface->UKnotSequence(u);
  surface->VKnotSequence(v);
  auto knotsU = KnotsFrom(surface->UDegree(), u);
  auto knotsV = KnotsFrom(surface->VDegree(), v);
  if (!knotsU || !knotsV)
  {
    return knotsU ? knotsV.Status : knotsU.Status;
  }
  auto space = MakeTensorSpace<2>({ knotsU.Value, knotsV.Value });
  if (!space)
  {
    return space.Status;
  }
  Spline<2> result;
  result.Space = space.Value;
  result.ControlPoints.resize(static_cast<Eigen::Index>(nu) * nv, 3);
  const bool rational = surface->IsURational() || surface->IsVRational();
  result.Weights.resize(rational ? result.ControlPoints.rows() : 0);
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      const gp_Pnt& pole = surface->Pole(i + 1, j + 1);
      result.ControlPoints.row(j * nu + i) << pole.X(), pole.Y(), pole.Z();
      if (rational)
      {
        result.Weights[j * nu + i] = surface->Weight(i + 1, j + 1);
      }
    }
  }
  return result;
}

Result<Spline<1>> FromOpenCASCADE(const Handle(Geom_BSplineCurve) & curve)
{
  return CurveFrom(curve, 3);
}

Result<Spline<1>> FromOpenCASCADE(const Handle(Geom2d_BSplineCurve) & curve)
{
  return CurveFrom(curve, 2);
}
}
