// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenReport.h"

#include "MeshWeights.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr int DistanceSources = 6;

struct SingularValues
{
  double Large = 0.0;
  double Small = 0.0; ///< negative when the triangle is flipped
};

SingularValues Decompose(const Eigen::Matrix2d& j)
{
  const double sum = std::hypot(j(0, 0) + j(1, 1), j(1, 0) - j(0, 1));
  const double difference = std::hypot(j(0, 0) - j(1, 1), j(1, 0) + j(0, 1));
  return { 0.5 * (sum + difference), 0.5 * (sum - difference) };
}

double MeasureDistances(const DiscMesh& mesh, const PointMatrix& uv, GeodesicEstimator estimator)
{
  GeodesicMarch march(mesh, estimator);
  const auto n = static_cast<std::size_t>(mesh.NumPoints());
  std::vector<double> nearest(n, std::numeric_limits<double>::infinity());
  double sum = 0.0;
  double diameter = 0.0;
  int source = mesh.Loops.front().front();
  for (int k = 0; k < DistanceSources; ++k)
  {
    const std::vector<double> distances = march.Distances(source);
    for (std::size_t v = 0; v < n; ++v)
    {
      const double plane = (uv.row(static_cast<Eigen::Index>(v)) - uv.row(source)).norm();
      sum += (distances[v] - plane) * (distances[v] - plane);
      diameter = std::max(diameter, distances[v]);
      nearest[v] = std::min(nearest[v], distances[v]);
    }
    source = static_cast<int>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return std::sqrt(sum / static_cast<double>(n * DistanceSources)) / diameter;
}
}

Eigen::Matrix2d TriangleJacobian(const DiscMesh& mesh, const PointMatrix& uv, std::size_t t)
{
  const auto& corners = mesh.Triangles[t];
  Eigen::Matrix2d image;
  image.col(0) = (uv.row(corners[1]) - uv.row(corners[0])).transpose();
  image.col(1) = (uv.row(corners[2]) - uv.row(corners[0])).transpose();
  const Eigen::Matrix2d sides = LayTriangle(mesh, t);
  return image * sides.inverse();
}

int CountFlips(const DiscMesh& mesh, const PointMatrix& uv)
{
  int positive = 0;
  int negative = 0;
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const double det = (TriangleJacobian(mesh, uv, t) * LayTriangle(mesh, t)).determinant();
    positive += det > 0.0 ? 1 : 0;
    negative += det < 0.0 ? 1 : 0;
    area += det;
  }
  return static_cast<int>(mesh.Triangles.size()) - (area >= 0.0 ? positive : negative);
}

void NormalizeAffinely(const DiscMesh& mesh, PointMatrix& uv)
{
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const Eigen::Matrix2d j = TriangleJacobian(mesh, uv, t);
    mean += 0.5 * LayTriangle(mesh, t).determinant() / mesh.Area * j * j.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(mean);
  if (solver.eigenvalues()[0] > 0.0)
  {
    uv = (uv * solver.operatorInverseSqrt()).eval();
  }
}

void NormalizeSimilarity(const DiscMesh& mesh, PointMatrix& uv)
{
  double linear = 0.0;
  double square = 0.0;
  double signedArea = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const double area = LayTriangle(mesh, t).determinant();
    const SingularValues s = Decompose(TriangleJacobian(mesh, uv, t));
    linear += area * (s.Large + std::abs(s.Small));
    square += area * (s.Large * s.Large + s.Small * s.Small);
    signedArea += area * s.Large * s.Small;
  }
  const double scale = square > 0.0 ? linear / square : 1.0;
  uv *= scale;
  if (signedArea < 0.0)
  {
    uv.col(1) *= -1.0;
  }
  const Eigen::RowVector2d centre = uv.colwise().mean();
  uv.rowwise() -= centre;
  if (uv(0, 0) < 0.0)
  {
    uv *= -1.0; // half a turn
  }
}

void TurnToAxes(PointMatrix& uv)
{
  const PointMatrix centred = uv.rowwise() - Eigen::RowVector2d(uv.colwise().mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(centred.transpose() * centred);
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  Eigen::Matrix2d turn; // a rotation: its second column is the first one turned left
  turn << along[0], -along[1], along[1], along[0];
  uv = (uv * turn).eval();
}

double LargestStretch(const DiscMesh& mesh, const PointMatrix& uv)
{
  double largest = 1.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const SingularValues s = Decompose(TriangleJacobian(mesh, uv, t));
    const double stretch =
      s.Small > 0.0 ? std::max(s.Large, 1.0 / s.Small) : std::numeric_limits<double>::infinity();
    largest = std::max(largest, stretch);
  }
  return largest;
}

FlattenMeasures MeasureMap(const DiscMesh& mesh, const PointMatrix& uv, GeodesicEstimator estimator)
{
  FlattenMeasures measures;
  measures.MinSingularValue = std::numeric_limits<double>::infinity();
  measures.SingularValues.resize(static_cast<Eigen::Index>(mesh.Triangles.size()), 2);
  double square = 0.0;
  const double least = std::numeric_limits<double>::min();
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const double share = 0.5 * LayTriangle(mesh, t).determinant() / mesh.Area;
    const SingularValues s = Decompose(TriangleJacobian(mesh, uv, t));
    const double small = std::abs(s.Small);
    measures.SingularValues.row(static_cast<Eigen::Index>(t)) << s.Large, s.Small;
    const double stretch = std::max(s.Large, 1.0 / std::max(small, least));
    const double area = std::max(s.Large * small, least);
    const double distortion = std::max(area, 1.0 / area);
    measures.FlippedTriangles += s.Small > 0.0 ? 0 : 1;
    measures.MeanStretch += share * stretch;
    measures.MaxStretch = std::max(measures.MaxStretch, stretch);
    measures.MinSingularValue = std::min(measures.MinSingularValue, small);
    measures.MaxSingularValue = std::max(measures.MaxSingularValue, s.Large);
    measures.MeanAreaDistortion += share * distortion;
    measures.MaxAreaDistortion = std::max(measures.MaxAreaDistortion, distortion);
    square += share * ((s.Large - 1.0) * (s.Large - 1.0) + (small - 1.0) * (small - 1.0));
  }
  measures.IsometryError = std::sqrt(square);
  measures.DistanceError = MeasureDistances(mesh, uv, estimator);
  return measures;
}
}
