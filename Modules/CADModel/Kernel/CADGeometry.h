// SPDX-License-Identifier: BSD-3-Clause
// Knotwork's splines as OpenCASCADE's and back: distinct knots with multiplicities there, repeated
// knots here; the same parametrization. Functions with OpenCASCADE's types throw its exceptions.
#pragma once
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Spline.h>

#include <Geom2d_BSplineCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>

namespace knotwork
{
/// InvalidKnots: a spline of tensor kind jumps somewhere, which OpenCASCADE's cannot.
template <int Dim>
Status CheckContinuity(const Spline<Dim>& spline, const std::string& place)
{
  for (const KnotVector& knots : spline.Space->Knots)
  {
    for (int b = 1; b < knots.NumElements(); ++b)
    {
      if (knots.Multiplicity(b) > knots.Degree())
      {
        return { ErrorCode::InvalidKnots,
          place + ": it jumps at the knot " + Digits(knots.Breaks()[static_cast<std::size_t>(b)]) +
            "; split it there" };
      }
    }
  }
  return {};
}

/// Clamped splines of tensor kind, interior multiplicities at most the degree.
opencascade::handle<Geom_BSplineSurface> ToOpenCASCADE(const Spline<2>& surface);
opencascade::handle<Geom_BSplineCurve> ToOpenCASCADE(const Spline<1>& curve);
opencascade::handle<Geom2d_BSplineCurve> ToOpenCASCADEPlane(const Spline<1>& curve);

/// Splines that are not periodic. @return failures of KnotVector::Create.
Result<Spline<2>> FromOpenCASCADE(const opencascade::handle<Geom_BSplineSurface>& surface);
Result<Spline<1>> FromOpenCASCADE(const opencascade::handle<Geom_BSplineCurve>& curve);
Result<Spline<1>> FromOpenCASCADE(const opencascade::handle<Geom2d_BSplineCurve>& curve);
}
