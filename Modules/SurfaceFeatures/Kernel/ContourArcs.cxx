// SPDX-License-Identifier: BSD-3-Clause
#include "ContourArcs.h"

#include "SignRoots.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int MostPoints = 1 << 16; // of an arc
constexpr int LargestChordDegree = 2 * MaxDegree;
}

void ContourArcs::SetElement(const ContourElement& element)
{
  this->Element = element;
  const IntArray<2>& degree = element.Degree;
  if (degree == this->Degree)
  {
    return;
  }
  this->Degree = degree;
  this->Share.clear();
  const int n = degree[0] + degree[1];
  for (int j = 0; j <= degree[1]; ++j)
  {
    for (int i = 0; i <= degree[0]; ++i)
    {
      this->Share.push_back(Binomial(degree[0], i) * Binomial(degree[1], j) / Binomial(n, i + j));
    }
  }
  this->Box.resize(this->Share.size());
}

void ContourArcs::Restrict(
  const double* coefficients, const RealArray<2>& a, const RealArray<2>& b, double* onChord)
{
  double factorU[(MaxDegree + 1) * (MaxDegree + 1)];
  double factorV[(MaxDegree + 1) * (MaxDegree + 1)];
  BernsteinRestriction(this->Degree[0], a[0], b[0], factorU);
  BernsteinRestriction(this->Degree[1], a[1], b[1], factorV);
  ApplyFactors<2>(this->Degree, { factorU, factorV }, coefficients, this->Box.data());
  // the diagonal of the box from a to b: B_i^p(t) B_j^q(t) is a share of B_{i+j}^{p+q}(t)
  std::fill(onChord, onChord + this->Degree[0] + this->Degree[1] + 1, 0.0);
  std::size_t k = 0;
  for (int j = 0; j <= this->Degree[1]; ++j)
  {
    for (int i = 0; i <= this->Degree[0]; ++i, ++k)
    {
      onChord[i + j] += this->Share[k] * this->Box[k];
    }
  }
}

bool ContourArcs::IsStraight(const RealArray<2>& a, const RealArray<2>& b)
{
  const int n = this->Degree[0] + this->Degree[1];
  const int size = NumTensorFunctions<2>(this->Degree);
  double weight[LargestChordDegree + 2];
  std::fill(weight, weight + n + 1, 1.0);
  if (this->Element.Rational)
  {
    this->Restrict(this->Element.Block + this->Element.NumComponents * size, a, b, weight);
  }
  // w S(t) - w L(t) of degree n + 1, L the straight line between the ends
  double squared[LargestChordDegree + 2] = {};
  for (int c = 0; c < this->Element.NumSpaceComponents; ++c)
  {
    double x[LargestChordDegree + 1];
    this->Restrict(this->Element.Block + c * size, a, b, x);
    const double first = x[0] / weight[0];
    const double last = x[n] / weight[n];
    for (int k = 0; k <= n + 1; ++k)
    {
      const double up = k <= n ? x[k] - first * weight[k] : 0.0;
      const double down = k > 0 ? x[k - 1] - last * weight[k - 1] : 0.0;
      const double difference = ((n + 1 - k) * up + k * down) / (n + 1);
      squared[k] += difference * difference;
    }
  }
  const double least = *std::min_element(weight, weight + n + 1);
  return std::sqrt(*std::max_element(squared, squared + n + 2)) <=
    this->Element.ChordTolerance * least;
}

RealArray<2> ContourArcs::PointBetween(
  const MonotoneCell& cell, const RealArray<2>& a, const RealArray<2>& b) const
{
  // along `solved` g is monotone; where it is along both, the longer way is halved
  const bool both = cell.Monotone[0] && cell.Monotone[1];
  const std::size_t solved =
    both ? (std::abs(a[0] - b[0]) > std::abs(a[1] - b[1]) ? 1 : 0) : (cell.Monotone[1] ? 1 : 0);
  const std::size_t halved = 1 - solved;
  RealArray<2> point;
  point[halved] = 0.5 * (a[halved] + b[halved]);

  double values[MaxDegree + 1];
  BernsteinValues(this->Degree[halved], point[halved], values);
  double line[MaxDegree + 1] = {};
  const int width = this->Degree[0] + 1;
  for (int j = 0; j <= this->Degree[1]; ++j)
  {
    for (int i = 0; i <= this->Degree[0]; ++i)
    {
      line[solved == 1 ? j : i] += values[solved == 1 ? i : j] * cell.G[j * width + i];
    }
  }
  const int degree = this->Degree[solved];
  double low = both ? std::min(a[solved], b[solved]) : 0.0;
  double high = both ? std::max(a[solved], b[solved]) : 1.0;
  const double valueLow = EvaluateBernstein(degree, line, low, nullptr);
  const double valueHigh = EvaluateBernstein(degree, line, high, nullptr);
  if (IsPositive(valueLow) == IsPositive(valueHigh)) // within rounding of an end
  {
    point[solved] = std::abs(valueLow) < std::abs(valueHigh) ? low : high;
    return point;
  }
  point[solved] = FindSignChange(degree, line, low, high, 0.5 * (a[solved] + b[solved]), 1e-8);
  return point;
}

double ContourArcs::RefineChord(const MonotoneCell& cell, const RealArray<2>& a,
  const RealArray<2>& b, bool force, std::vector<RealArray<2>>& points)
{
  const auto inElement = [&cell](const RealArray<2>& p)
  {
    return RealArray<2>{ cell.Lower[0] + p[0] * (cell.Upper[0] - cell.Lower[0]),
      cell.Lower[1] + p[1] * (cell.Upper[1] - cell.Lower[1]) };
  };
  double onChord[LargestChordDegree + 1];
  this->Restrict(cell.G, a, b, onChord);
  double bound = 0.0;
  for (int k = 0; k <= this->Degree[0] + this->Degree[1]; ++k)
  {
    bound = std::max(bound, std::abs(onChord[k]));
  }
  const bool near = !force && bound <= this->Element.Tolerance &&
    (this->Element.ChordTolerance <= 0.0 || this->IsStraight(inElement(a), inElement(b)));
  if (near || this->Budget <= 0)
  {
    return bound;
  }
  --this->Budget;
  const RealArray<2> middle = this->PointBetween(cell, a, b);
  if (middle == a || middle == b)
  {
    return bound;
  }
  const double before = this->RefineChord(cell, a, middle, false, points);
  points.push_back(inElement(middle));
  return std::max(before, this->RefineChord(cell, middle, b, false, points));
}

double ContourArcs::Refine(const MonotoneCell& cell, const RealArray<2>& from,
  const RealArray<2>& to, std::vector<RealArray<2>>& points)
{
  const auto inCell = [&cell](const RealArray<2>& p)
  {
    RealArray<2> local;
    for (std::size_t d = 0; d < 2; ++d)
    {
      local[d] = (p[d] - cell.Lower[d]) / (cell.Upper[d] - cell.Lower[d]);
      local[d] = std::clamp(local[d], 0.0, 1.0);
    }
    return local;
  };
  this->Budget = cell.Monotone[0] || cell.Monotone[1] ? MostPoints : 0;
  // an arc back to the line it came from is half of a loop, perhaps: loops are no segments
  const bool back = from[0] == to[0] || from[1] == to[1];
  return this->RefineChord(cell, inCell(from), inCell(to), back, points);
}
}
