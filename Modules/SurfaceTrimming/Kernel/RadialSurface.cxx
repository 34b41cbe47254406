// SPDX-License-Identifier: BSD-3-Clause
#include "RadialSurface.h"

#include "DenseCholesky.h"
#include "RadialKernel.h"

#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
constexpr std::size_t PointChunk = 64;
/// Centres that the greedy choice begins with.
constexpr int FirstCentres = 250;
constexpr int GridRounds = 4;
constexpr int MaxRounds = 16;

/// A <- H A H with the Householder reflection H = I - factor v v^T, A symmetric.
void Reflect(Eigen::MatrixXd& matrix, const Eigen::VectorXd& v, double factor)
{
  const Eigen::VectorXd product = factor * (matrix * v);
  const Eigen::VectorXd w = product - (0.5 * factor * product.dot(v)) * v;
  matrix.noalias() -= v * w.transpose();
  matrix.noalias() -= w * v.transpose();
}

PointMatrix RowsOf(const PointMatrix& all, const std::vector<int>& rows)
{
  PointMatrix some(static_cast<Eigen::Index>(rows.size()), all.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    some.row(static_cast<Eigen::Index>(i)) = all.row(rows[i]);
  }
  return some;
}

/// Rows far from each other, the one of least parameters first.
std::vector<int> FarRows(const PointMatrix& parameters, const std::vector<int>& from, int count)
{
  int next = *std::min_element(from.begin(), from.end(),
    [&](int a, int b)
    {
      return std::make_pair(parameters(a, 0), parameters(a, 1)) <
        std::make_pair(parameters(b, 0), parameters(b, 1));
    });
  std::vector<double> distance(from.size(), std::numeric_limits<double>::infinity());
  std::vector<int> rows;
  while (static_cast<int>(rows.size()) < count)
  {
    rows.push_back(next);
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      distance[i] =
        std::min(distance[i], (parameters.row(from[i]) - parameters.row(next)).squaredNorm());
      farthest = distance[i] > distance[farthest] ? i : farthest;
    }
    next = from[farthest];
  }
  return rows;
}

/// Adds rows of the largest residuals beyond the tolerance, spread out: one a cell of a grid, which
/// is made finer until there are enough of them.
void AddFarOff(const PointMatrix& parameters, const Eigen::VectorXd& residuals,
  const std::vector<int>& from, std::size_t count, double tolerance, std::vector<int>& rows)
{
  const std::size_t wanted = rows.size() + count;
  std::vector<char> taken(static_cast<std::size_t>(parameters.rows()), 0);
  for (int row : rows)
  {
    taken[static_cast<std::size_t>(row)] = 1;
  }
  std::vector<int> order;
  for (int row : from)
  {
    if (!taken[static_cast<std::size_t>(row)] && residuals[row] > tolerance)
    {
      order.push_back(row);
    }
  }
  std::stable_sort(
    order.begin(), order.end(), [&](int a, int b) { return residuals[a] > residuals[b]; });
  const Eigen::RowVector2d lower = parameters.colwise().minCoeff();
  const Eigen::RowVector2d size = parameters.colwise().maxCoeff() - lower;
  double cell = std::sqrt(size.prod() / static_cast<double>(wanted));
  for (int round = 0; round < GridRounds; ++round, cell *= 0.5)
  {
    std::set<std::pair<int, int>> used;
    for (int row : order)
    {
      const Eigen::RowVector2d place = (parameters.row(row) - lower) / cell;
      if (rows.size() < wanted && !taken[static_cast<std::size_t>(row)] &&
        used.emplace(static_cast<int>(place[0]), static_cast<int>(place[1])).second)
      {
        taken[static_cast<std::size_t>(row)] = 1;
        rows.push_back(row);
      }
    }
  }
}
}

Result<RadialSurface> RadialSurface::Interpolate(
  const PointMatrix& parameters, const PointMatrix& points, int threads)
{
  const Eigen::Index n = parameters.rows();
  RadialSurface surface;
  const Eigen::RowVector2d lower = parameters.colwise().minCoeff();
  const Eigen::RowVector2d upper = parameters.colwise().maxCoeff();
  surface.Origin = 0.5 * (lower + upper);
  surface.Scale = 2.0 / (upper - lower).maxCoeff();
  surface.Centres = surface.Scale * (parameters.rowwise() - surface.Origin);

  Eigen::MatrixXd matrix(n, n);
  const RadialKernel kernel(surface.Centres);
  ParallelFor(static_cast<std::size_t>(n), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
      {
        kernel.Values(surface.Centres(i, 0), surface.Centres(i, 1), matrix.col(i).data());
      }
    });
  // Q^T A Q, Q that of the affine maps' QR: the part below and right of its first 3 is definite.
  Eigen::MatrixXd maps(n, 3);
  maps << Eigen::VectorXd::Ones(n), surface.Centres;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(maps);
  Eigen::MatrixXd sides = points;
  std::array<Eigen::VectorXd, 3> reflections;
  for (Eigen::Index k = 0; k < 3; ++k)
  {
    Eigen::VectorXd& v = reflections[static_cast<std::size_t>(k)];
    v = Eigen::VectorXd::Zero(n);
    v[k] = 1.0;
    v.tail(n - k - 1) = qr.matrixQR().col(k).tail(n - k - 1);
    Reflect(matrix, v, qr.hCoeffs()[k]);
    sides -= (qr.hCoeffs()[k] * v) * (v.transpose() * sides);
  }
  const Eigen::MatrixXd mixed = matrix.topRightCorner(3, n - 3);
  Eigen::Ref<Eigen::MatrixXd> definite = matrix.bottomRightCorner(n - 3, n - 3);
  const Eigen::Matrix3d triangle = qr.matrixQR().topRows(3).triangularView<Eigen::Upper>();
  const bool onLine = std::abs(triangle(2, 2)) <= 1e-12 * triangle.diagonal().cwiseAbs().maxCoeff();
  if (onLine || !FactorInPlace(definite, threads))
  {
    return { ErrorCode::SingularSystem,
      "radial basis functions do not determine a surface: points of the chart lie on a line or on "
      "one another in the plane" };
  }
  surface.Coefficients.setZero(n, points.cols());
  Eigen::MatrixXd weights = sides.bottomRows(n - 3);
  SolveFactored(definite, weights);
  surface.Coefficients.bottomRows(n - 3) = weights;
  surface.Affine = triangle.triangularView<Eigen::Upper>().solve(
    sides.topRows(3) - mixed * surface.Coefficients.bottomRows(n - 3));
  for (std::size_t k = 3; k-- > 0;)
  {
    const Eigen::VectorXd& v = reflections[k];
    surface.Coefficients -=
      (qr.hCoeffs()[static_cast<Eigen::Index>(k)] * v) * (v.transpose() * surface.Coefficients);
  }
  if (!surface.Coefficients.allFinite() || !surface.Affine.allFinite())
  {
    return { ErrorCode::SingularSystem, "radial basis functions overflow" };
  }
  return surface;
}

PointMatrix RadialSurface::Evaluate(const PointMatrix& parameters, int threads) const
{
  PointMatrix result(parameters.rows(), this->Coefficients.cols());
  std::vector<RadialKernel> kernels; // of so many components as one takes
  for (Eigen::Index c = 0; c < this->Coefficients.cols(); c += RadialKernel::MaxComponents)
  {
    kernels.emplace_back(this->Centres,
      this->Coefficients.middleCols(
        c, std::min<Eigen::Index>(RadialKernel::MaxComponents, this->Coefficients.cols() - c)));
  }
  ParallelFor(static_cast<std::size_t>(parameters.rows()), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
      {
        const Eigen::RowVector2d u = this->Scale * (parameters.row(i) - this->Origin);
        for (std::size_t k = 0; k < kernels.size(); ++k)
        {
          kernels[k].Sums(u[0], u[1],
            result.row(i).data() + k * static_cast<std::size_t>(RadialKernel::MaxComponents));
        }
        result.row(i) += this->Affine.row(0) + u * this->Affine.bottomRows(2);
      }
    });
  return result;
}

Result<RadialFit> FitRadialSurface(const PointMatrix& parameters, const PointMatrix& points,
  int maxCentres, double tolerance, int threads)
{
  const std::vector<int> first = FirstOfEqualPoints(parameters);
  std::vector<int> from;
  for (int row = 0; row < static_cast<int>(first.size()); ++row)
  {
    if (first[static_cast<std::size_t>(row)] == row)
    {
      from.push_back(row);
    }
  }
  RadialFit fit;
  const bool all = static_cast<int>(from.size()) <= maxCentres;
  fit.Rows = all ? from : FarRows(parameters, from, std::min(FirstCentres, maxCentres));
  for (int round = 0;; ++round)
  {
    std::sort(fit.Rows.begin(), fit.Rows.end());
    auto surface =
      RadialSurface::Interpolate(RowsOf(parameters, fit.Rows), RowsOf(points, fit.Rows), threads);
    if (!surface)
    {
      return surface.Status;
    }
    fit.Surface = std::move(surface.Value);
    const auto room = static_cast<std::size_t>(maxCentres) - fit.Rows.size();
    if (all || room == 0 || round == MaxRounds)
    {
      return fit;
    }
    const PointMatrix found = fit.Surface.Evaluate(parameters, threads);
    const Eigen::VectorXd residuals = (found - points).rowwise().norm();
    const std::size_t before = fit.Rows.size();
    AddFarOff(parameters, residuals, from, std::min(room, before), tolerance, fit.Rows);
    if (fit.Rows.size() == before)
    {
      return fit;
    }
  }
}
}
