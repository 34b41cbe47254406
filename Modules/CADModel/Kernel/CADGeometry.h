// SPDX-License-Identifier: BSD-3-Clause
// Knotwork's splines as OpenCASCADE's and back: distinct knots with multiplicities there, repeated
// knots here; the same parametrization. Functions with OpenCASCADE's types throw its exceptions.
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <Geom2d_BSplineCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>

namespace knotwork
{
/// Clamped splines of tensor kind, interior multiplicities at most the degree.
opencascade::handle<Geom_BSplineSurface> ToOpenCASCADE(const Spline<2>& surface);
opencascade::handle<Geom_BSplineCurve> ToOpenCASCADE(const Spline<1>& curve);
opencascade::handle<Geom2d_BSplineCurve> ToOpenCASCADEPlane(const Spline<1>& curve);

/// Splines that are not periodic. @return failures of KnotVector::Create.
Result<Spline<2>> FromOpenCASCADE(const opencascade::handle<Geom_BSplineSurface>& surface);
Result<Spline<1>> FromOpenCASCADE(const opencascade::handle<Geom_BSplineCurve>& curve);
Result<Spline<1>> FromOpenCASCADE(const opencascade::handle<Geom2d_BSplineCurve>& curve);
}
