// SPDX-License-Identifier: BSD-3-Clause
#include "TensorPreconditioners.h"

#include "ElementRule.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Means of |J| |grad u_d|^2 over a tensor-product patch, u_d its parameters.
std::array<double, 3> MeanStretches(const GalerkinSpace& space)
{
  constexpr int Samples = 1000;
  const int step = std::max(1, space.NumElements() / Samples);
  std::array<double, 3> means{};
  PointValues values;
  const std::array<double, 3> middle{ 0.5, 0.5, 0.5 };
  for (int e = 0; e < space.NumElements(); e += step)
  {
    EvaluateFunctions(space, e, middle.data(), values);
    double volume = std::abs(values.Determinant);
    std::array<double, 3> widths{ 1.0, 1.0, 1.0 };
    int rest = e;
    for (std::size_t d = 0; d < space.Knots.size(); ++d)
    {
      const KnotVector& knots = space.Knots[d];
      const auto i = static_cast<std::size_t>(rest % knots.NumElements());
      widths[d] = knots.Breaks()[i + 1] - knots.Breaks()[i];
      volume /= widths[d];
      rest /= knots.NumElements();
    }
    // each element counts by the parameters that it covers
    const double share = widths[0] * widths[1] * widths[2];
    for (std::size_t d = 0; d < space.Knots.size(); ++d)
    {
      means[d] += share * volume * widths[d] * widths[d] *
        values.Inverse.row(static_cast<Eigen::Index>(d)).squaredNorm();
    }
  }
  return means;
}

/// Calls for indices in a box of a grid, the first direction fastest.
template <typename Visitor>
void ForGrid(const std::array<int, 3>& low, const std::array<int, 3>& high, const Visitor& visit)
{
  for (int k = low[2]; k < high[2]; ++k)
  {
    for (int j = low[1]; j < high[1]; ++j)
    {
      for (int i = low[0]; i < high[0]; ++i)
      {
        visit(std::array<int, 3>{ i, j, k });
      }
    }
  }
}

/// Functions a direction; 1 in those that the patch does not have.
std::array<int, 3> CountFunctions(const GalerkinSpace& space)
{
  std::array<int, 3> counts{ 1, 1, 1 };
  for (std::size_t d = 0; d < space.Knots.size(); ++d)
  {
    counts[d] = space.Knots[d].NumFunctions();
  }
  return counts;
}
}

FastDiagonalization::FastDiagonalization(const GalerkinSpace& space, int components,
  const std::vector<int>& numbers, const Eigen::VectorXd& diagonal, int threads)
  : Threads(threads)
{
  for (int c = 0; c < components; ++c)
  {
    this->Components.push_back(this->MakeComponent(space, components, c, numbers, diagonal));
  }
}

FastDiagonalization::Component FastDiagonalization::MakeComponent(const GalerkinSpace& space,
  int components, int component, const std::vector<int>& numbers,
  const Eigen::VectorXd& diagonal) const
{
  const std::size_t dimension = space.Knots.size();
  const std::array<int, 3> counts = CountFunctions(space);
  const auto numberOf = [&](const std::array<int, 3>& i)
  {
    const auto f = static_cast<std::size_t>(i[0]) +
      static_cast<std::size_t>(counts[0]) *
        (static_cast<std::size_t>(i[1]) +
          static_cast<std::size_t>(counts[1]) * static_cast<std::size_t>(i[2]));
    return numbers[f * static_cast<std::size_t>(components) + static_cast<std::size_t>(component)];
  };
  std::array<int, 3> first{};
  std::array<int, 3> last = counts;
  for (std::size_t d = 0; d < dimension; ++d)
  {
    for (int end = 0; end < 2; ++end)
    {
      std::array<int, 3> low{};
      std::array<int, 3> high = counts;
      low[d] = end == 0 ? 0 : counts[d] - 1;
      high[d] = low[d] + 1;
      bool given = true;
      ForGrid(low, high, [&](const std::array<int, 3>& i) { given = given && numberOf(i) < 0; });
      (end == 0 ? first[d] : last[d]) += given ? (end == 0 ? 1 : -1) : 0;
    }
    last[d] = std::max(last[d], first[d]);
  }
  const std::array<double, 3> stretches = MeanStretches(space);
  std::vector<Eigen::MatrixXd> masses;
  std::vector<Eigen::MatrixXd> stiffnesses;
  for (std::size_t d = 0; d < dimension; ++d)
  {
    const LineIntegrals line = IntegrateLine(space.Knots[d]);
    const Eigen::Index n = last[d] - first[d];
    masses.emplace_back(line.Mass.block(first[d], first[d], n, n));
    stiffnesses.emplace_back(stretches[d] * line.Stiffness.block(first[d], first[d], n, n));
  }
  Component made;
  made.Laplacian = TensorLaplacian(masses, stiffnesses, this->Threads);
  const Eigen::Index size = made.Laplacian.Size();
  made.Unknowns.reserve(static_cast<std::size_t>(size));
  made.Scales.setZero(size);
  ForGrid(first, last,
    [&](const std::array<int, 3>& i)
    {
      const int number = numberOf(i);
      if (number >= 0)
      {
        double own = 0.0;
        for (std::size_t d = 0; d < dimension; ++d)
        {
          double term = 1.0;
          for (std::size_t k = 0; k < dimension; ++k)
          {
            const Eigen::Index at = i[k] - first[k];
            term *= (k == d ? stiffnesses : masses)[k](at, at);
          }
          own += term;
        }
        made.Scales[static_cast<Eigen::Index>(made.Unknowns.size())] =
          std::sqrt(own / diagonal[number]);
      }
      made.Unknowns.push_back(number);
    });
  return made;
}

void FastDiagonalization::Apply(const UnknownColumns<1>& side, UnknownColumns<1>& x)
{
  x.setZero(side.rows());
  for (Component& component : this->Components)
  {
    const Eigen::Index size = component.Laplacian.Size();
    this->Values.resize(size);
    const auto forUnknowns = [&](const auto& body)
    {
      ForSegments(size, this->Threads,
        [&](Eigen::Index first, Eigen::Index count)
        {
          for (Eigen::Index i = first; i < first + count; ++i)
          {
            body(i, component.Unknowns[static_cast<std::size_t>(i)]);
          }
        });
    };
    forUnknowns([&](Eigen::Index i, int number)
      { this->Values[i] = number < 0 ? 0.0 : component.Scales[i] * side[number]; });
    component.Laplacian.Apply(this->Values.data());
    forUnknowns(
      [&](Eigen::Index i, int number)
      {
        if (number >= 0)
        {
          x[number] = component.Scales[i] * this->Values[i];
        }
      });
  }
}

TensorMass::TensorMass(const GalerkinSpace& space, const Eigen::VectorXd& diagonal, int threads)
  : Scales(diagonal.size()), Threads(threads)
{
  std::array<Eigen::VectorXd, 3> diagonals;
  diagonals.fill(Eigen::VectorXd::Ones(1));
  for (std::size_t d = 0; d < space.Knots.size(); ++d)
  {
    const Eigen::MatrixXd mass = IntegrateLine(space.Knots[d]).Mass;
    diagonals[d] = mass.diagonal();
    this->Factors.push_back(Factorize(mass, space.Knots[d].Degree()));
  }
  Eigen::Index f = 0;
  ForGrid({}, CountFunctions(space),
    [&](const std::array<int, 3>& i)
    {
      this->Scales[f] =
        std::sqrt(diagonals[0][i[0]] * diagonals[1][i[1]] * diagonals[2][i[2]] / diagonal[f]);
      ++f;
    });
}

TensorMass::BandFactor TensorMass::Factorize(const Eigen::MatrixXd& matrix, int band)
{
  BandFactor factor;
  factor.Band = band;
  const auto width = static_cast<std::size_t>(band) + 1;
  factor.Rows.assign(static_cast<std::size_t>(matrix.rows()) * width, 0.0);
  const auto entry = [&](Eigen::Index i, Eigen::Index j) -> double&
  {
    return factor
      .Rows[static_cast<std::size_t>(i) * width + static_cast<std::size_t>(j - i + band)];
  };
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
  {
    for (Eigen::Index j = std::max<Eigen::Index>(0, i - band); j <= i; ++j)
    {
      double sum = matrix(i, j);
      for (Eigen::Index k = std::max<Eigen::Index>(0, i - band); k < j; ++k)
      {
        sum -= entry(i, k) * entry(j, k);
      }
      entry(i, j) = i == j ? 1.0 / std::sqrt(sum) : sum * entry(j, j);
    }
  }
  return factor;
}

/// Lines of the grid along a direction, many beside each other.
void TensorMass::SolveDirection(
  const BandFactor& factor, Eigen::Index inner, UnknownColumns<4>& x) const
{
  constexpr Eigen::Index Lines = 64; // numbers beside each other that a thread takes at a time
  const int band = factor.Band;
  const auto n = static_cast<Eigen::Index>(factor.Rows.size()) / (band + 1);
  const Eigen::Index slabs = x.size() / (inner * n);
  const Eigen::Index parts = (inner + Lines - 1) / Lines;
  ParallelFor(static_cast<std::size_t>(slabs * parts), 64, this->Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (auto part = static_cast<Eigen::Index>(begin); part < static_cast<Eigen::Index>(end);
           ++part)
      {
        const Eigen::Index at = part % parts * Lines;
        const Eigen::Index count = std::min(Lines, inner - at);
        double* const lines = x.data() + part / parts * inner * n + at;
        const auto line = [&](Eigen::Index i)
        { return Eigen::Map<Eigen::ArrayXd>(lines + i * inner, count); };
        const auto entry = [&](Eigen::Index i, Eigen::Index j)
        { return factor.Rows[static_cast<std::size_t>(i * (band + 1) + j - i + band)]; };
        for (Eigen::Index i = 0; i < n; ++i)
        {
          auto own = line(i);
          for (Eigen::Index j = std::max<Eigen::Index>(0, i - band); j < i; ++j)
          {
            own -= entry(i, j) * line(j);
          }
          own *= entry(i, i);
        }
        for (Eigen::Index i = n; i-- > 0;)
        {
          auto own = line(i);
          for (Eigen::Index j = i + 1; j < std::min(n, i + band + 1); ++j)
          {
            own -= entry(j, i) * line(j);
          }
          own *= entry(i, i);
        }
      }
    });
}

void TensorMass::Apply(const UnknownColumns<4>& side, UnknownColumns<4>& x)
{
  x.resize(side.rows(), 4);
  const auto scale = [&](const UnknownColumns<4>& from)
  {
    ForSegments(x.rows(), this->Threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        x.middleRows(first, count) =
          this->Scales.segment(first, count).asDiagonal() * from.middleRows(first, count);
      });
  };
  scale(side);
  Eigen::Index inner = 4;
  for (const BandFactor& factor : this->Factors)
  {
    this->SolveDirection(factor, inner, x);
    inner *= static_cast<Eigen::Index>(factor.Rows.size()) / (factor.Band + 1);
  }
  scale(x);
}
}
