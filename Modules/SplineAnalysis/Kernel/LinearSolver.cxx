// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSolver.h"

#include "ElementRule.h"
#include <knotwork/MeshParameterization/SparseCholesky.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace knotwork
{
namespace
{
using Vector = Eigen::VectorXd;
constexpr Eigen::Index Chunk = 4096; // of vectors: sums are those of chunks, in order
constexpr int NumBlocks = 8;         // of columns

/// Calls for segments of vectors.
template <typename Body>
void ForSegments(Eigen::Index size, int threads, const Body& body)
{
  ParallelFor(static_cast<std::size_t>(size), Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    { body(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin)); });
}

double Dot(const Vector& a, const Vector& b, int threads)
{
  std::vector<double> sums(static_cast<std::size_t>((a.size() + Chunk - 1) / Chunk));
  ForSegments(a.size(), threads,
    [&](Eigen::Index first, Eigen::Index count)
    {
      sums[static_cast<std::size_t>(first / Chunk)] =
        a.segment(first, count).dot(b.segment(first, count));
    });
  double sum = 0.0;
  for (const double part : sums)
  {
    sum += part;
  }
  return sum;
}

/// A symmetric matrix by its lower triangle, whose columns are divided into blocks of about as many
/// entries.
class SymmetricMatrix
{
public:
  SymmetricMatrix(const Eigen::SparseMatrix<double>& lower, int threads)
    : Lower(lower), Threads(threads)
  {
    const Eigen::Index n = lower.cols();
    for (int k = 1; k <= NumBlocks; ++k)
    {
      const double share = static_cast<double>(lower.nonZeros()) / NumBlocks * k;
      Eigen::Index end = this->Ends.back();
      while (end < n && (k == NumBlocks || lower.outerIndexPtr()[end] < share))
      {
        ++end;
      }
      Eigen::Index behind = end; // of the rows that the columns have entries in
      for (Eigen::Index j = this->Ends.back(); j < end; ++j)
      {
        behind = std::max(behind, Eigen::Index{ lower.innerIndexPtr()[this->End(j) - 1] } + 1);
      }
      this->Parts.emplace_back(behind - this->Ends.back());
      this->Ends.push_back(end);
    }
  }

  void Multiply(const Vector& x, Vector& y)
  {
    this->ForBlocks(
      [&](std::size_t k, Eigen::Index begin, Eigen::Index end)
      {
        Vector& part = this->Parts[k];
        part.setZero();
        double* to = part.data() - begin;
        for (Eigen::Index j = begin; j < end; ++j)
        {
          const double xj = x[j];
          int place = this->Begin(j);
          double sum = this->Value(place) * xj; // the diagonal
          for (++place; place < this->End(j); ++place)
          {
            const int i = this->Row(place);
            sum += this->Value(place) * x[i];
            to[i] += this->Value(place) * xj;
          }
          to[j] += sum;
        }
      });
    y.resize(x.size());
    ForSegments(x.size(), this->Threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        y.segment(first, count).setZero();
        for (std::size_t k = 0; k < NumBlocks; ++k)
        {
          const Eigen::Index begin = std::max(first, this->Ends[k]);
          const Eigen::Index end = std::min(first + count, this->Ends[k] + this->Parts[k].size());
          if (begin < end)
          {
            y.segment(begin, end - begin) +=
              this->Parts[k].segment(begin - this->Ends[k], end - begin);
          }
        }
      });
  }

  /// One step forth and back from 0 within each block.
  void GaussSeidel(const Vector& side, Vector& x) const
  {
    x = side;
    this->ForBlocks(
      [&](std::size_t, Eigen::Index begin, Eigen::Index end)
      {
        for (Eigen::Index j = begin; j < end; ++j)
        {
          const double xj = x[j] / this->Value(this->Begin(j));
          for (int place = this->Begin(j) + 1; place < this->End(j) && this->Row(place) < end;
               ++place)
          {
            x[this->Row(place)] -= this->Value(place) * xj;
          }
        }
        for (Eigen::Index j = end; j-- > begin;)
        {
          double sum = x[j];
          for (int place = this->Begin(j) + 1; place < this->End(j) && this->Row(place) < end;
               ++place)
          {
            sum -= this->Value(place) * x[this->Row(place)];
          }
          x[j] = sum / this->Value(this->Begin(j));
        }
      });
  }

private:
  int Begin(Eigen::Index column) const { return this->Lower.outerIndexPtr()[column]; }
  int End(Eigen::Index column) const { return this->Lower.outerIndexPtr()[column + 1]; }
  int Row(int place) const { return this->Lower.innerIndexPtr()[place]; }
  double Value(int place) const { return this->Lower.valuePtr()[place]; }
  template <typename Body>
  void ForBlocks(const Body& body) const
  {
    ParallelFor(NumBlocks, 1, this->Threads,
      [&](std::size_t k, std::size_t) { body(k, this->Ends[k], this->Ends[k + 1]); });
  }

  const Eigen::SparseMatrix<double>& Lower;
  int Threads;
  std::vector<Eigen::Index> Ends{ 0 };
  std::vector<Vector> Parts; ///< of a product, from the first row of a block
};

class Preconditioner
{
public:
  virtual ~Preconditioner() = default;
  /// An approximate solution.
  virtual void Apply(const Vector& side, Vector& x) = 0;
};

/// Mass and stiffness of the functions of a knot vector.
void IntegrateLine(const KnotVector& knots, Eigen::MatrixXd& mass, Eigen::MatrixXd& stiffness)
{
  const int p = knots.Degree();
  const QuadratureRule rule = GaussLegendre(p + 1);
  mass.setZero(knots.NumFunctions(), knots.NumFunctions());
  stiffness = mass;
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> values(2, p + 1);
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    const double begin = knots.Breaks()[static_cast<std::size_t>(e)];
    const double width = knots.Breaks()[static_cast<std::size_t>(e) + 1] - begin;
    const int first = knots.Span(e) - p;
    for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
    {
      knots.EvaluateFunctions(e, begin + width * rule.Nodes[q], 1, values.data());
      const double weight = width * rule.Weights[q];
      mass.block(first, first, p + 1, p + 1) += weight * values.row(0).transpose() * values.row(0);
      stiffness.block(first, first, p + 1, p + 1) +=
        weight * values.row(1).transpose() * values.row(1);
    }
  }
}

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

/// The Laplacian of the parameters of a tensor-product patch on the functions behind sides that are
/// given as a whole, for one component.
class FastDiagonalization : public Preconditioner
{
public:
  FastDiagonalization(const GalerkinSpace& space, int components, int component,
    const std::vector<int>& numbers, const Vector& diagonal, int threads)
    : Threads(threads)
  {
    const std::size_t dimension = space.Knots.size();
    std::array<int, 3> counts{ 1, 1, 1 };
    for (std::size_t d = 0; d < dimension; ++d)
    {
      counts[d] = space.Knots[d].NumFunctions();
    }
    const auto numberOf = [&](const std::array<int, 3>& i)
    {
      const auto f = static_cast<std::size_t>(i[0]) +
        static_cast<std::size_t>(counts[0]) *
          (static_cast<std::size_t>(i[1]) +
            static_cast<std::size_t>(counts[1]) * static_cast<std::size_t>(i[2]));
      return numbers[f * static_cast<std::size_t>(components) +
        static_cast<std::size_t>(component)];
    };
    const auto forAll =
      [](const std::array<int, 3>& low, const std::array<int, 3>& high, const auto& visit)
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
        forAll(low, high, [&](const std::array<int, 3>& i) { given = given && numberOf(i) < 0; });
        (end == 0 ? first[d] : last[d]) += given ? (end == 0 ? 1 : -1) : 0;
      }
      last[d] = std::max(last[d], first[d]);
    }
    const std::array<double, 3> stretches = MeanStretches(space);
    std::array<Vector, 3> masses;
    std::array<Vector, 3> stiffnesses;
    Vector sums = Vector::Zero(1);
    for (std::size_t d = 0; d < 3; ++d)
    {
      this->Counts[d] = last[d] - first[d];
      const Eigen::Index n = this->Counts[d];
      masses[d] = Vector::Ones(n);
      stiffnesses[d] = Vector::Zero(n);
      if (d >= dimension || n == 0)
      {
        continue;
      }
      Eigen::MatrixXd mass;
      Eigen::MatrixXd stiffness;
      IntegrateLine(space.Knots[d], mass, stiffness);
      mass = mass.block(first[d], first[d], n, n).eval();
      stiffness = (stretches[d] * stiffness.block(first[d], first[d], n, n)).eval();
      masses[d] = mass.diagonal();
      stiffnesses[d] = stiffness.diagonal();
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
      this->Modes[d] = solver.eigenvectors();
      Vector grown(sums.size() * n);
      for (Eigen::Index i = 0; i < n; ++i)
      {
        grown.segment(i * sums.size(), sums.size()) = sums.array() + solver.eigenvalues()[i];
      }
      sums = grown;
    }
    const Eigen::Index size = this->Counts[0] * this->Counts[1] * this->Counts[2];
    if (size == 0)
    {
      return;
    }
    // the constant, where no side is given: as large as the next
    const double zero = 1e-12 * sums.maxCoeff();
    const double least = (sums.array() > zero).select(sums.array(), sums.maxCoeff()).minCoeff();
    this->Inverse = sums.cwiseMax(least).cwiseInverse();
    this->Unknowns.reserve(static_cast<std::size_t>(size));
    this->Scales.setZero(size);
    forAll(first, last,
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
              term *= (k == d ? stiffnesses : masses)[k][i[k] - first[k]];
            }
            own += term;
          }
          this->Scales[static_cast<Eigen::Index>(this->Unknowns.size())] =
            std::sqrt(own / diagonal[number]);
        }
        this->Unknowns.push_back(number);
      });
    this->Values.resize(size);
    this->Other.resize(size);
  }

  /// Writes the unknowns of its component alone.
  void Apply(const Vector& side, Vector& x) override
  {
    const Eigen::Index size = this->Inverse.size();
    ForSegments(size, this->Threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        for (Eigen::Index i = first; i < first + count; ++i)
        {
          const int number = this->Unknowns[static_cast<std::size_t>(i)];
          this->Values[i] = number < 0 ? 0.0 : this->Scales[i] * side[number];
        }
      });
    this->Multiply(true);
    ForSegments(size, this->Threads,
      [&](Eigen::Index first, Eigen::Index count) {
        this->Values.segment(first, count).array() *= this->Inverse.segment(first, count).array();
      });
    this->Multiply(false);
    ForSegments(size, this->Threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        for (Eigen::Index i = first; i < first + count; ++i)
        {
          const int number = this->Unknowns[static_cast<std::size_t>(i)];
          if (number >= 0)
          {
            x[number] = this->Scales[i] * this->Values[i];
          }
        }
      });
  }

private:
  /// The values by the modes of all directions, or by their transposes.
  void Multiply(bool transposed)
  {
    using Strided = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
    constexpr std::size_t Rows = 256; // of a product at a time
    const Eigen::Index size = this->Inverse.size();
    Eigen::Index inner = 1;
    for (std::size_t d = 0; d < 3; ++d)
    {
      const Eigen::MatrixXd& modes = this->Modes[d];
      const Eigen::Index n = modes.rows();
      if (n == 0)
      {
        continue; // a direction that the patch does not have
      }
      const Eigen::MatrixXd matrix = transposed ? modes : Eigen::MatrixXd(modes.transpose());
      if (d == 0)
      {
        ParallelFor(static_cast<std::size_t>(size / n), Rows, this->Threads,
          [&](std::size_t begin, std::size_t end)
          {
            const auto first = static_cast<Eigen::Index>(begin) * n;
            const auto columns = static_cast<Eigen::Index>(end - begin);
            Eigen::Map<Eigen::MatrixXd>(this->Other.data() + first, n, columns).noalias() =
              matrix.transpose() *
              Eigen::Map<Eigen::MatrixXd>(this->Values.data() + first, n, columns);
          });
      }
      else
      {
        const Eigen::Index slabs = size / (inner * n);
        const auto parts = (static_cast<std::size_t>(inner) + Rows - 1) / Rows;
        ParallelFor(static_cast<std::size_t>(slabs) * parts, 1, this->Threads,
          [&](std::size_t k, std::size_t)
          {
            const auto row = static_cast<Eigen::Index>(k % parts * Rows);
            const Eigen::Index rows = std::min<Eigen::Index>(Rows, inner - row);
            const Eigen::Index first = static_cast<Eigen::Index>(k / parts) * inner * n + row;
            const Eigen::OuterStride<> stride(inner);
            Strided(this->Other.data() + first, rows, n, stride).noalias() =
              Strided(this->Values.data() + first, rows, n, stride) * matrix;
          });
      }
      this->Values.swap(this->Other);
      inner *= n;
    }
  }

  int Threads;
  std::array<Eigen::Index, 3> Counts{ 1, 1, 1 };
  std::array<Eigen::MatrixXd, 3> Modes; ///< mass-orthonormal, columns
  Vector Inverse;                       ///< of sums of eigenvalues
  std::vector<int> Unknowns;            ///< of the functions; -1: given
  Vector Scales;
  Vector Values;
  Vector Other;
};

/// One component after the other.
class ComponentWise : public Preconditioner
{
public:
  ComponentWise(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
    const Vector& diagonal, int threads)
  {
    for (int c = 0; c < components; ++c)
    {
      this->Parts.emplace_back(space, components, c, numbers, diagonal, threads);
    }
  }
  void Apply(const Vector& side, Vector& x) override
  {
    x.setZero(side.size());
    for (FastDiagonalization& part : this->Parts)
    {
      part.Apply(side, x);
    }
  }

private:
  std::vector<FastDiagonalization> Parts;
};

/// Gauss-Seidel alone.
class OneLevel : public Preconditioner
{
public:
  explicit OneLevel(const SymmetricMatrix& matrix) : Matrix(matrix) {}
  void Apply(const Vector& side, Vector& x) override { this->Matrix.GaussSeidel(side, x); }

private:
  const SymmetricMatrix& Matrix;
};

/// Gauss-Seidel, and the constants of the control points in each cell of a grid.
class TwoLevels : public Preconditioner
{
public:
  TwoLevels(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
    const Eigen::SparseMatrix<double>& lower, const SymmetricMatrix& matrix)
    : Matrix(matrix), CoarseOf(static_cast<std::size_t>(lower.cols()))
  {
    constexpr double CellFunctions = 250; // in the mean, if points filled their box
    const Eigen::RowVectorXd low = space.Points.colwise().minCoeff();
    const Eigen::RowVectorXd size = space.Points.colwise().maxCoeff() - low;
    const double width =
      std::pow(size.prod() * CellFunctions / space.NumFunctions(), 1.0 / space.Dimension);
    std::unordered_map<std::uint64_t, int> cells;
    for (int f = 0; f < space.NumFunctions(); ++f)
    {
      std::uint64_t cell = 0;
      for (int d = 0; d < space.Dimension; ++d)
      {
        cell = cell << 20U | static_cast<std::uint64_t>((space.Points(f, d) - low[d]) / width);
      }
      for (int c = 0; c < components; ++c)
      {
        const int number =
          numbers[static_cast<std::size_t>(f) * static_cast<std::size_t>(components) +
            static_cast<std::size_t>(c)];
        if (number >= 0)
        {
          this->CoarseOf[static_cast<std::size_t>(number)] =
            cells
              .try_emplace(
                cell << 2U | static_cast<std::uint64_t>(c), static_cast<int>(cells.size()))
              .first->second;
        }
      }
    }
    // entries between cells, added column by column
    std::unordered_map<std::uint64_t, double> entries;
    for (Eigen::Index j = 0; j < lower.cols(); ++j)
    {
      const int column = this->CoarseOf[static_cast<std::size_t>(j)];
      for (Eigen::SparseMatrix<double>::InnerIterator it(lower, j); it; ++it)
      {
        const int row = this->CoarseOf[static_cast<std::size_t>(it.row())];
        const bool twice = row == column && it.row() != j;
        entries[static_cast<std::uint64_t>(std::max(row, column)) << 32U |
          static_cast<std::uint64_t>(std::min(row, column))] +=
          twice ? 2.0 * it.value() : it.value();
      }
    }
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (const auto& entry : entries)
    {
      triplets.emplace_back(static_cast<int>(entry.first >> 32U),
        static_cast<int>(entry.first & 0xffffffffU), entry.second);
    }
    const auto count = static_cast<Eigen::Index>(cells.size());
    Eigen::SparseMatrix<double> coarse(count, count);
    coarse.setFromTriplets(triplets.begin(), triplets.end());
    this->HasCoarse = static_cast<bool>(this->Coarse.Factorize(coarse));
    this->Sums.resize(count, 1);
  }

  void Apply(const Vector& side, Vector& x) override
  {
    this->Matrix.GaussSeidel(side, x);
    if (!this->HasCoarse)
    {
      return;
    }
    this->Sums.setZero();
    for (Eigen::Index i = 0; i < side.size(); ++i)
    {
      this->Sums(this->CoarseOf[static_cast<std::size_t>(i)], 0) += side[i];
    }
    this->Coarse.Solve(this->Sums);
    for (Eigen::Index i = 0; i < side.size(); ++i)
    {
      x[i] += this->Sums(this->CoarseOf[static_cast<std::size_t>(i)], 0);
    }
  }

private:
  const SymmetricMatrix& Matrix;
  std::vector<int> CoarseOf; ///< unknowns
  SparseCholesky Coarse;
  bool HasCoarse = false;
  Eigen::MatrixXd Sums;
};

Status Factorize(const Eigen::SparseMatrix<double>& lower, Eigen::MatrixXd& sides)
{
  SparseCholesky factor;
  if (const Status status = factor.Factorize(lower); !status)
  {
    return { ErrorCode::SingularSystem,
      "the matrix is not positive definite: functions are dependent, or materials or elements "
      "differ too much" };
  }
  const Eigen::MatrixXd right = sides;
  factor.Solve(sides);
  // one step of refinement: what is left is rounding of the residual
  Eigen::MatrixXd rest = right - lower.selfadjointView<Eigen::Lower>() * sides;
  factor.Solve(rest);
  sides += rest;
  return {};
}

Status CheckDiagonal(const Vector& diagonal)
{
  return diagonal.minCoeff() > 0.0
    ? Status()
    : Status{ ErrorCode::SingularSystem,
        "the matrix is not positive definite: a function has no part in any element" };
}

/// Conjugate gradients from 0. @source  Hestenes, Stiefel, J. Res. NBS 49 (1952) 409-436.
Status Iterate(SymmetricMatrix& matrix, Preconditioner& preconditioner, double tolerance,
  int threads, Vector& x, int& iterations)
{
  constexpr int Limit = 20000;
  Vector residual = x;
  x.setZero();
  double norm = std::sqrt(Dot(residual, residual, threads));
  const double start = norm;
  const double goal = tolerance * start;
  Vector step;
  Vector product;
  preconditioner.Apply(residual, product);
  Vector way = product;
  double slope = Dot(residual, product, threads);
  for (iterations = 0; norm > goal && iterations < Limit; ++iterations)
  {
    matrix.Multiply(way, product);
    const double length = slope / Dot(way, product, threads);
    ForSegments(x.size(), threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        x.segment(first, count) += length * way.segment(first, count);
        residual.segment(first, count) -= length * product.segment(first, count);
      });
    norm = std::sqrt(Dot(residual, residual, threads));
    if (!std::isfinite(norm))
    {
      break;
    }
    preconditioner.Apply(residual, step);
    const double next = Dot(residual, step, threads);
    const double keep = next / slope;
    slope = next;
    ForSegments(x.size(), threads,
      [&](Eigen::Index first, Eigen::Index count) {
        way.segment(first, count) = step.segment(first, count) + keep * way.segment(first, count);
      });
  }
  if (!(norm <= goal))
  {
    return { ErrorCode::NotConverged,
      "conjugate gradients stopped at a residual of " + std::to_string(norm / start) +
        "; raise the limit of factorization" };
  }
  return {};
}
}

Status SolveUnknowns(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
  const Eigen::SparseMatrix<double>& lower, const GalerkinParams& params, Eigen::MatrixXd& sides,
  LinearSolverReport& report)
{
  if (lower.rows() <= params.DirectLimit)
  {
    return Factorize(lower, sides);
  }
  const Vector diagonal = lower.diagonal();
  if (const Status status = CheckDiagonal(diagonal); !status)
  {
    return status;
  }
  SymmetricMatrix matrix(lower, params.Threads);
  std::unique_ptr<Preconditioner> preconditioner;
  if (!space.Knots.empty())
  {
    report.Preconditioner = "fast diagonalization";
    preconditioner =
      std::make_unique<ComponentWise>(space, components, numbers, diagonal, params.Threads);
  }
  else
  {
    report.Preconditioner = "Gauss-Seidel and constants of cells";
    preconditioner = std::make_unique<TwoLevels>(space, components, numbers, lower, matrix);
  }
  Vector x = sides.col(0);
  const Status status =
    Iterate(matrix, *preconditioner, params.Tolerance, params.Threads, x, report.Iterations);
  sides.col(0) = x;
  return status;
}

Status SolveMass(const Eigen::SparseMatrix<double>& lower, int threads, Eigen::MatrixXd& sides)
{
  constexpr double Tolerance = 1e-13;
  if (const Status status = CheckDiagonal(lower.diagonal()); !status)
  {
    return status;
  }
  SymmetricMatrix matrix(lower, threads);
  OneLevel preconditioner(matrix);
  for (Eigen::Index c = 0; c < sides.cols(); ++c)
  {
    Vector x = sides.col(c);
    int iterations = 0;
    if (const Status status = Iterate(matrix, preconditioner, Tolerance, threads, x, iterations);
        !status)
    {
      return status;
    }
    sides.col(c) = x;
  }
  return {};
}
}
