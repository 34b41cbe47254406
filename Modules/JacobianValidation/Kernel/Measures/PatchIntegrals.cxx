// SPDX-License-Identifier: BSD-3-Clause
#include "PatchIntegrals.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double UnitRoundoff = 0x1p-53;
/// Points a direction of a rule at most, the exact ones of the highest degree included.
constexpr int MaxPoints = 32;
constexpr int NumPlanes = PatchForm::NumPlanes;
/// Legendre coefficients by which an error is estimated: two groups of three.
constexpr int NumTails = 6;
/// Points a direction of the rule that is tried first where nothing is exact.
constexpr int QuickPoints = 10;
/// Where the weights' exponents differ by more after they were balanced, a rule may have missed a
/// layer: its own estimate is not believed, but what the control points allow.
constexpr int LargestSpread = 8;
/// Of the integrand: its measure and three moments.
constexpr int NumValues = 4;

/// A part of a patch and its integral.
struct Piece
{
  PatchForm Form;
  int Depth = 0;
  double Measure = 0.0;
  double Absolute = 0.0;
  std::array<double, 3> Moment{};
  double Error = 0.0;
  int Direction = 1;    ///< in which most of the error is made
  bool IsFinal = false; ///< not to be halved
  int Points = 0;       ///< of its rule

  bool operator<(const Piece& other) const
  {
    return (this->IsFinal ? 0.0 : this->Error) < (other.IsFinal ? 0.0 : other.Error);
  }
};

/// What a row of points contributes, as arrays over the points.
struct RowValues
{
  double X[NumPlanes][MaxPoints];
  double S[NumPlanes][MaxPoints]; ///< derivatives
  double T[NumPlanes][MaxPoints];
  double F[NumValues][MaxPoints];
};

void MakeFlux(RowValues& row, bool isCurve, int count)
{
  const auto& x = row.X;
  const auto& s = row.S;
  const auto& t = row.T;
  for (int m = 0; m < count; ++m)
  {
    const double over = 1.0 / x[3][m];
    double f = 0.0;
    double moment = 0.0; // over the coordinate
    if (isCurve)
    {
      f = (x[0][m] * t[1][m] - x[1][m] * t[0][m]) * over * over;
      moment = f * over * (1.0 / 3.0);
      f *= 0.5;
    }
    else
    {
      const double det = x[0][m] * (s[1][m] * t[2][m] - s[2][m] * t[1][m]) +
        x[1][m] * (s[2][m] * t[0][m] - s[0][m] * t[2][m]) +
        x[2][m] * (s[0][m] * t[1][m] - s[1][m] * t[0][m]);
      f = det * over * over * over;
      moment = f * over * 0.25;
      f *= 1.0 / 3.0;
    }
    row.F[0][m] = f;
    for (int c = 0; c < 3; ++c)
    {
      row.F[c + 1][m] = moment * x[c][m];
    }
  }
}

void MakeSize(RowValues& row, bool isCurve, int count)
{
  for (int m = 0; m < count; ++m)
  {
    const double over = 1.0 / row.X[3][m];
    double s[3];
    double t[3];
    for (int c = 0; c < 3; ++c)
    {
      const double x = row.X[c][m] * over;
      s[c] = (row.S[c][m] - x * row.S[3][m]) * over;
      t[c] = (row.T[c][m] - x * row.T[3][m]) * over;
    }
    if (!isCurve)
    {
      const double normal[3] = { s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2],
        s[0] * t[1] - s[1] * t[0] };
      std::copy(normal, normal + 3, t);
    }
    const double f = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    row.F[0][m] = f;
    for (int c = 0; c < 3; ++c)
    {
      row.F[c + 1][m] = f * row.X[c][m] * over;
    }
  }
}

/// Values and both derivatives of the homogeneous coordinates at one node of the first rule and all
/// of the second.
void EvaluateRow(const PatchForm& form, const PatchRules::Rule& u, int node,
  const PatchRules::Rule& v, RowValues& row)
{
  const int p = form.Degree[0];
  const int q = form.Degree[1];
  const int n = form.Size();
  const int count = v.Count;
  for (int plane = 0; plane < NumPlanes; ++plane)
  {
    double* x = row.X[plane];
    double* s = row.S[plane];
    double* t = row.T[plane];
    std::fill(x, x + count, 0.0);
    std::fill(s, s + count, 0.0);
    std::fill(t, t + count, 0.0);
    for (int j = 0; j <= q; ++j)
    {
      const double* c = form.Data.data() + plane * n + j * (p + 1);
      double value = 0.0;
      double slope = 0.0;
      for (int i = 0; i <= p; ++i)
      {
        value += u.Values[static_cast<std::size_t>(i * u.Count + node)] * c[i];
        slope += u.Slopes[static_cast<std::size_t>(i * u.Count + node)] * c[i];
      }
      const double* values = v.Values.data() + j * count;
      const double* slopes = v.Slopes.data() + j * count;
      for (int m = 0; m < count; ++m)
      {
        x[m] += values[m] * value;
        s[m] += values[m] * slope;
        t[m] += slopes[m] * value;
      }
    }
  }
}

/// The error that a rule makes of a function of which it saw the values: see the header.
double EstimateError(const PatchRules::Rule& rule, const double* values, bool isRational)
{
  double largest = 0.0;
  for (int i = 0; i < rule.Count; ++i)
  {
    largest = std::max(largest, std::abs(values[i]));
  }
  double tails[2] = { 0.0, 0.0 };
  for (int k = 0; k < NumTails; ++k)
  {
    double sum = 0.0;
    for (int i = 0; i < rule.Count; ++i)
    {
      sum += rule.Tails[static_cast<std::size_t>(k * rule.Count + i)] * values[i];
    }
    double& tail = tails[k < NumTails / 2 ? 0 : 1];
    tail = std::max(tail, std::abs(sum));
  }
  if (!isRational || !(tails[0] > tails[1]))
  {
    return tails[1];
  }
  const double decay = tails[1] / tails[0];
  return tails[1] * std::min(1.0, 8.0 * std::max(tails[1] / largest, decay * decay * decay));
}

class Integrator
{
public:
  Integrator(const PatchIntegralParams& params, PatchRules& rules) : Params(params), Rules(rules) {}

  bool IsExact() const
  {
    return this->Params.Integrand == PatchIntegrand::Flux && !this->Params.Rational;
  }

  /// @param isQuick  by a rule of few points, which does for small pieces of smooth shapes.
  void Evaluate(Piece& piece, bool isQuick = false)
  {
    const bool isCurve = piece.Form.IsCurve();
    const bool isFlux = this->Params.Integrand == PatchIntegrand::Flux;
    const int spread = this->Params.Rational ? BalanceWeights(piece.Form) : 0;
    const PatchRules::Rule& u = this->GetRule(isCurve, piece.Form.Degree[0], isQuick);
    const PatchRules::Rule& v = this->GetRule(isCurve, piece.Form.Degree[1], isQuick);
    double rows[NumValues][MaxPoints];
    double columns[NumValues][MaxPoints] = {};
    piece.Measure = 0.0;
    piece.Absolute = 0.0;
    piece.Moment = {};
    RowValues row;
    for (int i = 0; i < u.Count; ++i)
    {
      EvaluateRow(piece.Form, u, i, v, row);
      if (isFlux)
      {
        MakeFlux(row, isCurve, v.Count);
      }
      else
      {
        MakeSize(row, isCurve, v.Count);
      }
      const double weight = u.Weights[static_cast<std::size_t>(i)];
      for (int f = 0; f < NumValues; ++f)
      {
        double sum = 0.0;
        double absolute = 0.0;
        for (int m = 0; m < v.Count; ++m)
        {
          const double x = v.Weights[static_cast<std::size_t>(m)] * row.F[f][m];
          sum += x;
          absolute += std::abs(x);
          columns[f][m] += weight * row.F[f][m];
        }
        rows[f][i] = sum;
        (f == 0 ? piece.Measure : piece.Moment[static_cast<std::size_t>(f - 1)]) += weight * sum;
        piece.Absolute += f == 0 ? weight * absolute : 0.0;
      }
    }
    piece.Points = u.Count * v.Count;
    piece.Error = 0.0;
    if (!this->IsExact())
    {
      double error[2] = { 0.0, 0.0 };
      for (int f = 0; f < NumValues; ++f)
      {
        const double scale = f == 0 ? 1.0 : 1.0 / this->Params.Size;
        error[0] = isCurve ? 0.0 : std::max(error[0], scale * EstimateError(u, rows[f], isFlux));
        error[1] = std::max(error[1], scale * EstimateError(v, columns[f], isFlux));
      }
      piece.Error = error[0] + error[1];
      if (spread > LargestSpread)
      {
        piece.Error = std::max({ piece.Error, piece.Absolute, this->HullBound(piece.Form) });
      }
      piece.Direction = error[0] > error[1] ? 0 : 1;
    }
  }

private:
  /// About the most that a patch of these control points contributes, whatever its weights.
  double HullBound(const PatchForm& form) const
  {
    const int n = form.Size();
    const int p = form.Degree[0];
    const int q = form.Degree[1];
    const auto distance = [&](int i, int j)
    {
      double sum = 0.0;
      for (int c = 0; c < 3; ++c)
      {
        const double* x = form.Data.data() + c * n;
        const double* w = form.Data.data() + 3 * n;
        sum += std::pow(x[j] / w[j] - (i < 0 ? 0.0 : x[i] / w[i]), 2);
      }
      return std::sqrt(sum);
    };
    double lengths[2] = { 0.0, 0.0 };
    double reach = 0.0;
    for (int j = 0; j <= q; ++j)
    {
      double length = 0.0;
      for (int i = 0; i <= p; ++i)
      {
        reach = std::max(reach, distance(-1, j * (p + 1) + i));
        length += i > 0 ? distance(j * (p + 1) + i - 1, j * (p + 1) + i) : 0.0;
      }
      lengths[0] = std::max(lengths[0], length);
    }
    for (int i = 0; i <= p; ++i)
    {
      double length = 0.0;
      for (int j = 1; j <= q; ++j)
      {
        length += distance((j - 1) * (p + 1) + i, j * (p + 1) + i);
      }
      lengths[1] = std::max(lengths[1], length);
    }
    const double size = (form.IsCurve() ? 1.0 : lengths[0]) * lengths[1];
    return this->Params.Integrand == PatchIntegrand::Size
      ? size
      : size * reach / (form.IsCurve() ? 2.0 : 3.0);
  }

  const PatchRules::Rule& GetRule(bool isCurve, int degree, bool isQuick)
  {
    if (degree == 0)
    {
      return this->Rules.Get(0, 1);
    }
    // a flux times a coordinate has d + 1 factors, one of them a derivative
    const int factors = isCurve ? 3 : 4;
    const int exact = (factors * degree + 1) / 2;
    const int least = isQuick                          ? QuickPoints
      : this->Params.Integrand == PatchIntegrand::Flux ? 14
                                                       : 20;
    return this->Rules.Get(degree, this->IsExact() ? exact : std::max(least, exact + 6));
  }

  const PatchIntegralParams& Params;
  PatchRules& Rules;
};

/// Sums in the order of the pieces.
PatchIntegral SumOf(const std::vector<Piece>& pieces)
{
  PatchIntegral sum;
  for (const Piece& piece : pieces)
  {
    sum.Measure += piece.Measure;
    sum.Absolute += piece.Absolute;
    sum.Error += piece.Error;
    for (std::size_t c = 0; c < 3; ++c)
    {
      sum.Moment[c] += piece.Moment[c];
    }
  }
  return sum;
}
}

const PatchRules::Rule& PatchRules::Get(int degree, int count)
{
  const auto [at, isNew] = this->Rules.try_emplace({ degree, count });
  Rule& rule = at->second;
  if (!isNew)
  {
    return rule;
  }
  const QuadratureRule gauss = GaussLegendre(count);
  const std::size_t n = static_cast<std::size_t>(count);
  rule.Count = count;
  rule.Weights = gauss.Weights;
  rule.Values.resize(static_cast<std::size_t>(degree + 1) * n);
  rule.Slopes.resize(rule.Values.size());
  rule.Tails.resize(NumTails * n);
  for (std::size_t m = 0; m < n; ++m)
  {
    double basis[2 * (MaxDegree + 1)] = { 1.0 };
    BernsteinDerivatives(degree, gauss.Nodes[m], 1, basis);
    for (int i = 0; i <= degree; ++i)
    {
      rule.Values[static_cast<std::size_t>(i) * n + m] = basis[i];
      rule.Slopes[static_cast<std::size_t>(i) * n + m] = basis[degree + 1 + i];
    }
    const double x = 2.0 * gauss.Nodes[m] - 1.0;
    double legendre = 1.0;
    double before = 0.0;
    for (int k = 0; k < count; ++k)
    {
      if (k >= count - NumTails)
      {
        rule.Tails[static_cast<std::size_t>(k - (count - NumTails)) * n + m] =
          (2 * k + 1) * gauss.Weights[m] * legendre;
      }
      const double next = ((2 * k + 1) * x * legendre - k * before) / (k + 1);
      before = legendre;
      legendre = next;
    }
  }
  return rule;
}

PatchIntegral IntegratePatches(
  std::vector<PatchForm> patches, const PatchIntegralParams& params, PatchRules& rules)
{
  Integrator integrator(params, rules);
  std::vector<Piece> pieces;
  std::int64_t points = 0;
  const auto evaluate = [&](bool isQuick)
  {
    for (Piece& piece : pieces)
    {
      integrator.Evaluate(piece, isQuick);
      points += piece.Points;
    }
    return SumOf(pieces);
  };
  for (PatchForm& patch : patches)
  {
    pieces.emplace_back();
    pieces.back().Form = std::move(patch);
    pieces.back().IsFinal = params.MaxDepth == 0;
  }
  const auto isDone = [&](const PatchIntegral& sum)
  {
    return sum.Error <=
      std::max(params.Tolerance * std::abs(sum.Measure), 16.0 * UnitRoundoff * sum.Absolute);
  };
  PatchIntegral sum = evaluate(params.Integrand == PatchIntegrand::Size);
  if (params.Integrand == PatchIntegrand::Size && !isDone(sum))
  {
    sum = evaluate(false);
  }
  if (!integrator.IsExact() && !isDone(sum))
  {
    std::make_heap(pieces.begin(), pieces.end());
    while (points < params.MaxPoints && !pieces.front().IsFinal)
    {
      std::pop_heap(pieces.begin(), pieces.end());
      Piece halves[2];
      halves[1] = std::move(pieces.back());
      pieces.pop_back();
      sum.Error -= halves[1].Error;
      sum.Measure -= halves[1].Measure;
      halves[0].Form = CutOffHalf(halves[1].Form, halves[1].Direction);
      halves[0].Depth = ++halves[1].Depth;
      for (Piece& half : halves)
      {
        integrator.Evaluate(half);
        points += half.Points;
        half.IsFinal = half.Depth >= params.MaxDepth;
        sum.Error += half.Error;
        sum.Measure += half.Measure;
        pieces.push_back(std::move(half));
        std::push_heap(pieces.begin(), pieces.end());
      }
      // running sums round: what they say is looked at once more
      if (isDone(sum) && isDone(sum = SumOf(pieces)))
      {
        break;
      }
    }
    sum = SumOf(pieces);
  }
  sum.Converged = isDone(sum);
  sum.Points = points;
  return sum;
}
}
