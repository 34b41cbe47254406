// SPDX-License-Identifier: BSD-3-Clause
#include "TrimLoops.h"
#include <knotwork/JacobianValidation/PlaneCurves.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Curves of a loop whose ends are so near, by their coordinates, end in one point.
constexpr double SameEnd = 0x1p-40;
/// Roundings of a coefficient in Bernstein form, for each degree.
constexpr double ExtractionRounding = 16.0 * 0x1p-53;

/// The curves of all loops of a face as Bernstein cells.
class LoopCells
{
public:
  Status Add(const TrimmedLoop& loop)
  {
    std::vector<CurveStep>& steps = this->Loops.emplace_back();
    this->Boxes.push_back({ { 1e300, 1e300 }, { -1e300, -1e300 } });
    const int firstEnd = static_cast<int>(this->Ends.size());
    for (const TrimmingCurve& use : loop.Curves)
    {
      const Spline<1> curve = use.ParameterCurve();
      if (Status status = curve.Check(); !status)
      {
        return status;
      }
      if (curve.NumComponents() != 2)
      {
        return { ErrorCode::DimensionMismatch, "a parameter curve needs two coordinates" };
      }
      const BezierForm<1> form = MakeBezierForm(curve, 1);
      const int elements = form.Space->NumElements();
      for (int k = 0; k < elements; ++k)
      {
        this->AddCell(form, use.Reversed ? elements - 1 - k : k);
        steps.push_back({ this->Cells.NumCells() - 1, use.Reversed });
        this->GrowBox(this->Cells.NumCells() - 1);
        const int end = static_cast<int>(this->Ends.size());
        this->Ends.push_back(
          use.Reversed ? std::array<int, 2>{ end + 1, end } : std::array<int, 2>{ end, end + 1 });
      }
    }
    if (steps.empty())
    {
      return { ErrorCode::EmptyInput, "a loop without curves" };
    }
    this->Ends.back()[steps.back().Reversed ? 0 : 1] = firstEnd;
    this->Close(steps);
    return {};
  }

  /// The proof of what has been added.
  Result<LoopVerdict> Prove(int threads) const
  {
    if (!this->IsClosed)
    {
      return LoopVerdict::Undecided;
    }
    LoopVerdict verdict = LoopVerdict::SimpleNested;
    const auto lower = [&](LoopVerdict to)
    {
      verdict = to == LoopVerdict::Crossing || verdict == LoopVerdict::Crossing
        ? LoopVerdict::Crossing
        : LoopVerdict::Undecided;
    };
    for (std::size_t l = 0; l < this->Loops.size(); ++l)
    {
      const auto orientation = FindOrientation(this->Cells, this->Loops[l]);
      if (orientation != (l == 0 ? 1 : -1))
      {
        lower(orientation ? LoopVerdict::Crossing : LoopVerdict::Undecided);
      }
    }
    SimpleCurvesParams params;
    params.MaxBoxes = std::max<std::int64_t>(1000000, 1000 * this->Cells.NumCells());
    params.Threads = threads;
    const auto simple = ProveSimpleCurves(this->Cells, this->Ends, params);
    if (!simple)
    {
      return simple.Status;
    }
    if (simple->Verdict != CurvesVerdict::Simple)
    {
      lower(simple->Verdict == CurvesVerdict::Crossing ? LoopVerdict::Crossing
                                                       : LoopVerdict::Undecided);
      return verdict;
    }
    std::vector<LoopVerdict> nesting(this->Loops.size(), LoopVerdict::SimpleNested);
    ParallelFor(this->Loops.size(), 1, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t l = begin; l < end; ++l)
        {
          nesting[l] = l == 0 ? LoopVerdict::SimpleNested : this->ProveNesting(l);
        }
      });
    for (const LoopVerdict v : nesting)
    {
      if (v != LoopVerdict::SimpleNested)
      {
        lower(v);
      }
    }
    return verdict;
  }

private:
  using Box = ParametricBox<2>;

  void AddCell(const BezierForm<1>& form, int element)
  {
    const int degree = form.Space->Elements[static_cast<std::size_t>(element)].Degree[0];
    // polynomial cells get weights when others have them
    const bool rational = this->Cells.Rational || form.Rational;
    if (rational && !this->Cells.Rational)
    {
      this->MakeRational();
    }
    const int cell = this->Cells.Add(CellShape::Curve, { degree, 0, 0 });
    double* block = this->Cells.Block(cell);
    const double* from = form.Block(element);
    const int n = degree + 1;
    std::copy(from, from + form.NumPlanes() * n, block);
    if (rational && !form.Rational)
    {
      std::fill(block + 2 * n, block + 3 * n, 1.0);
    }
    double largest = 0.0;
    for (int i = 0; i < form.NumPlanes() * n; ++i)
    {
      largest = std::max(largest, std::abs(block[i]));
    }
    this->Cells.Errors.push_back(ExtractionRounding * degree * largest);
  }

  void MakeRational()
  {
    BernsteinCells polynomial = std::move(this->Cells);
    this->Cells = {};
    this->Cells.NumComponents = 2;
    this->Cells.Rational = true;
    this->Cells.Errors = polynomial.Errors;
    for (int c = 0; c < polynomial.NumCells(); ++c)
    {
      const std::size_t at = static_cast<std::size_t>(c);
      const int cell = this->Cells.Add(polynomial.Shapes[at], polynomial.Degrees[at]);
      const int n = polynomial.Degrees[at][0] + 1;
      double* block = this->Cells.Block(cell);
      std::copy(polynomial.Block(c), polynomial.Block(c) + 2 * n, block);
      std::fill(block + 2 * n, block + 3 * n, 1.0);
    }
  }

  void GrowBox(int cell)
  {
    const int n = this->Cells.Degrees[static_cast<std::size_t>(cell)][0] + 1;
    const double* block = this->Cells.Block(cell);
    Box& box = this->Boxes.back();
    for (int i = 0; i < n; ++i)
    {
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double w = this->Cells.Rational ? block[2 * n + i] : 1.0;
        const double x = block[static_cast<std::ptrdiff_t>(d) * n + i] / w;
        box.Lower[d] = std::min(box.Lower[d], x);
        box.Upper[d] = std::max(box.Upper[d], x);
      }
    }
  }

  std::array<double, 2> End(int cell, bool atEnd) const
  {
    std::array<double, 2> point{};
    EvaluateCell(this->Cells, cell, { atEnd ? 1.0 : 0.0, 0.0, 0.0 }, point.data());
    return point;
  }

  /// What two curves differ by where they meet counts as their error.
  void Close(const std::vector<CurveStep>& steps)
  {
    const Box& box = this->Boxes.back();
    double size = 0.0;
    for (std::size_t d = 0; d < 2; ++d)
    {
      size = std::max({ size, std::abs(box.Lower[d]), std::abs(box.Upper[d]) });
    }
    for (std::size_t s = 0; s < steps.size(); ++s)
    {
      const CurveStep& step = steps[s];
      const CurveStep& next = steps[(s + 1) % steps.size()];
      const auto a = this->End(step.Curve, !step.Reversed);
      const auto b = this->End(next.Curve, next.Reversed);
      const double gap = std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
      this->IsClosed = this->IsClosed && gap <= SameEnd * size;
      for (const int cell : { step.Curve, next.Curve })
      {
        double& error = this->Cells.Errors[static_cast<std::size_t>(cell)];
        error = std::max(error, 2.0 * gap);
      }
    }
  }

  /// Hole l lies inside the outer loop and outside all others. @pre the loops are disjoint.
  LoopVerdict ProveNesting(std::size_t l) const
  {
    LoopVerdict verdict = LoopVerdict::SimpleNested;
    for (std::size_t other = 0; other < this->Loops.size(); ++other)
    {
      if (other == l)
      {
        continue;
      }
      const auto isInside = this->IsInside(l, other);
      if (!isInside)
      {
        verdict = LoopVerdict::Undecided;
      }
      else if (*isInside != (other == 0))
      {
        return LoopVerdict::Crossing;
      }
    }
    return verdict;
  }

  /// By one point of the first loop; by another one where the loops nearly touch.
  std::optional<bool> IsInside(std::size_t l, std::size_t other) const
  {
    constexpr std::size_t tries = 8;
    const auto& steps = this->Loops[l];
    for (std::size_t k = 0; k < tries; ++k)
    {
      const CurveStep& step = steps[k * steps.size() / tries];
      const auto point = this->End(step.Curve, (k % 2 == 0) == step.Reversed);
      const Box& box = this->Boxes[other];
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double away = 1e-3 * (box.Upper[d] - box.Lower[d]);
        if (point[d] < box.Lower[d] - away || point[d] > box.Upper[d] + away)
        {
          return false;
        }
      }
      const auto windings = CountWindings(this->Cells, this->Loops[other], point,
        this->Cells.Errors[static_cast<std::size_t>(step.Curve)]);
      if (windings)
      {
        return *windings != 0;
      }
    }
    return {};
  }

  BernsteinCells Cells = []
  {
    BernsteinCells cells;
    cells.NumComponents = 2;
    return cells;
  }();
  std::vector<std::array<int, 2>> Ends;
  std::vector<std::vector<CurveStep>> Loops;
  std::vector<Box> Boxes;
  bool IsClosed = true;
};
}

const char* ToString(LoopVerdict verdict)
{
  switch (verdict)
  {
    case LoopVerdict::SimpleNested:
      return "simple_nested";
    case LoopVerdict::Crossing:
      return "crossing";
    default:
      return "undecided";
  }
}

Result<LoopVerdict> ProveLoops(const TrimmedFace& face, int threads)
{
  if (face.Loops.empty())
  {
    return LoopVerdict::SimpleNested;
  }
  LoopCells cells;
  for (std::size_t l = 0; l < face.Loops.size(); ++l)
  {
    if (Status status = cells.Add(face.Loops[l]); !status)
    {
      return { status.Code, "loop " + std::to_string(l) + ": " + status.Detail };
    }
  }
  return cells.Prove(threads);
}
}
