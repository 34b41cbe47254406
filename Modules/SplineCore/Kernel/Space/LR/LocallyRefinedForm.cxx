// SPDX-License-Identifier: BSD-3-Clause
#include "LocallyRefinedForm.h"

#include "Bernstein.h"
#include "HierarchicalSpace.h"
#include "LRRefinement.h"
#include "Recovery.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Relative to the size of the Bezier points: far above rounding, far below a missing function.
constexpr double InSpace = 1e-11;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Breaks of a level: those of level 0 halved so often.
std::vector<double> LevelBreaks(const KnotVector& knots, int level)
{
  KnotVector fine = knots;
  for (int l = 0; l < level; ++l)
  {
    fine = fine.Dyadic();
  }
  return fine.Breaks();
}

/// The lines that halve the cells of a box of level `level`, across all functions alive on them.
void AddHalvings(const SplineSpace<2>& space, const std::array<std::vector<double>, 2>& breaks,
  const HierarchyBox<2>& box, std::vector<LRSegment>& segments)
{
  const LRData& data = *space.LocallyRefined;
  const LRBasis& basis = data.Basis;
  for (auto j = At(static_cast<int>(box.Lower[1])); j < At(static_cast<int>(box.Upper[1])); j += 2)
  {
    for (auto i = At(static_cast<int>(box.Lower[0])); i < At(static_cast<int>(box.Upper[0]));
         i += 2)
    {
      const std::array<double, 2> middle{ breaks[0][i + 1], breaks[1][j + 1] };
      double local[2];
      const int element = space.Locate(middle.data(), local);
      std::array<std::array<int, 2>, 2> range{ { { 1 << 30, 0 }, { 1 << 30, 0 } } };
      for (std::size_t a = data.AliveStart[At(element)]; a < data.AliveStart[At(element) + 1]; ++a)
      {
        for (int d = 0; d < 2; ++d)
        {
          const int* knots = basis.Local(data.AliveFunctions[a], d);
          range[At(d)][0] = std::min(range[At(d)][0], knots[0]);
          range[At(d)][1] = std::max(range[At(d)][1], knots[basis.Degree[At(d)] + 1]);
        }
      }
      for (std::size_t d = 0; d < 2; ++d)
      {
        segments.push_back({ static_cast<int>(d), middle[d],
          basis.Knots[1 - d][At(range[1 - d][0])], basis.Knots[1 - d][At(range[1 - d][1])] });
      }
    }
  }
}

/// The tensor-product space of the level-0 knots as LR B-splines, the ends clamped.
Result<SplineSpacePtr<2>> ClampedRoot(const SplineSpace<2>& space, int threads)
{
  std::array<KnotVector, 2> clamped;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    std::vector<double> values;
    for (int b = 0; b <= knots.NumElements(); ++b)
    {
      const bool isEnd = b == 0 || b == knots.NumElements();
      values.insert(values.end(), At(isEnd ? knots.Degree() + 1 : knots.Multiplicity(b)),
        knots.Breaks()[At(b)]);
    }
    auto made = KnotVector::Create(knots.Degree(), std::move(values));
    if (!made)
    {
      return made.Status;
    }
    clamped[d] = std::move(made.Value);
  }
  const auto tensor = MakeTensorSpace<2>(clamped);
  auto basis = tensor ? LRBasisOfTensor(*tensor.Value) : tensor.Status;
  return basis ? MakeLRSpace(std::move(basis.Value), threads) : basis.Status;
}

/// Every line of the hierarchical mesh as long as the domain.
std::vector<LRSegment> LongLines(
  const SplineSpace<2>& space, const std::vector<HierarchyBox<2>>& boxes)
{
  std::vector<LRSegment> segments;
  const ParametricBox<2> domain = space.Domain();
  for (const HierarchyBox<2>& box : boxes)
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      const std::vector<double> breaks = LevelBreaks(space.Knots[d], box.Level);
      for (auto k = box.Lower[d] + 1; k < box.Upper[d]; ++k)
      {
        segments.push_back({ static_cast<int>(d), breaks[static_cast<std::size_t>(k)],
          domain.Lower[1 - d], domain.Upper[1 - d] });
      }
    }
  }
  return segments;
}

/// The spline's Bezier points on the elements of a finer mesh, and the control points behind them.
RecoveryResult<2> Recover(const Spline<2>& spline, const SplineSpacePtr<2>& fine, int threads)
{
  const BezierForm<2> form = MakeBezierForm(spline, threads);
  BezierForm<2> parts;
  parts.Space = fine;
  parts.NumComponents = form.NumComponents;
  parts.Rational = form.Rational;
  parts.Offsets.push_back(0);
  for (const auto& element : fine->Elements)
  {
    RealArray<2> centre;
    for (std::size_t d = 0; d < 2; ++d)
    {
      centre[d] = 0.5 * (element.Box.Lower[d] + element.Box.Upper[d]);
    }
    double local[2];
    const int parent = spline.Space->Locate(centre.data(), local);
    const auto& whole = spline.Space->Elements[At(parent)];
    std::array<std::vector<double>, 2> factors;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double length = whole.Box.Upper[d] - whole.Box.Lower[d];
      factors[d].resize(At((element.Degree[d] + 1) * (element.Degree[d] + 1)));
      BernsteinRestriction(element.Degree[d], (element.Box.Lower[d] - whole.Box.Lower[d]) / length,
        (element.Box.Upper[d] - whole.Box.Lower[d]) / length, factors[d].data());
    }
    const auto n = At(NumTensorFunctions<2>(element.Degree));
    for (int c = 0; c < form.NumPlanes(); ++c)
    {
      parts.Data.resize(parts.Data.size() + n);
      ApplyFactors<2>(element.Degree, { factors[0].data(), factors[1].data() },
        form.Block(parent) + At(c) * n, parts.Data.data() + parts.Data.size() - n);
    }
    parts.Offsets.push_back(parts.Data.size());
  }
  return RecoverSpline(parts, threads);
}

Result<Spline<2>> Checked(RecoveryResult<2> recovered)
{
  if (recovered && recovered.Residual > InSpace * recovered.Size)
  {
    return { ErrorCode::NotInSpace, "the spline has no locally refined form" };
  }
  return recovered ? Result<Spline<2>>(std::move(recovered.Value)) : recovered.Status;
}

Result<Spline<2>> FromTensor(const Spline<2>& spline, int threads)
{
  const auto root = ClampedRoot(*spline.Space, threads);
  if (!root)
  {
    return root.Status;
  }
  if (root.Value->Knots != spline.Space->Knots)
  {
    return Checked(Recover(spline, root.Value, threads));
  }
  Spline<2> result = spline;
  result.Space = root.Value;
  return result;
}

Result<Spline<2>> FromHierarchical(const Spline<2>& spline, int threads)
{
  const SplineSpace<2>& space = *spline.Space;
  const auto root = ClampedRoot(space, threads);
  if (!root)
  {
    return root.Status;
  }
  std::vector<HierarchyBox<2>> boxes = HierarchyBoxes(space);
  std::stable_sort(boxes.begin(), boxes.end(),
    [](const HierarchyBox<2>& a, const HierarchyBox<2>& b) { return a.Level < b.Level; });
  SplineSpacePtr<2> fine = root.Value;
  for (std::size_t b = 0; b < boxes.size();)
  {
    const int level = boxes[b].Level;
    const std::array<std::vector<double>, 2> breaks{ LevelBreaks(space.Knots[0], level),
      LevelBreaks(space.Knots[1], level) };
    std::vector<LRSegment> segments;
    for (; b < boxes.size() && boxes[b].Level == level; ++b)
    {
      AddHalvings(*fine, breaks, boxes[b], segments);
    }
    auto next = InsertSegments(fine, segments, threads);
    if (!next)
    {
      return next.Status;
    }
    fine = std::move(next.Value);
  }
  RecoveryResult<2> recovered = Recover(spline, fine, threads);
  if (recovered && recovered.Residual > InSpace * recovered.Size)
  {
    auto all = InsertSegments(root.Value, LongLines(space, boxes), threads);
    if (!all)
    {
      return all.Status;
    }
    recovered = Recover(spline, all.Value, threads);
  }
  return Checked(std::move(recovered));
}
}

Result<Spline<2>> MakeLocallyRefined(const Spline<2>& spline, int threads)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  switch (spline.Space->Kind)
  {
    case SpaceKind::LocallyRefined:
      return spline;
    case SpaceKind::Hierarchical:
      return FromHierarchical(spline, threads);
    case SpaceKind::Unstructured:
    case SpaceKind::Explicit:
    case SpaceKind::Bezier:
      return { ErrorCode::DimensionMismatch,
        "Bezier elements without a common parameter domain have no locally refined form" };
    case SpaceKind::Tensor:
      break;
  }
  return FromTensor(spline, threads);
}
}
