// SPDX-License-Identifier: BSD-3-Clause
#include "DomainMeasure.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
/// Calls body(point, derivatives, weight) at the quadrature points of a side; derivatives: Dim - 1
/// rows.
template <int D, typename Body>
void Integrate(const Spline<D>& side, int extraPoints, const Body& body)
{
  const BezierForm<D> form = MakeBezierForm<D>(side, 1);
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = 1;
  EvaluationBatch batch;
  IntArray<D> numPoints{};
  for (std::size_t d = 0; d < D; ++d)
  {
    numPoints[d] = 2 * side.Space->Knots[d].Degree() + 1 + extraPoints;
  }
  const ElementQuadrature<D> rule = MakeElementQuadrature<D>(numPoints);
  std::vector<int> elements(static_cast<std::size_t>(rule.Local.rows()));
  for (int e = 0; e < side.Space->NumElements(); ++e)
  {
    std::fill(elements.begin(), elements.end(), e);
    const auto& box = side.Space->Elements[static_cast<std::size_t>(e)].Box;
    double volume = 1.0;
    for (std::size_t d = 0; d < D; ++d)
    {
      volume *= box.Upper[d] - box.Lower[d];
    }
    EvaluateElements<D>(form, elements, rule.Local, params, batch);
    for (Eigen::Index i = 0; i < rule.Local.rows(); ++i)
    {
      body(batch.Values.row(i), batch.First.row(i), volume * rule.Weights[i]);
    }
  }
}
}

template <>
void AddSideMeasure<2>(
  const Spline<1>& side, int number, const Eigen::RowVector2d& origin, double& sum)
{
  constexpr double signs[4] = { -1.0, 1.0, 1.0, -1.0 }; // counter-clockwise along the sides
  Integrate<1>(side, side.IsRational() ? 12 : 0,
    [&](const auto& point, const auto& tangent, double weight)
    {
      const double x = point[0] - origin[0];
      const double y = point[1] - origin[1];
      sum += 0.5 * signs[number] * weight * (x * tangent[1] - y * tangent[0]);
    });
}

template <>
void AddSideMeasure<3>(
  const Spline<2>& side, int number, const Eigen::RowVector3d& origin, double& sum)
{
  // the product of a side's derivatives in increasing directions points outward at u = 1, w = 1
  // and inward at v = 1
  constexpr double signs[6] = { -1.0, 1.0, 1.0, -1.0, -1.0, 1.0 };
  Integrate<2>(side, side.IsRational() ? 12 : 0,
    [&](const auto& point, const auto& first, double weight)
    {
      const Eigen::RowVector3d a(first[0], first[1], first[2]);
      const Eigen::RowVector3d b(first[3], first[4], first[5]);
      const Eigen::RowVector3d x = Eigen::RowVector3d(point[0], point[1], point[2]) - origin;
      sum += signs[number] * weight / 3.0 * x.dot(a.cross(b));
    });
}

template <int Dim>
double SignedMeasure(const std::array<Spline<Dim - 1>, 2 * Dim>& sides)
{
  double measure = 0.0;
  for (std::size_t s = 0; s < 2 * Dim; ++s)
  {
    AddSideMeasure<Dim>(sides[s], static_cast<int>(s), sides[0].ControlPoints.row(0), measure);
  }
  return measure;
}

template double SignedMeasure<2>(const std::array<Spline<1>, 4>&);
template double SignedMeasure<3>(const std::array<Spline<2>, 6>&);
}
