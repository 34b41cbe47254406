// SPDX-License-Identifier: BSD-3-Clause
#include "OffsetExtension.h"

#include <knotwork/SplineCore/LatticeInterpolation.h>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Pairs of points of a shape that are one step of the lattice apart along its edges' directions.
std::vector<std::array<int, 2>> StepsOf(CellShape shape, int order)
{
  std::vector<std::array<int, 3>> places;
  for (const auto& parameters : LatticeParameters(shape, DegreeOf(shape, order)))
  {
    std::array<int, 3> place{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      place[d] = static_cast<int>(std::lround(parameters[d] * order));
    }
    places.push_back(place);
  }
  std::vector<std::array<int, 3>> directions;
  for (const auto& [a, b] : EdgesOf(shape))
  {
    const auto from = CornerParameters(shape, a);
    const auto to = CornerParameters(shape, b);
    std::array<int, 3> direction{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      direction[d] = static_cast<int>(to[d] - from[d]);
    }
    directions.push_back(direction);
  }
  std::sort(directions.begin(), directions.end());
  directions.erase(std::unique(directions.begin(), directions.end()), directions.end());
  std::vector<std::array<int, 2>> steps;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    for (const auto& direction : directions)
    {
      const std::array<int, 3> next{ places[i][0] + direction[0], places[i][1] + direction[1],
        places[i][2] + direction[2] };
      const auto found = std::find(places.begin(), places.end(), next);
      if (found != places.end())
      {
        steps.push_back({ static_cast<int>(i), static_cast<int>(found - places.begin()) });
      }
    }
  }
  return steps;
}
}

Status ExtendWays(const NodeLattice& lattice, const PointMatrix& straight,
  const std::vector<int>& elements, const std::vector<char>& isFree, PointMatrix& ways)
{
  std::vector<int> unknowns(isFree.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < isFree.size(); ++i)
  {
    unknowns[i] = isFree[i] != 0 ? count++ : -1;
  }
  std::array<std::vector<std::array<int, 2>>, NumCellShapes> steps;
  std::vector<Eigen::Triplet<double>> entries;
  PointMatrix right = PointMatrix::Zero(count, 3);
  for (const int e : elements)
  {
    const CellShape shape = lattice.Shapes[At(e)];
    auto& ofShape = steps[static_cast<std::size_t>(shape)];
    ofShape = ofShape.empty() ? StepsOf(shape, lattice.Order) : std::move(ofShape);
    const int* nodes = lattice.Nodes.data() + lattice.Begin[At(e)];
    double mean = 0.0; // of the logarithms: lengths differ by orders in thin elements
    for (const auto& [a, b] : ofShape)
    {
      mean += std::log((straight.row(nodes[a]) - straight.row(nodes[b])).norm());
    }
    const double size = std::exp(3.0 * mean / static_cast<double>(ofShape.size()));
    for (const auto& [a, b] : ofShape)
    {
      const int i = unknowns[At(nodes[a])];
      const int j = unknowns[At(nodes[b])];
      const double weight = size / (straight.row(nodes[a]) - straight.row(nodes[b])).squaredNorm();
      for (const auto& [own, other, node] :
        { std::array<int, 3>{ i, j, nodes[b] }, std::array<int, 3>{ j, i, nodes[a] } })
      {
        if (own < 0)
        {
          continue;
        }
        entries.emplace_back(own, own, weight);
        if (other >= 0)
        {
          entries.emplace_back(own, other, -weight);
        }
        else
        {
          right.row(own) += weight * ways.row(node);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::MatrixXd found = solver.solve(Eigen::MatrixXd(right));
  if (solver.info() != Eigen::Success || !found.allFinite())
  {
    return { ErrorCode::SingularSystem, "points inside hang together with none on the target" };
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i)
  {
    if (unknowns[i] >= 0)
    {
      ways.row(static_cast<Eigen::Index>(i)) = found.row(unknowns[i]);
    }
  }
  return {};
}

std::vector<int> RingsOf(const NodeLattice& lattice, const std::vector<int>& elements, int rings)
{
  std::vector<char> isIn(lattice.Shapes.size(), 0);
  for (const int e : elements)
  {
    isIn[At(e)] = 1;
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    std::vector<char> touched(At(lattice.NumCorners), 0);
    const auto visit = [&](int e, auto&& act)
    {
      for (std::size_t i = lattice.Begin[At(e)]; i < lattice.Begin[At(e) + 1]; ++i)
      {
        if (lattice.Nodes[i] < lattice.NumCorners)
        {
          act(touched[At(lattice.Nodes[i])]);
        }
      }
    };
    for (int e = 0; e < lattice.NumElements(); ++e)
    {
      if (isIn[At(e)] != 0)
      {
        visit(e, [](char& corner) { corner = 1; });
      }
    }
    for (int e = 0; e < lattice.NumElements(); ++e)
    {
      visit(e, [&](char corner) { isIn[At(e)] = corner != 0 ? 1 : isIn[At(e)]; });
    }
  }
  std::vector<int> found;
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    if (isIn[At(e)] != 0)
    {
      found.push_back(e);
    }
  }
  return found;
}
}
