// SPDX-License-Identifier: BSD-3-Clause
#include "SpectralMaps.h"

#include "FlattenReport.h"
#include "HessianMatrix.h"
#include "MeshWeights.h"
#include "SmallEigenpairs.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr int FirstVectors = 3;   // usually enough
constexpr int FurtherVectors = 7; // when one of these lives on few vertices, or the first two fold

/// Part of the total mass on which a vector lives: 1 for a constant, 5/9 for a linear function on a
/// strip, about 1/n for a single vertex.
double Participation(const Eigen::VectorXd& vector, const Eigen::VectorXd& masses)
{
  const Eigen::ArrayXd square = vector.array().square();
  const double second = (masses.array() * square).sum();
  return second * second / (masses.array() * square.square()).sum() / masses.sum();
}

std::vector<Eigen::Index> SpreadVectors(
  const SmallEigenpairs& pairs, const Eigen::VectorXd& masses, double least)
{
  std::vector<Eigen::Index> spread;
  for (Eigen::Index i = 0; i < pairs.Values.size(); ++i)
  {
    if (Participation(pairs.Vectors.col(i), masses) >= least)
    {
      spread.push_back(i);
    }
  }
  return spread;
}

PointMatrix PairOf(
  const DiscMesh& mesh, const SmallEigenpairs& pairs, Eigen::Index first, Eigen::Index second)
{
  PointMatrix uv(pairs.Vectors.rows(), 2);
  uv.col(0) = pairs.Vectors.col(first);
  uv.col(1) = pairs.Vectors.col(second);
  NormalizeAffinely(mesh, uv);
  TurnToAxes(uv);
  return uv;
}

Status TooSmall()
{
  return { ErrorCode::InvalidParameter, "spectral methods need 8 points or more" };
}
}

Result<FlatMesh> HessianEigenmap(const DiscMesh& mesh, const FlattenParams& params)
{
  if (mesh.NumPoints() < 8)
  {
    return TooSmall();
  }
  const Eigen::SparseMatrix<double> matrix = HessianMatrix(mesh, params.Neighbours, params.Threads);
  const Eigen::VectorXd masses = VertexAreas(mesh);
  // well below the first bending of a plate of this area, well above rounding
  const double bending = 1.0 / (mesh.Area * mesh.Area);
  const double rounding = 1e-14 * (matrix.diagonal().array() / masses.array()).maxCoeff();
  const double shift = std::max(1e-3 * bending, rounding);
  Result<FlatMesh> result;
  int fewest = std::numeric_limits<int>::max();
  for (int count : { FirstVectors, FurtherVectors })
  {
    count = std::min(count, mesh.NumPoints() - 2);
    const auto pairs = FindSmallEigenpairs(matrix, masses, shift, count);
    if (!pairs)
    {
      return pairs.Status;
    }
    const std::vector<Eigen::Index> spread =
      SpreadVectors(pairs.Value, masses, params.MinParticipation);
    result.Value.RejectedEigenvectors = count - static_cast<int>(spread.size());
    for (std::size_t j = 1; j < spread.size() && fewest > 0; ++j)
    {
      for (std::size_t i = 0; i < j && fewest > 0; ++i)
      {
        PointMatrix uv = PairOf(mesh, pairs.Value, spread[i], spread[j]);
        const int flips = CountFlips(mesh, uv);
        if (flips < fewest)
        {
          fewest = flips;
          result.Value.UV = std::move(uv);
        }
      }
    }
    if (fewest == 0)
    {
      return result;
    }
  }
  if (result.Value.UV.rows() == 0)
  {
    return { ErrorCode::SingularSystem, "all eigenvectors of the Hessian live on few vertices" };
  }
  return result;
}

Result<FlatMesh> LaplacianEigenmap(const DiscMesh& mesh, const FlattenParams& params)
{
  if (mesh.NumPoints() < 8)
  {
    return TooSmall();
  }
  const bool graph = params.Weights == LaplacianWeights::Graph;
  const Eigen::SparseMatrix<double> matrix =
    graph ? GraphLaplacian(mesh) : CotangentLaplacian(mesh);
  const Eigen::VectorXd masses = graph ? Eigen::VectorXd(matrix.diagonal()) : VertexAreas(mesh);
  // below the first eigenvalue of a membrane of this mass, by far
  const double shift = graph ? 1e-3 / masses.sum() : 1e-2 / mesh.Area;
  const auto pairs = FindSmallEigenpairs(matrix, masses, shift, FirstVectors - 1);
  if (!pairs)
  {
    return pairs.Status;
  }
  Result<FlatMesh> result;
  result.Value.UV = pairs.Value.Vectors.leftCols(2);
  return result;
}

Result<FlatMesh> LandmarkIsomap(const DiscMesh& mesh, const FlattenParams& params)
{
  const Eigen::Index n = mesh.NumPoints();
  const Eigen::Index m = std::min<Eigen::Index>(params.Landmarks, n);
  GeodesicMarch march(mesh, params.Geodesics);
  Eigen::MatrixXd distances(n, m);
  std::vector<int> landmarks;
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  const std::vector<double> start = march.Distances(0);
  int next = static_cast<int>(std::max_element(start.begin(), start.end()) - start.begin());
  for (Eigen::Index k = 0; k < m; ++k)
  {
    landmarks.push_back(next);
    const std::vector<double> from = march.Distances(next);
    distances.col(k) = Eigen::Map<const Eigen::VectorXd>(from.data(), n);
    nearest = nearest.cwiseMin(distances.col(k));
    Eigen::Index farthest = 0;
    nearest.maxCoeff(&farthest);
    next = static_cast<int>(farthest);
  }
  distances = distances.cwiseAbs2();
  Eigen::MatrixXd between(m, m);
  for (Eigen::Index k = 0; k < m; ++k)
  {
    between.row(k) = distances.row(landmarks[static_cast<std::size_t>(k)]);
  }
  between = (0.5 * (between + between.transpose())).eval();
  const Eigen::RowVectorXd means = between.colwise().mean();
  Eigen::MatrixXd inner = between.rowwise() - means;
  inner.colwise() -= means.transpose();
  inner.array() = -0.5 * (inner.array() + means.mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inner);
  const Eigen::VectorXd& values = solver.eigenvalues();
  if (!(values[m - 2] > 1e-12 * values[m - 1]))
  {
    return { ErrorCode::SingularSystem,
      "geodesic distances between the landmarks are those of a line" };
  }
  Result<FlatMesh> result;
  distances.rowwise() -= means;
  result.Value.UV.resize(n, 2);
  for (Eigen::Index d = 0; d < 2; ++d)
  {
    result.Value.UV.col(d) =
      -0.5 / std::sqrt(values[m - 1 - d]) * (distances * solver.eigenvectors().col(m - 1 - d));
  }
  return result;
}
}
