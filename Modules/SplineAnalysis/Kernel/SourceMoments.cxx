// SPDX-License-Identifier: BSD-3-Clause
#include "SourceMoments.h"

#include "ElementGeometry.h"
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// An element of a batch: what is known of it between the steps, which several threads take.
struct SourceElement
{
  QuadratureFunctions Functions;
  std::vector<double> Memory;    ///< of its functions
  std::vector<double> Positions; ///< of the points, a row each
  /// Of the points: weight times volume, and then that times the function, a row each.
  std::vector<double> Values;
  std::vector<double> Moments; ///< of the functions, a row of their stride a component
};

template <int Dim>
void FindPoints(const GalerkinSpace& space, const RuleTables& tables, int e, int components,
  SourceElement& element)
{
  element.Functions = tables.Functions(space, e, element.Memory);
  const QuadratureFunctions& functions = element.Functions;
  const auto count = static_cast<std::size_t>(functions.NumPoints);
  element.Positions.resize(count * Dim);
  element.Values.assign(count * static_cast<std::size_t>(components), 0.0);
  ElementGeometry<Dim> geometry;
  geometry.Take(space, e, functions.Stride);
  for (int q = 0; q < functions.NumPoints; ++q)
  {
    const double* rows = functions.Rows + std::ptrdiff_t{ q } * (Dim + 1) * functions.Stride;
    Eigen::Map<Eigen::Matrix<double, Dim, 1>>(
      element.Positions.data() + std::ptrdiff_t{ q } * Dim) = geometry.Position(rows);
    element.Values[static_cast<std::size_t>(q * components)] =
      functions.Weights[q] * std::abs(geometry.Jacobian(rows + functions.Stride).determinant());
  }
}

void CallFunction(
  const PointFunction& function, int dimension, SourceElement& element, Eigen::VectorXd& given)
{
  const Eigen::Index components = given.size();
  for (int q = 0; q < element.Functions.NumPoints; ++q)
  {
    function(element.Positions.data() + std::ptrdiff_t{ q } * dimension, given.data());
    double* values = element.Values.data() + q * components;
    Eigen::Map<Eigen::VectorXd>(values, components) = values[0] * given;
  }
}

void Integrate(int dimension, int components, SourceElement& element)
{
  const QuadratureFunctions& functions = element.Functions;
  element.Moments.assign(static_cast<std::size_t>(functions.Stride * components), 0.0);
  for (int q = 0; q < functions.NumPoints; ++q)
  {
    const double* row = functions.Rows + std::ptrdiff_t{ q } * (dimension + 1) * functions.Stride;
    for (int c = 0; c < components; ++c)
    {
      const double value = element.Values[static_cast<std::size_t>(q * components + c)];
      double* to = element.Moments.data() + std::ptrdiff_t{ c } * functions.Stride;
      for (int a = 0; a < functions.Stride; ++a)
      {
        to[a] += value * row[a];
      }
    }
  }
}
}

void AddMoments(const GalerkinSpace& space, int components, const PointFunction& function,
  const GalerkinParams& params, Eigen::VectorXd& moments)
{
  constexpr int Batch = 512; // elements that wait between two steps
  constexpr std::size_t Chunk = 32;
  RuleTables tables(params.QuadratureTolerance);
  tables.Prepare(space);
  std::vector<SourceElement> elements(
    static_cast<std::size_t>(std::min(Batch, space.NumElements())));
  Eigen::VectorXd given = Eigen::VectorXd::Zero(components);
  const auto findPoints = space.Dimension == 2 ? FindPoints<2> : FindPoints<3>;
  for (int first = 0; first < space.NumElements(); first += Batch)
  {
    const int count = std::min(Batch, space.NumElements() - first);
    const auto forElements = [&](const auto& body)
    {
      ParallelFor(static_cast<std::size_t>(count), Chunk, params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            body(first + static_cast<int>(i), elements[i]);
          }
        });
    };
    forElements(
      [&](int e, SourceElement& element) { findPoints(space, tables, e, components, element); });
    for (int i = 0; i < count; ++i)
    {
      CallFunction(function, space.Dimension, elements[static_cast<std::size_t>(i)], given);
    }
    forElements(
      [&](int, SourceElement& element) { Integrate(space.Dimension, components, element); });
    for (int i = 0; i < count; ++i)
    {
      const SourceElement& element = elements[static_cast<std::size_t>(i)];
      for (int a = 0; a < element.Functions.NumFunctions; ++a)
      {
        for (int c = 0; c < components; ++c)
        {
          moments[Eigen::Index{ space.Alive(first + i)[a] } * components + c] +=
            element.Moments[static_cast<std::size_t>(c * element.Functions.Stride + a)];
        }
      }
    }
  }
}
}
