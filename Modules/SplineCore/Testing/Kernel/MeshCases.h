// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineOracle.h"
#include <knotwork/SplineCore/CellMesh.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <string>

/// Meshes of quadrilaterals and hexahedra of known structure, and random ones.
namespace meshes
{
using knotwork::CellMesh;
using oracle::Random;

/// Points are one where their keys are.
template <int Dim>
class Maker
{
public:
  int Point(const std::vector<int>& key)
  {
    return this->Points.emplace(key, static_cast<int>(this->Points.size())).first->second;
  }
  void AddCorner(const std::vector<int>& key) { this->Mesh.Corners.push_back(this->Point(key)); }
  CellMesh<Dim> Done()
  {
    this->Mesh.NumPoints = static_cast<int>(this->Points.size());
    return this->Mesh;
  }

private:
  std::map<std::vector<int>, int> Points;
  CellMesh<Dim> Mesh;
};

/// A grid of cells, closed along a direction where periodic.
template <int Dim>
CellMesh<Dim> Grid(const std::array<int, Dim>& n, const std::array<bool, Dim>& periodic = {})
{
  CellMesh<Dim> mesh;
  std::array<int, Dim> points;
  int cells = 1;
  mesh.NumPoints = 1;
  for (int d = 0; d < Dim; ++d)
  {
    points[d] = n[d] + (periodic[d] ? 0 : 1);
    mesh.NumPoints *= points[d];
    cells *= n[d];
  }
  for (int c = 0; c < cells; ++c)
  {
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      int rest = c;
      int stride = 1;
      int id = 0;
      for (int d = 0; d < Dim; ++d)
      {
        id += stride * ((rest % n[d] + (corner >> d & 1)) % points[d]);
        rest /= n[d];
        stride *= points[d];
      }
      mesh.Corners.push_back(id);
    }
  }
  return mesh;
}

/// A strip of n by m cells whose ends along the first direction are joined with a twist: a Moebius
/// strip, or a Klein bottle when the other direction is periodic.
inline CellMesh<2> Twisted(int n, int m, bool periodic)
{
  Maker<2> maker;
  for (int c = 0; c < n * m; ++c)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      int i = c % n + (corner & 1);
      int j = c / n + (corner >> 1);
      if (i == n)
      {
        i = 0;
        j = m - j;
      }
      maker.AddCorner({ i, periodic ? (j % m + m) % m : j });
    }
  }
  return maker.Done();
}

/// n by n cells in each of the sectors around a point.
inline CellMesh<2> Star(int valence, int n)
{
  Maker<2> maker;
  for (int s = 0; s < valence; ++s)
  {
    for (int c = 0; c < n * n; ++c)
    {
      for (int corner = 0; corner < 4; ++corner)
      {
        const int i = c % n + (corner & 1);
        const int j = c / n + (corner >> 1);
        if (i == 0 && j == 0)
        {
          maker.AddCorner({ 0 });
        }
        else if (i == 0 || j == 0) // on a spoke
        {
          maker.AddCorner({ 1, i == 0 ? (s + 1) % valence : s, i + j });
        }
        else
        {
          maker.AddCorner({ 2, s, i, j });
        }
      }
    }
  }
  return maker.Done();
}

/// The boundary of a grid of n cells a direction, as blocks with `layers` cells outward (0: the
/// boundary itself, of one dimension less), and the grid inside when filled.
template <int Dim>
CellMesh<Dim> Blocks(int n, int layers)
{
  Maker<Dim> maker;
  const auto count = [n](int directions) {
    return directions == 0 ? 1 : directions == 1 ? n : directions == 2 ? n * n : n * n * n;
  };
  for (int c = 0; c < count(Dim); ++c)
  {
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      std::vector<int> key{ 0 };
      for (int d = 0, rest = c; d < Dim; ++d, rest /= n)
      {
        key.push_back(rest % n + (corner >> d & 1));
      }
      maker.AddCorner(key);
    }
  }
  for (int side = 0; side < 2 * Dim; ++side)
  {
    for (int c = 0; c < count(Dim - 1) * layers; ++c)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        // the side's directions, then outward; directions are exchanged where that turns the cell
        const bool swap = (side % 2 == 1) == (Dim == 2 ? side / 2 == 0 : side / 2 % 2 == 1);
        const int layer =
          c / count(Dim - 1) + (Dim == 2 ? (swap ? corner : corner >> 1) & 1 : corner >> 2 & 1);
        std::vector<int> key{ layer };
        int rest = c % count(Dim - 1);
        int k = 0;
        for (int d = 0; d < Dim; ++d)
        {
          if (d == side / 2)
          {
            key.push_back(side % 2 * n);
            continue;
          }
          const int bit = Dim == 2 ? (swap ? 1 : 0) : (swap ? 1 - k : k);
          key.push_back(rest % n + (corner >> bit & 1));
          rest /= n;
          ++k;
        }
        maker.AddCorner(key);
      }
    }
  }
  return maker.Done();
}

/// The boundary of a cube of n cells a direction.
inline CellMesh<2> CubeSphere(int n)
{
  Maker<2> maker;
  for (int side = 0; side < 6; ++side)
  {
    for (int c = 0; c < n * n; ++c)
    {
      for (int corner = 0; corner < 4; ++corner)
      {
        const bool swap = (side % 2 == 0) == (side / 2 % 2 == 0);
        std::vector<int> key(3, side % 2 * n);
        const int a = side / 2 == 0 ? 1 : 0;
        const int b = side / 2 == 2 ? 1 : 2;
        key[a] = c % n + (corner >> (swap ? 1 : 0) & 1);
        key[b] = c / n + (corner >> (swap ? 0 : 1) & 1);
        maker.AddCorner(key);
      }
    }
  }
  return maker.Done();
}

/// Points of the equiangular sphere of radius 1 on the boundary of a cube: `mesh` is CubeSphere(n).
inline knotwork::PointMatrix CubeSpherePoints(const CellMesh<2>& mesh, int n)
{
  knotwork::PointMatrix points(mesh.NumPoints, 3);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int side = c / (n * n);
    for (int corner = 0; corner < 4; ++corner)
    {
      const bool swap = (side % 2 == 0) == (side / 2 % 2 == 0);
      Eigen::RowVector3d x = Eigen::RowVector3d::Constant(side % 2 == 0 ? -1.0 : 1.0);
      const int a = side / 2 == 0 ? 1 : 0;
      const int b = side / 2 == 2 ? 1 : 2;
      const auto angle = [n](int i)
      { return std::tan((2.0 * i / n - 1.0) * static_cast<double>(EIGEN_PI) / 4.0); };
      x[a] = angle(c % n + (corner >> (swap ? 1 : 0) & 1));
      x[b] = angle(c / n % n + (corner >> (swap ? 0 : 1) & 1));
      points.row(mesh.Cell(c)[corner]) = x.normalized();
    }
  }
  return points;
}

/// Points of a strip around a circle that turns half round on its way: `mesh` is Twisted(n, 1,
/// false).
inline knotwork::PointMatrix MoebiusPoints(const CellMesh<2>& mesh, int n)
{
  knotwork::PointMatrix points(mesh.NumPoints, 3);
  for (int c = 0; c < n; ++c)
  {
    const double angle = 2.0 * c * static_cast<double>(EIGEN_PI) / n;
    for (const int corner : { 0, 2 })
    {
      const double out = (corner - 1) * 0.1;
      points.row(mesh.Cell(c)[corner]) << std::cos(angle) * (1.0 + out * std::cos(angle / 2)),
        std::sin(angle) * (1.0 + out * std::cos(angle / 2)), out * std::sin(angle / 2);
    }
  }
  return points;
}

/// Layers of hexahedra over quadrilaterals, closed to a ring when periodic.
inline CellMesh<3> Sweep(const CellMesh<2>& base, int layers, bool periodic = false)
{
  CellMesh<3> mesh;
  const int levels = layers + (periodic ? 0 : 1);
  mesh.NumPoints = base.NumPoints * levels;
  for (int z = 0; z < layers; ++z)
  {
    for (int c = 0; c < base.NumCells(); ++c)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        mesh.Corners.push_back(
          base.Cell(c)[corner & 3] + base.NumPoints * ((z + (corner >> 2)) % levels));
      }
    }
  }
  return mesh;
}

/// Every cell cut into 2^Dim: by the points of the edges, faces and cells.
template <int Dim>
CellMesh<Dim> Halved(const CellMesh<Dim>& mesh)
{
  Maker<Dim> maker;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int child = 0; child < (1 << Dim); ++child)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        std::vector<int> key; // the corners whose middle it is
        for (int k = 0; k < (1 << Dim); ++k)
        {
          bool in = true;
          for (int d = 0; d < Dim; ++d)
          {
            const int at = (child >> d & 1) + (corner >> d & 1);
            in = in && (at == 1 || at / 2 == (k >> d & 1));
          }
          if (in)
          {
            key.push_back(mesh.Cell(c)[k]);
          }
        }
        std::sort(key.begin(), key.end());
        maker.AddCorner(key);
      }
    }
  }
  return maker.Done();
}

/// Squares glued along random pairs of their edges, and cut: any closed or bounded surface, any
/// valence, edges glued with a twist unless oriented. May be no mesh that is accepted.
inline CellMesh<2> GluedSquares(Random& random, int squares, int mostCuts, bool oriented)
{
  std::vector<int> free(static_cast<std::size_t>(squares) * 4);
  std::iota(free.begin(), free.end(), 0);
  for (std::size_t i = free.size(); i > 1; --i)
  {
    std::swap(free[i - 1], free[static_cast<std::size_t>(random.Int(0, static_cast<int>(i) - 1))]);
  }
  struct Glue
  {
    int A, B; // sides: 4 square + side
    bool Reversed;
  };
  std::vector<Glue> glues;
  const double bound = random.In(0.0, 0.5);
  for (std::size_t i = 0; i + 1 < free.size(); i += 2)
  {
    if (random.Unit() < bound)
    {
      continue;
    }
    const int a = free[i];
    const int b = free[i + 1];
    const auto sign = [](int side) { return (side % 2 == 1) == (side / 2 % 2 == 0) ? 1 : -1; };
    const bool coherent = sign(a % 4) * sign(b % 4) == 1;
    glues.push_back({ a, b, oriented ? coherent : random.Unit() < 0.5 });
  }
  // equal numbers of cells where edges are glued
  std::vector<int> sheet(static_cast<std::size_t>(squares) * 2);
  std::iota(sheet.begin(), sheet.end(), 0);
  const auto direction = [](int side) { return side / 4 * 2 + 1 - side % 4 / 2; };
  for (bool changed = true; changed;)
  {
    changed = false;
    for (const Glue& glue : glues)
    {
      int& a = sheet[static_cast<std::size_t>(direction(glue.A))];
      int& b = sheet[static_cast<std::size_t>(direction(glue.B))];
      changed = changed || a != b;
      a = b = std::min(a, b);
    }
  }
  std::vector<int> cuts(sheet.size());
  for (std::size_t i = 0; i < cuts.size(); ++i)
  {
    cuts[i] = random.Int(1, mostCuts);
  }
  const auto cutsOf = [&](int square, int d)
  { return cuts[static_cast<std::size_t>(sheet[static_cast<std::size_t>(square * 2 + d)])]; };
  std::vector<int> first{ 0 };
  for (int s = 0; s < squares; ++s)
  {
    first.push_back(first.back() + (cutsOf(s, 0) + 1) * (cutsOf(s, 1) + 1));
  }
  std::vector<int> same(static_cast<std::size_t>(first.back()));
  std::iota(same.begin(), same.end(), 0);
  const auto find = [&](int a)
  {
    while (same[static_cast<std::size_t>(a)] != a)
    {
      a = same[static_cast<std::size_t>(a)];
    }
    return a;
  };
  const auto onSide = [&](int side, int t)
  {
    const int s = side / 4;
    const int n0 = cutsOf(s, 0);
    const int fixed = side % 2 == 0 ? 0 : side % 4 / 2 == 0 ? n0 : cutsOf(s, 1);
    const int i = side % 4 / 2 == 0 ? fixed : t;
    const int j = side % 4 / 2 == 0 ? t : fixed;
    return first[static_cast<std::size_t>(s)] + i + j * (n0 + 1);
  };
  for (const Glue& glue : glues)
  {
    const int n = cutsOf(glue.A / 4, 1 - glue.A % 4 / 2);
    for (int t = 0; t <= n; ++t)
    {
      const int a = find(onSide(glue.A, t));
      const int b = find(onSide(glue.B, glue.Reversed ? n - t : t));
      same[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  Maker<2> maker;
  for (int s = 0; s < squares; ++s)
  {
    const int n0 = cutsOf(s, 0);
    for (int c = 0; c < n0 * cutsOf(s, 1); ++c)
    {
      for (int corner = 0; corner < 4; ++corner)
      {
        maker.AddCorner({ find(first[static_cast<std::size_t>(s)] + c % n0 + (corner & 1) +
          (c / n0 + (corner >> 1)) * (n0 + 1)) });
      }
    }
  }
  return maker.Done();
}

/// Some cells of a grid. May be no mesh that is accepted.
template <int Dim>
CellMesh<Dim> SomeOfGrid(Random& random, const std::array<int, Dim>& n, double share)
{
  const CellMesh<Dim> grid = Grid<Dim>(n);
  Maker<Dim> maker;
  for (int c = 0; c < grid.NumCells(); ++c)
  {
    if (random.Unit() < share)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        maker.AddCorner({ grid.Cell(c)[corner] });
      }
    }
  }
  return maker.Done();
}

/// Simplices of a grid's cells that are left by chance, each cut into quadrilaterals or hexahedra
/// at the middles of its faces. May be no mesh that is accepted.
template <int Dim>
CellMesh<Dim> CutSimplices(Random& random, const std::array<int, Dim>& n, double share)
{
  const CellMesh<Dim> grid = Grid<Dim>(n);
  Maker<Dim> maker;
  for (int c = 0; c < grid.NumCells(); ++c)
  {
    std::array<int, Dim> order;
    std::iota(order.begin(), order.end(), 0);
    bool even = true;
    do
    {
      std::array<int, Dim + 1> simplex{ grid.Cell(c)[0] };
      for (int k = 0, corner = 0; k < Dim; ++k)
      {
        corner |= 1 << order[k];
        simplex[k + 1] = grid.Cell(c)[corner];
      }
      int inversions = 0;
      for (int a = 0; a < Dim; ++a)
      {
        for (int b = a + 1; b < Dim; ++b)
        {
          inversions += order[a] > order[b] ? 1 : 0;
        }
      }
      even = inversions % 2 == 0;
      if (random.Unit() >= share)
      {
        continue;
      }
      for (int v = 0; v <= Dim; ++v)
      {
        std::vector<int> others;
        for (int w = 0; w <= Dim; ++w)
        {
          if (w != v)
          {
            others.push_back(simplex[w]);
          }
        }
        if ((v % 2 == 0) != even) // right-handed
        {
          std::swap(others[0], others[1]);
        }
        for (int corner = 0; corner < (1 << Dim); ++corner)
        {
          std::vector<int> key{ simplex[v] };
          for (int d = 0; d < Dim; ++d)
          {
            if ((corner >> d & 1) != 0)
            {
              key.push_back(others[d]);
            }
          }
          std::sort(key.begin(), key.end());
          maker.AddCorner(key);
        }
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return maker.Done();
}

/// The same mesh with cells and points in another order and each cell's corners turned.
template <int Dim>
CellMesh<Dim> Shuffled(Random& random, const CellMesh<Dim>& mesh, bool turn = true)
{
  const auto order = [&random](int n)
  {
    std::vector<int> numbers(static_cast<std::size_t>(n));
    std::iota(numbers.begin(), numbers.end(), 0);
    for (int i = n - 1; i > 0; --i)
    {
      std::swap(
        numbers[static_cast<std::size_t>(i)], numbers[static_cast<std::size_t>(random.Int(0, i))]);
    }
    return numbers;
  };
  const std::vector<int> points = order(mesh.NumPoints);
  CellMesh<Dim> result;
  result.NumPoints = mesh.NumPoints;
  for (const int c : order(mesh.NumCells()))
  {
    // direction d of the turned cell is direction axis[d], run backwards where a bit is set
    std::array<int, Dim> axis;
    std::iota(axis.begin(), axis.end(), 0);
    int flips = 0;
    if (turn)
    {
      const int turns = random.Int(0, 3);
      for (int t = 0; t < turns; ++t)
      {
        const int a = random.Int(0, Dim - 1);
        const int b = (a + 1) % Dim;
        std::swap(axis[a], axis[b]);
        const int bits = (flips >> a & 1) << b | (flips >> b & 1) << a;
        flips = (flips & ~(1 << a | 1 << b)) | bits;
        flips ^= 1 << a;
      }
    }
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      int old = 0;
      for (int d = 0; d < Dim; ++d)
      {
        old |= ((corner ^ flips) >> d & 1) << axis[d];
      }
      result.Corners.push_back(points[static_cast<std::size_t>(mesh.Cell(c)[old])]);
    }
  }
  return result;
}

/// A random mesh that is accepted.
template <int Dim>
CellMesh<Dim> RandomMesh(Random& random, int mostCells)
{
  for (;;)
  {
    CellMesh<Dim> mesh;
    const int kind = random.Int(0, 5);
    if constexpr (Dim == 2)
    {
      mesh = kind < 3 ? GluedSquares(random, random.Int(1, 8), random.Int(1, 5), kind == 0)
        : kind == 3   ? SomeOfGrid<2>(random, { random.Int(2, 8), random.Int(2, 8) }, 0.8)
        : kind == 4   ? CutSimplices<2>(random, { random.Int(1, 3), random.Int(1, 3) }, 0.8)
                      : Star(random.Int(3, 9), random.Int(1, 4));
    }
    else
    {
      mesh = kind < 2 ? Sweep(GluedSquares(random, random.Int(1, 4), random.Int(1, 3), true),
                          random.Int(1, 4), random.Unit() < 0.3)
        : kind == 2
        ? SomeOfGrid<3>(random, { random.Int(2, 4), random.Int(2, 4), random.Int(2, 4) }, 0.8)
        : kind == 3 ? CutSimplices<3>(random, { random.Int(1, 2), 1, 1 }, 0.7)
        : kind == 4 ? Sweep(Star(random.Int(3, 7), random.Int(1, 3)), random.Int(1, 4))
                    : Blocks<3>(random.Int(1, 2), random.Int(1, 2));
    }
    mesh = random.Unit() < 0.2 && mesh.NumCells() << Dim <= mostCells ? Halved(mesh) : mesh;
    if (mesh.NumCells() > 0 && mesh.NumCells() <= mostCells &&
      knotwork::MeshTopology<Dim>::Make(mesh))
    {
      return Shuffled(random, mesh);
    }
  }
}

/// Up to four inner facets, each seen from a cell.
template <int Dim>
std::vector<knotwork::CellSide> RandomFacets(Random& random, const CellMesh<Dim>& mesh)
{
  const auto topology = knotwork::MeshTopology<Dim>::Make(mesh);
  std::vector<knotwork::CellSide> facets;
  for (int i = random.Int(1, 4); i > 0; --i)
  {
    const knotwork::CellSide facet{ random.Int(0, mesh.NumCells() - 1),
      random.Int(0, 2 * Dim - 1) };
    if (!topology->IsBoundary(facet.Cell, facet.Side))
    {
      facets.push_back(facet);
    }
  }
  return facets;
}

/// A mesh of a file (OFF with quadrilaterals, legacy VTK with hexahedra) in the folder that the
/// environment variable KNOTWORK_UNSTRUCTURED_MESHES names; without cells when it is not there.
template <int Dim>
CellMesh<Dim> ReadMesh(const std::string& name)
{
  CellMesh<Dim> mesh;
  const char* folder = std::getenv("KNOTWORK_UNSTRUCTURED_MESHES");
  std::ifstream file(std::string(folder ? folder : "") + "/" + name);
  if (!folder || !file)
  {
    return mesh;
  }
  std::string word;
  int cells = 0;
  double skipped = 0.0;
  const auto skip = [&](int count)
  {
    for (int i = 0; i < count; ++i)
    {
      file >> skipped;
    }
  };
  if (Dim == 2)
  {
    file >> word >> mesh.NumPoints >> cells >> skipped;
    skip(3 * mesh.NumPoints);
  }
  else
  {
    while (file >> word && word != "POINTS")
    {
    }
    file >> mesh.NumPoints >> word;
    skip(3 * mesh.NumPoints);
    file >> word >> cells >> skipped;
  }
  for (int c = 0; c < cells; ++c)
  {
    int n = 0;
    std::array<int, (1 << Dim)> points{};
    file >> n;
    for (int& point : points)
    {
      file >> point;
    }
    for (int i = 2; i < (1 << Dim); i += 4)
    {
      std::swap(points[static_cast<std::size_t>(i)], points[static_cast<std::size_t>(i + 1)]);
    }
    mesh.Corners.insert(mesh.Corners.end(), points.begin(), points.end());
  }
  return mesh;
}
}
