// SPDX-License-Identifier: BSD-3-Clause
#include "VolumePoints.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 32;
constexpr std::size_t FunctionChunk = 256;
constexpr int MaxSteps = 300; // of conjugate gradients

std::size_t At(std::ptrdiff_t i)
{
  return static_cast<std::size_t>(i);
}

void BernsteinLine(int p, double t, double* values)
{
  values[0] = 1.0;
  for (int k = 1; k <= p; ++k)
  {
    values[k] = t * values[k - 1];
    for (int i = k - 1; i > 0; --i)
    {
      values[i] = (1.0 - t) * values[i] + t * values[i - 1];
    }
    values[0] *= 1.0 - t;
  }
}

double Binomial(int n, int k)
{
  double value = 1.0;
  for (int i = 1; i <= k; ++i)
  {
    value *= static_cast<double>(n - k + i) / i;
  }
  return value;
}

/// Integrals over [0, 1] of products of derivatives of Bernstein polynomials of degree p.
Eigen::MatrixXd LineProducts(int p, int order)
{
  if (order > p)
  {
    return Eigen::MatrixXd::Zero(p + 1, p + 1);
  }
  const int q = p - order;
  Eigen::MatrixXd products(q + 1, q + 1);
  for (int i = 0; i <= q; ++i)
  {
    for (int j = 0; j <= q; ++j)
    {
      products(i, j) =
        Binomial(q, i) * Binomial(q, j) / Binomial(2 * q, i + j) / static_cast<double>(2 * q + 1);
    }
  }
  Eigen::MatrixXd differences = Eigen::MatrixXd::Identity(p + 1, p + 1);
  for (int r = 0; r < order; ++r)
  {
    const Eigen::Index rows = differences.rows() - 1;
    differences =
      (static_cast<double>(p - r) * (differences.bottomRows(rows) - differences.topRows(rows)))
        .eval();
  }
  return differences.transpose() * products * differences;
}

/// The energy of an element in its own parameters: integral of the sum of all squared second
/// derivatives.
Eigen::MatrixXd ElementEnergy(int p)
{
  const std::array<Eigen::MatrixXd, 3> line{ LineProducts(p, 0), LineProducts(p, 1),
    LineProducts(p, 2) };
  const int n = (p + 1) * (p + 1) * (p + 1);
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(n, n);
  const auto add = [&](double weight, const IntArray<3>& orders)
  {
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; j < n; ++j)
      {
        double value = weight;
        int restOfI = i;
        int restOfJ = j;
        for (const int order : orders)
        {
          value *= line[At(order)](restOfI % (p + 1), restOfJ % (p + 1));
          restOfI /= p + 1;
          restOfJ /= p + 1;
        }
        energy(i, j) += value;
      }
    }
  };
  add(1.0, { 2, 0, 0 });
  add(1.0, { 0, 2, 0 });
  add(1.0, { 0, 0, 2 });
  add(2.0, { 1, 1, 0 });
  add(2.0, { 1, 0, 1 });
  add(2.0, { 0, 1, 1 });
  return energy;
}

/// The equations, element by element: squares of Bernstein polynomials at the points where there
/// are many of them, else the points themselves.
class Equations
{
public:
  Equations(const ElementFunctions& functions, const VolumePoints& points, int degree,
    double smoothing, int threads)
    : Functions(functions), Points(points), Degree(degree), Threads(threads),
      N(At(functions.PerElement)), Energy(ElementEnergy(degree)), Result(functions.Functions.size())
  {
    const auto numElements = At(functions.NumElements());
    const double mean = static_cast<double>(points.Order.size()) / static_cast<double>(numElements);
    this->Energy *= smoothing * mean;
    this->SquareStart.assign(numElements + 1, 0);
    for (std::size_t e = 0; e < numElements; ++e)
    {
      const bool isDense = 2 * points.Count(e) > this->N;
      this->SquareStart[e + 1] = this->SquareStart[e] + (isDense ? this->N * this->N : 0);
    }
    this->Squares.resize(this->SquareStart.back());
    ParallelFor(numElements, ElementChunk, threads,
      [this](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          this->MakeSquares(e);
        }
      });
  }

  /// y = A x for a column.
  void Multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y)
  {
    this->ForEachElement(
      [this, &x](std::size_t e, Eigen::VectorXd& local, Eigen::VectorXd& image)
      {
        local.setZero();
        for (std::size_t k = this->Functions.Start[e]; k < this->Functions.Start[e + 1]; ++k)
        {
          const double* row = this->Functions.Row(k);
          const double value = x[this->Functions.Functions[k]];
          for (std::size_t b = 0; b < this->N; ++b)
          {
            local[static_cast<Eigen::Index>(b)] += row[b] * value;
          }
        }
        this->Apply(e, local, image);
      });
    this->Gather(y);
  }

  void Right(Eigen::Index column, Eigen::VectorXd& y)
  {
    this->ForEachElement(
      [this, column](std::size_t e, Eigen::VectorXd& values, Eigen::VectorXd& image)
      {
        image.setZero();
        for (std::size_t i = this->Points.Start[e]; i < this->Points.Start[e + 1]; ++i)
        {
          EvaluateVolumeBernstein(this->Degree, this->Points.Local.data() + 3 * i, values.data());
          image += this->Points.Values(static_cast<Eigen::Index>(i), column) * values;
        }
      });
    this->Gather(y);
  }

  Eigen::VectorXd Diagonal()
  {
    const auto n = static_cast<Eigen::Index>(this->N);
    ParallelFor(At(this->Functions.NumElements()), ElementChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        Eigen::VectorXd image(n);
        for (std::size_t e = begin; e < end; ++e)
        {
          for (std::size_t k = this->Functions.Start[e]; k < this->Functions.Start[e + 1]; ++k)
          {
            const Eigen::Map<const Eigen::VectorXd> row(this->Functions.Row(k), n);
            this->Apply(e, row, image);
            this->Result[k] = row.dot(image);
          }
        }
      });
    Eigen::VectorXd diagonal;
    this->Gather(diagonal);
    return diagonal;
  }

private:
  void MakeSquares(std::size_t e)
  {
    if (this->SquareStart[e] == this->SquareStart[e + 1])
    {
      return;
    }
    const auto n = static_cast<Eigen::Index>(this->N);
    Eigen::Map<Eigen::MatrixXd> square(this->Squares.data() + this->SquareStart[e], n, n);
    square.setZero();
    Eigen::VectorXd values(n);
    for (std::size_t i = this->Points.Start[e]; i < this->Points.Start[e + 1]; ++i)
    {
      EvaluateVolumeBernstein(this->Degree, this->Points.Local.data() + 3 * i, values.data());
      for (Eigen::Index b = 0; b < n; ++b)
      {
        square.col(b).tail(n - b) += values[b] * values.tail(n - b);
      }
    }
    square.triangularView<Eigen::StrictlyUpper>() = square.transpose();
  }

  /// Image of Bernstein coefficients on an element.
  template <typename Vector>
  void Apply(std::size_t e, const Vector& local, Eigen::VectorXd& image) const
  {
    const auto n = static_cast<Eigen::Index>(this->N);
    image.noalias() = this->Energy * local;
    if (this->SquareStart[e] < this->SquareStart[e + 1])
    {
      const Eigen::Map<const Eigen::MatrixXd> square(
        this->Squares.data() + this->SquareStart[e], n, n);
      image.noalias() += square * local;
      return;
    }
    Eigen::VectorXd values(n);
    for (std::size_t i = this->Points.Start[e]; i < this->Points.Start[e + 1]; ++i)
    {
      EvaluateVolumeBernstein(this->Degree, this->Points.Local.data() + 3 * i, values.data());
      image += values.dot(local) * values;
    }
  }

  /// make(element, workspace, image) writes the image's Bernstein coefficients; Result gets its
  /// product with every function of the element.
  template <typename Make>
  void ForEachElement(Make&& make)
  {
    ParallelFor(At(this->Functions.NumElements()), ElementChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        const auto n = static_cast<Eigen::Index>(this->N);
        Eigen::VectorXd workspace(n);
        Eigen::VectorXd image(n);
        for (std::size_t e = begin; e < end; ++e)
        {
          make(e, workspace, image);
          for (std::size_t k = this->Functions.Start[e]; k < this->Functions.Start[e + 1]; ++k)
          {
            this->Result[k] =
              Eigen::Map<const Eigen::VectorXd>(this->Functions.Row(k), n).dot(image);
          }
        }
      });
  }

  /// Sums the results of every function, in the order of the elements.
  void Gather(Eigen::VectorXd& y) const
  {
    y.resize(this->Functions.NumFunctions);
    ParallelFor(At(this->Functions.NumFunctions), FunctionChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t f = begin; f < end; ++f)
        {
          double sum = 0.0;
          for (std::size_t k = this->Functions.UseStart[f]; k < this->Functions.UseStart[f + 1];
               ++k)
          {
            sum += this->Result[this->Functions.Uses[k]];
          }
          y[static_cast<Eigen::Index>(f)] = sum;
        }
      });
  }

  const ElementFunctions& Functions;
  const VolumePoints& Points;
  int Degree;
  int Threads;
  std::size_t N;
  Eigen::MatrixXd Energy;
  std::vector<std::size_t> SquareStart;
  UntouchedVector<double> Squares;
  std::vector<double> Result; // an entry of Functions
};
}

VolumePoints GroupVolumePoints(const SplineSpace<3>& space, const VolumeCloud& cloud)
{
  const auto n = At(cloud.Points.rows());
  std::vector<int> elements(n);
  std::vector<double> local(3 * n);
  space.Locate(cloud.Points.data(), 3, n, elements.data(), local.data());
  VolumePoints points;
  points.Start.assign(space.Elements.size() + 1, 0);
  for (const int e : elements)
  {
    ++points.Start[At(e) + 1];
  }
  std::partial_sum(points.Start.begin(), points.Start.end(), points.Start.begin());
  std::vector<std::size_t> next(points.Start.begin(), points.Start.end() - 1);
  points.Order.resize(n);
  points.Local.resize(3 * n);
  points.Values.resize(cloud.Values.rows(), cloud.Values.cols());
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t place = next[At(elements[i])]++;
    points.Order[place] = static_cast<int>(i);
    std::copy_n(local.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
      points.Local.begin() + static_cast<std::ptrdiff_t>(3 * place));
    points.Values.row(static_cast<Eigen::Index>(place)) =
      cloud.Values.row(static_cast<Eigen::Index>(i));
  }
  return points;
}

void EvaluateVolumeBernstein(int degree, const double* local, double* values)
{
  std::array<std::array<double, MaxDegree + 1>, 3> lines;
  for (std::size_t d = 0; d < 3; ++d)
  {
    BernsteinLine(degree, local[d], lines[d].data());
  }
  for (int k = 0; k <= degree; ++k)
  {
    for (int j = 0; j <= degree; ++j)
    {
      const double across = lines[1][At(j)] * lines[2][At(k)];
      for (int i = 0; i <= degree; ++i)
      {
        *values++ = lines[0][At(i)] * across;
      }
    }
  }
}

void SolveVolumeLeastSquares(const ElementFunctions& functions, const VolumePoints& points,
  int degree, double smoothing, double accuracy, int threads, PointMatrix& coefficients)
{
  Equations equations(functions, points, degree, smoothing, threads);
  const Eigen::VectorXd diagonal = equations.Diagonal();
  Eigen::VectorXd inverse = Eigen::VectorXd::Ones(diagonal.size());
  for (Eigen::Index f = 0; f < diagonal.size(); ++f)
  {
    inverse[f] = diagonal[f] > 0.0 ? 1.0 / diagonal[f] : 1.0;
  }
  for (Eigen::Index c = 0; c < coefficients.cols(); ++c)
  {
    Eigen::VectorXd x = coefficients.col(c);
    Eigen::VectorXd residual, image;
    equations.Right(c, residual);
    equations.Multiply(x, image);
    residual -= image;
    Eigen::VectorXd scaled = inverse.cwiseProduct(residual);
    Eigen::VectorXd direction = scaled;
    double product = residual.dot(scaled);
    for (int step = 0; step < MaxSteps && product > 0.0; ++step)
    {
      equations.Multiply(direction, image);
      const double curvature = direction.dot(image);
      const double length = product / curvature;
      if (!(curvature > 0.0) || !std::isfinite(length))
      {
        break;
      }
      x += length * direction;
      residual -= length * image;
      scaled = inverse.cwiseProduct(residual);
      // a change of a coefficient that its own equation asks for
      if (scaled.cwiseAbs().maxCoeff() <= accuracy)
      {
        break;
      }
      const double before = product;
      product = residual.dot(scaled);
      direction = scaled + (product / before) * direction;
    }
    coefficients.col(c) = x;
  }
}

void VolumeMultilevelStep(const ElementFunctions& functions, const VolumePoints& points, int degree,
  int threads, PointMatrix& coefficients)
{
  const Eigen::Index columns = coefficients.cols();
  const auto n = static_cast<Eigen::Index>(functions.PerElement);
  PointMatrix above =
    PointMatrix::Zero(static_cast<Eigen::Index>(functions.Functions.size()), columns);
  std::vector<double> below(functions.Functions.size(), 0.0);
  ParallelFor(At(functions.NumElements()), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Eigen::VectorXd bernstein(n);
      for (std::size_t e = begin; e < end; ++e)
      {
        const std::size_t first = functions.Start[e];
        const auto alive = static_cast<Eigen::Index>(functions.Start[e + 1] - first);
        const Eigen::Map<const PointMatrix> rows(functions.Row(first), alive, n);
        Eigen::VectorXd weights(alive);
        for (std::size_t i = points.Start[e]; i < points.Start[e + 1]; ++i)
        {
          EvaluateVolumeBernstein(degree, points.Local.data() + 3 * i, bernstein.data());
          weights.noalias() = rows * bernstein;
          Eigen::RowVectorXd rest = points.Values.row(static_cast<Eigen::Index>(i));
          for (Eigen::Index k = 0; k < alive; ++k)
          {
            rest -= weights[k] * coefficients.row(functions.Functions[first + At(k)]);
          }
          rest /= weights.squaredNorm();
          for (Eigen::Index k = 0; k < alive; ++k)
          {
            const double square = weights[k] * weights[k];
            above.row(static_cast<Eigen::Index>(first) + k) += square * weights[k] * rest;
            below[first + At(k)] += square;
          }
        }
      }
    });
  for (std::size_t f = 0; f < At(functions.NumFunctions); ++f)
  {
    Eigen::RowVectorXd change = Eigen::RowVectorXd::Zero(columns);
    double weight = 0.0;
    for (std::size_t k = functions.UseStart[f]; k < functions.UseStart[f + 1]; ++k)
    {
      change += above.row(static_cast<Eigen::Index>(functions.Uses[k]));
      weight += below[functions.Uses[k]];
    }
    if (weight > 0.0)
    {
      coefficients.row(static_cast<Eigen::Index>(f)) += change / weight;
    }
  }
}
}
