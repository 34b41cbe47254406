// SPDX-License-Identifier: BSD-3-Clause
#include "AnalyticPatch.h"
#include "SurfaceProfile.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double MaxSpan = 0.5 * Pi;

/// Points x, y and weights of a polygon.
using Polygon = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Arc of a radius about 0.
Polygon MakeArc(double begin, double end, int spans, double radius)
{
  const double half = (end - begin) / (2 * spans);
  Polygon arc(2 * spans + 1, 3);
  for (int i = 0; i <= 2 * spans; ++i)
  {
    const double weight = i % 2 == 1 ? std::cos(half) : 1.0;
    const double angle = begin + half * i;
    arc.row(i) << radius * std::cos(angle) / weight, radius * std::sin(angle) / weight, weight;
  }
  return arc;
}
}

AnalyticPatch::AnalyticPatch(const AnalyticSurface& surface, const Eigen::Vector3d& reference)
  : Of(surface)
{
  constexpr double enough = 1e-6; // of the reference's length
  const Eigen::Vector3d& axis = surface.Axis;
  Eigen::Vector3d across = reference - reference.dot(axis) * axis;
  if (!(across.norm() > enough * reference.norm()))
  {
    across = axis.unitOrthogonal();
  }
  this->X =
    surface.Type == SurfaceType::Extrusion ? surface.Profile->Across() : across.normalized().eval();
  this->Y = axis.cross(this->X);
}

bool AnalyticPatch::IsAngle(int direction) const
{
  return this->Of.Type != SurfaceType::Plane && this->Of.Type != SurfaceType::Extrusion &&
    (direction == 0 || this->Of.Type == SurfaceType::Sphere || this->Of.Type == SurfaceType::Torus);
}

bool AnalyticPatch::IsPeriodic(int direction) const
{
  return this->IsAngle(direction) && (direction == 0 || this->Of.Type == SurfaceType::Torus);
}

Eigen::Vector3d AnalyticPatch::Point(const Eigen::Vector2d& parameters) const
{
  const double u = parameters[0];
  const double v = parameters[1];
  const AnalyticSurface& s = this->Of;
  if (s.Type == SurfaceType::Plane)
  {
    return s.Point + u * this->X + v * this->Y;
  }
  if (s.Type == SurfaceType::Extrusion)
  {
    const Eigen::Vector2d at = s.Profile->Point(u);
    return s.Point + at[0] * this->X + at[1] * this->Y + v * s.Axis;
  }
  double radius = s.Radius;
  double height = v;
  switch (s.Type)
  {
    case SurfaceType::Cone:
      radius = s.Radius + v * std::tan(s.Angle);
      break;
    case SurfaceType::Sphere:
      radius = s.Radius * std::cos(v);
      height = s.Radius * std::sin(v);
      break;
    case SurfaceType::Torus:
      radius = s.Radius + s.MinorRadius * std::cos(v);
      height = s.MinorRadius * std::sin(v);
      break;
    case SurfaceType::Revolution:
    {
      const Eigen::Vector2d at = s.Profile->Point(v);
      radius = at[0];
      height = at[1];
      break;
    }
    case SurfaceType::Plane:
    case SurfaceType::Cylinder:
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
      break;
  }
  return s.Point + radius * (std::cos(u) * this->X + std::sin(u) * this->Y) + height * s.Axis;
}

Eigen::Vector2d AnalyticPatch::Parameters(const Eigen::Vector3d& point) const
{
  const AnalyticSurface& s = this->Of;
  const Eigen::Vector3d offset = point - s.Point;
  const Eigen::Vector2d across(offset.dot(this->X), offset.dot(this->Y));
  if (s.Type == SurfaceType::Plane)
  {
    return across;
  }
  const double height = offset.dot(s.Axis);
  if (s.Type == SurfaceType::Extrusion)
  {
    return { s.Profile->Nearest(across), height };
  }
  const double radius = across.norm();
  const double angle = std::atan2(across[1], across[0]);
  switch (s.Type)
  {
    case SurfaceType::Cone:
    {
      // along the ruling
      const double slope = std::tan(s.Angle);
      return { angle, (height + slope * (radius - s.Radius)) / (1.0 + slope * slope) };
    }
    case SurfaceType::Sphere:
      return { angle, std::atan2(height, radius) };
    case SurfaceType::Torus:
      return { angle, std::atan2(height, radius - s.Radius) };
    case SurfaceType::Revolution:
      return { angle, s.Profile->Nearest({ radius, height }) };
    case SurfaceType::Plane:
    case SurfaceType::Cylinder:
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
      break;
  }
  return { angle, height };
}

Eigen::Vector2d AnalyticPatch::ParametersNear(
  const Eigen::Vector3d& point, const Eigen::Vector2d& place) const
{
  Eigen::Vector2d parameters = this->Parameters(point);
  for (int d = 0; d < 2; ++d)
  {
    if (this->IsPeriodic(d))
    {
      parameters[d] += 2.0 * Pi * std::round((place[d] - parameters[d]) / (2.0 * Pi));
    }
  }
  return parameters;
}

std::array<double, 2> AnalyticPatch::Poles() const
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (this->Of.Type == SurfaceType::Sphere)
  {
    return { -0.5 * Pi, 0.5 * Pi };
  }
  if (this->Of.Type == SurfaceType::Cone)
  {
    return { -this->Of.Radius / std::tan(this->Of.Angle), infinity };
  }
  return { -infinity, infinity };
}

void AnalyticPatch::SetRange(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper)
{
  this->Begin = lower;
  this->End = upper;
  if (HasProfile(this->Of.Type))
  {
    const Eigen::Index along = this->Of.Type == SurfaceType::Extrusion ? 0 : 1;
    this->Begin[along] = std::max(lower[along], this->Of.Profile->Begin());
    this->End[along] = std::min(upper[along], this->Of.Profile->End());
  }
}

int AnalyticPatch::NumSpans(int direction) const
{
  constexpr double rounding = 1e-12;
  const double length = this->End[direction] - this->Begin[direction];
  return this->IsAngle(direction)
    ? std::max(1, static_cast<int>(std::ceil(length / MaxSpan - rounding)))
    : 1;
}

std::vector<double> AnalyticPatch::Breaks(int direction) const
{
  const int spans = this->NumSpans(direction);
  std::vector<double> breaks;
  for (int i = 1; i < spans; ++i)
  {
    breaks.push_back(
      this->Begin[direction] + (this->End[direction] - this->Begin[direction]) * i / spans);
  }
  return breaks;
}

Spline<2> AnalyticPatch::MakeSpline() const
{
  constexpr double rounding = 1e-12;
  const AnalyticSurface& s = this->Of;
  std::array<KnotVector, 2> knots;
  PointMatrix ofProfile;
  for (int d = 0; d < 2; ++d)
  {
    knots[static_cast<std::size_t>(d)] = this->IsAngle(d)
      ? KnotVector::Uniform(2, this->NumSpans(d), this->Begin[d], this->End[d], 2)
      : KnotVector::Uniform(1, 1, this->Begin[d], this->End[d]);
  }
  if (HasProfile(s.Type))
  {
    const Eigen::Index along = s.Type == SurfaceType::Extrusion ? 0 : 1;
    const Spline<1> part = s.Profile->Part(this->Begin[along], this->End[along]);
    knots[static_cast<std::size_t>(along)] = part.Space->Knots[0];
    ofProfile = part.ControlPoints;
  }
  Spline<2> spline;
  spline.Space = MakeTensorSpace<2>(knots).Value;
  const Eigen::Index rows = spline.Space->NumFunctions;
  spline.ControlPoints.resize(rows, 3);
  if (s.Type == SurfaceType::Plane)
  {
    const PointMatrix at = GrevillePoints(*spline.Space);
    for (Eigen::Index i = 0; i < rows; ++i)
    {
      spline.ControlPoints.row(i) = this->Point({ at(i, 0), at(i, 1) }).transpose();
    }
    return spline;
  }
  if (s.Type == SurfaceType::Extrusion)
  {
    for (Eigen::Index i = 0; i < rows; ++i)
    {
      const Eigen::Index at = i % ofProfile.rows();
      spline.ControlPoints.row(i) = (s.Point + ofProfile(at, 0) * this->X +
        ofProfile(at, 1) * this->Y + (i == at ? this->Begin[1] : this->End[1]) * s.Axis)
                                      .transpose();
    }
    return spline;
  }
  // the curve that turns, as radius and height
  Polygon profile(2, 3);
  switch (s.Type)
  {
    case SurfaceType::Cone:
      profile << s.Radius + this->Begin[1] * std::tan(s.Angle), this->Begin[1], 1.0,
        s.Radius + this->End[1] * std::tan(s.Angle), this->End[1], 1.0;
      break;
    case SurfaceType::Sphere:
      profile = MakeArc(this->Begin[1], this->End[1], this->NumSpans(1), s.Radius);
      break;
    case SurfaceType::Torus:
      profile = MakeArc(this->Begin[1], this->End[1], this->NumSpans(1), s.MinorRadius);
      profile.col(0).array() += s.Radius;
      break;
    case SurfaceType::Revolution:
      profile.resize(ofProfile.rows(), 3);
      profile << ofProfile, Eigen::VectorXd::Ones(ofProfile.rows());
      break;
    case SurfaceType::Plane:
    case SurfaceType::Cylinder:
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
      profile << s.Radius, this->Begin[1], 1.0, s.Radius, this->End[1], 1.0;
      break;
  }
  for (const Eigen::Index end : { Eigen::Index{ 0 }, profile.rows() - 1 })
  {
    if (std::abs(profile(end, 0)) <= rounding * s.Radius) // a pole is one point
    {
      profile(end, 0) = 0.0;
    }
  }
  const Polygon turn = MakeArc(this->Begin[0], this->End[0], this->NumSpans(0), 1.0);
  spline.Weights.resize(rows);
  Eigen::Index row = 0;
  for (Eigen::Index j = 0; j < profile.rows(); ++j)
  {
    for (Eigen::Index i = 0; i < turn.rows(); ++i, ++row)
    {
      spline.ControlPoints.row(row) = (s.Point +
        profile(j, 0) * (turn(i, 0) * this->X + turn(i, 1) * this->Y) + profile(j, 1) * s.Axis)
                                        .transpose();
      spline.Weights[row] = turn(i, 2) * profile(j, 2);
    }
  }
  return spline;
}

namespace
{
/// A parameter as the number of its span, and where in it.
struct PlaceInSpan
{
  PlaceInSpan(double parameter, double begin, double end, int spans) : Length((end - begin) / spans)
  {
    const double at = (parameter - begin) / this->Length;
    const double span = std::min(std::max(std::floor(at), 0.0), spans - 1.0);
    this->Middle = begin + (span + 0.5) * this->Length;
    this->Local = at - span - 0.5;
  }
  double Length;
  double Middle = 0.0;
  double Local = 0.0; ///< from the middle, in lengths
};
}

Eigen::Vector2d AnalyticPatch::SplineParameters(const Eigen::Vector2d& parameters) const
{
  Eigen::Vector2d result = parameters;
  for (int d = 0; d < 2; ++d)
  {
    if (this->IsAngle(d))
    {
      const PlaceInSpan at(parameters[d], this->Begin[d], this->End[d], this->NumSpans(d));
      result[d] = at.Middle +
        0.5 * at.Length * std::tan(0.5 * at.Local * at.Length) / std::tan(0.25 * at.Length);
    }
  }
  return result;
}

Eigen::Vector2d AnalyticPatch::SurfaceParameters(const Eigen::Vector2d& splineParameters) const
{
  Eigen::Vector2d result = splineParameters;
  for (int d = 0; d < 2; ++d)
  {
    if (this->IsAngle(d))
    {
      const PlaceInSpan at(splineParameters[d], this->Begin[d], this->End[d], this->NumSpans(d));
      result[d] = at.Middle + 2.0 * std::atan(2.0 * at.Local * std::tan(0.25 * at.Length));
    }
  }
  return result;
}
}
