// SPDX-License-Identifier: BSD-3-Clause
#include "InjectiveMap.h"

#include "FlattenReport.h"
#include "MeshWeights.h"
#include "ReferenceMaps.h"
#include "SparseCholesky.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double ShareOfStep = 0.8; // of the step at which a first triangle degenerates
constexpr double Pi = 3.14159265358979323846;

/// What does not change: gradients of the corners' functions, a column each, and areas.
struct Elements
{
  std::vector<Eigen::Matrix<double, 2, 3>> Gradients;
  std::vector<double> Areas;
};

Elements BuildElements(const DiscMesh& mesh)
{
  Elements elements;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const Eigen::Matrix2d sides = LayTriangle(mesh, t);
    const Eigen::Matrix2d inverse = sides.inverse();
    Eigen::Matrix<double, 2, 3> gradients;
    gradients.col(1) = inverse.row(0).transpose();
    gradients.col(2) = inverse.row(1).transpose();
    gradients.col(0) = -gradients.col(1) - gradients.col(2);
    elements.Gradients.push_back(gradients);
    elements.Areas.push_back(0.5 * sides.determinant());
  }
  return elements;
}

/// Coordinates of a triangle's corners, a column each.
Eigen::Matrix<double, 2, 3> Corners(const DiscMesh& mesh, const PointMatrix& uv, std::size_t t)
{
  Eigen::Matrix<double, 2, 3> corners;
  for (int k = 0; k < 3; ++k)
  {
    corners.col(k) = uv.row(mesh.Triangles[t][static_cast<std::size_t>(k)]).transpose();
  }
  return corners;
}

/// Infinite when a triangle is flipped.
double Energy(const DiscMesh& mesh, const Elements& elements, const PointMatrix& uv)
{
  double energy = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const Eigen::Matrix2d j = Corners(mesh, uv, t) * elements.Gradients[t].transpose();
    const double det = j.determinant();
    if (!(det > 0.0))
    {
      return std::numeric_limits<double>::infinity();
    }
    energy += elements.Areas[t] * j.squaredNorm() * (1.0 + 1.0 / (det * det));
  }
  return energy;
}

/// The smallest positive step along `direction` that degenerates a triangle.
double LargestStep(const DiscMesh& mesh, const PointMatrix& uv, const PointMatrix& direction)
{
  double largest = std::numeric_limits<double>::infinity();
  const auto cross = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q)
  { return p[0] * q[1] - p[1] * q[0]; };
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto at = Corners(mesh, uv, t);
    const auto to = Corners(mesh, direction, t);
    const Eigen::Vector2d p = at.col(1) - at.col(0);
    const Eigen::Vector2d q = at.col(2) - at.col(0);
    const Eigen::Vector2d dp = to.col(1) - to.col(0);
    const Eigen::Vector2d dq = to.col(2) - to.col(0);
    const double c = cross(p, q);
    const double b = cross(p, dq) + cross(dp, q);
    const double a = cross(dp, dq);
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0)
    {
      continue;
    }
    // of a s^2 + b s + c = 0 with c > 0, without cancellation
    const double sum = b + std::copysign(std::sqrt(discriminant), b);
    for (const double root : { -2.0 * c / sum, -sum / (2.0 * a) })
    {
      if (root > 0.0)
      {
        largest = std::min(largest, root);
      }
    }
  }
  return largest;
}

/// Matrix and right-hand side of the quadratic proxy: sum of area |W (J - R)|^2.
void AssembleProxy(const DiscMesh& mesh, const Elements& elements, const PointMatrix& uv,
  const Eigen::VectorXd& proximal, Eigen::SparseMatrix<double>& matrix, Eigen::MatrixXd& side)
{
  const int n = mesh.NumPoints();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(21 * mesh.Triangles.size() + static_cast<std::size_t>(2 * n));
  side.resize(2 * n, 1);
  for (int i = 0; i < n; ++i)
  {
    for (int d = 0; d < 2; ++d)
    {
      entries.emplace_back(2 * i + d, 2 * i + d, proximal[i]);
      side(2 * i + d, 0) = proximal[i] * uv(i, d);
    }
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto& gradients = elements.Gradients[t];
    const Eigen::Matrix2d j = Corners(mesh, uv, t) * gradients.transpose();
    const Eigen::Vector2d turn =
      Eigen::Vector2d(j(0, 0) + j(1, 1), j(1, 0) - j(0, 1)).normalized(); // nearest rotation
    Eigen::Matrix2d rotation;
    rotation << turn[0], -turn[1], turn[1], turn[0];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(j * j.transpose());
    const double large = std::sqrt(axes.eigenvalues()[1]);
    const Eigen::Array2d inverse(large / j.determinant(), 1.0 / large);
    // (s - s^-3) / (s - 1): the proxy has the energy's gradient
    const Eigen::Vector2d weights = (1.0 + inverse + inverse.square() + inverse.cube()).matrix();
    const Eigen::Matrix2d metric = elements.Areas[t] * axes.eigenvectors() * weights.asDiagonal() *
      axes.eigenvectors().transpose();
    const Eigen::Matrix<double, 2, 3> loads = metric * rotation * gradients;
    for (int k = 0; k < 3; ++k)
    {
      const int row = 2 * mesh.Triangles[t][static_cast<std::size_t>(k)];
      side.block<2, 1>(row, 0) += loads.col(k);
      for (int l = 0; l < 3; ++l)
      {
        const int column = 2 * mesh.Triangles[t][static_cast<std::size_t>(l)];
        const double product = gradients.col(k).dot(gradients.col(l));
        for (int p = 0; p < 2; ++p)
        {
          for (int q = 0; q < 2; ++q)
          {
            if (row + p >= column + q)
            {
              entries.emplace_back(row + p, column + q, product * metric(p, q));
            }
          }
        }
      }
    }
  }
  matrix.resize(2 * n, 2 * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
}
}

Result<FlatMesh> BarycentricMap(const DiscMesh& mesh)
{
  const int n = mesh.NumPoints();
  const int holes = static_cast<int>(mesh.Loops.size()) - 1;
  PointMatrix uv = PointMatrix::Zero(n + holes, 2);
  std::vector<int> number(static_cast<std::size_t>(n + holes), 0);
  const auto& outer = mesh.Loops.front();
  const auto step = [&](std::size_t i)
  { return (mesh.Point(outer[(i + 1) % outer.size()]) - mesh.Point(outer[i])).norm(); };
  double length = 0.0;
  for (std::size_t i = 0; i < outer.size(); ++i)
  {
    length += step(i);
  }
  double passed = 0.0;
  for (std::size_t i = 0; i < outer.size(); ++i)
  {
    const double angle = 2.0 * Pi * passed / length;
    uv.row(outer[i]) << std::cos(angle), std::sin(angle);
    number[static_cast<std::size_t>(outer[i])] = -1;
    passed += step(i);
  }
  int unknowns = 0;
  for (int& i : number)
  {
    i = i < 0 ? -1 : unknowns++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd side = Eigen::MatrixXd::Zero(unknowns, 2);
  const auto connect = [&](int a, int b) // from a's row
  {
    const int p = number[static_cast<std::size_t>(a)];
    const int q = number[static_cast<std::size_t>(b)];
    if (p < 0)
    {
      return;
    }
    entries.emplace_back(p, p, 1.0);
    if (q < 0)
    {
      side.row(p) += uv.row(b);
    }
    else if (q < p)
    {
      entries.emplace_back(p, q, -1.0);
    }
  };
  for (int v = 0; v < n; ++v)
  {
    for (int j = mesh.FanStart[static_cast<std::size_t>(v)];
         j < mesh.FanStart[static_cast<std::size_t>(v) + 1]; ++j)
    {
      connect(v, mesh.Fan[static_cast<std::size_t>(j)]);
    }
  }
  for (int h = 0; h < holes; ++h)
  {
    for (int v : mesh.Loops[static_cast<std::size_t>(h) + 1])
    {
      connect(v, n + h);
      connect(n + h, v);
    }
  }
  Result<FlatMesh> result;
  if (unknowns > 0)
  {
    if (Status status = SolvePositive(entries, side); !status)
    {
      return status;
    }
    for (int i = 0; i < n; ++i)
    {
      if (const int p = number[static_cast<std::size_t>(i)]; p >= 0)
      {
        uv.row(i) = side.row(p);
      }
    }
  }
  result.Value.UV = uv.topRows(n);
  return result;
}

Result<FlatMesh> MapWithoutFlips(const DiscMesh& mesh)
{
  auto result = LeastSquaresConformalMap(mesh);
  if (!result || CountFlips(mesh, result.Value.UV) > 0)
  {
    result = BarycentricMap(mesh);
  }
  if (result)
  {
    NormalizeSimilarity(mesh, result.Value.UV);
  }
  return result;
}

Status RelaxMap(const DiscMesh& mesh, const RelaxParams& params, PointMatrix& uv)
{
  const Elements elements = BuildElements(mesh);
  double energy = Energy(mesh, elements, uv);
  if (!std::isfinite(energy))
  {
    return { ErrorCode::NotConverged, "the first map of the injective one is not injective" };
  }
  const Eigen::VectorXd proximal = 1e-8 / mesh.Area * VertexAreas(mesh);
  SparseCholesky cholesky;
  Eigen::SparseMatrix<double> matrix;
  Eigen::MatrixXd side;
  for (int iteration = 0; iteration < params.MaxIterations; ++iteration)
  {
    AssembleProxy(mesh, elements, uv, proximal, matrix, side);
    if (!cholesky.Factorize(matrix))
    {
      break; // what has been reached is a map without flips
    }
    cholesky.Solve(side);
    const PointMatrix direction = Eigen::Map<const PointMatrix>(side.data(), uv.rows(), 2) - uv;
    double step = std::min(1.0, ShareOfStep * LargestStep(mesh, uv, direction));
    double next = std::numeric_limits<double>::infinity();
    PointMatrix moved;
    for (int halving = 0; halving < 40 && !(next < energy); ++halving, step *= 0.5)
    {
      moved = uv + step * direction;
      next = Energy(mesh, elements, moved);
    }
    if (!(next < energy))
    {
      break;
    }
    const bool done = energy - next < params.LeastDecrease * energy;
    uv = moved;
    energy = next;
    if (done || (params.GoOn && !params.GoOn(uv)))
    {
      break;
    }
  }
  return {};
}

Result<FlatMesh> InjectiveMap(const DiscMesh& mesh, int maxIterations)
{
  auto result = MapWithoutFlips(mesh);
  if (result)
  {
    RelaxParams params;
    params.MaxIterations = maxIterations;
    result.Status = RelaxMap(mesh, params, result.Value.UV);
  }
  return result;
}
}
