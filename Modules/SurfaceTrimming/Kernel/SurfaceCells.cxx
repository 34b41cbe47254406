// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCells.h"

#include "Bernstein.h"
#include "ChordalBound.h"
#include "Parallel.h"

#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double Side(const ParametricBox<2>& box, int d)
{
  return box.Upper[At(d)] - box.Lower[At(d)];
}

/// Bounds of the second derivatives on a part of an element, by the domain's parameters.
std::array<double, 3> BoundSecond(
  const BezierForm<2>& form, int element, const ParametricBox<2>& part)
{
  const auto& e = form.Space->Elements[At(element)];
  const std::size_t size = At(NumTensorFunctions<2>(e.Degree));
  std::vector<double> net;
  for (int plane = 0; plane < form.NumPlanes(); ++plane)
  {
    const double* begin = form.Block(element) + At(plane) * size;
    std::vector<double> values(begin, begin + size);
    for (int d = 0; d < 2; ++d)
    {
      const double scale = 1.0 / Side(e.Box, d);
      const double lower = (part.Lower[At(d)] - e.Box.Lower[At(d)]) * scale;
      const double upper = (part.Upper[At(d)] - e.Box.Lower[At(d)]) * scale;
      if (lower > 0.0 || upper < 1.0)
      {
        values = BernsteinRestrict<2>(e.Degree, values, d, lower, upper);
      }
    }
    net.insert(net.end(), values.begin(), values.end());
  }
  const auto bound =
    BoundSecondDerivatives<2>(e.Degree, form.NumComponents, form.Rational, net.data());
  const double u = Side(part, 0);
  const double v = Side(part, 1);
  return { bound[0] / (u * u), bound[1] / (u * v), bound[3] / (v * v) };
}

/// Bounds on all elements: the second derivatives by their control nets, the first ones by their
/// values in the middle and the mean value theorem.
std::vector<DerivativeBounds> BoundElements(const BezierForm<2>& form, int threads)
{
  const int n = form.Space->NumElements();
  std::vector<int> elements(At(n));
  for (int e = 0; e < n; ++e)
  {
    elements[At(e)] = e;
  }
  EvaluationBatch middle;
  EvaluateElements<2>(form, elements, PointMatrix::Constant(n, 2, 0.5), { 1, threads }, middle);
  std::vector<DerivativeBounds> bounds(At(n));
  ParallelFor(At(n), 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        const ParametricBox<2>& box = form.Space->Elements[e].Box;
        DerivativeBounds& bound = bounds[e];
        bound.Second = BoundSecond(form, static_cast<int>(e), box);
        for (int d = 0; d < 2; ++d)
        {
          bound.First[At(d)] =
            middle.First.row(static_cast<Eigen::Index>(e)).segment<3>(3 * d).norm() +
            0.5 * (bound.Second[At(d)] * Side(box, 0) + bound.Second[At(d + 1)] * Side(box, 1));
        }
      }
    });
  return bounds;
}

/// A cell that may be divided, and its elements: [Begin, End) in each direction.
struct Range
{
  int Cell = 0;
  IntArray<2> Begin{};
  IntArray<2> End{};
  int Halvings = 0; ///< since the bounds were taken
};
}

void DerivativeBounds::Include(const DerivativeBounds& other)
{
  for (std::size_t i = 0; i < 2; ++i)
  {
    this->First[i] = std::max(this->First[i], other.First[i]);
  }
  for (std::size_t i = 0; i < 3; ++i)
  {
    this->Second[i] = std::max(this->Second[i], other.Second[i]);
  }
}

double ChordalDeviation(const DerivativeBounds& bounds, const std::array<double, 2>& sides)
{
  return (bounds.Second[0] * sides[0] * sides[0] + 2.0 * bounds.Second[1] * sides[0] * sides[1] +
           bounds.Second[2] * sides[1] * sides[1]) /
    8.0;
}

Result<SurfaceCells> SurfaceCells::Create(
  const BezierForm<2>& form, double tolerance, std::size_t maxCells, int threads)
{
  const auto& knots = form.Space->Knots;
  const std::vector<DerivativeBounds> elements = BoundElements(form, threads);
  SurfaceCells cells;
  for (int d = 0; d < 2; ++d)
  {
    const KnotVector& k = knots[At(d)];
    for (int b = 1; b < k.NumElements(); ++b)
    {
      if (k.Multiplicity(b) >= k.Degree())
      {
        cells.Breaks[At(d)].push_back(k.Breaks()[At(b)]);
      }
    }
  }
  const auto boundOf = [&](const Range& range)
  {
    DerivativeBounds bounds;
    for (int j = range.Begin[1]; j < range.End[1]; ++j)
    {
      for (int i = range.Begin[0]; i < range.End[0]; ++i)
      {
        bounds.Include(elements[At(i + knots[0].NumElements() * j)]);
      }
    }
    return bounds;
  };
  Range whole;
  whole.End = { knots[0].NumElements(), knots[1].NumElements() };
  cells.Tree.push_back({ form.Space->Domain(), boundOf(whole), -1 });
  std::vector<Range> stack{ whole };
  while (!stack.empty())
  {
    const Range range = stack.back();
    stack.pop_back();
    const Cell cell = cells.Tree[At(range.Cell)];
    const std::array<double, 2> sides{ Side(cell.Box, 0), Side(cell.Box, 1) };
    int direction = -1;
    double at = 0.0;
    for (int d = 0; d < 2 && direction < 0; ++d) // creases first, the middle one of them
    {
      const auto& breaks = cells.Breaks[At(d)];
      const auto first = std::upper_bound(breaks.begin(), breaks.end(), cell.Box.Lower[At(d)]);
      const auto last = std::lower_bound(breaks.begin(), breaks.end(), cell.Box.Upper[At(d)]);
      if (first < last)
      {
        direction = d;
        at = *(first + (last - first) / 2);
      }
    }
    if (direction < 0)
    {
      if (ChordalDeviation(cell.Bounds, sides) <= tolerance)
      {
        continue;
      }
      direction =
        cell.Bounds.Second[0] * sides[0] * sides[0] >= cell.Bounds.Second[2] * sides[1] * sides[1]
        ? 0
        : 1;
      const int begin = range.Begin[At(direction)];
      const int end = range.End[At(direction)];
      at = end - begin > 1 ? knots[At(direction)].Breaks()[At(begin + (end - begin) / 2)]
                           : 0.5 * (cell.Box.Lower[At(direction)] + cell.Box.Upper[At(direction)]);
    }
    if (cells.Tree.size() > 2 * maxCells)
    {
      return { ErrorCode::TooLarge, "more than " + std::to_string(maxCells) + " cells" };
    }
    const int children = static_cast<int>(cells.Tree.size());
    cells.Tree[At(range.Cell)].Children = children;
    for (int upper = 0; upper < 2; ++upper)
    {
      Range part = range;
      part.Cell = children + upper;
      Cell child = cell;
      child.Children = -1;
      (upper == 1 ? child.Box.Lower : child.Box.Upper)[At(direction)] = at;
      const auto& breaks = knots[At(direction)].Breaks();
      if (upper == 1)
      {
        part.Begin[At(direction)] =
          static_cast<int>(std::upper_bound(breaks.begin(), breaks.end(), at) - breaks.begin() - 1);
      }
      else
      {
        part.End[At(direction)] =
          static_cast<int>(std::lower_bound(breaks.begin(), breaks.end(), at) - breaks.begin());
      }
      // Bounds are taken anew where that may save several cells.
      ++part.Halvings;
      const bool single = part.End[0] - part.Begin[0] == 1 && part.End[1] - part.Begin[1] == 1;
      const bool wasSingle =
        range.End[0] - range.Begin[0] == 1 && range.End[1] - range.Begin[1] == 1;
      if (!wasSingle)
      {
        child.Bounds = boundOf(part);
      }
      else if (part.Halvings >= 2 &&
        ChordalDeviation(child.Bounds, { Side(child.Box, 0), Side(child.Box, 1) }) >
          2.0 * tolerance)
      {
        part.Halvings = 0;
        child.Bounds.Second =
          BoundSecond(form, part.Begin[0] + knots[0].NumElements() * part.Begin[1], child.Box);
      }
      if (single && !wasSingle)
      {
        part.Halvings = 0;
      }
      cells.Tree.push_back(child);
      stack.push_back(part);
    }
  }
  for (std::size_t c = cells.Tree.size(); c-- > 0;) // children tell their parents
  {
    Cell& cell = cells.Tree[c];
    if (cell.Children >= 0)
    {
      cell.Bounds = cells.Tree[At(cell.Children)].Bounds;
      cell.Bounds.Include(cells.Tree[At(cell.Children + 1)].Bounds);
    }
  }
  return cells;
}

DerivativeBounds SurfaceCells::Bound(const ParametricBox<2>& box) const
{
  ParametricBox<2> clamped = box;
  const ParametricBox<2>& domain = this->Tree.front().Box;
  for (std::size_t d = 0; d < 2; ++d)
  {
    clamped.Lower[d] = std::clamp(box.Lower[d], domain.Lower[d], domain.Upper[d]);
    clamped.Upper[d] = std::clamp(box.Upper[d], domain.Lower[d], domain.Upper[d]);
  }
  DerivativeBounds bounds;
  std::vector<int> stack{ 0 };
  while (!stack.empty())
  {
    const Cell& cell = this->Tree[At(stack.back())];
    stack.pop_back();
    bool meets = true;
    bool within = true;
    for (std::size_t d = 0; d < 2; ++d)
    {
      // A box without extent meets the cells on both sides.
      const bool flat = clamped.Lower[d] == clamped.Upper[d];
      meets = meets &&
        (flat ? cell.Box.Lower[d] <= clamped.Lower[d] && clamped.Upper[d] <= cell.Box.Upper[d]
              : cell.Box.Lower[d] < clamped.Upper[d] && clamped.Lower[d] < cell.Box.Upper[d]);
      within =
        within && clamped.Lower[d] <= cell.Box.Lower[d] && cell.Box.Upper[d] <= clamped.Upper[d];
    }
    if (meets && (within || cell.Children < 0))
    {
      bounds.Include(cell.Bounds);
    }
    else if (meets)
    {
      stack.push_back(cell.Children + 1);
      stack.push_back(cell.Children);
    }
  }
  return bounds;
}
}
