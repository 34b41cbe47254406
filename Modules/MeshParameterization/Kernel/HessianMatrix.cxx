// SPDX-License-Identifier: BSD-3-Clause
#include "HessianMatrix.h"

#include "GeodesicMarch.h"
#include "MeshWeights.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/SparseLines.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Vertices a task; each task has arrays of its own over all vertices.
std::size_t ChunkOf(std::size_t n)
{
  return std::max<std::size_t>(2048, (n + 63) / 64);
}

/// Rows of the estimators: Size vertices each, and three values a vertex.
struct Estimators
{
  std::size_t Size = 0;
  std::vector<int> Vertices;
  std::vector<double> Values;
};

/// Three orthonormal columns that measure second derivatives.
void Estimate(const PointMatrix& places, double area, double* values)
{
  const Eigen::Index m = places.rows();
  const Eigen::RowVector2d centre = places.colwise().mean();
  const double radius =
    std::sqrt((places.rowwise() - centre).squaredNorm() / static_cast<double>(m));
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 64, 6> columns(m, 6);
  for (Eigen::Index i = 0; i < m; ++i)
  {
    const double u = (places(i, 0) - centre[0]) / radius;
    const double v = (places(i, 1) - centre[1]) / radius;
    columns.row(i) << 1.0, u, v, u * u, std::sqrt(2.0) * u * v, v * v;
  }
  const double scale = std::sqrt(area) / (radius * radius);
  for (Eigen::Index j = 0; j < 6; ++j) // Gram-Schmidt, twice
  {
    const double before = columns.col(j).norm();
    for (int pass = 0; pass < 2; ++pass)
    {
      for (Eigen::Index i = 0; i < j; ++i)
      {
        const double part = columns.col(i).dot(columns.col(j));
        columns.col(j) -= part * columns.col(i);
      }
    }
    const double norm = columns.col(j).norm();
    if (norm > 1e-8 * before)
    {
      columns.col(j) /= norm;
    }
    else // places on a conic: this combination says nothing here
    {
      columns.col(j).setZero();
    }
    for (Eigen::Index i = 0; i < m && j >= 3; ++i)
    {
      values[3 * i + j - 3] = scale * columns(i, j);
    }
  }
}

Estimators FindEstimators(const DiscMesh& mesh, int neighbours, int threads)
{
  const auto n = static_cast<std::size_t>(mesh.NumPoints());
  Estimators all;
  all.Size = std::min<std::size_t>(static_cast<std::size_t>(neighbours) + 1, n);
  all.Vertices.resize(n * all.Size);
  all.Values.resize(3 * n * all.Size);
  const Eigen::VectorXd areas = VertexAreas(mesh);
  ParallelFor(n, ChunkOf(n), threads,
    [&](std::size_t begin, std::size_t end)
    {
      GeodesicMarch march(mesh);
      std::vector<int> vertices;
      PointMatrix places;
      for (std::size_t v = begin; v < end; ++v)
      {
        march.Nearest(static_cast<int>(v), static_cast<int>(all.Size) - 1, vertices, places);
        std::copy(vertices.begin(), vertices.end(),
          all.Vertices.begin() + static_cast<std::ptrdiff_t>(v * all.Size));
        Estimate(places, areas[static_cast<Eigen::Index>(v)], all.Values.data() + 3 * v * all.Size);
      }
    });
  return all;
}
}

Eigen::SparseMatrix<double> HessianMatrix(const DiscMesh& mesh, int neighbours, int threads)
{
  const auto n = static_cast<std::size_t>(mesh.NumPoints());
  const Estimators all = FindEstimators(mesh, neighbours, threads);
  // entries of Vertices that are vertex v
  std::vector<int> start(n + 1, 0);
  for (int v : all.Vertices)
  {
    ++start[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 0; v < n; ++v)
  {
    start[v + 1] += start[v];
  }
  std::vector<int> entries(all.Vertices.size());
  std::vector<int> filled(start.begin(), start.end() - 1);
  for (std::size_t e = 0; e < all.Vertices.size(); ++e)
  {
    entries[static_cast<std::size_t>(filled[static_cast<std::size_t>(all.Vertices[e])]++)] =
      static_cast<int>(e);
  }
  // columns of the sum of H H', chunk by chunk
  const std::size_t chunk = ChunkOf(n);
  std::vector<SparseLines> parts((n + chunk - 1) / chunk);
  ParallelFor(n, ChunkOf(n), threads,
    [&](std::size_t begin, std::size_t end)
    {
      SparseLineSum sum(n);
      for (std::size_t v = begin; v < end; ++v)
      {
        for (int at = start[v]; at < start[v + 1]; ++at)
        {
          const auto e = static_cast<std::size_t>(entries[static_cast<std::size_t>(at)]);
          const std::size_t first = e - e % all.Size;
          const double* own = all.Values.data() + 3 * e;
          for (std::size_t other = first; other < first + all.Size; ++other)
          {
            const int row = all.Vertices[other];
            if (row < static_cast<int>(v))
            {
              continue;
            }
            const double* theirs = all.Values.data() + 3 * other;
            sum.Add(row, own[0] * theirs[0] + own[1] * theirs[1] + own[2] * theirs[2]);
          }
        }
        sum.MoveTo(parts[begin / chunk]);
      }
    });
  return JoinLines<Eigen::ColMajor>(
    parts, static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
}
}
