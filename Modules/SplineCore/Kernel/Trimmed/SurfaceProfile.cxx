// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceProfile.h"
#include <knotwork/SplineCore/TensorRestriction.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int SamplesOfSpan = 8;

Eigen::Vector2d RightOf(const Eigen::Vector2d& along)
{
  return Eigen::Vector2d(along[1], -along[0]).normalized();
}
}

SurfaceProfile::SurfaceProfile(Spline<1> curve, const Eigen::Vector3d& across)
  : Of(std::move(curve)), First(across)
{
  this->ExpandSpans();
  const std::vector<double>& breaks = this->Knots().Breaks();
  for (std::size_t b = 0; b + 1 < breaks.size(); ++b)
  {
    for (int i = 0; i < SamplesOfSpan; ++i)
    {
      const double share = static_cast<double>(i) / SamplesOfSpan;
      this->SampleParameters.push_back((1.0 - share) * breaks[b] + share * breaks[b + 1]);
    }
  }
  this->SampleParameters.push_back(breaks.back());
  this->SamplePoints.resize(static_cast<Eigen::Index>(this->SampleParameters.size()), 2);
  for (std::size_t i = 0; i < this->SampleParameters.size(); ++i)
  {
    this->SamplePoints.row(static_cast<Eigen::Index>(i)) =
      this->Derivatives(this->SampleParameters[i]).row(0);
  }
  this->BoundCurvatures();
}

void SurfaceProfile::ExpandSpans()
{
  const KnotVector& knots = this->Knots();
  const int count = knots.Degree() + 1;
  std::vector<double> values(static_cast<std::size_t>(count) * static_cast<std::size_t>(count));
  this->Coefficients = PointMatrix::Zero(static_cast<Eigen::Index>(count) * knots.NumElements(), 2);
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    knots.EvaluateFunctions(
      e, knots.Breaks()[static_cast<std::size_t>(e)], knots.Degree(), values.data());
    double factorial = 1.0;
    for (int k = 0; k < count; ++k)
    {
      factorial *= std::max(k, 1);
      for (int i = 0; i < count; ++i)
      {
        const double value = values[static_cast<std::size_t>(k * count + i)] / factorial;
        this->Coefficients.row(e * count + k) +=
          value * this->Of.ControlPoints.row(knots.Span(e) - knots.Degree() + i).head(2);
      }
    }
  }
}

Eigen::Matrix<double, 3, 2> SurfaceProfile::Derivatives(double parameter) const
{
  const KnotVector& knots = this->Knots();
  const double inside = std::min(std::max(parameter, knots.Begin()), knots.End());
  const int element = knots.FindElement(inside);
  const double s = inside - knots.Breaks()[static_cast<std::size_t>(element)];
  const Eigen::Index first = static_cast<Eigen::Index>(element) * (knots.Degree() + 1);
  std::array<std::array<double, 2>, 3> d{}; // Horner's rule, with derivatives
  for (Eigen::Index k = knots.Degree(); k >= 0; --k)
  {
    for (std::size_t c = 0; c < 2; ++c)
    {
      d[2][c] = s * d[2][c] + d[1][c];
      d[1][c] = s * d[1][c] + d[0][c];
      d[0][c] = s * d[0][c] + this->Coefficients(first + k, static_cast<Eigen::Index>(c));
    }
  }
  const bool isOutside = inside != parameter; // straight on
  const double beyond = parameter - inside;
  Eigen::Matrix<double, 3, 2> result;
  for (std::size_t c = 0; c < 2; ++c)
  {
    const auto column = static_cast<Eigen::Index>(c);
    result(0, column) = d[0][c] + beyond * d[1][c];
    result(1, column) = d[1][c];
    result(2, column) = isOutside ? 0.0 : 2.0 * d[2][c];
  }
  return result;
}

Eigen::Vector2d SurfaceProfile::Point(double parameter) const
{
  return this->Derivatives(parameter).row(0).transpose();
}

double SurfaceProfile::Nearest(const Eigen::Vector2d& point) const
{
  Eigen::Index nearest = 0;
  (this->SamplePoints.rowwise() - point.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  const Eigen::Index last = this->SamplePoints.rows() - 1;
  const auto at = [&](Eigen::Index i)
  { return this->SampleParameters[static_cast<std::size_t>(i)]; };
  // the nearest point lies between the samples beside the nearest one, or beyond an end
  const double lower = nearest == 0 ? -HUGE_VAL : at(nearest - 1);
  const double upper = nearest == last ? HUGE_VAL : at(nearest + 1);
  return this->Refine(point, at(nearest), lower, upper);
}

double SurfaceProfile::NearestFrom(const Eigen::Vector2d& point, double parameter) const
{
  return this->Refine(point, parameter, -HUGE_VAL, HUGE_VAL);
}

double SurfaceProfile::Refine(
  const Eigen::Vector2d& point, double parameter, double lower, double upper) const
{
  constexpr int MaxSteps = 20;
  constexpr double Converged = 1e-10; // of the length: the step after it would be nothing
  double t = parameter;
  for (int step = 0; step < MaxSteps; ++step)
  {
    const Eigen::Matrix<double, 3, 2> d = this->Derivatives(t);
    const Eigen::RowVector2d offset = d.row(0) - point.transpose();
    const double slope = offset.dot(d.row(1));
    const double speed = d.row(1).squaredNorm();
    const double second = speed + offset.dot(d.row(2));
    const double next =
      std::min(std::max(t - slope / (second > 0.1 * speed ? second : speed), lower), upper);
    const double move = std::abs(next - t);
    t = next;
    if (move <= Converged * (this->End() - this->Begin()))
    {
      break;
    }
  }
  return t;
}

double SurfaceProfile::Distance(const Eigen::Vector2d& point) const
{
  const Eigen::Matrix<double, 3, 2> d = this->Derivatives(this->Nearest(point));
  return RightOf(d.row(1).transpose()).dot(point - d.row(0).transpose());
}

Eigen::Vector2d SurfaceProfile::Normal(const Eigen::Vector2d& point) const
{
  return RightOf(this->Derivatives(this->Nearest(point)).row(1).transpose());
}

Spline<1> SurfaceProfile::Part(double begin, double end) const
{
  ParametricBox<1> box;
  box.Lower[0] = std::max(begin, this->Begin());
  box.Upper[0] = std::min(end, this->End());
  auto part = RestrictTensor<1>(this->Of, box);
  return part ? std::move(part.Value) : this->Of;
}

double SurfaceProfile::MaxCurvature(double begin, double end) const
{
  double most = 0.0;
  for (std::size_t i = 0; i < this->Curvatures.size(); ++i)
  {
    const bool meets = this->SampleParameters[i] <= end && this->SampleParameters[i + 1] >= begin;
    most = meets ? std::max(most, this->Curvatures[i]) : most;
  }
  return most;
}

void SurfaceProfile::BoundCurvatures()
{
  this->Curvatures.assign(this->SampleParameters.size() - 1, HUGE_VAL);
  // between samples: hulls of whole spans turn too far
  std::vector<double> inner;
  for (std::size_t i = 0; i < this->SampleParameters.size() - 1; ++i)
  {
    if (i % SamplesOfSpan != 0)
    {
      inner.push_back(this->SampleParameters[i]);
    }
  }
  const auto refined = InsertKnots<1>(this->Of, 0, inner);
  if (!refined)
  {
    return;
  }
  const KnotVector& knots = refined->Space->Knots[0];
  const std::vector<double>& t = knots.Knots();
  const int p = knots.Degree();
  // control points of the derivative of a curve of a degree whose first control point has knot t_f
  using Points = std::vector<Eigen::Vector2d>;
  const auto derive = [&](const Points& points, int degree, std::size_t f)
  {
    Points result;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
    {
      const std::size_t k = i + 1 + f;
      const double length = t[k + static_cast<std::size_t>(degree)] - t[k];
      result.emplace_back((length > 0.0 ? degree / length : 0.0) * (points[i + 1] - points[i]));
    }
    return result;
  };
  Points control;
  for (Eigen::Index i = 0; i < refined->ControlPoints.rows(); ++i)
  {
    control.emplace_back(refined->ControlPoints(i, 0), refined->ControlPoints(i, 1));
  }
  const Points first = derive(control, p, 0);
  const Points second = derive(first, p - 1, 1);
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    const auto begin = static_cast<std::size_t>(knots.Span(e) - p);
    const auto count = static_cast<std::size_t>(p);
    Eigen::Vector2d along = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < count; ++i)
    {
      along += first[begin + i];
    }
    along.normalize();
    double least = HUGE_VAL;
    double most = 0.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      least = std::min(least, along.dot(first[begin + i]));
      most = i + 1 < count ? std::max(most, second[begin + i].norm()) : most;
    }
    this->Curvatures[static_cast<std::size_t>(e)] = least > 0.0 ? most / (least * least) : HUGE_VAL;
  }
}
}
