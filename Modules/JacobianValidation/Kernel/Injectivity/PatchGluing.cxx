// SPDX-License-Identifier: BSD-3-Clause
#include "PatchGluing.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/PatchSides.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
class PatchGluer
{
public:
  explicit PatchGluer(GluingState& state) : State(state) {}

  /// Corners and edges that ids or parameters identify.
  void JoinKnownPoints()
  {
    Merger<std::pair<int, std::array<double, 3>>> corners(this->State.Corners);
    Merger<std::pair<int, std::array<double, 6>>> edges(this->State.Edges);
    Merger<std::int64_t> ids(this->State.Corners);
    Merger<std::array<std::int64_t, 4>> edgeIds(this->State.Edges);
    for (int c = 0; c < this->State.Cells.NumCells(); ++c)
    {
      const CellShape shape = this->State.Shape(c);
      if (this->State.HasBox(c))
      {
        for (int k = 0; k < NumCorners(shape); ++k)
        {
          corners.Add(
            { this->State.Patch(c), this->State.BoxCorner(c, k) }, this->State.CornerId(c, k));
        }
        for (const auto& ends : this->State.EdgeCorners[static_cast<int>(shape)])
        {
          const auto a = this->State.BoxCorner(c, ends[0]);
          const auto b = this->State.BoxCorner(c, ends[1]);
          edges.Add({ this->State.Patch(c), { a[0], a[1], a[2], b[0], b[1], b[2] } },
            this->State.EdgeId(c, ends[0], ends[1]));
        }
      }
      if (!this->State.Complex.PointIds.empty())
      {
        const CellLattice& lattice = this->State.Lattice(shape, this->State.Degree(c));
        for (int k = 0; k < NumCorners(shape); ++k)
        {
          ids.Add(this->State.PointId(c, lattice.Corners[static_cast<std::size_t>(k)]),
            this->State.CornerId(c, k));
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
              inner += this->State.PointId(c, line[i]);
            }
            const std::int64_t a = this->State.PointId(c, line.front());
            const std::int64_t b = this->State.PointId(c, line.back());
            edgeIds.Add(
              { std::min(a, b), std::max(a, b), inner, static_cast<std::int64_t>(line.size()) },
              this->State.EdgeId(c, static_cast<int>(first - lattice.Corners.begin()),
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
    for (std::size_t i = 0; i < this->State.Open.size(); ++i)
    {
      const SideOfCell side = this->State.Open[i];
      if (!this->State.HasBox(side.Cell))
      {
        continue;
      }
      const auto& box = this->State.Complex.Boxes[static_cast<std::size_t>(side.Cell)];
      const std::size_t d = static_cast<std::size_t>(side.Number / 2);
      Facing f{ this->State.Patch(side.Cell), side.Number / 2, 0.0, {}, {}, side.Number % 2,
        static_cast<int>(i) };
      f.Coordinate = f.End ? box.Upper[d] : box.Lower[d];
      std::size_t at = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(this->State.Dim); ++k)
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
    std::vector<bool> glued(this->State.Open.size(), false);
    std::vector<double> covered(this->State.Open.size(), 0.0);
    const auto glue = [&](const Facing& a, const Facing& b)
    {
      const SideOfCell sa = this->State.Open[static_cast<std::size_t>(a.Index)];
      const SideOfCell sb = this->State.Open[static_cast<std::size_t>(b.Index)];
      if (this->State.Sign(sa.Cell) != this->State.Sign(sb.Cell))
      {
        this->State.SetFolded(sa, sb);
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
          for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(this->State.Dim); ++k)
          {
            area *= std::max(
              0.0, std::min(a->Upper[k], b->Upper[k]) - std::max(a->Lower[k], b->Lower[k]));
          }
          if (area > 0.0)
          {
            covered[static_cast<std::size_t>(a->Index)] += area;
            covered[static_cast<std::size_t>(b->Index)] += area;
            glue(*b, *a);
            this->State.Uneven.push_back(this->State.Open[static_cast<std::size_t>(a->Index)]);
            this->State.Uneven.push_back(this->State.Open[static_cast<std::size_t>(b->Index)]);
          }
        }
      }
      for (const auto& list : rest)
      {
        for (const Facing* f : list)
        {
          double area = 1.0;
          for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(this->State.Dim); ++k)
          {
            area *= f->Upper[k] - f->Lower[k];
          }
          const double part = covered[static_cast<std::size_t>(f->Index)] / area;
          const SideOfCell side = this->State.Open[static_cast<std::size_t>(f->Index)];
          if (part > 1.0 - 1e-9)
          {
            glued[static_cast<std::size_t>(f->Index)] = true;
          }
          else if (part > 0.0 && this->State.Out.Partial[0] < 0)
          {
            this->State.Out.Partial = { side.Cell, side.Number };
          }
        }
      }
      begin = end;
    }
    this->State.KeepUnglued(glued);
  }

private:
  /// SideOfCell coefficients of a tensor-product cell, first free parameter fastest, restricted to
  /// a part of its box and raised to a degree.
  std::vector<std::vector<double>> InnerSide(
    SideOfCell side, const ParametricBox<2>& part, const IntArray<2>& target)
  {
    const CellDegree& degree = this->State.Degree(side.Cell);
    const auto& box = this->State.Complex.Boxes[static_cast<std::size_t>(side.Cell)];
    IntArray<3> points{ degree[0] + 1, degree[1] + 1, this->State.Dim == 2 ? 1 : degree[2] + 1 };
    const auto free = SideDirections<3>(side.Number);
    const IntArray<2> sideDegree{ points[free[0]] - 1, points[free[1]] - 1 };
    const std::vector<int> coefficients = EntityIndices<3>(points, EntityOfSide<3>(side.Number));
    const int n = NumCellCoefficients(this->State.Shape(side.Cell), degree);
    std::vector<std::vector<double>> planes;
    for (int plane = 0; plane < this->State.Cells.NumPlanes(); ++plane)
    {
      std::vector<double> values;
      for (const int i : coefficients)
      {
        values.push_back(this->State.Cells.Block(side.Cell)[plane * n + i]);
      }
      for (int k = 0; k + 1 < this->State.Dim; ++k)
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
  void CompareInner(SideOfCell a, SideOfCell b)
  {
    const auto& boxA = this->State.Complex.Boxes[static_cast<std::size_t>(a.Cell)];
    const auto& boxB = this->State.Complex.Boxes[static_cast<std::size_t>(b.Cell)];
    ParametricBox<2> part;
    IntArray<2> target{};
    std::size_t at = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(this->State.Dim); ++k)
    {
      if (static_cast<int>(k) != a.Number / 2)
      {
        part.Lower[at] = std::max(boxA.Lower[k], boxB.Lower[k]);
        part.Upper[at] = std::min(boxA.Upper[k], boxB.Upper[k]);
        target[at] = std::max(this->State.Degree(a.Cell)[k], this->State.Degree(b.Cell)[k]);
        ++at;
      }
    }
    const auto x = this->InnerSide(a, part, target);
    const auto y = this->InnerSide(b, part, target);
    // the weights of a cell may have a common factor of their own
    const std::size_t w = static_cast<std::size_t>(this->State.Cells.NumComponents);
    double difference = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < x[0].size(); ++i)
    {
      for (std::size_t c = 0; c < w; ++c)
      {
        const double p = this->State.Cells.Rational ? x[c][i] / x[w][i] : x[c][i];
        const double q = this->State.Cells.Rational ? y[c][i] / y[w][i] : y[c][i];
        difference = std::max(difference, std::abs(p - q));
        largest = std::max({ largest, std::abs(p), std::abs(q) });
      }
      if (this->State.Cells.Rational)
      {
        const double ratio = (x[w][i] / x[w][0]) / (y[w][i] / y[w][0]);
        difference = std::max(difference, std::abs(ratio - 1.0) * largest);
      }
    }
    this->State.Out.InnerRounding = std::max(this->State.Out.InnerRounding, difference);
    if (difference > this->State.Params.InnerTolerance * largest &&
      (this->State.Out.Torn[0] < 0 || difference > this->State.Out.TornSize))
    {
      this->State.Out.Torn = { a.Cell, a.Number, b.Cell, b.Number };
      this->State.Out.TornSize = difference;
    }
  }

  GluingState& State;
};
}

void JoinKnownPoints(GluingState& state)
{
  PatchGluer(state).JoinKnownPoints();
}

void GlueBoxes(GluingState& state)
{
  PatchGluer(state).GlueBoxes();
}
}
