// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticPatch.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TrimmedModel.h>

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

#include <optional>

namespace knotwork
{
/// A curve of OpenCASCADE in the place of an edge's spline, between two of its parameters; none for
/// an edge that is a point.
struct AnalyticCurve
{
  opencascade::handle<Geom_Curve> Curve;
  double First = 0.0;
  double Last = 1.0;
};

/// The line or circle that a curve is, within a distance; empty when it is neither.
std::optional<AnalyticCurve> FindAnalyticCurve(const Spline<1>& curve, double tolerance);

/// A face whose spline is a part of a plane, cylinder, sphere, cone or torus, or of an extrusion or
/// revolution, as such.
class AnalyticFace
{
public:
  /// @param face  its Type says what to look for.
  /// @return empty when the spline is no such surface within a billionth of its size.
  static std::optional<AnalyticFace> Find(const TrimmedFace& face);

  bool IsPlane() const { return this->Patch.Surface().Type == SurfaceType::Plane; }
  /// Whether the surface's normal, and the sense of its parameters, are opposite to the spline's.
  bool IsTurned() const { return this->Turned; }
  opencascade::handle<Geom_Surface> Surface() const;
  /// The pcurve of an edge, over the parameters of its curve: linear where it is, else a quintic
  /// spline.
  /// @param parameters  the pcurve in the parameters of the face's spline, in the same sense.
  opencascade::handle<Geom2d_Curve> ParameterCurve(
    const AnalyticCurve& curve, const Spline<1>& parameters) const;
  /// Largest distance of an edge's points from the surface.
  double GapOf(const AnalyticCurve& curve) const;

private:
  opencascade::handle<Geom_Surface> SurfaceOfProfile() const;
  PointMatrix Lift(const PointMatrix& splineParameters) const;

  BezierForm<2> Form;
  AnalyticPatch Patch;
  Eigen::RowVector2d Start = Eigen::RowVector2d::Zero(); ///< a place of the spline's domain
  Eigen::Vector2d StartPlace = Eigen::Vector2d::Zero();  ///< the same on the surface
  double Size = 1.0;
  bool Turned = false;
};
}
