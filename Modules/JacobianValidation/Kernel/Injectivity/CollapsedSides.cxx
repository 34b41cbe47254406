// SPDX-License-Identifier: BSD-3-Clause
#include "CollapsedSides.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
class CollapsedSides
{
public:
  explicit CollapsedSides(GluingState& state) : State(state) {}

  /// Sides whose image has no area count for nothing in the degree; what they identify is joined.
  void RemoveCollapsed()
  {
    std::vector<bool> gone(this->State.Open.size(), false);
    for (std::size_t k = 0; k < this->State.Open.size(); ++k)
    {
      const int c = this->State.Open[k].Cell;
      const SideFrame& frame = GetSideFrame(this->State.Shape(c), this->State.Open[k].Number);
      const auto coefficients =
        SideCoefficients(this->State.Shape(c), this->State.Degree(c), frame);
      const double tolerance =
        this->State.Params.CollapseTolerance * this->State.LargestCoordinate(c);
      if (this->State.IsPoint(c, coefficients, tolerance))
      {
        gone[k] = true;
        for (int i = 1; i < frame.NumCorners; ++i)
        {
          this->State.JoinCorners(
            c, frame.Corners[0], c, frame.Corners[static_cast<std::size_t>(i)]);
        }
        continue;
      }
      if (frame.Shape != CellShape::Quadrilateral)
      {
        continue;
      }
      const CellLattice& lattice = this->State.Lattice(
        frame.Shape, SideDegree(this->State.Shape(c), this->State.Degree(c), frame));
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
          collapsed = collapsed && this->State.IsPoint(c, points, tolerance);
        }
        if (collapsed)
        {
          gone[k] = true;
          const int step = d == 0 ? 1 : 2;
          const auto& f = frame.Corners;
          const std::size_t other = static_cast<std::size_t>(3 - step);
          this->State.JoinCorners(c, f[0], c, f[static_cast<std::size_t>(step)]);
          this->State.JoinCorners(c, f[other], c, f[3]);
          this->State.Edges.Unite(this->State.EdgeId(c, f[0], f[other]),
            this->State.EdgeId(c, f[static_cast<std::size_t>(step)], f[3]));
        }
      }
    }
    this->State.Out.NumCollapsed = static_cast<int>(std::count(gone.begin(), gone.end(), true));
    for (std::size_t k = 0; k < gone.size(); ++k)
    {
      if (gone[k])
      {
        this->State.Uneven.push_back(this->State.Open[k]);
      }
    }
    this->State.KeepUnglued(gone);
  }

  /// An edge with glued sides alone around it is inside of the solid; when it is a point, all of
  /// its points have one image. Edges of sides that dropped out, or that finer sides cover, may lie
  /// on the boundary: they are left alone.
  void FindInnerPoint()
  {
    if (this->State.Dim != 3)
    {
      return;
    }
    std::vector<bool> isOuter(static_cast<std::size_t>(this->State.Cells.NumCells()) * 12, false);
    for (const auto* sides : { &this->State.Open, &this->State.Uneven })
    {
      for (const SideOfCell side : *sides)
      {
        const SideFrame& frame = GetSideFrame(this->State.Shape(side.Cell), side.Number);
        for (int e = 0; e < NumSideEdges(frame.Shape); ++e)
        {
          const auto ends = SideEdge(frame.Shape, e);
          const int id =
            this->State.EdgeId(side.Cell, frame.Corners[static_cast<std::size_t>(ends[0])],
              frame.Corners[static_cast<std::size_t>(ends[1])]);
          isOuter[static_cast<std::size_t>(this->State.Edges.Find(id))] = true;
        }
      }
    }
    for (int c = 0; c < this->State.Cells.NumCells(); ++c)
    {
      const CellLattice& lattice = this->State.Lattice(this->State.Shape(c), this->State.Degree(c));
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
          if (isOuter[static_cast<std::size_t>(
                this->State.Edges.Find(this->State.EdgeId(c, a, b)))])
          {
            continue;
          }
          tolerance = tolerance < 0.0
            ? this->State.Params.CollapseTolerance * this->State.LargestCoordinate(c)
            : tolerance;
          if (this->State.IsPoint(c, line, tolerance))
          {
            this->State.Out.InnerPoint = { c, a, b };
            return;
          }
        }
      }
    }
  }

private:
  GluingState& State;
};
}

void RemoveCollapsed(GluingState& state)
{
  CollapsedSides(state).RemoveCollapsed();
}

void FindInnerPoint(GluingState& state)
{
  CollapsedSides(state).FindInnerPoint();
}
}
