// SPDX-License-Identifier: BSD-3-Clause
#include "ReferenceMaps.h"

#include "FlattenReport.h"
#include "MeshWeights.h"
#include "SparseCholesky.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double LeastChange = 1e-9; // of coordinates in an iteration, over the size of the map

int FarthestOf(const DiscMesh& mesh, const std::vector<int>& vertices, int from)
{
  const auto distance = [&](int v) { return (mesh.Point(v) - mesh.Point(from)).squaredNorm(); };
  return *std::max_element(
    vertices.begin(), vertices.end(), [&](int a, int b) { return distance(a) < distance(b); });
}
}

Result<FlatMesh> LeastSquaresConformalMap(const DiscMesh& mesh)
{
  // Dirichlet energy minus area; unknowns u of all vertices, then v
  const int n = mesh.NumPoints();
  const int first = FarthestOf(mesh, mesh.Loops.front(), mesh.Loops.front().front());
  const int second = FarthestOf(mesh, mesh.Loops.front(), first);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(2 * n);
  values[second] = (mesh.Point(second) - mesh.Point(first)).norm();
  std::vector<int> number(static_cast<std::size_t>(2 * n), 0);
  int unknowns = 0;
  for (int i = 0; i < 2 * n; ++i)
  {
    const bool held = i % n == first || i % n == second;
    number[static_cast<std::size_t>(i)] = held ? -1 : unknowns++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd side = Eigen::MatrixXd::Zero(unknowns, 1);
  const auto add = [&](int i, int j, double value) // and its transpose
  {
    const int p = number[static_cast<std::size_t>(i)];
    const int q = number[static_cast<std::size_t>(j)];
    if (p >= 0 && q >= 0)
    {
      entries.emplace_back(std::max(p, q), std::min(p, q), value);
    }
    if (p >= 0 && q < 0)
    {
      side(p, 0) -= value * values[j];
    }
    if (q >= 0 && p < 0)
    {
      side(q, 0) -= value * values[i];
    }
  };
  const Eigen::SparseMatrix<double> laplacian = CotangentLaplacian(mesh);
  for (int column = 0; column < laplacian.outerSize(); ++column)
  {
    for (Eigen::SparseMatrix<double>::InnerIterator at(laplacian, column); at; ++at)
    {
      add(static_cast<int>(at.row()), column, at.value());
      add(n + static_cast<int>(at.row()), n + column, at.value());
    }
  }
  for (const auto& loop : mesh.Loops)
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int a = loop[i];
      const int b = loop[(i + 1) % loop.size()];
      add(a, n + b, -0.5);
      add(b, n + a, 0.5);
    }
  }
  if (Status status = SolvePositive(entries, side); !status)
  {
    return status;
  }
  for (int i = 0; i < 2 * n; ++i)
  {
    if (number[static_cast<std::size_t>(i)] >= 0)
    {
      values[i] = side(number[static_cast<std::size_t>(i)], 0);
    }
  }
  Result<FlatMesh> result;
  result.Value.UV.resize(n, 2);
  result.Value.UV.col(0) = values.head(n);
  result.Value.UV.col(1) = values.tail(n);
  return result;
}

Result<FlatMesh> AsRigidAsPossibleMap(const DiscMesh& mesh, int maxIterations)
{
  auto result = LeastSquaresConformalMap(mesh);
  if (!result)
  {
    return result;
  }
  PointMatrix& uv = result.Value.UV;
  NormalizeSimilarity(mesh, uv);
  Eigen::SparseMatrix<double> matrix = CotangentLaplacian(mesh);
  const Eigen::VectorXd areas = VertexAreas(mesh);
  // a proximal term in place of a held point: the fixed points are the same
  const Eigen::VectorXd proximal = 1e-8 * matrix.diagonal().cwiseAbs().sum() / areas.sum() * areas;
  for (int i = 0; i < mesh.NumPoints(); ++i)
  {
    matrix.coeffRef(i, i) += proximal[i];
  }
  SparseCholesky cholesky;
  if (Status status = cholesky.Factorize(matrix); !status)
  {
    return status;
  }
  const double size = std::sqrt(mesh.Area);
  for (int iteration = 0; iteration < maxIterations; ++iteration)
  {
    Eigen::MatrixXd side = proximal.asDiagonal() * uv;
    for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
    {
      const auto& corners = mesh.Triangles[t];
      const Eigen::Matrix2d j = TriangleJacobian(mesh, uv, t);
      Eigen::Vector2d turn(j(0, 0) + j(1, 1), j(1, 0) - j(0, 1)); // nearest rotation
      const double norm = turn.norm();
      turn = norm > 0.0 ? Eigen::Vector2d(turn / norm) : Eigen::Vector2d(1.0, 0.0);
      Eigen::Matrix2d rotation;
      rotation << turn[0], -turn[1], turn[1], turn[0];
      const Eigen::Matrix2d sides = rotation * LayTriangle(mesh, t);
      const std::array<Eigen::Vector2d, 3> places = { Eigen::Vector2d::Zero(), sides.col(0),
        sides.col(1) };
      const Eigen::Vector3d weights = HalfCotangents(mesh, t);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const std::size_t a = (k + 1) % 3;
        const std::size_t b = (k + 2) % 3;
        const Eigen::RowVector2d edge =
          weights[static_cast<Eigen::Index>(k)] * (places[a] - places[b]).transpose();
        side.row(corners[a]) += edge;
        side.row(corners[b]) -= edge;
      }
    }
    cholesky.Solve(side);
    const double change = (side - uv).cwiseAbs().maxCoeff();
    uv = side;
    if (change < LeastChange * size)
    {
      break;
    }
  }
  return result;
}
}
