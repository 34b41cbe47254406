// SPDX-License-Identifier: BSD-3-Clause
#include "CellGluing.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/PatchSides.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

namespace knotwork
{
namespace
{
const std::vector<SideFrame>& Frames(CellShape shape)
{
  constexpr CellShape curve = CellShape::Curve;
  constexpr CellShape quad = CellShape::Quadrilateral;
  constexpr CellShape triangle = CellShape::Triangle;
  static const std::vector<SideFrame> none;
  static const std::vector<SideFrame> quads{ { curve, 2, { 2, 0, 0, 0 } },
    { curve, 2, { 1, 3, 0, 0 } }, { curve, 2, { 0, 1, 0, 0 } }, { curve, 2, { 3, 2, 0, 0 } } };
  static const std::vector<SideFrame> triangles{ { curve, 2, { 0, 1, 0, 0 } },
    { curve, 2, { 1, 2, 0, 0 } }, { curve, 2, { 2, 0, 0, 0 } } };
  static const std::vector<SideFrame> hexahedra{ { quad, 4, { 0, 4, 2, 6 } },
    { quad, 4, { 1, 3, 5, 7 } }, { quad, 4, { 0, 1, 4, 5 } }, { quad, 4, { 2, 6, 3, 7 } },
    { quad, 4, { 0, 2, 1, 3 } }, { quad, 4, { 4, 5, 6, 7 } } };
  static const std::vector<SideFrame> tetrahedra{ { triangle, 3, { 0, 3, 2, 0 } },
    { triangle, 3, { 0, 1, 3, 0 } }, { triangle, 3, { 0, 2, 1, 0 } },
    { triangle, 3, { 1, 2, 3, 0 } } };
  static const std::vector<SideFrame> wedges{ { quad, 4, { 0, 1, 3, 4 } },
    { quad, 4, { 1, 2, 4, 5 } }, { quad, 4, { 0, 3, 2, 5 } }, { triangle, 3, { 0, 2, 1, 0 } },
    { triangle, 3, { 3, 4, 5, 0 } } };
  switch (shape)
  {
    case CellShape::Quadrilateral:
      return quads;
    case CellShape::Triangle:
      return triangles;
    case CellShape::Hexahedron:
      return hexahedra;
    case CellShape::Tetrahedron:
      return tetrahedra;
    case CellShape::Wedge:
      return wedges;
    case CellShape::Curve:
      break;
  }
  return none;
}

/// Merges items with equal keys, in order.
template <typename Key>
class Merger
{
public:
  explicit Merger(DisjointSets& sets) : Sets(sets) {}
  void Add(const Key& key, int item)
  {
    const auto [at, isNew] = this->First.try_emplace(key, item);
    if (!isNew)
    {
      this->Sets.Unite(at->second, item);
    }
  }

private:
  DisjointSets& Sets;
  std::map<Key, int> First;
};

/// A way to look at a side: an origin corner and the neighbours that i and j run to.
struct Reframe
{
  std::vector<int> Coefficients;
  std::array<int, 4> Corners{};
  std::array<int, 2> Degree{};
  int Parity = 1;
};

std::vector<Reframe> MakeReframes(CellShape shape, const CellDegree& degree)
{
  std::vector<std::array<int, 3>> frames;
  if (shape == CellShape::Curve)
  {
    frames = { { 0, 1, -1 }, { 1, 0, -1 } };
  }
  else if (shape == CellShape::Triangle)
  {
    frames = { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 0, 2, 1 }, { 2, 1, 0 }, { 1, 0, 2 } };
  }
  else
  {
    for (int o = 0; o < 4; ++o)
    {
      frames.push_back({ o, o ^ 1, o ^ 2 });
      frames.push_back({ o, o ^ 2, o ^ 1 });
    }
  }
  std::vector<Reframe> reframes;
  for (const auto& frame : frames)
  {
    Reframe r;
    int corner[3][2] = {};
    for (int k = 0; k < 3 && frame[static_cast<std::size_t>(k)] >= 0; ++k)
    {
      const auto u = CornerParameters(shape, frame[static_cast<std::size_t>(k)]);
      corner[k][0] = static_cast<int>(u[0]);
      corner[k][1] = static_cast<int>(u[1]);
    }
    const int a[2] = { corner[1][0] - corner[0][0], corner[1][1] - corner[0][1] };
    int b[2] = { 0, 0 };
    r.Corners = { frame[0], frame[1], frame[2], 3 - frame[0] };
    if (shape == CellShape::Curve)
    {
      r.Degree = { degree[0], 0 };
      r.Parity = a[0];
    }
    else
    {
      b[0] = corner[2][0] - corner[0][0];
      b[1] = corner[2][1] - corner[0][1];
      r.Degree = { degree[a[0] != 0 ? 0 : 1], degree[b[0] != 0 ? 0 : 1] };
      r.Parity = a[0] * b[1] - a[1] * b[0];
    }
    for (int j = 0; j <= r.Degree[1]; ++j)
    {
      for (int i = 0; i <= r.Degree[0]; ++i)
      {
        if (shape == CellShape::Triangle && i + j > degree[0])
        {
          continue;
        }
        const int at[2] = { corner[0][0] * degree[0] + i * a[0] + j * b[0],
          corner[0][1] * degree[1] + i * a[1] + j * b[1] };
        r.Coefficients.push_back(CellCoefficient(shape, degree, at[0], at[1], 0));
      }
    }
    reframes.push_back(std::move(r));
  }
  return reframes;
}

struct Side
{
  int Cell;
  int Number;
};

/// Everything about one run of the gluing.
class Gluer
{
public:
  Gluer(const BernsteinCells& cells, const CellComplex& complex, const std::vector<int>& signs,
    const InjectivityParams& params)
    : Cells(cells), Complex(complex), Signs(signs), Params(params), Corners(cells.NumCells() * 8),
      Edges(cells.NumCells() * 12)
  {
    for (int s = 0; s < NumCellShapes; ++s)
    {
      const CellShape shape = static_cast<CellShape>(s);
      CellDegree one{};
      for (int d = 0; d < NumParameters(shape); ++d)
      {
        one[static_cast<std::size_t>(d)] = 1;
      }
      for (const auto& direction : CellLattice(shape, one).Directions)
      {
        for (const auto& pair : direction.CornerPairs)
        {
          this->EdgeCorners[s].push_back(pair);
        }
      }
    }
    this->Dim = NumParameters(cells.Shapes[0]);
  }

  CellGluing Run()
  {
    this->JoinKnownPoints();
    for (int c = 0; c < this->Cells.NumCells(); ++c)
    {
      for (int s = 0; s < NumSides(this->Shape(c)); ++s)
      {
        this->Open.push_back({ c, s });
      }
    }
    this->GlueBoxes();
    this->RemoveCollapsed();
    this->GlueEqual();
    this->GlueNear();
    this->FindInnerPoint();
    this->AssembleBoundary();
    return std::move(this->Out);
  }

private:
  CellShape Shape(int c) const { return this->Cells.Shapes[static_cast<std::size_t>(c)]; }
  const CellDegree& Degree(int c) const { return this->Cells.Degrees[static_cast<std::size_t>(c)]; }
  int Patch(int c) const
  {
    return this->Complex.Patches.empty() ? c : this->Complex.Patches[static_cast<std::size_t>(c)];
  }
  int CornerId(int c, int corner) const { return c * 8 + corner; }
  int EdgeId(int c, int a, int b) const
  {
    const auto& edges = this->EdgeCorners[static_cast<int>(this->Shape(c))];
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a))
      {
        return c * 12 + static_cast<int>(e);
      }
    }
    return -1;
  }
  bool HasBox(int c) const
  {
    if (this->Complex.Boxes.empty())
    {
      return false;
    }
    const CellShape shape = this->Shape(c);
    const auto& box = this->Complex.Boxes[static_cast<std::size_t>(c)];
    bool has = shape == CellShape::Quadrilateral || shape == CellShape::Hexahedron;
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Dim); ++d)
    {
      has = has && box.Lower[d] < box.Upper[d];
    }
    return has;
  }
  std::array<double, 3> BoxCorner(int c, int corner) const
  {
    const auto& box = this->Complex.Boxes[static_cast<std::size_t>(c)];
    std::array<double, 3> u{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Dim); ++d)
    {
      u[d] = ((corner >> d) & 1 ? box.Upper[d] : box.Lower[d]) + 0.0;
    }
    return u;
  }
  std::int64_t PointId(int c, int coefficient) const
  {
    return this->Complex.PointIds[this->Cells.Offsets[static_cast<std::size_t>(c)] /
        static_cast<std::size_t>(this->Cells.NumPlanes()) +
      static_cast<std::size_t>(coefficient)];
  }
  std::array<double, 3> Position(int c, int coefficient) const
  {
    const int n = NumCellCoefficients(this->Shape(c), this->Degree(c));
    const double* x = this->Cells.Block(c);
    std::array<double, 3> position{};
    for (int d = 0; d < this->Cells.NumComponents; ++d)
    {
      const double w = this->Cells.Rational ? x[this->Cells.NumComponents * n + coefficient] : 1.0;
      position[static_cast<std::size_t>(d)] = x[d * n + coefficient] / w + 0.0;
    }
    return position;
  }
  static double Distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
  {
    return std::max({ std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2]) });
  }
  double LargestCoordinate(int c) const
  {
    double largest = 0.0;
    const int n = NumCellCoefficients(this->Shape(c), this->Degree(c));
    for (int i = 0; i < n; ++i)
    {
      for (const double x : this->Position(c, i))
      {
        largest = std::max(largest, std::abs(x));
      }
    }
    return largest;
  }

  const CellLattice& Lattice(CellShape shape, const CellDegree& degree)
  {
    return this->Lattices.try_emplace({ static_cast<int>(shape), degree }, shape, degree)
      .first->second;
  }
  const std::vector<Reframe>& Reframes(CellShape shape, const CellDegree& degree)
  {
    auto& entry = this->ReframeCache[{ static_cast<int>(shape), degree }];
    if (entry.empty())
    {
      entry = MakeReframes(shape, degree);
    }
    return entry;
  }

  /// Corners and edges that ids or parameters identify.
  void JoinKnownPoints()
  {
    Merger<std::pair<int, std::array<double, 3>>> corners(this->Corners);
    Merger<std::pair<int, std::array<double, 6>>> edges(this->Edges);
    Merger<std::int64_t> ids(this->Corners);
    Merger<std::array<std::int64_t, 4>> edgeIds(this->Edges);
    for (int c = 0; c < this->Cells.NumCells(); ++c)
    {
      const CellShape shape = this->Shape(c);
      if (this->HasBox(c))
      {
        for (int k = 0; k < NumCorners(shape); ++k)
        {
          corners.Add({ this->Patch(c), this->BoxCorner(c, k) }, this->CornerId(c, k));
        }
        for (const auto& ends : this->EdgeCorners[static_cast<int>(shape)])
        {
          const auto a = this->BoxCorner(c, ends[0]);
          const auto b = this->BoxCorner(c, ends[1]);
          edges.Add({ this->Patch(c), { a[0], a[1], a[2], b[0], b[1], b[2] } },
            this->EdgeId(c, ends[0], ends[1]));
        }
      }
      if (!this->Complex.PointIds.empty())
      {
        const CellLattice& lattice = this->Lattice(shape, this->Degree(c));
        for (int k = 0; k < NumCorners(shape); ++k)
        {
          ids.Add(
            this->PointId(c, lattice.Corners[static_cast<std::size_t>(k)]), this->CornerId(c, k));
        }
        for (const auto& direction : lattice.Directions)
        {
          for (const auto& line : direction.Lines)
          {
            const auto first =
              std::find(lattice.Corners.begin(), lattice.Corners.end(), line.front());
            const auto last =
              std::find(lattice.Corners.begin(), lattice.Corners.end(), line.back());
            if (first == lattice.Corners.end() || last == lattice.Corners.end())
            {
              continue;
            }
            std::int64_t inner = 0;
            for (std::size_t i = 1; i + 1 < line.size(); ++i)
            {
              inner += this->PointId(c, line[i]);
            }
            const std::int64_t a = this->PointId(c, line.front());
            const std::int64_t b = this->PointId(c, line.back());
            edgeIds.Add(
              { std::min(a, b), std::max(a, b), inner, static_cast<std::int64_t>(line.size()) },
              this->EdgeId(c, static_cast<int>(first - lattice.Corners.begin()),
                static_cast<int>(last - lattice.Corners.begin())));
          }
        }
      }
    }
  }

  /// Glues elements of one patch by their boxes.
  void GlueBoxes()
  {
    struct Facing
    {
      int Patch;
      int Direction;
      double Coordinate;
      std::array<double, 2> Lower;
      std::array<double, 2> Upper;
      int End;
      int Index; // into Open
    };
    std::vector<Facing> facings;
    for (std::size_t i = 0; i < this->Open.size(); ++i)
    {
      const Side side = this->Open[i];
      if (!this->HasBox(side.Cell))
      {
        continue;
      }
      const auto& box = this->Complex.Boxes[static_cast<std::size_t>(side.Cell)];
      const std::size_t d = static_cast<std::size_t>(side.Number / 2);
      Facing f{ this->Patch(side.Cell), side.Number / 2, 0.0, {}, {}, side.Number % 2,
        static_cast<int>(i) };
      f.Coordinate = f.End ? box.Upper[d] : box.Lower[d];
      std::size_t at = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(this->Dim); ++k)
      {
        if (k != d)
        {
          f.Lower[at] = box.Lower[k];
          f.Upper[at] = box.Upper[k];
          ++at;
        }
      }
      facings.push_back(f);
    }
    std::sort(facings.begin(), facings.end(),
      [](const Facing& a, const Facing& b)
      {
        return std::tie(a.Patch, a.Direction, a.Coordinate, a.Lower, a.Upper, a.End, a.Index) <
          std::tie(b.Patch, b.Direction, b.Coordinate, b.Lower, b.Upper, b.End, b.Index);
      });
    std::vector<bool> glued(this->Open.size(), false);
    std::vector<double> covered(this->Open.size(), 0.0);
    const auto glue = [&](const Facing& a, const Facing& b)
    {
      const Side sa = this->Open[static_cast<std::size_t>(a.Index)];
      const Side sb = this->Open[static_cast<std::size_t>(b.Index)];
      if (this->Sign(sa.Cell) != this->Sign(sb.Cell))
      {
        this->SetFolded(sa, sb);
      }
      this->CompareInner(sa, sb);
    };
    for (std::size_t begin = 0; begin < facings.size();)
    {
      std::size_t end = begin;
      while (end < facings.size() && facings[end].Patch == facings[begin].Patch &&
        facings[end].Direction == facings[begin].Direction &&
        facings[end].Coordinate == facings[begin].Coordinate)
      {
        ++end;
      }
      std::vector<const Facing*> rest[2];
      for (std::size_t i = begin; i < end; ++i)
      {
        const Facing& a = facings[i];
        if (i + 1 < end && a.Lower == facings[i + 1].Lower && a.Upper == facings[i + 1].Upper &&
          a.End == 0 && facings[i + 1].End == 1)
        {
          glued[static_cast<std::size_t>(a.Index)] = true;
          glued[static_cast<std::size_t>(facings[i + 1].Index)] = true;
          glue(facings[i + 1], a);
          ++i;
          continue;
        }
        rest[a.End].push_back(&a);
      }
      for (const Facing* a : rest[0])
      {
        for (const Facing* b : rest[1])
        {
          double area = 1.0;
          for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(this->Dim); ++k)
          {
            area *= std::max(
              0.0, std::min(a->Upper[k], b->Upper[k]) - std::max(a->Lower[k], b->Lower[k]));
          }
          if (area > 0.0)
          {
            covered[static_cast<std::size_t>(a->Index)] += area;
            covered[static_cast<std::size_t>(b->Index)] += area;
            glue(*b, *a);
            this->Uneven.push_back(this->Open[static_cast<std::size_t>(a->Index)]);
            this->Uneven.push_back(this->Open[static_cast<std::size_t>(b->Index)]);
          }
        }
      }
      for (const auto& list : rest)
      {
        for (const Facing* f : list)
        {
          double area = 1.0;
          for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(this->Dim); ++k)
          {
            area *= f->Upper[k] - f->Lower[k];
          }
          const double part = covered[static_cast<std::size_t>(f->Index)] / area;
          const Side side = this->Open[static_cast<std::size_t>(f->Index)];
          if (part > 1.0 - 1e-9)
          {
            glued[static_cast<std::size_t>(f->Index)] = true;
          }
          else if (part > 0.0 && this->Out.Partial[0] < 0)
          {
            this->Out.Partial = { side.Cell, side.Number };
          }
        }
      }
      begin = end;
    }
    this->KeepUnglued(glued);
  }

  void KeepUnglued(const std::vector<bool>& glued)
  {
    std::vector<Side> rest;
    for (std::size_t i = 0; i < this->Open.size(); ++i)
    {
      if (!glued[i])
      {
        rest.push_back(this->Open[i]);
      }
    }
    this->Open = std::move(rest);
  }

  int Sign(int c) const { return this->Signs[static_cast<std::size_t>(c)]; }
  void SetFolded(Side a, Side b)
  {
    if (this->Out.Folded[0] < 0)
    {
      this->Out.Folded = { a.Cell, a.Number, b.Cell, b.Number };
    }
  }

  /// Side coefficients of a tensor-product cell, first free parameter fastest, restricted to a part
  /// of its box and raised to a degree.
  std::vector<std::vector<double>> InnerSide(
    Side side, const ParametricBox<2>& part, const IntArray<2>& target)
  {
    const CellDegree& degree = this->Degree(side.Cell);
    const auto& box = this->Complex.Boxes[static_cast<std::size_t>(side.Cell)];
    IntArray<3> points{ degree[0] + 1, degree[1] + 1, this->Dim == 2 ? 1 : degree[2] + 1 };
    const auto free = SideDirections<3>(side.Number);
    const IntArray<2> sideDegree{ points[free[0]] - 1, points[free[1]] - 1 };
    const std::vector<int> coefficients = EntityIndices<3>(points, EntityOfSide<3>(side.Number));
    const int n = NumCellCoefficients(this->Shape(side.Cell), degree);
    std::vector<std::vector<double>> planes;
    for (int plane = 0; plane < this->Cells.NumPlanes(); ++plane)
    {
      std::vector<double> values;
      for (const int i : coefficients)
      {
        values.push_back(this->Cells.Block(side.Cell)[plane * n + i]);
      }
      for (int k = 0; k + 1 < this->Dim; ++k)
      {
        const std::size_t at = static_cast<std::size_t>(k);
        const std::size_t along = free[at];
        const double width = box.Upper[along] - box.Lower[along];
        const double low = (part.Lower[at] - box.Lower[along]) / width;
        const double high = (part.Upper[at] - box.Lower[along]) / width;
        if (low != 0.0 || high != 1.0)
        {
          values = BernsteinRestrict<2>(sideDegree, values, k, low, high);
        }
      }
      if (sideDegree != target)
      {
        values = BernsteinElevate<2>(sideDegree, values, target);
      }
      planes.push_back(std::move(values));
    }
    return planes;
  }

  /// How far two elements of a patch are apart where their boxes touch.
  void CompareInner(Side a, Side b)
  {
    const auto& boxA = this->Complex.Boxes[static_cast<std::size_t>(a.Cell)];
    const auto& boxB = this->Complex.Boxes[static_cast<std::size_t>(b.Cell)];
    ParametricBox<2> part;
    IntArray<2> target{};
    std::size_t at = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(this->Dim); ++k)
    {
      if (static_cast<int>(k) != a.Number / 2)
      {
        part.Lower[at] = std::max(boxA.Lower[k], boxB.Lower[k]);
        part.Upper[at] = std::min(boxA.Upper[k], boxB.Upper[k]);
        target[at] = std::max(this->Degree(a.Cell)[k], this->Degree(b.Cell)[k]);
        ++at;
      }
    }
    const auto x = this->InnerSide(a, part, target);
    const auto y = this->InnerSide(b, part, target);
    // the weights of a cell may have a common factor of their own
    const std::size_t w = static_cast<std::size_t>(this->Cells.NumComponents);
    double difference = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < x[0].size(); ++i)
    {
      for (std::size_t c = 0; c < w; ++c)
      {
        const double p = this->Cells.Rational ? x[c][i] / x[w][i] : x[c][i];
        const double q = this->Cells.Rational ? y[c][i] / y[w][i] : y[c][i];
        difference = std::max(difference, std::abs(p - q));
        largest = std::max({ largest, std::abs(p), std::abs(q) });
      }
      if (this->Cells.Rational)
      {
        const double ratio = (x[w][i] / x[w][0]) / (y[w][i] / y[w][0]);
        difference = std::max(difference, std::abs(ratio - 1.0) * largest);
      }
    }
    this->Out.InnerRounding = std::max(this->Out.InnerRounding, difference);
    if (difference > this->Params.InnerTolerance * largest &&
      (this->Out.Torn[0] < 0 || difference > this->Out.TornSize))
    {
      this->Out.Torn = { a.Cell, a.Number, b.Cell, b.Number };
      this->Out.TornSize = difference;
    }
  }

  bool IsPoint(int c, const std::vector<int>& coefficients, double tolerance) const
  {
    const auto first = this->Position(c, coefficients[0]);
    return std::all_of(coefficients.begin(), coefficients.end(),
      [&](int i) { return Distance(first, this->Position(c, i)) <= tolerance; });
  }

  /// Sides whose image has no area count for nothing in the degree; what they identify is joined.
  void RemoveCollapsed()
  {
    std::vector<bool> gone(this->Open.size(), false);
    for (std::size_t k = 0; k < this->Open.size(); ++k)
    {
      const int c = this->Open[k].Cell;
      const SideFrame& frame = GetSideFrame(this->Shape(c), this->Open[k].Number);
      const auto coefficients = SideCoefficients(this->Shape(c), this->Degree(c), frame);
      const double tolerance = this->Params.CollapseTolerance * this->LargestCoordinate(c);
      if (this->IsPoint(c, coefficients, tolerance))
      {
        gone[k] = true;
        for (int i = 1; i < frame.NumCorners; ++i)
        {
          this->JoinCorners(c, frame.Corners[0], c, frame.Corners[static_cast<std::size_t>(i)]);
        }
        continue;
      }
      if (frame.Shape != CellShape::Quadrilateral)
      {
        continue;
      }
      const CellLattice& lattice =
        this->Lattice(frame.Shape, SideDegree(this->Shape(c), this->Degree(c), frame));
      for (std::size_t d = 0; d < 2 && !gone[k]; ++d)
      {
        bool collapsed = true;
        for (const auto& line : lattice.Directions[d].Lines)
        {
          std::vector<int> points;
          for (const int i : line)
          {
            points.push_back(coefficients[static_cast<std::size_t>(i)]);
          }
          collapsed = collapsed && this->IsPoint(c, points, tolerance);
        }
        if (collapsed)
        {
          gone[k] = true;
          const int step = d == 0 ? 1 : 2;
          const auto& f = frame.Corners;
          const std::size_t other = static_cast<std::size_t>(3 - step);
          this->JoinCorners(c, f[0], c, f[static_cast<std::size_t>(step)]);
          this->JoinCorners(c, f[other], c, f[3]);
          this->Edges.Unite(this->EdgeId(c, f[0], f[other]),
            this->EdgeId(c, f[static_cast<std::size_t>(step)], f[3]));
        }
      }
    }
    this->Out.NumCollapsed = static_cast<int>(std::count(gone.begin(), gone.end(), true));
    for (std::size_t k = 0; k < gone.size(); ++k)
    {
      if (gone[k])
      {
        this->Uneven.push_back(this->Open[k]);
      }
    }
    this->KeepUnglued(gone);
  }

  /// An edge with glued sides alone around it is inside of the solid; when it is a point, all of
  /// its points have one image. Edges of sides that dropped out, or that finer sides cover, may lie
  /// on the boundary: they are left alone.
  void FindInnerPoint()
  {
    if (this->Dim != 3)
    {
      return;
    }
    std::vector<bool> isOuter(static_cast<std::size_t>(this->Cells.NumCells()) * 12, false);
    for (const auto* sides : { &this->Open, &this->Uneven })
    {
      for (const Side side : *sides)
      {
        const SideFrame& frame = GetSideFrame(this->Shape(side.Cell), side.Number);
        for (int e = 0; e < NumSideEdges(frame.Shape); ++e)
        {
          const auto ends = SideEdge(frame.Shape, e);
          const int id = this->EdgeId(side.Cell, frame.Corners[static_cast<std::size_t>(ends[0])],
            frame.Corners[static_cast<std::size_t>(ends[1])]);
          isOuter[static_cast<std::size_t>(this->Edges.Find(id))] = true;
        }
      }
    }
    for (int c = 0; c < this->Cells.NumCells(); ++c)
    {
      const CellLattice& lattice = this->Lattice(this->Shape(c), this->Degree(c));
      double tolerance = -1.0;
      for (const auto& direction : lattice.Directions)
      {
        for (const auto& line : direction.Lines)
        {
          const auto first =
            std::find(lattice.Corners.begin(), lattice.Corners.end(), line.front());
          const auto last = std::find(lattice.Corners.begin(), lattice.Corners.end(), line.back());
          if (first == lattice.Corners.end() || last == lattice.Corners.end())
          {
            continue;
          }
          const int a = static_cast<int>(first - lattice.Corners.begin());
          const int b = static_cast<int>(last - lattice.Corners.begin());
          if (isOuter[static_cast<std::size_t>(this->Edges.Find(this->EdgeId(c, a, b)))])
          {
            continue;
          }
          tolerance = tolerance < 0.0 ? this->Params.CollapseTolerance * this->LargestCoordinate(c)
                                      : tolerance;
          if (this->IsPoint(c, line, tolerance))
          {
            this->Out.InnerPoint = { c, a, b };
            return;
          }
        }
      }
    }
  }

  void JoinCorners(int a, int cornerA, int b, int cornerB)
  {
    this->Corners.Unite(this->CornerId(a, cornerA), this->CornerId(b, cornerB));
  }

  /// Values of a side in a frame, with signed zeros made equal.
  void FrameValues(Side side, const Reframe& reframe, const std::vector<int>& coefficients,
    std::vector<double>& values) const
  {
    const int n = NumCellCoefficients(this->Shape(side.Cell), this->Degree(side.Cell));
    const double* block = this->Cells.Block(side.Cell);
    values.clear();
    values.push_back(reframe.Degree[0]);
    values.push_back(reframe.Degree[1]);
    values.push_back(static_cast<double>(coefficients.size()));
    for (const int i : reframe.Coefficients)
    {
      for (int plane = 0; plane < this->Cells.NumPlanes(); ++plane)
      {
        values.push_back(block[plane * n + coefficients[static_cast<std::size_t>(i)]] + 0.0);
      }
    }
  }

  struct Canonical
  {
    std::vector<double> Values;
    const Reframe* Frame = nullptr;
  };
  Canonical MakeCanonical(Side side)
  {
    const CellShape shape = this->Shape(side.Cell);
    const SideFrame& frame = GetSideFrame(shape, side.Number);
    const auto coefficients = SideCoefficients(shape, this->Degree(side.Cell), frame);
    Canonical best;
    std::vector<double> values;
    for (const Reframe& reframe :
      this->Reframes(frame.Shape, SideDegree(shape, this->Degree(side.Cell), frame)))
    {
      this->FrameValues(side, reframe, coefficients, values);
      if (!best.Frame || values < best.Values)
      {
        best.Values = values;
        best.Frame = &reframe;
      }
    }
    return best;
  }
  static std::uint64_t Hash(const std::vector<double>& values)
  {
    std::uint64_t hash = 1469598103934665603ull;
    for (const double x : values)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ull;
      hash ^= hash >> 29;
    }
    return hash;
  }

  /// Glues sides whose control points agree bit by bit.
  void GlueEqual()
  {
    std::vector<std::pair<std::uint64_t, int>> hashes;
    for (std::size_t i = 0; i < this->Open.size(); ++i)
    {
      hashes.push_back({ Hash(this->MakeCanonical(this->Open[i]).Values), static_cast<int>(i) });
    }
    std::sort(hashes.begin(), hashes.end());
    std::vector<bool> glued(this->Open.size(), false);
    for (std::size_t begin = 0; begin < hashes.size();)
    {
      std::size_t end = begin + 1;
      while (end < hashes.size() && hashes[end].first == hashes[begin].first)
      {
        ++end;
      }
      for (std::size_t i = begin; i + 1 < end; ++i)
      {
        const std::size_t first = static_cast<std::size_t>(hashes[i].second);
        if (glued[first])
        {
          continue;
        }
        const Side a = this->Open[first];
        const Canonical ca = this->MakeCanonical(a);
        for (std::size_t j = i + 1; j < end; ++j)
        {
          const std::size_t second = static_cast<std::size_t>(hashes[j].second);
          const Side b = this->Open[second];
          const Canonical cb = this->MakeCanonical(b);
          if (ca.Values != cb.Values)
          {
            continue;
          }
          if (glued[second] || glued[first] ||
            ca.Frame->Parity * this->Sign(a.Cell) == cb.Frame->Parity * this->Sign(b.Cell))
          {
            this->SetFolded(a, b); // two of the cells lie on one side of it
          }
          glued[first] = true;
          glued[second] = true;
          this->GluePair(a, *ca.Frame, b, *cb.Frame);
        }
      }
      begin = end;
    }
    this->KeepUnglued(glued);
  }

  /// Control points of a side, Euclidean, with the weights relative to the first one's.
  std::vector<std::array<double, 4>> SidePoints(Side side) const
  {
    const CellShape shape = this->Shape(side.Cell);
    const int n = NumCellCoefficients(shape, this->Degree(side.Cell));
    const double* w = this->Cells.Block(side.Cell) + this->Cells.NumComponents * n;
    std::vector<std::array<double, 4>> points;
    for (const int i :
      SideCoefficients(shape, this->Degree(side.Cell), GetSideFrame(shape, side.Number)))
    {
      const auto x = this->Position(side.Cell, i);
      points.push_back({ x[0], x[1], x[2], this->Cells.Rational ? w[i] : 1.0 });
    }
    return points;
  }

  /// Glues what agrees up to rounding.
  void GlueNear()
  {
    const Eigen::Index n = static_cast<Eigen::Index>(this->Open.size());
    if (n == 0 || !(this->Params.InterfaceTolerance > 0.0))
    {
      return;
    }
    double largest = 0.0;
    PointMatrix lower = PointMatrix::Constant(n, 3, std::numeric_limits<double>::max());
    PointMatrix upper = -lower;
    std::vector<std::vector<std::array<double, 4>>> points;
    for (Eigen::Index i = 0; i < n; ++i)
    {
      points.push_back(this->SidePoints(this->Open[static_cast<std::size_t>(i)]));
      for (const auto& x : points.back())
      {
        for (int d = 0; d < 3; ++d)
        {
          lower(i, d) = std::min(lower(i, d), x[static_cast<std::size_t>(d)]);
          upper(i, d) = std::max(upper(i, d), x[static_cast<std::size_t>(d)]);
          largest = std::max(largest, std::abs(x[static_cast<std::size_t>(d)]));
        }
      }
    }
    const double tolerance = this->Params.InterfaceTolerance * largest;
    const BoxTree tree(lower, upper);
    std::vector<bool> glued(this->Open.size(), false);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const std::size_t first = static_cast<std::size_t>(i);
      double low[3];
      double high[3];
      for (int d = 0; d < 3; ++d)
      {
        low[d] = lower(i, d) - tolerance;
        high[d] = upper(i, d) + tolerance;
      }
      std::vector<int> near;
      tree.ForNear(low, high,
        [&](int j)
        {
          bool same = j > i;
          for (int d = 0; d < 3 && same; ++d)
          {
            same = std::abs(lower(j, d) - lower(i, d)) <= tolerance &&
              std::abs(upper(j, d) - upper(i, d)) <= tolerance;
          }
          if (same)
          {
            near.push_back(j);
          }
        });
      std::sort(near.begin(), near.end());
      for (const int j : near)
      {
        const std::size_t second = static_cast<std::size_t>(j);
        double difference = 0.0;
        const Reframe* frame = this->FindReframe(this->Open[first], points[first],
          this->Open[second], points[second], tolerance, difference);
        if (!frame)
        {
          continue;
        }
        const Side a = this->Open[first];
        const Side b = this->Open[second];
        const SideFrame& shape = GetSideFrame(this->Shape(a.Cell), a.Number);
        const Reframe& identity = this->Reframes(
          shape.Shape, SideDegree(this->Shape(a.Cell), this->Degree(a.Cell), shape))[0];
        if (glued[first] || glued[second] ||
          identity.Parity * this->Sign(a.Cell) == frame->Parity * this->Sign(b.Cell))
        {
          this->SetFolded(a, b);
        }
        glued[first] = true;
        glued[second] = true;
        this->Out.InnerRounding = std::max(this->Out.InnerRounding, difference);
        this->GluePair(a, identity, b, *frame);
      }
    }
    this->KeepUnglued(glued);
  }

  /// The way to look at side b in which it agrees with a, if any.
  const Reframe* FindReframe(Side a, const std::vector<std::array<double, 4>>& pa, Side b,
    const std::vector<std::array<double, 4>>& pb, double tolerance, double& difference)
  {
    const SideFrame& fa = GetSideFrame(this->Shape(a.Cell), a.Number);
    const SideFrame& fb = GetSideFrame(this->Shape(b.Cell), b.Number);
    if (fa.Shape != fb.Shape || pa.size() != pb.size())
    {
      return nullptr;
    }
    const Reframe& identity =
      this->Reframes(fa.Shape, SideDegree(this->Shape(a.Cell), this->Degree(a.Cell), fa))[0];
    for (const Reframe& reframe :
      this->Reframes(fb.Shape, SideDegree(this->Shape(b.Cell), this->Degree(b.Cell), fb)))
    {
      if (reframe.Degree != identity.Degree)
      {
        continue;
      }
      bool same = true;
      double largest = 0.0;
      const std::size_t firstA = static_cast<std::size_t>(identity.Coefficients[0]);
      const std::size_t firstB = static_cast<std::size_t>(reframe.Coefficients[0]);
      for (std::size_t k = 0; k < pa.size() && same; ++k)
      {
        const auto& x = pa[static_cast<std::size_t>(identity.Coefficients[k])];
        const auto& y = pb[static_cast<std::size_t>(reframe.Coefficients[k])];
        for (std::size_t d = 0; d < 3; ++d)
        {
          largest = std::max(largest, std::abs(x[d] - y[d]));
        }
        const double ratio = (x[3] / pa[firstA][3]) / (y[3] / pb[firstB][3]);
        same = largest <= tolerance &&
          std::abs(ratio - 1.0) <= std::max(this->Params.InterfaceTolerance, 0x1p-50);
      }
      if (same)
      {
        difference = largest;
        return &reframe;
      }
    }
    return nullptr;
  }

  void GluePair(Side a, const Reframe& fa, Side b, const Reframe& fb)
  {
    const SideFrame& sa = GetSideFrame(this->Shape(a.Cell), a.Number);
    const SideFrame& sb = GetSideFrame(this->Shape(b.Cell), b.Number);
    std::array<int, 4> ca{};
    std::array<int, 4> cb{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(sa.NumCorners); ++k)
    {
      ca[k] = sa.Corners[static_cast<std::size_t>(fa.Corners[k])];
      cb[k] = sb.Corners[static_cast<std::size_t>(fb.Corners[k])];
      this->JoinCorners(a.Cell, ca[k], b.Cell, cb[k]);
    }
    for (int e = 0; e < NumSideEdges(sa.Shape); ++e)
    {
      const auto ends = SideEdge(sa.Shape, e);
      const std::size_t i = static_cast<std::size_t>(ends[0]);
      const std::size_t j = static_cast<std::size_t>(ends[1]);
      this->Edges.Unite(this->EdgeId(a.Cell, ca[i], ca[j]), this->EdgeId(b.Cell, cb[i], cb[j]));
    }
    if (this->Patch(a.Cell) != this->Patch(b.Cell))
    {
      ++this->Out.NumInterfaces;
    }
    else if (!this->AreSameIds(a, b))
    {
      ++this->Out.NumSeams;
    }
  }

  /// Of sides of one patch with equal points: the same by what is known beside them?
  bool AreSameIds(Side a, Side b) const
  {
    if (a.Cell == b.Cell || (this->HasBox(a.Cell) && this->HasBox(b.Cell)))
    {
      return false;
    }
    if (this->Complex.PointIds.empty())
    {
      return true;
    }
    const auto sorted = [this](Side s)
    {
      std::vector<std::int64_t> ids;
      const CellShape shape = this->Shape(s.Cell);
      for (const int i :
        SideCoefficients(shape, this->Degree(s.Cell), GetSideFrame(shape, s.Number)))
      {
        ids.push_back(this->PointId(s.Cell, i));
      }
      std::sort(ids.begin(), ids.end());
      return ids;
    };
    return sorted(a) == sorted(b);
  }

  void AssembleBoundary()
  {
    // collapsed edges make their ends one point: before points are numbered
    for (const Side side : this->Open)
    {
      BoundarySide b;
      const CellShape shape = this->Shape(side.Cell);
      b.Cell = side.Cell;
      b.Number = side.Number;
      b.Frame = GetSideFrame(shape, side.Number);
      b.Degree = SideDegree(shape, this->Degree(side.Cell), b.Frame);
      b.Patch = this->Patch(side.Cell);
      b.Error =
        this->Cells.Errors.empty() ? 0.0 : this->Cells.Errors[static_cast<std::size_t>(b.Cell)];
      const auto coefficients = SideCoefficients(shape, this->Degree(side.Cell), b.Frame);
      const int n = NumCellCoefficients(shape, this->Degree(side.Cell));
      for (int plane = 0; plane < this->Cells.NumPlanes(); ++plane)
      {
        for (const int i : coefficients)
        {
          b.Data.push_back(this->Cells.Block(side.Cell)[plane * n + i]);
        }
      }
      const double tolerance = this->Params.CollapseTolerance * this->LargestCoordinate(side.Cell);
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const auto points = this->EdgePoints(b, e, coefficients);
        if (this->IsPoint(side.Cell, points, tolerance))
        {
          const auto ends = SideEdge(b.Frame.Shape, e);
          b.CollapsedEdges[static_cast<std::size_t>(e)] = true;
          this->JoinCorners(side.Cell, b.Frame.Corners[static_cast<std::size_t>(ends[0])],
            side.Cell, b.Frame.Corners[static_cast<std::size_t>(ends[1])]);
        }
      }
      this->Out.Boundary.push_back(std::move(b));
    }
    this->NumberPointsAndEdges();
    this->FindComponents();
  }

  std::vector<int> EdgePoints(
    const BoundarySide& side, int edge, const std::vector<int>& coefficients)
  {
    const CellLattice& lattice = this->Lattice(side.Frame.Shape, side.Degree);
    const auto ends = SideEdge(side.Frame.Shape, edge);
    for (const auto& direction : lattice.Directions)
    {
      for (std::size_t k = 0; k < direction.CornerPairs.size(); ++k)
      {
        const auto& pair = direction.CornerPairs[k];
        const bool forward = pair[0] == ends[0] && pair[1] == ends[1];
        if (!forward && !(pair[1] == ends[0] && pair[0] == ends[1]))
        {
          continue;
        }
        const int from = lattice.Corners[static_cast<std::size_t>(pair[0])];
        for (const auto& line : direction.Lines)
        {
          if (line.front() == from)
          {
            std::vector<int> points;
            for (const int i : line)
            {
              points.push_back(coefficients[static_cast<std::size_t>(i)]);
            }
            if (!forward)
            {
              std::reverse(points.begin(), points.end());
            }
            return points;
          }
        }
      }
    }
    return {};
  }

  void NumberPointsAndEdges()
  {
    DisjointSets places = this->Corners;
    DisjointSets edgePlaces = this->Edges;
    Merger<std::array<double, 3>> positions(places);
    Merger<std::vector<double>> polygons(edgePlaces);
    for (BoundarySide& b : this->Out.Boundary)
    {
      const CellShape shape = this->Shape(b.Cell);
      const auto coefficients = SideCoefficients(shape, this->Degree(b.Cell), b.Frame);
      const CellLattice& lattice = this->Lattice(b.Frame.Shape, b.Degree);
      for (std::size_t k = 0; k < static_cast<std::size_t>(b.Frame.NumCorners); ++k)
      {
        positions.Add(
          this->Position(b.Cell, coefficients[static_cast<std::size_t>(lattice.Corners[k])]),
          this->CornerId(b.Cell, b.Frame.Corners[k]));
      }
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        std::vector<double> there;
        const auto points = this->EdgePoints(b, e, coefficients);
        const auto ends = SideEdge(b.Frame.Shape, e);
        const int id = this->EdgeId(b.Cell, b.Frame.Corners[static_cast<std::size_t>(ends[0])],
          b.Frame.Corners[static_cast<std::size_t>(ends[1])]);
        if (b.CollapsedEdges[static_cast<std::size_t>(e)])
        {
          continue;
        }
        for (const int i : points)
        {
          const auto x = this->Position(b.Cell, i);
          there.insert(there.end(), x.begin(), x.end());
        }
        std::vector<double> back;
        for (auto i = points.rbegin(); i != points.rend(); ++i)
        {
          const auto x = this->Position(b.Cell, *i);
          back.insert(back.end(), x.begin(), x.end());
        }
        polygons.Add(std::min(there, back), id);
      }
    }
    std::map<std::array<double, 5>, int> lines;
    for (BoundarySide& b : this->Out.Boundary)
    {
      for (std::size_t k = 0; k < static_cast<std::size_t>(b.Frame.NumCorners); ++k)
      {
        const int id = this->CornerId(b.Cell, b.Frame.Corners[k]);
        b.Vertices[k] = this->Corners.Find(id);
        b.Places[k] = places.Find(id);
      }
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const std::size_t at = static_cast<std::size_t>(e);
        const auto ends = SideEdge(b.Frame.Shape, e);
        const int c0 = b.Frame.Corners[static_cast<std::size_t>(ends[0])];
        const int c1 = b.Frame.Corners[static_cast<std::size_t>(ends[1])];
        b.Edges[at] = edgePlaces.Find(this->EdgeId(b.Cell, c0, c1));
        if (this->HasBox(b.Cell))
        {
          const auto u = this->BoxCorner(b.Cell, c0);
          const auto v = this->BoxCorner(b.Cell, c1);
          std::array<double, 5> key{ static_cast<double>(b.Patch), 0., 0., 0., 0. };
          for (std::size_t d = 0; d < 3; ++d)
          {
            if (u[d] != v[d])
            {
              key[1] = static_cast<double>(d);
              b.LineEnds[at] = { u[d], v[d] };
            }
            else
            {
              key[d + 2] = u[d];
            }
          }
          b.Lines[at] = lines.try_emplace(key, static_cast<int>(lines.size())).first->second;
        }
      }
    }
  }

  void FindComponents()
  {
    auto& boundary = this->Out.Boundary;
    DisjointSets components(static_cast<int>(boundary.size()));
    std::map<int, std::vector<std::pair<int, int>>> atPlace; // sides and their corners
    for (std::size_t i = 0; i < boundary.size(); ++i)
    {
      for (int k = 0; k < boundary[i].Frame.NumCorners; ++k)
      {
        atPlace[boundary[i].Places[static_cast<std::size_t>(k)]].push_back(
          { static_cast<int>(i), k });
      }
    }
    const auto setOpen = [&](int side)
    {
      if (this->Out.Open[0] < 0)
      {
        const auto& b = boundary[static_cast<std::size_t>(side)];
        this->Out.Open = { b.Cell, b.Number };
      }
    };
    if (this->Dim == 2)
    {
      for (const auto& [place, sides] : atPlace)
      {
        for (const auto& s : sides)
        {
          components.Unite(sides[0].first, s.first);
        }
        if (sides.size() % 2 != 0)
        {
          setOpen(sides[0].first);
        }
        this->Out.NumTouching += sides.size() > 2 ? 1 : 0;
      }
    }
    else
    {
      DisjointSets fans(static_cast<int>(boundary.size()) * 4);
      std::map<int, std::vector<int>> byEdge;
      std::map<int, std::vector<int>> byLine;
      for (std::size_t i = 0; i < boundary.size(); ++i)
      {
        const BoundarySide& b = boundary[i];
        for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
        {
          const std::size_t at = static_cast<std::size_t>(e);
          const auto ends = SideEdge(b.Frame.Shape, e);
          if (b.CollapsedEdges[at])
          {
            fans.Unite(static_cast<int>(i) * 4 + ends[0], static_cast<int>(i) * 4 + ends[1]);
            continue;
          }
          byEdge[b.Edges[at]].push_back(static_cast<int>(i));
          if (b.Lines[at] >= 0)
          {
            byLine[b.Lines[at]].push_back(static_cast<int>(i));
          }
        }
      }
      for (std::size_t i = 0; i < boundary.size(); ++i)
      {
        const BoundarySide& b = boundary[i];
        std::vector<int> near{ static_cast<int>(i) };
        for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
        {
          const std::size_t at = static_cast<std::size_t>(e);
          if (!b.CollapsedEdges[at])
          {
            const auto& same = byEdge[b.Edges[at]];
            near.insert(near.end(), same.begin(), same.end());
            if (b.Lines[at] >= 0)
            {
              const auto& line = byLine[b.Lines[at]];
              near.insert(near.end(), line.begin(), line.end());
            }
          }
        }
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        std::array<double, 4> covered{};
        for (const int j : near)
        {
          for (const SideContact& contact : FindContacts(boundary, static_cast<int>(i), j))
          {
            if (!contact.IsEdge)
            {
              continue;
            }
            covered[static_cast<std::size_t>(contact.A)] += std::abs(contact.A1 - contact.A0);
            components.Unite(static_cast<int>(i), j);
            const BoundarySide& other = boundary[static_cast<std::size_t>(j)];
            for (const int ka : SideEdge(b.Frame.Shape, contact.A))
            {
              for (const int kb : SideEdge(other.Frame.Shape, contact.B))
              {
                if (b.Places[static_cast<std::size_t>(ka)] ==
                  other.Places[static_cast<std::size_t>(kb)])
                {
                  fans.Unite(static_cast<int>(i) * 4 + ka, j * 4 + kb);
                }
              }
            }
          }
        }
        for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
        {
          const std::size_t at = static_cast<std::size_t>(e);
          if (!b.CollapsedEdges[at] && covered[at] < 1.0 - 1e-9)
          {
            setOpen(static_cast<int>(i));
          }
          this->Out.NumTouching += covered[at] > 1.0 + 1e-9 ? 1 : 0;
        }
      }
      for (const auto& [place, sides] : atPlace)
      {
        int fan = -1;
        bool several = false;
        for (const auto& [side, corner] : sides)
        {
          const int f = fans.Find(side * 4 + corner);
          several = several || (fan >= 0 && f != fan);
          fan = f;
        }
        this->Out.NumTouching += several ? 1 : 0;
      }
    }
    std::map<int, int> numbers;
    for (std::size_t i = 0; i < boundary.size(); ++i)
    {
      boundary[i].Component =
        numbers.try_emplace(components.Find(static_cast<int>(i)), static_cast<int>(numbers.size()))
          .first->second;
    }
    this->Out.NumComponents = static_cast<int>(numbers.size());
  }

  const BernsteinCells& Cells;
  const CellComplex& Complex;
  const std::vector<int>& Signs;
  const InjectivityParams& Params;
  DisjointSets Corners;
  DisjointSets Edges;
  std::vector<std::array<int, 2>> EdgeCorners[NumCellShapes];
  std::map<std::pair<int, CellDegree>, std::vector<Reframe>> ReframeCache;
  CellLatticeTable Lattices;
  std::vector<Side> Open;
  std::vector<Side> Uneven; ///< sides that dropped out, and those that cover each other in parts
  int Dim = 2;
  CellGluing Out;
};
}

int NumSides(CellShape shape)
{
  return static_cast<int>(Frames(shape).size());
}

const SideFrame& GetSideFrame(CellShape shape, int side)
{
  return Frames(shape)[static_cast<std::size_t>(side)];
}

CellDegree SideDegree(CellShape shape, const CellDegree& degree, const SideFrame& frame)
{
  const auto along = [&](int from, int to)
  {
    const auto a = CornerParameters(shape, from);
    const auto b = CornerParameters(shape, to);
    for (std::size_t d = 0; d < 3; ++d)
    {
      if (a[d] != b[d])
      {
        return degree[d];
      }
    }
    return 0;
  };
  CellDegree out{ along(frame.Corners[0], frame.Corners[1]), 0, 0 };
  if (frame.NumCorners > 2)
  {
    out[1] = along(frame.Corners[0], frame.Corners[2]);
  }
  return out;
}

std::vector<int> SideCoefficients(CellShape shape, const CellDegree& degree, const SideFrame& frame)
{
  const CellDegree side = SideDegree(shape, degree, frame);
  std::array<std::array<int, 3>, 3> corner{};
  for (std::size_t k = 0; k < std::min<std::size_t>(3, static_cast<std::size_t>(frame.NumCorners));
       ++k)
  {
    const auto u = CornerParameters(shape, frame.Corners[k]);
    for (std::size_t d = 0; d < 3; ++d)
    {
      corner[k][d] = static_cast<int>(u[d]);
    }
  }
  std::vector<int> coefficients;
  for (int j = 0; j <= side[1]; ++j)
  {
    for (int i = 0; i <= side[0]; ++i)
    {
      if (frame.Shape == CellShape::Triangle && i + j > side[0])
      {
        continue;
      }
      int at[3];
      for (std::size_t d = 0; d < 3; ++d)
      {
        at[d] = corner[0][d] * degree[d] + i * (corner[1][d] - corner[0][d]) +
          (frame.NumCorners > 2 ? j * (corner[2][d] - corner[0][d]) : 0);
      }
      coefficients.push_back(CellCoefficient(shape, degree, at[0], at[1], at[2]));
    }
  }
  return coefficients;
}

std::array<double, 3> SideToCell(CellShape shape, const SideFrame& frame, const double* s)
{
  const auto a = CornerParameters(shape, frame.Corners[0]);
  const auto b = CornerParameters(shape, frame.Corners[1]);
  const auto c = CornerParameters(shape, frame.Corners[2]);
  std::array<double, 3> u{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    u[d] = a[d] + s[0] * (b[d] - a[d]) + (frame.NumCorners > 2 ? s[1] * (c[d] - a[d]) : 0.0);
  }
  return u;
}

int NumSideEdges(CellShape side)
{
  return side == CellShape::Quadrilateral ? 4 : side == CellShape::Triangle ? 3 : 0;
}

std::array<int, 2> SideEdge(CellShape side, int edge)
{
  static constexpr std::array<int, 2> quad[4] = { { 0, 1 }, { 1, 3 }, { 3, 2 }, { 2, 0 } };
  static constexpr std::array<int, 2> triangle[3] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };
  return side == CellShape::Triangle ? triangle[edge] : quad[edge];
}

double EdgeParameter(CellShape side, int edge, const std::array<double, 3>& s)
{
  const bool triangle = side == CellShape::Triangle;
  switch (edge)
  {
    case 0:
      return s[1] == 0.0 ? s[0] : -1.0;
    case 1:
      return (triangle ? s[0] + s[1] == 1.0 : s[0] == 1.0) ? s[1] : -1.0;
    case 2:
      return triangle ? (s[0] == 0.0 ? 1.0 - s[1] : -1.0) : (s[1] == 1.0 ? 1.0 - s[0] : -1.0);
    default:
      return s[0] == 0.0 ? 1.0 - s[1] : -1.0;
  }
}

CellGluing GlueCells(const BernsteinCells& cells, const CellComplex& complex,
  const std::vector<int>& signs, const InjectivityParams& params)
{
  return Gluer(cells, complex, signs, params).Run();
}

std::vector<SideContact> FindContacts(const std::vector<BoundarySide>& boundary, int a, int b)
{
  const BoundarySide& x = boundary[static_cast<std::size_t>(a)];
  const BoundarySide& y = boundary[static_cast<std::size_t>(b)];
  std::vector<SideContact> contacts;
  for (int i = 0; i < NumSideEdges(x.Frame.Shape); ++i)
  {
    const std::size_t ei = static_cast<std::size_t>(i);
    for (int j = 0; j < NumSideEdges(y.Frame.Shape); ++j)
    {
      const std::size_t ej = static_cast<std::size_t>(j);
      if ((a == b && i == j) || x.CollapsedEdges[ei] || y.CollapsedEdges[ej])
      {
        continue;
      }
      SideContact contact;
      contact.IsEdge = true;
      contact.A = i;
      contact.B = j;
      if (x.Edges[ei] == y.Edges[ej])
      {
        const auto endsX = SideEdge(x.Frame.Shape, i);
        const auto endsY = SideEdge(y.Frame.Shape, j);
        const bool forward = x.Places[static_cast<std::size_t>(endsX[0])] ==
            y.Places[static_cast<std::size_t>(endsY[0])] &&
          x.Places[static_cast<std::size_t>(endsX[1])] ==
            y.Places[static_cast<std::size_t>(endsY[1])];
        if (!forward)
        {
          std::swap(contact.B0, contact.B1);
        }
        contacts.push_back(contact);
      }
      else if (x.Lines[ei] >= 0 && x.Lines[ei] == y.Lines[ej])
      {
        const auto& p = x.LineEnds[ei];
        const auto& q = y.LineEnds[ej];
        const double low = std::max(std::min(p[0], p[1]), std::min(q[0], q[1]));
        const double high = std::min(std::max(p[0], p[1]), std::max(q[0], q[1]));
        if (low < high)
        {
          const auto place = [](const std::array<double, 2>& ends, double t) {
            return std::ldexp(std::round(std::ldexp((t - ends[0]) / (ends[1] - ends[0]), 40)), -40);
          };
          contact.A0 = place(p, low);
          contact.A1 = place(p, high);
          contact.B0 = place(q, low);
          contact.B1 = place(q, high);
          contacts.push_back(contact);
        }
      }
    }
  }
  for (int i = 0; i < x.Frame.NumCorners; ++i)
  {
    for (int j = 0; j < y.Frame.NumCorners; ++j)
    {
      bool isPole = false; // of one collapsed edge: one corner
      for (int e = 0; a == b && e < NumSideEdges(x.Frame.Shape); ++e)
      {
        const auto ends = SideEdge(x.Frame.Shape, e);
        isPole = isPole ||
          (x.CollapsedEdges[static_cast<std::size_t>(e)] &&
            std::min(i, j) == std::min(ends[0], ends[1]) &&
            std::max(i, j) == std::max(ends[0], ends[1]));
      }
      if (!(a == b && i == j) && !isPole &&
        x.Places[static_cast<std::size_t>(i)] == y.Places[static_cast<std::size_t>(j)])
      {
        contacts.push_back({ false, i, j, 0.0, 1.0, 0.0, 1.0 });
      }
    }
  }
  return contacts;
}
}
