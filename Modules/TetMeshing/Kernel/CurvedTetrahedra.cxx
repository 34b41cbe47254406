// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedTetrahedra.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::array<std::array<int, 2>, 6> EdgeCorners{ { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 },
  { 1, 3 }, { 2, 3 } } };
constexpr std::array<int, 4> OppositeCorners{ 2, 0, 1, 3 }; ///< of the faces' points
constexpr double FirstStep = 1.0 / 32.0; ///< of the way back; twice as far each time

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::array<int, 3> FaceWithout(const std::array<int, 4>& cell, int corner)
{
  std::array<int, 3> face{};
  std::size_t n = 0;
  for (int i = 0; i < 4; ++i)
  {
    if (i != corner)
    {
      face[n++] = cell[At(i)];
    }
  }
  std::sort(face.begin(), face.end());
  return face;
}

template <typename Item>
void MakeUnique(std::vector<Item>& items)
{
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

template <typename Item>
int PlaceIn(const std::vector<Item>& items, const Item& item)
{
  return static_cast<int>(std::lower_bound(items.begin(), items.end(), item) - items.begin());
}

/// Coefficients of a cubic edge from its ends and its two points.
Eigen::RowVector3d CubicCoefficient(const Eigen::RowVector3d& end, const Eigen::RowVector3d& near,
  const Eigen::RowVector3d& far, const Eigen::RowVector3d& other)
{
  return (-5.0 * end + 18.0 * near - 9.0 * far + 2.0 * other) / 6.0;
}
}

int NumTetrahedronPoints(int order)
{
  return (order + 1) * (order + 2) * (order + 3) / 6;
}

int NodeLattice::NumNodes() const
{
  return this->NumCorners + static_cast<int>(this->Edges.size()) * (this->Order - 1) +
    static_cast<int>(this->Faces.size());
}

int NodeLattice::FindEdge(int a, int b) const
{
  return PlaceIn(this->Edges, { std::min(a, b), std::max(a, b) });
}

int NodeLattice::FindFace(std::array<int, 3> corners) const
{
  std::sort(corners.begin(), corners.end());
  return PlaceIn(this->Faces, corners);
}

int NodeLattice::EdgeNode(int edge, int k) const
{
  return this->NumCorners + edge * (this->Order - 1) + k - 1;
}

int NodeLattice::FaceNode(int face) const
{
  return this->EdgeNode(static_cast<int>(this->Edges.size()), 1) + face;
}

NodeLattice MakeLattice(const std::vector<std::array<int, 4>>& cells, int numCorners, int order)
{
  NodeLattice lattice;
  lattice.Order = order;
  lattice.NumCorners = numCorners;
  for (const auto& cell : cells)
  {
    for (const auto& [a, b] : EdgeCorners)
    {
      if (order > 1)
      {
        const auto ends = std::minmax(cell[At(a)], cell[At(b)]);
        lattice.Edges.push_back({ ends.first, ends.second });
      }
    }
    for (int corner = 0; corner < 4 && order > 2; ++corner)
    {
      lattice.Faces.push_back(FaceWithout(cell, corner));
    }
  }
  MakeUnique(lattice.Edges);
  MakeUnique(lattice.Faces);
  for (const auto& cell : cells)
  {
    std::vector<int> nodes(cell.begin(), cell.end());
    for (const auto& [a, b] : EdgeCorners)
    {
      const int first = cell[At(a)];
      const int second = cell[At(b)];
      for (int k = 1; k < order; ++k)
      {
        nodes.push_back(
          lattice.EdgeNode(lattice.FindEdge(first, second), first < second ? k : order - k));
      }
    }
    if (order > 2)
    {
      for (const int corner : OppositeCorners)
      {
        nodes.push_back(lattice.FaceNode(lattice.FindFace(FaceWithout(cell, corner))));
      }
    }
    lattice.Cells.push_back(std::move(nodes));
  }
  return lattice;
}

BernsteinCells MakeBernstein(
  const NodeLattice& lattice, const PointMatrix& points, const std::vector<int>& which)
{
  const int order = lattice.Order;
  const CellDegree degree{ order, order, order };
  BernsteinCells cells;
  cells.NumComponents = 3;
  for (const int number : which)
  {
    const std::vector<int>& nodes = lattice.Cells[At(number)];
    const auto point = [&](std::size_t i) -> Eigen::RowVector3d { return points.row(nodes[i]); };
    const int cell = cells.Add(CellShape::Tetrahedron, degree);
    double* block = cells.Block(cell);
    const int count = NumCellCoefficients(CellShape::Tetrahedron, degree);
    const auto set = [&](const std::array<int, 4>& corners, const Eigen::RowVector3d& value)
    {
      const int at =
        CellCoefficient(CellShape::Tetrahedron, degree, corners[1], corners[2], corners[3]);
      for (int c = 0; c < 3; ++c)
      {
        block[c * count + at] = value[c];
      }
    };
    double largest = 0.0;
    for (const int node : nodes)
    {
      largest = std::max(largest, points.row(node).cwiseAbs().maxCoeff());
    }
    for (std::size_t i = 0; i < 4; ++i)
    {
      std::array<int, 4> at{};
      at[i] = order;
      set(at, point(i));
    }
    std::array<std::array<Eigen::RowVector3d, 4>, 4> edges; // coefficient next to the first corner
    for (std::size_t e = 0; e < 6 && order > 1; ++e)
    {
      const std::size_t a = At(EdgeCorners[e][0]);
      const std::size_t b = At(EdgeCorners[e][1]);
      const std::size_t first = 4 + e * At(order - 1);
      std::array<int, 4> at{};
      at[a] = order - 1;
      at[b] = 1;
      if (order == 2)
      {
        set(at, 2.0 * point(first) - 0.5 * (point(a) + point(b)));
        continue;
      }
      edges[a][b] = CubicCoefficient(point(a), point(first), point(first + 1), point(b));
      edges[b][a] = CubicCoefficient(point(b), point(first + 1), point(first), point(a));
      set(at, edges[a][b]);
      std::swap(at[a], at[b]);
      set(at, edges[b][a]);
    }
    for (std::size_t f = 0; f < 4 && order > 2; ++f)
    {
      Eigen::RowVector3d corners = Eigen::RowVector3d::Zero();
      Eigen::RowVector3d sides = Eigen::RowVector3d::Zero();
      std::array<int, 4> at{ 1, 1, 1, 1 };
      const std::size_t without = At(OppositeCorners[f]);
      at[without] = 0;
      for (std::size_t a = 0; a < 4; ++a)
      {
        for (std::size_t b = 0; b < 4; ++b)
        {
          if (a != b && a != without && b != without)
          {
            sides += edges[a][b];
          }
        }
        corners += a == without ? Eigen::RowVector3d::Zero() : point(a);
      }
      set(at, 4.5 * (point(16 + f) - corners / 27.0 - sides / 9.0));
    }
    // order 2: three roundings of at most 4 times the largest; 3: below 20 of 23 times the largest
    cells.Errors.push_back(order == 1 ? 0.0 : largest * (order == 2 ? 0x1p-49 : 0x1p-44));
  }
  if (order == 1)
  {
    cells.Errors.clear();
  }
  return cells;
}

CurvedNodes::CurvedNodes(const NodeLattice& lattice, const PointMatrix& corners)
  : Lattice(lattice), Corners(corners), At(lattice.NumNodes(), 3),
    Offsets(PointMatrix::Zero(lattice.NumNodes(), 3)),
    Placed(static_cast<std::size_t>(lattice.NumNodes()), 0),
    Shares(static_cast<std::size_t>(lattice.NumNodes()), 1.0)
{
  this->Update();
}

Eigen::RowVector3d CurvedNodes::BaseAmong(int node, const PointMatrix& positions) const
{
  const NodeLattice& lattice = this->Lattice;
  const int steps = lattice.Order - 1;
  if (node < lattice.NumCorners)
  {
    return this->Corners.row(node);
  }
  const int rest = node - lattice.NumCorners;
  const int numEdges = static_cast<int>(lattice.Edges.size());
  if (rest < numEdges * steps)
  {
    const auto& ends = lattice.Edges[static_cast<std::size_t>(rest / steps)];
    const double t = static_cast<double>(rest % steps + 1) / lattice.Order;
    return (1.0 - t) * positions.row(ends[0]) + t * positions.row(ends[1]);
  }
  // reproduces quadratic faces
  const auto& face = lattice.Faces[static_cast<std::size_t>(rest - numEdges * steps)];
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i)
  {
    sum -= positions.row(face[i]) / 6.0;
    const int edge = lattice.FindEdge(face[i], face[(i + 1) % 3]);
    sum +=
      0.25 * (positions.row(lattice.EdgeNode(edge, 1)) + positions.row(lattice.EdgeNode(edge, 2)));
  }
  return sum;
}

Eigen::RowVector3d CurvedNodes::Base(int node) const
{
  return this->BaseAmong(node, this->At);
}

void CurvedNodes::Place(int node, const Eigen::RowVector3d& at)
{
  this->Offsets.row(node) = at - this->Base(node);
  this->Placed[static_cast<std::size_t>(node)] = 1;
  this->At.row(node) = at;
}

void CurvedNodes::Update()
{
  for (int node = 0; node < this->Lattice.NumNodes(); ++node)
  {
    // corners come before edges, and edges before faces
    this->At.row(node) = this->BaseAmong(node, this->At) +
      this->Shares[static_cast<std::size_t>(node)] * this->Offsets.row(node);
  }
}

bool CurvedNodes::MoveBack(const std::vector<int>& nodes)
{
  bool moved = false;
  const auto step = [&](std::size_t begin, std::size_t end)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      double& share = this->Shares[static_cast<std::size_t>(nodes[i])];
      if (this->IsPlaced(nodes[i]) && share > 0.0)
      {
        share = share == 1.0 ? 1.0 - FirstStep : std::max(0.0, 2.0 * share - 1.0);
        moved = true;
      }
    }
  };
  step(4, nodes.size());
  if (!moved) // the corners are not on the given surface: they go back last
  {
    step(0, 4);
  }
  return moved;
}

Result<JacobianCertificate> CurvedNodes::Relax(int threads, std::vector<char>& relaxed)
{
  JacobianParams params;
  params.Threads = threads;
  std::vector<int> which(this->Lattice.Cells.size());
  std::iota(which.begin(), which.end(), 0);
  JacobianCertificate all;
  all.Cells.resize(which.size());
  while (!which.empty())
  {
    auto part = ValidateJacobian(MakeBernstein(this->Lattice, this->At, which), params);
    if (!part)
    {
      return part.Status;
    }
    std::vector<std::size_t> folded;
    for (std::size_t i = 0; i < which.size(); ++i)
    {
      const auto cell = static_cast<std::size_t>(which[i]);
      all.Cells[cell] = part->Cells[i];
      if (part->Cells[i].Verdict != Verdict::Valid)
      {
        folded.push_back(cell);
      }
    }
    for (const std::size_t cell : folded)
    {
      if (!this->MoveBack(this->Lattice.Cells[cell]))
      {
        const Eigen::RowVector3d place = this->At.row(this->Lattice.Cells[cell][0]);
        return { ErrorCode::NotConverged,
          "tetrahedron " + std::to_string(cell) + " at " + PointText(place.data(), 3) +
            " is not valid though it is straight: its volume is zero but for rounding; give the "
            "surface better triangles there" };
      }
    }
    if (folded.empty())
    {
      break;
    }
    const PointMatrix old = this->At;
    this->Update();
    which.clear();
    for (std::size_t cell = 0; cell < this->Lattice.Cells.size(); ++cell)
    {
      const auto& nodes = this->Lattice.Cells[cell];
      if (std::any_of(nodes.begin(), nodes.end(),
            [&](int node) { return old.row(node) != this->At.row(node); }) ||
        std::binary_search(folded.begin(), folded.end(), cell))
      {
        which.push_back(static_cast<int>(cell));
      }
    }
  }
  relaxed.clear();
  for (const auto& nodes : this->Lattice.Cells)
  {
    relaxed.push_back(std::any_of(nodes.begin(), nodes.end(),
      [this](int node) { return this->Shares[static_cast<std::size_t>(node)] < 1.0; }));
  }
  Summarize(all);
  return all;
}
}
