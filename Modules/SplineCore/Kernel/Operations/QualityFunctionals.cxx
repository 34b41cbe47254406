// SPDX-License-Identifier: BSD-3-Clause
#include "QualityFunctionals.h"

#include "BasisEvaluation.h"
#include "Parallel.h"
#include "Quadrature.h"
#include "SparseLines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr double SelfIntersectionEpsilon = 1e-7;
constexpr std::size_t ElementChunk = 64;

/// Gauss points of all elements of one degree: they are the same in local parameters.
template <int Dim>
const ElementQuadrature<Dim>& RuleOf(
  const IntArray<Dim>& degree, std::map<IntArray<Dim>, ElementQuadrature<Dim>>& rules)
{
  const auto found = rules.find(degree);
  if (found != rules.end())
  {
    return found->second;
  }
  IntArray<Dim> points = degree;
  for (int& n : points)
  {
    ++n;
  }
  return rules.emplace(degree, MakeElementQuadrature<Dim>(points)).first->second;
}

/// The integrand at row i of a batch.
template <int Dim>
double Integrand(QualityKind kind, const EvaluationBatch& batch, Eigen::Index i)
{
  double sum = 0.0;
  if (kind == QualityKind::Length)
  {
    return batch.First.row(i).squaredNorm();
  }
  int pair = 0; // of directions, the diagonal ones included
  QualityJet<Dim> jet = QualityJet<Dim>::Zero();
  for (int k = 0; k < Dim; ++k)
  {
    jet.row(k) = batch.First.row(i).segment(k * Dim, Dim);
    for (int l = k; l < Dim && batch.Second.rows() > 0; ++l, ++pair)
    {
      const auto second = batch.Second.row(i).segment(pair * Dim, Dim);
      sum += (k == l ? 1.0 : 2.0) * second.squaredNorm();
      if (k == l)
      {
        jet.row(Dim + k) = second;
      }
    }
  }
  if (kind == QualityKind::Uniformity)
  {
    return sum;
  }
  sum = 0.0;
  QualityResidual<Dim> residuals[3];
  const int count = QualityResiduals<Dim>(kind, jet, residuals);
  for (int r = 0; r < count; ++r)
  {
    sum += residuals[r].Value * residuals[r].Value;
  }
  return sum;
}

/// Integrals over an element, of one direction, of products of the local functions' derivatives:
/// Order[a](i, j) = int f_i^(a) f_j^(a), row-major.
struct LineMatrices
{
  std::array<std::vector<double>, 3> Order;
};

LineMatrices IntegrateDirection(int degree, const double* factor, double length)
{
  constexpr int stride = MaxDegree + 1;
  const int n = degree + 1;
  const QuadratureRule rule = GaussLegendre(n);
  LineMatrices result;
  for (auto& matrix : result.Order)
  {
    matrix.assign(static_cast<std::size_t>(n * n), 0.0);
  }
  for (int q = 0; q < n; ++q)
  {
    double lines[3 * stride];
    EvaluateLocalLine(degree, factor, rule.Nodes[static_cast<std::size_t>(q)], length, 2, lines);
    for (std::size_t order = 0; order < 3; ++order)
    {
      const double* values = lines + order * stride;
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          result.Order[order][static_cast<std::size_t>(i * n + j)] +=
            length * rule.Weights[static_cast<std::size_t>(q)] * values[i] * values[j];
        }
      }
    }
  }
  return result;
}

/// The matrices of every element and direction; those of equal elements are shared.
template <int Dim>
struct LineTables
{
  std::vector<LineMatrices> Matrices;
  std::vector<std::array<int, Dim>> OfElement;

  explicit LineTables(const SplineSpace<Dim>& space)
  {
    std::map<std::tuple<int, int, double>, int> known; // degree, factor, length
    this->OfElement.resize(static_cast<std::size_t>(space.NumElements()));
    for (int e = 0; e < space.NumElements(); ++e)
    {
      const auto& element = space.Elements[static_cast<std::size_t>(e)];
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const double length = element.Box.Upper[d] - element.Box.Lower[d];
        const auto [place, isNew] =
          known.try_emplace({ element.Degree[d], element.Factor[d], length },
            static_cast<int>(this->Matrices.size()));
        if (isNew)
        {
          this->Matrices.push_back(
            IntegrateDirection(element.Degree[d], space.Factor(e, static_cast<int>(d)), length));
        }
        this->OfElement[static_cast<std::size_t>(e)][d] = place->second;
      }
    }
  }
};

/// Row i of the element matrix of the weighted sum of both functionals, prod(p + 1) numbers.
template <int Dim>
void ElementRow(const LineTables<Dim>& tables, const IntArray<Dim>& degree, int e, int i,
  double uniformity, double length, double* row)
{
  const double* line[3][3]; // direction, order: the row of the direction's matrix
  IntArray<3> size{ 1, 1, 1 };
  static constexpr double one = 1.0;
  static constexpr double zero = 0.0;
  for (std::size_t d = 0; d < 3; ++d)
  {
    if (d < Dim)
    {
      size[d] = degree[d] + 1;
      const auto& matrices =
        tables.Matrices[static_cast<std::size_t>(tables.OfElement[static_cast<std::size_t>(e)][d])];
      for (std::size_t order = 0; order < 3; ++order)
      {
        line[d][order] = matrices.Order[order].data() + (i % size[d]) * size[d];
      }
      i /= size[d];
    }
    else
    {
      line[d][0] = &one;
      line[d][1] = line[d][2] = &zero;
    }
  }
  for (int c = 0; c < size[2]; ++c)
  {
    const double z0 = line[2][0][c];
    const double z1 = line[2][1][c];
    const double z2 = line[2][2][c];
    for (int b = 0; b < size[1]; ++b)
    {
      const double y0 = line[1][0][b];
      const double y1 = line[1][1][b];
      const double y2 = line[1][2][b];
      // factors of f, f', f'' of the first direction
      const double by0 =
        uniformity * (y2 * z0 + 2.0 * y1 * z1 + y0 * z2) + length * (y1 * z0 + y0 * z1);
      const double by1 = 2.0 * uniformity * (y1 * z0 + y0 * z1) + length * y0 * z0;
      const double by2 = uniformity * y0 * z0;
      for (int a = 0; a < size[0]; ++a)
      {
        *row++ = by0 * line[0][0][a] + by1 * line[0][1][a] + by2 * line[0][2][a];
      }
    }
  }
}
}

template <int Dim>
int QualityResiduals(QualityKind kind, const QualityJet<Dim>& jet, QualityResidual<Dim>* residuals)
{
  int count = 0;
  const auto next = [&]() -> QualityResidual<Dim>&
  {
    residuals[count].Gradient.setZero();
    return residuals[count++];
  };
  switch (kind)
  {
    case QualityKind::Orthogonality:
      for (int k = 0; k < Dim; ++k)
      {
        for (int l = k + 1; l < Dim; ++l)
        {
          QualityResidual<Dim>& r = next();
          r.Value = jet.row(k).dot(jet.row(l));
          r.Gradient.row(k) = jet.row(l);
          r.Gradient.row(l) = jet.row(k);
        }
      }
      break;
    case QualityKind::Skewness:
      for (int k = 0; k < Dim; ++k)
      {
        for (int l = k + 1; l < Dim; ++l)
        {
          QualityResidual<Dim>& r = next();
          const double dot = jet.row(k).dot(jet.row(l));
          const double kk = jet.row(k).squaredNorm();
          const double ll = jet.row(l).squaredNorm();
          if (!(kk * ll > 0.0))
          {
            r.Value = std::numeric_limits<double>::infinity();
            break;
          }
          const double slope = 2.0 * dot / (kk * ll);
          r.Value = 0.5 * slope * dot;
          r.Gradient.row(k) = slope * (jet.row(l) - dot / kk * jet.row(k));
          r.Gradient.row(l) = slope * (jet.row(k) - dot / ll * jet.row(l));
        }
      }
      break;
    case QualityKind::Eccentricity:
      for (int k = 0; k < Dim; ++k)
      {
        QualityResidual<Dim>& r = next();
        const double kk = jet.row(k).squaredNorm();
        if (!(kk > 0.0))
        {
          r.Value = std::numeric_limits<double>::infinity();
          continue;
        }
        r.Value = jet.row(k).dot(jet.row(Dim + k)) / kk;
        r.Gradient.row(k) = (jet.row(Dim + k) - 2.0 * r.Value * jet.row(k)) / kk;
        r.Gradient.row(Dim + k) = jet.row(k) / kk;
      }
      break;
    case QualityKind::Area:
    {
      QualityResidual<Dim>& r = next();
      if constexpr (Dim == 2)
      {
        r.Gradient.row(0) << jet(1, 1), -jet(1, 0);
        r.Gradient.row(1) << -jet(0, 1), jet(0, 0);
      }
      else
      {
        r.Gradient.row(0) = jet.row(1).cross(jet.row(2));
        r.Gradient.row(1) = jet.row(2).cross(jet.row(0));
        r.Gradient.row(2) = jet.row(0).cross(jet.row(1));
      }
      r.Value = jet.row(0).dot(r.Gradient.row(0));
      break;
    }
    case QualityKind::SelfIntersection:
      for (int k = 0; k < Dim; ++k)
      {
        QualityResidual<Dim>& r = next();
        r.Value = 1.0 / (jet.row(k).squaredNorm() + SelfIntersectionEpsilon);
        r.Gradient.row(k) = -2.0 * r.Value * r.Value * jet.row(k);
      }
      break;
    case QualityKind::Uniformity:
    case QualityKind::Length:
      break;
  }
  return count;
}

template <int Dim>
double QualityValue(const BezierForm<Dim>& form, QualityKind kind, int threads)
{
  const SplineSpace<Dim>& space = *form.Space;
  const std::size_t count = static_cast<std::size_t>(space.NumElements());
  std::vector<double> sums((count + ElementChunk - 1) / ElementChunk, 0.0);
  ParallelFor(count, ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::map<IntArray<Dim>, ElementQuadrature<Dim>> rules;
      Eigen::Index total = 0;
      for (std::size_t e = begin; e < end; ++e)
      {
        total += RuleOf<Dim>(space.Elements[e].Degree, rules).Weights.size();
      }
      PointMatrix local(total, Dim);
      Eigen::VectorXd weights(total);
      std::vector<int> elements;
      elements.reserve(static_cast<std::size_t>(total));
      for (std::size_t e = begin; e < end; ++e)
      {
        const auto& element = space.Elements[e];
        const ElementQuadrature<Dim>& rule = RuleOf<Dim>(element.Degree, rules);
        double volume = 1.0;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          volume *= element.Box.Upper[d] - element.Box.Lower[d];
        }
        const Eigen::Index first = static_cast<Eigen::Index>(elements.size());
        local.middleRows(first, rule.Local.rows()) = rule.Local;
        weights.segment(first, rule.Local.rows()) = volume * rule.Weights;
        elements.insert(
          elements.end(), static_cast<std::size_t>(rule.Local.rows()), static_cast<int>(e));
      }
      EvaluationParams params;
      params.Derivatives = kind == QualityKind::Uniformity || ReadsSecondDerivatives(kind) ? 2 : 1;
      params.Threads = 1;
      EvaluationBatch batch;
      EvaluateElements<Dim>(form, elements, local, params, batch);
      double& sum = sums[begin / ElementChunk];
      for (Eigen::Index i = 0; i < total; ++i)
      {
        sum += weights(i) * Integrand<Dim>(kind, batch, i);
      }
    });
  double value = 0.0;
  for (double sum : sums)
  {
    value += sum;
  }
  return value;
}

template <int Dim>
double QualityValue(const SplineSpacePtr<Dim>& space, const PointMatrixView& controlPoints,
  QualityKind kind, int threads)
{
  Spline<Dim> map;
  map.Space = space;
  map.ControlPoints = controlPoints;
  return QualityValue(MakeBezierForm(map, threads), kind, threads);
}

template <int Dim>
Eigen::SparseMatrix<double, Eigen::RowMajor> QuadraticMatrix(const SplineSpace<Dim>& space,
  double uniformity, double length, int threads, const std::vector<double>& lengths)
{
  const LineTables<Dim> tables(space);
  const std::size_t size =
    static_cast<std::size_t>(space.IsIdentityMap() ? space.NumFunctions : space.NumLocalFunctions);
  // Where every local function appears: element and number on it, by function.
  std::vector<std::size_t> first(size + 1, 0);
  for (int j : space.LocalFunctionIds)
  {
    ++first[static_cast<std::size_t>(j) + 1];
  }
  for (std::size_t j = 0; j < size; ++j)
  {
    first[j + 1] += first[j];
  }
  struct Place
  {
    int Element;
    int Number;
  };
  std::vector<Place> places(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const int n = NumTensorFunctions<Dim>(space.Elements[static_cast<std::size_t>(e)].Degree);
    for (int i = 0; i < n; ++i)
    {
      places[next[static_cast<std::size_t>(space.LocalFunctions(e)[i])]++] = { e, i };
    }
  }

  constexpr std::size_t chunk = 256;
  std::vector<SparseLines> chunks((size + chunk - 1) / chunk);
  ParallelFor(size, chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      SparseLineSum sum(size);
      std::vector<double> row;
      for (std::size_t j = begin; j < end; ++j)
      {
        for (std::size_t k = first[j]; k < first[j + 1]; ++k)
        {
          const int e = places[k].Element;
          const double ownLength =
            length + (lengths.empty() ? 0.0 : lengths[static_cast<std::size_t>(e)]);
          if (!(uniformity > 0.0 || ownLength > 0.0))
          {
            continue;
          }
          const IntArray<Dim>& degree = space.Elements[static_cast<std::size_t>(e)].Degree;
          const int n = NumTensorFunctions<Dim>(degree);
          row.resize(static_cast<std::size_t>(n));
          ElementRow<Dim>(tables, degree, e, places[k].Number, uniformity, ownLength, row.data());
          const int* ids = space.LocalFunctions(e);
          for (int i = 0; i < n; ++i)
          {
            sum.Add(ids[i], row[static_cast<std::size_t>(i)]);
          }
        }
        sum.MoveTo(chunks[begin / chunk]);
      }
    });
  return JoinLines<Eigen::RowMajor>(
    chunks, static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
}

template <int Dim>
Eigen::SparseMatrix<double, Eigen::RowMajor> TruncationMatrix(const SplineSpace<Dim>& space)
{
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(space.NumLocalFunctions, space.NumFunctions);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(space.RowFunction.size()));
  std::transform(space.RowStart.begin(), space.RowStart.end(), matrix.outerIndexPtr(),
    [](std::size_t start) { return static_cast<int>(start); });
  std::copy(space.RowFunction.begin(), space.RowFunction.end(), matrix.innerIndexPtr());
  std::copy(space.RowCoefficient.begin(), space.RowCoefficient.end(), matrix.valuePtr());
  return matrix;
}

template <int Dim>
Eigen::SparseMatrix<double> LowerInFunctions(
  const SplineSpace<Dim>& space, const Eigen::SparseMatrix<double, Eigen::RowMajor>& local)
{
  using ColumnMatrix = Eigen::SparseMatrix<double>;
  if (space.IsIdentityMap())
  {
    return ColumnMatrix(local.template triangularView<Eigen::Lower>());
  }
  using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const RowMatrix map = TruncationMatrix<Dim>(space);
  const RowMatrix product = RowMatrix(map.transpose()) * RowMatrix(local * map);
  return ColumnMatrix(product.template triangularView<Eigen::Lower>());
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template int QualityResiduals<Dim>(QualityKind, const QualityJet<Dim>&, QualityResidual<Dim>*);  \
  template double QualityValue<Dim>(const BezierForm<Dim>&, QualityKind, int);                     \
  template double QualityValue<Dim>(                                                               \
    const SplineSpacePtr<Dim>&, const PointMatrixView&, QualityKind, int);                         \
  template Eigen::SparseMatrix<double, Eigen::RowMajor> QuadraticMatrix<Dim>(                      \
    const SplineSpace<Dim>&, double, double, int, const std::vector<double>&);                     \
  template Eigen::SparseMatrix<double, Eigen::RowMajor> TruncationMatrix<Dim>(                     \
    const SplineSpace<Dim>&);                                                                      \
  template Eigen::SparseMatrix<double> LowerInFunctions<Dim>(                                      \
    const SplineSpace<Dim>&, const Eigen::SparseMatrix<double, Eigen::RowMajor>&)
KNOTWORK_INSTANTIATE(2);
KNOTWORK_INSTANTIATE(3);
#undef KNOTWORK_INSTANTIATE
}
