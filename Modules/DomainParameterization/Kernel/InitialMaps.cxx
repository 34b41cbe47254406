// SPDX-License-Identifier: BSD-3-Clause
#include "InitialMaps.h"

#include "HarmonicMaps.h"
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/SparseCholesky>
#include <cmath>

namespace knotwork
{
namespace
{
template <int Dim>
std::array<int, Dim> Counts(const SplineSpace<Dim>& space)
{
  std::array<int, Dim> counts{};
  for (std::size_t d = 0; d < Dim; ++d)
  {
    counts[d] = space.Knots[d].NumFunctions();
  }
  return counts;
}

/// Calls body(function, multi-index) in the order of the functions.
template <int Dim, typename Body>
void ForEachFunction(const std::array<int, Dim>& counts, const Body& body)
{
  std::array<int, Dim> index{};
  for (int i = 0;; ++i)
  {
    body(i, index);
    std::size_t d = 0;
    while (d < Dim && ++index[d] == counts[d])
    {
      index[d++] = 0;
    }
    if (d == Dim)
    {
      return;
    }
  }
}

template <int Dim>
bool OnBoundary(const std::array<int, Dim>& index, const std::array<int, Dim>& counts)
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    if (index[d] == 0 || index[d] == counts[d] - 1)
    {
      return true;
    }
  }
  return false;
}

double Power(double x, int exponent)
{
  double product = x;
  for (int i = 1; i < exponent; ++i)
  {
    product *= x;
  }
  return product;
}

template <int Dim>
std::array<int, Dim> Linear()
{
  std::array<int, Dim> ones{};
  ones.fill(1);
  return ones;
}

/// The Boolean sum of one column of numbers.
template <int Dim, typename Column>
void CoonsColumn(
  const SplineSpace<Dim>& space, Column&& values, const std::array<int, Dim>& steepness)
{
  const auto counts = Counts(space);
  std::array<std::vector<double>, Dim> share; // Greville abscissae, on [0, 1]
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    for (int i = 0; i < counts[d]; ++i)
    {
      share[d].push_back((knots.Greville(i) - knots.Begin()) / (knots.End() - knots.Begin()));
    }
  }
  ForEachFunction<Dim>(counts,
    [&](int i, const std::array<int, Dim>& index)
    {
      if (OnBoundary<Dim>(index, counts))
      {
        return;
      }
      double sum = 0.0;
      // base 3 digits: 0 own index, 1 lower end, 2 upper end; not all own
      constexpr int numTerms = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
      for (int term = 1; term < numTerms; ++term)
      {
        double factor = -1.0;
        int from = 0;
        int stride = 1;
        int digits = term;
        for (std::size_t d = 0; d < Dim; ++d, digits /= 3)
        {
          const double a = share[d][static_cast<std::size_t>(index[d])];
          const int digit = digits % 3;
          factor *= digit == 0 ? 1.0 : -Power(digit == 1 ? 1.0 - a : a, steepness[d]);
          from += stride * (digit == 0 ? index[d] : digit == 1 ? 0 : counts[d] - 1);
          stride *= counts[d];
        }
        sum += factor * values[from];
      }
      values[i] = sum;
    });
}

/// Solves for the inner control points: sum_j matrix(i, j) x_j = 0 for every inner i, where
/// addRow(i, index, put) gives the entries of a row by put(j, value).
template <int Dim, typename AddRow>
Status SolveInner(Spline<Dim>& map, const AddRow& addRow)
{
  const auto counts = Counts(*map.Space);
  const std::vector<bool> fixed = BoundaryFunctions<Dim>(*map.Space);
  std::vector<int> unknown(fixed.size(), -1);
  int n = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    unknown[i] = fixed[i] ? -1 : n++;
  }
  if (n == 0)
  {
    return {};
  }
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, Dim);
  ForEachFunction<Dim>(counts,
    [&](int i, const std::array<int, Dim>& index)
    {
      const int row = unknown[static_cast<std::size_t>(i)];
      if (row < 0)
      {
        return;
      }
      addRow(i, index,
        [&](int j, double value)
        {
          const int column = unknown[static_cast<std::size_t>(j)];
          if (column < 0)
          {
            right.row(row) -= value * map.ControlPoints.row(j);
          }
          else
          {
            triplets.emplace_back(row, column, value);
          }
        });
    });
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success)
  {
    return { ErrorCode::SingularSystem, "the equations of the first map have no unique solution" };
  }
  const Eigen::MatrixXd solution = solver.solve(right);
  if (!solution.allFinite())
  {
    return { ErrorCode::SingularSystem, "the first map is not finite" };
  }
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    if (unknown[i] >= 0)
    {
      map.ControlPoints.row(static_cast<Eigen::Index>(i)) = solution.row(unknown[i]);
    }
  }
  return {};
}
}

template <int Dim>
std::vector<bool> BoundaryFunctions(const SplineSpace<Dim>& space)
{
  std::vector<bool> boundary(static_cast<std::size_t>(space.NumFunctions));
  const auto counts = Counts(space);
  ForEachFunction<Dim>(counts,
    [&](int i, const std::array<int, Dim>& index)
    { boundary[static_cast<std::size_t>(i)] = OnBoundary<Dim>(index, counts); });
  return boundary;
}

template <int Dim>
Spline<Dim> MapOfBoundary(const CompatibleBoundary<Dim>& boundary)
{
  Spline<Dim> map;
  map.Space = MakeTensorSpace<Dim>(boundary.Knots).Value;
  map.ControlPoints = PointMatrix::Zero(map.Space->NumFunctions, Dim);
  if (boundary.IsRational())
  {
    map.Weights = Eigen::VectorXd::Ones(map.Space->NumFunctions);
  }
  const auto counts = Counts(*map.Space);
  ForEachFunction<Dim>(counts,
    [&](int i, const std::array<int, Dim>& index)
    {
      for (std::size_t s = 0; s < 2 * Dim; ++s)
      {
        const std::size_t across = s / 2;
        if (index[across] != (s % 2 ? counts[across] - 1 : 0))
        {
          continue;
        }
        Eigen::Index j = 0;
        Eigen::Index stride = 1;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          if (d != across)
          {
            j += stride * index[d];
            stride *= counts[d];
          }
        }
        map.ControlPoints.row(i) = boundary.Sides[s].ControlPoints.row(j);
        if (map.IsRational())
        {
          map.Weights[i] = boundary.Sides[s].Weights[j];
        }
        return;
      }
    });
  return map;
}

template <int Dim>
void FillWeights(Spline<Dim>& map, InitialWeights kind)
{
  if (!map.IsRational())
  {
    return;
  }
  Eigen::VectorXd logarithms = map.Weights.array().log();
  CoonsColumn<Dim>(*map.Space, logarithms, Linear<Dim>());
  const std::vector<bool> fixed = BoundaryFunctions<Dim>(*map.Space);
  for (Eigen::Index i = 0; i < map.Weights.size(); ++i)
  {
    if (!fixed[static_cast<std::size_t>(i)])
    {
      map.Weights[i] = kind == InitialWeights::Ones ? 1.0 : std::exp(logarithms[i]);
    }
  }
}

template <int Dim>
void FillCoons(Spline<Dim>& map, const std::array<int, Dim>& steepness)
{
  for (int c = 0; c < map.NumComponents(); ++c)
  {
    CoonsColumn<Dim>(*map.Space, map.ControlPoints.col(c), steepness);
  }
}

template <int Dim>
void FillCoons(Spline<Dim>& map)
{
  FillCoons<Dim>(map, Linear<Dim>());
}

template <int Dim>
Status FillSpring(Spline<Dim>& map)
{
  const auto counts = Counts(*map.Space);
  return SolveInner<Dim>(map,
    [&](int i, const std::array<int, Dim>&, const auto& put)
    {
      put(i, 2.0 * Dim);
      int stride = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        put(i - stride, -1.0);
        put(i + stride, -1.0);
        stride *= counts[d];
      }
    });
}

template <int Dim>
Status FillHarmonic(Spline<Dim>& map)
{
  if (map.IsRational())
  {
    return FillRationalHarmonic<Dim>(map);
  }
  const auto counts = Counts(*map.Space);
  std::vector<LineIntegrals> lines;
  bool linear = false;
  for (const KnotVector& knots : map.Space->Knots)
  {
    lines.push_back(IntegrateLine(knots));
    linear = linear || knots.Degree() == 1;
  }
  return SolveInner<Dim>(map,
    [&](int, const std::array<int, Dim>& index, const auto& put)
    {
      std::array<int, Dim> lower{}, span{};
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const int p = map.Space->Knots[d].Degree();
        lower[d] = std::max(0, index[d] - p);
        span[d] = std::min(counts[d] - 1, index[d] + p) - lower[d] + 1;
      }
      ForEachFunction<Dim>(span,
        [&](int, const std::array<int, Dim>& offset)
        {
          std::array<double, Dim> mass{}, stiffness{}, bending{}, mixed{}, turned{};
          int j = 0;
          int stride = 1;
          for (std::size_t d = 0; d < Dim; ++d)
          {
            const int a = index[d];
            const int b = lower[d] + offset[d];
            mass[d] = lines[d].Mass(a, b);
            stiffness[d] = lines[d].Stiffness(a, b);
            bending[d] = lines[d].Bending(a, b);
            mixed[d] = lines[d].Mixed(a, b);
            turned[d] = lines[d].Mixed(b, a);
            j += stride * b;
            stride *= counts[d];
          }
          double value = 0.0;
          for (std::size_t d = 0; d < Dim; ++d)
          {
            for (std::size_t k = 0; k < Dim; ++k)
            {
              // (d/du_d)^2 of one function times (d/du_k)^2 of the other
              double product = 1.0;
              for (std::size_t m = 0; m < Dim; ++m)
              {
                product *= m == d && m == k ? (linear ? stiffness[m] : bending[m])
                  : m == d                  ? (linear ? 0.0 : mixed[m])
                  : m == k                  ? (linear ? 0.0 : turned[m])
                                            : mass[m];
              }
              value += product;
            }
          }
          put(j, value);
        });
    });
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template std::vector<bool> BoundaryFunctions<Dim>(const SplineSpace<Dim>&);                      \
  template Spline<Dim> MapOfBoundary<Dim>(const CompatibleBoundary<Dim>&);                         \
  template void FillWeights<Dim>(Spline<Dim>&, InitialWeights);                                    \
  template void FillCoons<Dim>(Spline<Dim>&, const std::array<int, Dim>&);                         \
  template void FillCoons<Dim>(Spline<Dim>&);                                                      \
  template Status FillSpring<Dim>(Spline<Dim>&);                                                   \
  template Status FillHarmonic<Dim>(Spline<Dim>&);
template std::vector<bool> BoundaryFunctions<1>(const SplineSpace<1>&);
template void FillWeights<1>(Spline<1>&, InitialWeights);
template void FillCoons<1>(Spline<1>&);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
