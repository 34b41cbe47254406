// SPDX-License-Identifier: BSD-3-Clause
#include "PatchGeometry.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace knotwork
{
PatchCurve::PatchCurve(const SkeletonPatch<2>& patch)
  : PatchCurve(patch.Points, ParametersOrUniform(patch, 0.0, 1.0).col(0))
{
}

PatchCurve::PatchCurve(PointMatrix points, Eigen::VectorXd parameters)
  : Points(std::move(points)), Parameters(std::move(parameters))
{
}

void PatchCurve::Evaluate(double t, double* point, double* derivative) const
{
  const double* first = this->Parameters.data();
  const Eigen::Index n = this->Parameters.size();
  t = std::min(std::max(t, this->Begin()), this->End());
  // Parameters are often equally spaced: guess, and search only when the guess is wrong.
  const double guess = double(n - 1) * ((t - this->Begin()) / (this->End() - this->Begin()));
  Eigen::Index piece = std::min(static_cast<Eigen::Index>(guess), n - 2);
  if (!(first[piece] <= t && (t < first[piece + 1] || piece == n - 2)))
  {
    piece = std::min<Eigen::Index>(std::upper_bound(first, first + n, t) - first - 1, n - 2);
  }
  const double width = first[piece + 1] - first[piece];
  const double share = (t - first[piece]) / width;
  for (Eigen::Index d = 0; d < this->Points.cols(); ++d)
  {
    const double a = this->Points(piece, d);
    const double b = this->Points(piece + 1, d);
    point[d] = share == 1.0 ? b : a + share * (b - a); // vertices exactly
    if (derivative)
    {
      derivative[d] = (b - a) / width;
    }
  }
}

Eigen::VectorXd PatchCurve::SampleParameters(int count) const
{
  if (count == 0)
  {
    return this->Parameters;
  }
  Eigen::VectorXd samples(count);
  for (int i = 0; i < count; ++i)
  {
    samples(i) = this->Begin() + (this->End() - this->Begin()) * i / (count - 1);
  }
  samples(count - 1) = this->End();
  return samples;
}

PointMatrix PatchCurve::SamplePlaces(int count, std::vector<std::array<int, 2>>& simplices) const
{
  simplices.clear();
  return this->SampleParameters(count);
}

PointMatrix PatchCurve::FirstPlaces(const SkeletonPatch<2>& target) const
{
  return ParametersOrUniform(target, this->Begin(), this->End())
    .cwiseMax(this->Begin())
    .cwiseMin(this->End());
}

PatchSurface::PatchSurface(const SkeletonPatch<3>& patch)
  : Index(patch.Points, patch.Simplices), Parameters(patch.Parameters),
    Welded(ReplaceCorners(patch.Simplices, FirstOfEqualPoints(patch.Points)))
{
  this->RingStart.assign(static_cast<std::size_t>(patch.Points.rows()) + 1, 0);
  for (const MeshTriangle& t : this->Welded)
  {
    for (int corner : t)
    {
      ++this->RingStart[static_cast<std::size_t>(corner) + 1];
    }
  }
  std::partial_sum(this->RingStart.begin(), this->RingStart.end(), this->RingStart.begin());
  this->Rings.resize(3 * this->Welded.size());
  std::vector<int> next = this->RingStart;
  for (std::size_t t = 0; t < this->Welded.size(); ++t)
  {
    for (int corner : this->Welded[t])
    {
      this->Rings[static_cast<std::size_t>(next[static_cast<std::size_t>(corner)]++)] =
        static_cast<int>(t);
    }
  }
}

void PatchSurface::Evaluate(const double* place, double* point, double* derivatives) const
{
  using Row = Eigen::Map<Eigen::RowVector3d>;
  using ConstRow = Eigen::Map<const Eigen::RowVector3d>;
  const int triangle = static_cast<int>(place[0]);
  Row position(point);
  position = this->Index.PointAt(triangle, place[1], place[2]);
  for (int k = 0; derivatives && k < 2; ++k)
  {
    Row derivative(derivatives + 3 * k);
    derivative =
      ConstRow(this->Index.Corner(triangle, k + 1)) - ConstRow(this->Index.Corner(triangle, 0));
  }
}

PointMatrix PatchSurface::SamplePlaces(int count, std::vector<MeshTriangle>& simplices) const
{
  const std::vector<MeshTriangle>& mesh = this->Index.Triangles();
  const long long numPoints = this->Index.Points().rows();
  const long long numTriangles = static_cast<long long>(mesh.size());
  if (count <= numPoints)
  {
    PointMatrix corners(numPoints, 3);
    for (std::size_t t = mesh.size(); t-- > 0;) // the first triangle of a point counts
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        corners.row(mesh[t][k]) << double(t), double(k == 1), double(k == 2);
      }
    }
    simplices = mesh;
    return corners;
  }
  std::map<std::pair<int, int>, int> edges; // in the order of their first use
  for (const MeshTriangle& t : mesh)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      edges.try_emplace(std::minmax(t[k], t[(k + 1) % 3]), static_cast<int>(edges.size()));
    }
  }
  const long long numEdges = static_cast<long long>(edges.size());
  const auto total = [&](long long cuts)
  { return numPoints + numEdges * (cuts - 1) + numTriangles * (cuts - 1) * (cuts - 2) / 2; };
  int cuts = 1;
  while (total(cuts) < count)
  {
    ++cuts;
  }

  PointMatrix places = PointMatrix::Constant(total(cuts), 3, -1.0);
  simplices.clear();
  simplices.reserve(mesh.size() * static_cast<std::size_t>(cuts * cuts));
  Eigen::Index next = numPoints + numEdges * (cuts - 1); // first inner sample
  for (std::size_t t = 0; t < mesh.size(); ++t)
  {
    const MeshTriangle& corners = mesh[t];
    // Row of the sample at (i, j): i steps towards corner 1, j towards corner 2.
    const auto onEdge = [&](int from, int to, int step)
    {
      const int edge = edges.at(std::minmax(from, to));
      return numPoints + static_cast<long long>(edge) * (cuts - 1) +
        (from < to ? step : cuts - step) - 1;
    };
    const auto sample = [&](int i, int j) -> long long
    {
      const int k = cuts - i - j;
      if (i == cuts || j == cuts || k == cuts)
      {
        return corners[i == cuts ? 1 : j == cuts ? 2 : 0];
      }
      if (j == 0)
      {
        return onEdge(corners[0], corners[1], i);
      }
      if (i == 0)
      {
        return onEdge(corners[0], corners[2], j);
      }
      if (k == 0)
      {
        return onEdge(corners[1], corners[2], j);
      }
      // Rows of inner samples: j = 1 has cuts - 2 of them, j = 2 one less, ...
      return next + (i - 1) + (j - 1) * (2LL * cuts - 2 - j) / 2;
    };
    for (int j = 0; j <= cuts; ++j)
    {
      for (int i = 0; i + j <= cuts; ++i)
      {
        const long long row = sample(i, j);
        if (places(row, 0) < 0.0)
        {
          places.row(row) << double(t), double(i) / cuts, double(j) / cuts;
        }
        const auto corner = [&](int di, int dj)
        { return static_cast<int>(sample(i + di, j + dj)); };
        if (i + j < cuts)
        {
          simplices.push_back({ corner(0, 0), corner(1, 0), corner(0, 1) });
        }
        if (i + j + 1 < cuts)
        {
          simplices.push_back({ corner(1, 0), corner(1, 1), corner(0, 1) });
        }
      }
    }
    next += (cuts - 1) * (cuts - 2) / 2;
  }
  return places;
}

PointMatrix PatchSurface::FirstPlaces(const SkeletonPatch<3>& target) const
{
  if (this->Parameters.rows() == 0 || target.Parameters.rows() == 0)
  {
    return PointMatrix(0, 3);
  }
  const TriangleIndex<2> chart(this->Parameters, this->Index.Triangles());
  PointMatrix places(target.Parameters.rows(), 3);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    const TriangleFoot foot = chart.Nearest(target.Parameters.row(i).data());
    places.row(i) << double(foot.Triangle), foot.Second, foot.Third;
  }
  return places;
}
}
