// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCells.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/ChordalBound.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <string>

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
std::vector<CellBounds> BoundElements(const BezierForm<2>& form, int threads)
{
  const int n = form.Space->NumElements();
  std::vector<int> elements(At(n));
  for (int e = 0; e < n; ++e)
  {
    elements[At(e)] = e;
  }
  EvaluationBatch middle;
  EvaluateElements<2>(form, elements, PointMatrix::Constant(n, 2, 0.5), { 1, threads }, middle);
  std::vector<CellBounds> bounds(At(n));
  ParallelFor(At(n), 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        const ParametricBox<2>& box = form.Space->Elements[e].Box;
        CellBounds& bound = bounds[e];
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

/// Mean norms of the first derivatives over the domain.
std::array<double, 2> FindMeanSpeeds(const BezierForm<2>& form)
{
  constexpr int n = 8;
  const ParametricBox<2> domain = form.Space->Domain();
  PointMatrix samples(n * n, 2);
  for (int i = 0; i < n * n; ++i)
  {
    samples(i, 0) = domain.Lower[0] + (i % n + 0.5) / n * Side(domain, 0);
    samples(i, 1) = domain.Lower[1] + (i / n + 0.5) / n * Side(domain, 1);
  }
  EvaluationBatch batch;
  EvaluateParameters<2>(form, samples, { 1, 1 }, batch);
  std::array<double, 2> speeds;
  for (int d = 0; d < 2; ++d)
  {
    const double mean = batch.First.middleCols(3 * d, 3).rowwise().norm().mean();
    speeds[At(d)] = mean * Side(domain, d) > 0.0 ? mean : 1.0 / Side(domain, d);
  }
  return speeds;
}

/// A cell that may be divided, and its elements: [Begin, End) in each direction.
struct Range
{
  int Cell = 0;
  IntArray<2> Begin{};
  IntArray<2> End{};
  int Halvings = 0; ///< since the bounds were taken

  bool IsInElement() const
  {
    return this->End[0] - this->Begin[0] == 1 && this->End[1] - this->Begin[1] == 1;
  }
};

/// Longest cell, by its shape in space. Triangles are Delaunay there: longer ones would be cut
/// across and not keep to the cells.
constexpr double MaxAspect = 1.5;
/// Unless the surface is straight along them, but for this share of the tolerance.
constexpr double Straight = 1e-4;

/// Where and in which direction a cell is to be divided.
struct Cut
{
  int Direction = -1; ///< -1: not at all
  double At = 0.0;
};
}

void CellBounds::Include(const CellBounds& other)
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

double ChordalDeviation(const CellBounds& bounds, const std::array<double, 2>& sides)
{
  return (bounds.Second[0] * sides[0] * sides[0] + 2.0 * bounds.Second[1] * sides[0] * sides[1] +
           bounds.Second[2] * sides[1] * sides[1]) /
    8.0;
}

/// Divides the domain into cells.
class SurfaceCells::Builder
{
public:
  Builder(const BezierForm<2>& form, double tolerance, int threads)
    : Form(form), Tolerance(tolerance), Elements(BoundElements(form, threads))
  {
    this->Cells.Speeds = FindMeanSpeeds(form);
    for (int d = 0; d < 2; ++d)
    {
      const KnotVector& knots = this->Knots(d);
      for (int b = 1; b < knots.NumElements(); ++b)
      {
        if (knots.Multiplicity(b) >= knots.Degree())
        {
          this->Cells.Breaks[At(d)].push_back(knots.Breaks()[At(b)]);
        }
      }
    }
  }

  Result<SurfaceCells> Build(std::size_t maxCells)
  {
    Range whole;
    whole.End = { this->Knots(0).NumElements(), this->Knots(1).NumElements() };
    std::vector<Cell>& tree = this->Cells.Tree;
    tree.push_back({ this->Form.Space->Domain(), this->BoundOf(whole), -1 });
    std::vector<Range> stack{ whole };
    while (!stack.empty())
    {
      const Range range = stack.back();
      stack.pop_back();
      const Cut cut = this->ChooseCut(range);
      if (cut.Direction < 0)
      {
        continue;
      }
      if (tree.size() > 2 * maxCells)
      {
        return { ErrorCode::TooLarge, "more than " + std::to_string(maxCells) + " cells" };
      }
      const int children = static_cast<int>(tree.size());
      tree[At(range.Cell)].Children = children;
      for (int half = 0; half < 2; ++half)
      {
        stack.push_back(this->Divide(range, cut, half));
      }
    }
    for (std::size_t c = tree.size(); c-- > 0;) // children tell their parents
    {
      if (tree[c].Children >= 0)
      {
        tree[c].Bounds = tree[At(tree[c].Children)].Bounds;
        tree[c].Bounds.Include(tree[At(tree[c].Children + 1)].Bounds);
      }
    }
    return std::move(this->Cells);
  }

private:
  const KnotVector& Knots(int d) const { return this->Form.Space->Knots[At(d)]; }

  CellBounds BoundOf(const Range& range) const
  {
    CellBounds bounds;
    for (int j = range.Begin[1]; j < range.End[1]; ++j)
    {
      for (int i = range.Begin[0]; i < range.End[0]; ++i)
      {
        bounds.Include(this->Elements[At(i + this->Knots(0).NumElements() * j)]);
      }
    }
    return bounds;
  }

  double Deviation(const Cell& cell) const
  {
    return ChordalDeviation(cell.Bounds, { Side(cell.Box, 0), Side(cell.Box, 1) });
  }

  /// At creases first, then where interpolation deviates.
  Cut ChooseCut(const Range& range) const
  {
    const Cell& cell = this->Cells.Tree[At(range.Cell)];
    for (int d = 0; d < 2; ++d)
    {
      const std::vector<double>& breaks = this->Cells.Breaks[At(d)];
      const auto first = std::upper_bound(breaks.begin(), breaks.end(), cell.Box.Lower[At(d)]);
      const auto last = std::lower_bound(breaks.begin(), breaks.end(), cell.Box.Upper[At(d)]);
      if (first < last)
      {
        return { d, *(first + (last - first) / 2) };
      }
    }
    if (this->Deviation(cell) <= this->Tolerance)
    {
      return {};
    }
    const std::array<double, 2> need{ cell.Bounds.Second[0] * Side(cell.Box, 0) *
        Side(cell.Box, 0) / 8.0,
      cell.Bounds.Second[2] * Side(cell.Box, 1) * Side(cell.Box, 1) / 8.0 };
    int d = need[0] >= need[1] ? 0 : 1;
    const std::array<double, 2> length{ this->Cells.Speeds[0] * Side(cell.Box, 0),
      this->Cells.Speeds[1] * Side(cell.Box, 1) };
    if (length[At(1 - d)] > MaxAspect * length[At(d)] &&
      need[At(1 - d)] > Straight * this->Tolerance)
    {
      d = 1 - d;
    }
    const int begin = range.Begin[At(d)];
    const int count = range.End[At(d)] - begin;
    return { d,
      count > 1 ? this->Knots(d).Breaks()[At(begin + count / 2)]
                : 0.5 * (cell.Box.Lower[At(d)] + cell.Box.Upper[At(d)]) };
  }

  /// Makes the lower or upper half of a cell.
  Range Divide(const Range& range, const Cut& cut, int half)
  {
    Cell child = this->Cells.Tree[At(range.Cell)];
    Range part = range;
    child.Children = -1;
    part.Cell = static_cast<int>(this->Cells.Tree.size());
    ++part.Halvings;
    const std::size_t d = At(cut.Direction);
    const std::vector<double>& breaks = this->Knots(cut.Direction).Breaks();
    if (half == 0)
    {
      child.Box.Upper[d] = cut.At;
      part.End[d] =
        static_cast<int>(std::lower_bound(breaks.begin(), breaks.end(), cut.At) - breaks.begin());
    }
    else
    {
      child.Box.Lower[d] = cut.At;
      part.Begin[d] = static_cast<int>(
        std::upper_bound(breaks.begin(), breaks.end(), cut.At) - breaks.begin() - 1);
    }
    if (!range.IsInElement())
    {
      child.Bounds = this->BoundOf(part);
      part.Halvings = part.IsInElement() ? 0 : part.Halvings;
    }
    else if (part.Halvings >= 2 && this->Deviation(child) > 2.0 * this->Tolerance)
    {
      // Taken anew where that may save cells.
      part.Halvings = 0;
      child.Bounds.Second = BoundSecond(
        this->Form, part.Begin[0] + this->Knots(0).NumElements() * part.Begin[1], child.Box);
    }
    this->Cells.Tree.push_back(child);
    return part;
  }

  const BezierForm<2>& Form;
  double Tolerance;
  std::vector<CellBounds> Elements;
  SurfaceCells Cells;
};

Result<SurfaceCells> SurfaceCells::Create(
  const BezierForm<2>& form, double tolerance, std::size_t maxCells, int threads)
{
  return Builder(form, tolerance, threads).Build(maxCells);
}

CellBounds SurfaceCells::Bound(const ParametricBox<2>& box) const
{
  ParametricBox<2> clamped = box;
  const ParametricBox<2>& domain = this->Tree.front().Box;
  for (std::size_t d = 0; d < 2; ++d)
  {
    clamped.Lower[d] = std::clamp(box.Lower[d], domain.Lower[d], domain.Upper[d]);
    clamped.Upper[d] = std::clamp(box.Upper[d], domain.Lower[d], domain.Upper[d]);
  }
  CellBounds bounds;
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
