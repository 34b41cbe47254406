// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <Eigen/Core>

namespace knotwork
{
/// A plane curve that goes on straight beyond its ends: the profile of a surface of extrusion or of
/// revolution. Parameters are about lengths.
class SurfaceProfile
{
public:
  /// @param curve  of tensor kind and a degree of 2 at least, n x 2 control points, polynomial,
  /// regular. @param across  of length 1: where the first coordinate of an extrusion's profile
  /// points to, across its axis.
  SurfaceProfile(Spline<1> curve, const Eigen::Vector3d& across);

  const Eigen::Vector3d& Across() const { return this->First; }
  const Spline<1>& Curve() const { return this->Of; }
  double Begin() const { return this->Knots().Begin(); }
  double End() const { return this->Knots().End(); }
  Eigen::Vector2d Point(double parameter) const;
  /// Parameter of the nearest point: from the nearest of eight samples a span on, by Newton's
  /// iteration.
  double Nearest(const Eigen::Vector2d& point) const;
  /// The same from a parameter on that is about right.
  double NearestFrom(const Eigen::Vector2d& point, double parameter) const;
  /// Signed, positive on the right of the curve.
  double Distance(const Eigen::Vector2d& point) const;
  /// To the right of the curve at the nearest point, of length 1.
  Eigen::Vector2d Normal(const Eigen::Vector2d& point) const;
  /// A bound of the curvature, from the control points of the derivatives of an eighth of a span
  /// each; infinite when these do not prove the curve to be regular.
  double MaxCurvature() const { return this->MaxCurvature(this->Begin(), this->End()); }
  /// The same between two parameters.
  double MaxCurvature(double begin, double end) const;
  /// The curve from one parameter of its domain to another.
  Spline<1> Part(double begin, double end) const;

private:
  const KnotVector& Knots() const { return this->Of.Space->Knots[0]; }
  /// Row k is the k-th derivative, up to the second.
  Eigen::Matrix<double, 3, 2> Derivatives(double parameter) const;
  double Refine(const Eigen::Vector2d& point, double parameter, double lower, double upper) const;
  void ExpandSpans();
  void BoundCurvatures();

  Spline<1> Of;
  Eigen::Vector3d First;
  /// Taylor coefficients at the begin of each span, degree + 1 rows a span.
  PointMatrix Coefficients;
  std::vector<double> SampleParameters;
  PointMatrix SamplePoints;
  std::vector<double> Curvatures; ///< bounds between samples
};
}
