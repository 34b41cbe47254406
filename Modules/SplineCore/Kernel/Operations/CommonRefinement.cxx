// SPDX-License-Identifier: BSD-3-Clause
#include "CommonRefinement.h"

#include "HierarchicalSpace.h"
#include "LROperations.h"
#include "LocallyRefinedForm.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Relative to the domain; what the insertion of segments takes for one knot.
constexpr double SameKnot = 1e-12;
constexpr int MaxExchanges = 20;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Knots of one vector that the other one lacks, as often as it lacks them.
std::vector<double> MissingKnots(const KnotVector& have, const KnotVector& other)
{
  const double tolerance = SameKnot * (have.End() - have.Begin());
  std::vector<double> missing;
  for (int b = 1; b < other.NumElements(); ++b)
  {
    const double value = other.Breaks()[At(b)];
    const auto count = std::count_if(have.Knots().begin(), have.Knots().end(),
      [&](double t) { return std::fabs(t - value) <= tolerance; });
    const auto near = std::find_if(have.Knots().begin(), have.Knots().end(),
      [&](double t) { return std::fabs(t - value) <= tolerance; });
    for (auto k = count; k < other.Multiplicity(b); ++k)
    {
      missing.push_back(near == have.Knots().end() ? value : *near);
    }
  }
  return missing;
}

Status ShareKnots(Spline<2>& a, Spline<2>& b, int maxFunctions)
{
  double functions = 1.0;
  for (std::size_t d = 0; d < 2; ++d)
  {
    functions *= a.Space->Knots[d].NumFunctions() +
      static_cast<double>(MissingKnots(a.Space->Knots[d], b.Space->Knots[d]).size());
  }
  if (Status status = CheckSize(functions, maxFunctions); !status)
  {
    return status;
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    const std::vector<double> forA = MissingKnots(a.Space->Knots[d], b.Space->Knots[d]);
    const std::vector<double> forB = MissingKnots(b.Space->Knots[d], a.Space->Knots[d]);
    auto inA = InsertKnots<2>(a, static_cast<int>(d), forA);
    auto inB = InsertKnots<2>(b, static_cast<int>(d), forB);
    if (!inA || !inB)
    {
      return inA ? inB.Status : inA.Status;
    }
    a = std::move(inA.Value);
    b = std::move(inB.Value);
  }
  return {};
}

bool AreSameKnots(const KnotVector& a, const KnotVector& b)
{
  const double tolerance = SameKnot * (a.End() - a.Begin());
  return a.Degree() == b.Degree() &&
    std::equal(a.Knots().begin(), a.Knots().end(), b.Knots().begin(), b.Knots().end(),
      [tolerance](double s, double t) { return std::fabs(s - t) <= tolerance; });
}

/// Both get the level-0 knots of the first. @pre those of the second are the same up to rounding.
Status ShareHierarchy(Spline<2>& a, Spline<2>& b, int maxFunctions)
{
  std::vector<HierarchyBox<2>> boxes = HierarchyBoxes(*a.Space);
  const std::vector<HierarchyBox<2>> others = HierarchyBoxes(*b.Space);
  if (a.Space->Knots != b.Space->Knots)
  {
    auto moved = MakeHierarchicalSpace<2>(a.Space->Knots, others);
    if (!moved)
    {
      return moved.Status;
    }
    b.Space = std::move(moved.Value);
  }
  boxes.insert(boxes.end(), others.begin(), others.end());
  const auto space = MakeHierarchicalSpace<2>(a.Space->Knots, boxes);
  if (!space)
  {
    return space.Status;
  }
  if (Status status = CheckSize(space.Value->NumFunctions, maxFunctions); !status)
  {
    return status;
  }
  for (Spline<2>* spline : { &a, &b })
  {
    auto refined = TransferToRefined<2>(*spline, space.Value);
    if (!refined)
    {
      return refined.Status;
    }
    *spline = std::move(refined.Value);
  }
  return {};
}

/// All lines of a mesh as segments as long as they go, one for each multiplicity; the longest
/// first.
std::vector<LRSegment> LinesOf(const LRBasis& basis)
{
  std::vector<LRSegment> segments;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const std::vector<double>& across = basis.Knots[1 - d];
    for (std::size_t k = 1; k + 1 < basis.Knots[d].size(); ++k)
    {
      const LRLine& line = basis.Lines[d][k];
      for (int m = 1; m <= basis.Degree[d] + 1; ++m)
      {
        for (std::size_t i = 0; i < line.size(); ++i)
        {
          if (line[i].Multiplicity < m)
          {
            continue;
          }
          const int start = line[i].Knot;
          while (i + 1 < line.size() && line[i + 1].Multiplicity >= m)
          {
            ++i;
          }
          const int end =
            i + 1 < line.size() ? line[i + 1].Knot : static_cast<int>(across.size()) - 1;
          segments.push_back(
            { static_cast<int>(d), basis.Knots[d][k], across[At(start)], across[At(end)], m });
        }
      }
    }
  }
  std::stable_sort(segments.begin(), segments.end(),
    [](const LRSegment& x, const LRSegment& y)
    {
      return x.Multiplicity != y.Multiplicity ? x.Multiplicity < y.Multiplicity
                                              : x.End - x.Start > y.End - y.Start;
    });
  return segments;
}

/// Inserts the lines of another mesh of the same domain.
Status InsertLines(Spline<2>& spline, const SplineSpace<2>& other, int threads, int maxFunctions)
{
  LRRefinement refinement(*spline.Space, spline.ControlPoints);
  const ParametricBox<2> domain = spline.Space->Domain();
  std::vector<LRSegment> left = LinesOf(other.LocallyRefined->Basis);
  while (!left.empty())
  {
    // what cannot be inserted yet may begin or end at another one
    std::vector<LRSegment> refused;
    for (const LRSegment& segment : left)
    {
      if (!refinement.Insert(segment))
      {
        refused.push_back(segment);
      }
      if (Status status = CheckSize(refinement.NumFunctions(), maxFunctions); !status)
      {
        return status;
      }
    }
    if (refused.size() == left.size())
    {
      LRSegment whole = refused.front();
      const auto across = At(1 - whole.Direction);
      whole.Start = domain.Lower[across];
      whole.End = domain.Upper[across];
      if (const Status inserted = refinement.Insert(whole); !inserted)
      {
        return inserted;
      }
      refused.erase(refused.begin());
    }
    left = std::move(refused);
  }
  auto space = refinement.Finish(&spline.ControlPoints, threads);
  if (space)
  {
    spline.Space = std::move(space.Value);
  }
  return space.Status;
}

Status ShareLines(Spline<2>& a, Spline<2>& b, int threads, int maxFunctions)
{
  for (int exchange = 0; exchange < MaxExchanges; ++exchange)
  {
    Status status = InsertLines(a, *b.Space, threads, maxFunctions);
    status = status ? InsertLines(b, *a.Space, threads, maxFunctions) : status;
    if (!status)
    {
      return status;
    }
    if (a.Space->LocallyRefined->Basis.LocalKnots == b.Space->LocallyRefined->Basis.LocalKnots)
    {
      return {};
    }
  }
  // lines as long as the domain have one set of functions
  for (Spline<2>* spline : { &a, &b })
  {
    auto tensor = ExpandToTensor(*spline, threads, maxFunctions);
    if (!tensor)
    {
      return tensor.Status;
    }
    *spline = std::move(tensor.Value);
  }
  return ShareKnots(a, b, maxFunctions);
}
}

Status MakeCommon(Spline<2>& a, Spline<2>& b, int threads, int maxFunctions)
{
  // what came in is not refused
  maxFunctions = std::max({ maxFunctions, a.Space->NumFunctions, b.Space->NumFunctions });
  const auto both = [&](SpaceKind kind) { return a.Space->Kind == kind && b.Space->Kind == kind; };
  if (both(SpaceKind::Tensor))
  {
    return ShareKnots(a, b, maxFunctions);
  }
  if (both(SpaceKind::Hierarchical) && AreSameKnots(a.Space->Knots[0], b.Space->Knots[0]) &&
    AreSameKnots(a.Space->Knots[1], b.Space->Knots[1]))
  {
    return ShareHierarchy(a, b, maxFunctions);
  }
  for (Spline<2>* spline : { &a, &b })
  {
    auto local = MakeLocallyRefined(*spline, threads);
    if (!local)
    {
      return local.Status;
    }
    *spline = std::move(local.Value);
  }
  return ShareLines(a, b, threads, maxFunctions);
}
}
