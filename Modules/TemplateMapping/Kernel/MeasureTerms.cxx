// SPDX-License-Identifier: BSD-3-Clause
#include "MeasureTerms.h"

#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 8;
constexpr int MaxPoints = (MaxDegree + 1) * (MaxDegree + 1) * (MaxDegree + 1);

/// out[o][q][:] += sum_i matrix[q][i] in[o][i][:], with the transposed matrix at hand: row i of it
/// has the numbers of all q. Rows [:] have inner numbers.
template <typename Count>
void ContractBy(
  const Count n, int outer, int inner, const double* transposed, const double* in, double* out)
{
  if (inner == 1)
  {
    for (int o = 0; o < outer; ++o, in += n, out += n)
    {
      for (int i = 0; i < n; ++i)
      {
        for (int q = 0; q < n; ++q)
        {
          out[q] += transposed[i * n + q] * in[i];
        }
      }
    }
    return;
  }
  for (int o = 0; o < outer; ++o, in += n * inner, out += n * inner)
  {
    for (int q = 0; q < n; ++q)
    {
      for (int i = 0; i < n; ++i)
      {
        const double factor = transposed[i * n + q];
        for (int k = 0; k < inner; ++k)
        {
          out[q * inner + k] += factor * in[i * inner + k];
        }
      }
    }
  }
}

/// The sizes of the usual degrees are compiled.
void Contract(int n, int outer, int inner, const double* transposed, const double* in, double* out)
{
  if (n == 4)
  {
    ContractBy(std::integral_constant<int, 4>(), outer, inner, transposed, in, out);
  }
  else if (n == 3)
  {
    ContractBy(std::integral_constant<int, 3>(), outer, inner, transposed, in, out);
  }
  else
  {
    ContractBy(n, outer, inner, transposed, in, out);
  }
}
}

/// Arrays between the directions.
template <int Dim>
struct MeasureTerms<Dim>::Scratch
{
  double A[MaxPoints];
  double B[MaxPoints];
};

template <int Dim>
MeasureTerms<Dim>::MeasureTerms(SplineSpacePtr<Dim> space, std::size_t stride, int threads)
  : Space(std::move(space)), Stride(stride), Threads(threads)
{
  const IntArray<Dim>& degree = this->Space->Elements.front().Degree;
  IntArray<Dim> counts;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    counts[d] = this->Size[d] = degree[d] + 1;
    this->NumPoints *= static_cast<std::size_t>(counts[d]);
  }
  const ElementQuadrature<Dim> rule = MakeElementQuadrature<Dim>(counts);
  this->PointWeights.assign(rule.Weights.data(), rule.Weights.data() + rule.Weights.size());
  std::map<std::tuple<std::size_t, int, double>, int> known; // direction, factor, length
  for (int e = 0; e < this->Space->NumElements(); ++e)
  {
    const auto& element = this->Space->Elements[static_cast<std::size_t>(e)];
    double volume = 1.0;
    std::array<int, Dim> lines;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double length = element.Box.Upper[d] - element.Box.Lower[d];
      volume *= length;
      const auto [place, isNew] =
        known.try_emplace({ d, element.Factor[d], length }, static_cast<int>(this->Lines.size()));
      lines[d] = place->second;
      if (!isNew)
      {
        continue;
      }
      const int n = counts[d];
      const QuadratureRule points = GaussLegendre(n);
      std::vector<double> line(static_cast<std::size_t>(6 * n * n));
      for (int q = 0; q < n; ++q)
      {
        double rows[3][MaxDegree + 1];
        EvaluateLocalLine(degree[d], this->Space->Factor(e, static_cast<int>(d)),
          points.Nodes[static_cast<std::size_t>(q)], length, 2, rows[0]);
        for (int order = 0; order < 3; ++order)
        {
          for (int i = 0; i < n; ++i)
          {
            line[static_cast<std::size_t>((order * n + q) * n + i)] = rows[order][i];
            line[static_cast<std::size_t>(((3 + order) * n + i) * n + q)] = rows[order][i];
          }
        }
      }
      this->Lines.push_back(std::move(line));
    }
    this->LineOfElement.push_back(lines);
    this->Volumes.push_back(volume);
  }
}

template <int Dim>
const double* MeasureTerms<Dim>::Line(int element, int direction, int order) const
{
  const std::size_t d = static_cast<std::size_t>(direction);
  const int line = this->LineOfElement[static_cast<std::size_t>(element)][d];
  return this->Lines[static_cast<std::size_t>(line)].data() + order * this->Size[d] * this->Size[d];
}

template <int Dim>
const double* MeasureTerms<Dim>::LineTransposed(int element, int direction, int order) const
{
  return this->Line(element, direction, 3 + order);
}

template <int Dim>
void MeasureTerms<Dim>::Evaluate(int element, const double* x, double* fields) const
{
  const auto& n = this->Size;
  const std::size_t points = this->NumPoints;
  Scratch scratch;
  std::fill_n(fields, static_cast<std::size_t>(this->NumTerms()) * Dim * points, 0.0);
  const int outer0 = n[1] * n[2];
  for (std::size_t c = 0; c < Dim; ++c)
  {
    const double* plane = x + c * this->Stride;
    const auto field = [&](int term)
    { return fields + (static_cast<std::size_t>(term) * Dim + c) * points; };
    for (int a = 0; a <= (this->HasSecond ? 2 : 1); ++a) // order of the first direction
    {
      std::fill_n(scratch.A, points, 0.0);
      Contract(n[0], outer0, 1, this->LineTransposed(element, 0, a), plane, scratch.A);
      for (int b = 0; b <= (a > 0 ? 0 : (this->HasSecond ? 2 : 1)); ++b)
      {
        const int done = a + b;
        const int term = (done == 2 ? Dim : 0) + (a > 0 ? 0 : 1);
        const double* line = this->LineTransposed(element, 1, b);
        if constexpr (Dim == 2)
        {
          if (done > 0)
          {
            Contract(n[1], 1, n[0], line, scratch.A, field(term));
          }
        }
        else
        {
          std::fill_n(scratch.B, points, 0.0);
          Contract(n[1], n[2], n[0], line, scratch.A, scratch.B);
          if (done > 0)
          {
            Contract(
              n[2], 1, n[0] * n[1], this->LineTransposed(element, 2, 0), scratch.B, field(term));
            continue;
          }
          for (int order = 1; order <= (this->HasSecond ? 2 : 1); ++order)
          {
            Contract(n[2], 1, n[0] * n[1], this->LineTransposed(element, 2, order), scratch.B,
              field(order == 2 ? Dim + 2 : 2));
          }
        }
      }
    }
  }
}

template <int Dim>
void MeasureTerms<Dim>::Integrate(int element, const double* fields, double* sum) const
{
  const auto& n = this->Size;
  const std::size_t points = this->NumPoints;
  Scratch scratch;
  const int outer0 = n[1] * n[2];
  for (std::size_t c = 0; c < Dim; ++c)
  {
    double* plane = sum + c * this->Stride;
    const auto field = [&](int term)
    { return fields + (static_cast<std::size_t>(term) * Dim + c) * points; };
    for (int a = 0; a <= (this->HasSecond ? 2 : 1); ++a)
    {
      std::fill_n(scratch.A, points, 0.0);
      for (int b = 0; b <= (a > 0 ? 0 : (this->HasSecond ? 2 : 1)); ++b)
      {
        const int done = a + b;
        const int term = (done == 2 ? Dim : 0) + (a > 0 ? 0 : 1);
        const double* line = this->Line(element, 1, b);
        if constexpr (Dim == 2)
        {
          if (done > 0)
          {
            Contract(n[1], 1, n[0], line, field(term), scratch.A);
          }
        }
        else
        {
          std::fill_n(scratch.B, points, 0.0);
          if (done > 0)
          {
            Contract(n[2], 1, n[0] * n[1], this->Line(element, 2, 0), field(term), scratch.B);
          }
          for (int order = 1; done == 0 && order <= (this->HasSecond ? 2 : 1); ++order)
          {
            Contract(n[2], 1, n[0] * n[1], this->Line(element, 2, order),
              field(order == 2 ? Dim + 2 : 2), scratch.B);
          }
          Contract(n[1], n[2], n[0], line, scratch.B, scratch.A);
        }
      }
      Contract(n[0], outer0, 1, this->Line(element, 0, a), scratch.A, plane);
    }
  }
}

template <int Dim>
void MeasureTerms<Dim>::Linearize(const FitWeights& weights, const PointMatrix& local)
{
  this->HasSecond = weights.Eccentricity > 0.0;
  const std::size_t count = static_cast<std::size_t>(this->Space->NumElements());
  const std::size_t points = this->NumPoints;
  const std::size_t numFields = static_cast<std::size_t>(this->NumTerms()) * Dim;
  this->Squares.assign(count * NumPacked * points, 0.0);
  this->Pairs.assign(this->HasSecond ? count * 2 * NumFirst * points : 0, 0.0);
  this->Right.assign(count * numFields * points, 0.0);
  ParallelFor(count, ElementChunk, this->Threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<double> planes(Dim * this->Stride, 0.0);
      std::vector<double> fields(numFields * points);
      QualityResidual<Dim> residuals[3];
      for (std::size_t e = begin; e < end; ++e)
      {
        const int element = static_cast<int>(e);
        const int* ids = this->Space->LocalFunctions(element);
        for (std::size_t j = 0; j < points; ++j)
        {
          for (std::size_t d = 0; d < Dim; ++d)
          {
            planes[d * this->Stride + j] = local(ids[j], static_cast<Eigen::Index>(d));
          }
        }
        this->Evaluate(element, planes.data(), fields.data());
        double* right = this->Right.data() + e * numFields * points;
        double* squares = this->Squares.data() + e * NumPacked * points;
        for (std::size_t q = 0; q < points; ++q)
        {
          QualityJet<Dim> jet = QualityJet<Dim>::Zero();
          for (std::size_t k = 0; k < numFields; ++k)
          {
            jet.data()[k] = fields[k * points + q];
          }
          for (int k = 0; k < NumQualityKinds; ++k)
          {
            const QualityKind kind = static_cast<QualityKind>(k);
            const double weight = QualityWeight(weights, kind);
            if (IsQuadratic(kind) || !(weight > 0.0))
            {
              continue;
            }
            const double w = weight * this->Volumes[e] * this->PointWeights[q];
            const int found = QualityResiduals<Dim>(kind, jet, residuals);
            for (int r = 0; r < found; ++r)
            {
              const double* gradient = residuals[r].Gradient.data();
              for (std::size_t i = 0; i < numFields; ++i)
              {
                right[i * points + q] -= w * residuals[r].Value * gradient[i];
              }
              if (ReadsSecondDerivatives(kind))
              {
                // dq of direction r: with respect to g_r, then g_rr
                double* pair =
                  this->Pairs.data() + (e * Dim + static_cast<std::size_t>(r)) * 2 * Dim * points;
                for (std::size_t c = 0; c < Dim; ++c)
                {
                  pair[c * points + q] =
                    std::sqrt(w) * residuals[r].Gradient(r, static_cast<Eigen::Index>(c));
                  pair[(Dim + c) * points + q] =
                    std::sqrt(w) * residuals[r].Gradient(Dim + r, static_cast<Eigen::Index>(c));
                }
                continue;
              }
              for (std::size_t i = 0, entry = 0; i < NumFirst; ++i)
              {
                for (std::size_t j = 0; j <= i; ++j, ++entry)
                {
                  squares[entry * points + q] += w * gradient[i] * gradient[j];
                }
              }
            }
          }
        }
      }
    });
}

template <int Dim>
void MeasureTerms<Dim>::Apply(int element, const double* x, double* sum) const
{
  const std::size_t points = this->NumPoints;
  const std::size_t e = static_cast<std::size_t>(element);
  double fields[2 * NumFirst * MaxPoints];
  double results[2 * NumFirst * MaxPoints];
  this->Evaluate(element, x, fields);
  std::fill_n(results, static_cast<std::size_t>(this->NumTerms()) * Dim * points, 0.0);
  const double* squares = this->Squares.data() + e * NumPacked * points;
  for (std::size_t i = 0; i < NumFirst; ++i)
  {
    for (std::size_t j = 0; j <= i; ++j, squares += points)
    {
      for (std::size_t q = 0; q < points; ++q)
      {
        results[i * points + q] += squares[q] * fields[j * points + q];
      }
      for (std::size_t q = 0; j < i && q < points; ++q)
      {
        results[j * points + q] += squares[q] * fields[i * points + q];
      }
    }
  }
  for (std::size_t k = 0; this->HasSecond && k < Dim; ++k)
  {
    const double* pair = this->Pairs.data() + (e * Dim + k) * 2 * Dim * points;
    for (std::size_t q = 0; q < points; ++q)
    {
      const auto place = [&](std::size_t c)
      { return ((c < Dim ? k * Dim : NumFirst + k * Dim - Dim) + c) * points + q; };
      double along = 0.0;
      for (std::size_t c = 0; c < 2 * Dim; ++c)
      {
        along += pair[c * points + q] * fields[place(c)];
      }
      for (std::size_t c = 0; c < 2 * Dim; ++c)
      {
        results[place(c)] += along * pair[c * points + q];
      }
    }
  }
  this->Integrate(element, results, sum);
}

template <int Dim>
void MeasureTerms<Dim>::AddRight(int element, double* sum) const
{
  const std::size_t fields = static_cast<std::size_t>(this->NumTerms()) * Dim * this->NumPoints;
  this->Integrate(element, this->Right.data() + static_cast<std::size_t>(element) * fields, sum);
}

template <int Dim>
void MeasureTerms<Dim>::AddDiagonal(int element, Eigen::Matrix<double, Dim, Dim>* blocks) const
{
  const std::size_t points = this->NumPoints;
  const std::size_t e = static_cast<std::size_t>(element);
  const int numTerms = this->NumTerms();
  // Sums over the points of the matrices dq^T dq of all terms and components.
  using Matrix = Eigen::Matrix<double, 2 * NumFirst, 2 * NumFirst>;
  Matrix total = Matrix::Zero();
  const double* squares = this->Squares.data() + e * NumPacked * points;
  for (Eigen::Index i = 0; i < NumFirst; ++i)
  {
    for (Eigen::Index j = 0; j <= i; ++j, squares += points)
    {
      total(i, j) = total(j, i) =
        Eigen::Map<const Eigen::VectorXd>(squares, static_cast<Eigen::Index>(points)).sum();
    }
  }
  for (Eigen::Index k = 0; this->HasSecond && k < Dim; ++k)
  {
    const Eigen::Map<const PointMatrix> pair(
      this->Pairs.data() + (e * Dim + static_cast<std::size_t>(k)) * 2 * Dim * points, 2 * Dim,
      static_cast<Eigen::Index>(points));
    const Eigen::Matrix<double, 2 * Dim, 2 * Dim> square = pair * pair.transpose();
    const Eigen::Index start[2] = { k * Dim, NumFirst + k * Dim };
    for (int a = 0; a < 2; ++a)
    {
      for (int b = 0; b < 2; ++b)
      {
        total.template block<Dim, Dim>(start[a], start[b]) +=
          square.template block<Dim, Dim>(a * Dim, b * Dim);
      }
    }
  }
  // Means over the element of products of two derivatives of a function, a product of directions.
  double means[3][3][3][MaxDegree + 1] = {}; // direction, orders, function
  for (int d = 0; d < 3; ++d)
  {
    const int n = this->Size[static_cast<std::size_t>(d)];
    const QuadratureRule rule = GaussLegendre(n);
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
      {
        for (int i = 0; i < n; ++i)
        {
          means[d][a][b][i] = d < Dim ? 0.0 : (a + b == 0 ? 1.0 : 0.0);
          for (int q = 0; d < Dim && q < n; ++q)
          {
            means[d][a][b][i] += rule.Weights[static_cast<std::size_t>(q)] *
              this->Line(element, d, a)[q * n + i] * this->Line(element, d, b)[q * n + i];
          }
        }
      }
    }
  }
  const auto order = [](int term, int direction)
  { return term % Dim == direction ? (term < Dim ? 1 : 2) : 0; };
  std::size_t function = 0;
  for (int z = 0; z < this->Size[2]; ++z)
  {
    for (int y = 0; y < this->Size[1]; ++y)
    {
      for (int x = 0; x < this->Size[0]; ++x, ++function)
      {
        for (int s = 0; s < numTerms; ++s)
        {
          for (int t = 0; t < numTerms; ++t)
          {
            const double mean = means[0][order(s, 0)][order(t, 0)][x] *
              means[1][order(s, 1)][order(t, 1)][y] * means[2][order(s, 2)][order(t, 2)][z];
            blocks[function] += mean * total.template block<Dim, Dim>(s * Dim, t * Dim);
          }
        }
      }
    }
  }
}

template class MeasureTerms<2>;
template class MeasureTerms<3>;
}
