// SPDX-License-Identifier: BSD-3-Clause
#include "CombineSplines.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/CommonRefinement.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/LocallyRefinedForm.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/TensorRestriction.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double SameDomain = 1e-9; // of a side
constexpr double Rounding = 1e-12;  // of a side

Status CheckSplines(const Spline<2>& a, const Spline<2>& b, const CombineParams& params)
{
  const char* const names[] = { "the first spline", "the second spline" };
  for (int i = 0; i < 2; ++i)
  {
    const Spline<2>& spline = i == 0 ? a : b;
    const std::string name = names[i];
    if (const Status status = spline.Check(); !status)
    {
      return { status.Code, name + ": " + status.Detail };
    }
    if (!spline.Space->HasDomain())
    {
      return { ErrorCode::DimensionMismatch,
        name + " is made of Bezier elements without a common parameter domain" };
    }
    if (spline.IsRational())
    {
      return { ErrorCode::InvalidWeight,
        name + " is rational: only polynomial splines, as fits are, can be combined" };
    }
  }
  if (a.NumComponents() != b.NumComponents())
  {
    return { ErrorCode::SizeMismatch,
      "the splines have " + std::to_string(a.NumComponents()) + " and " +
        std::to_string(b.NumComponents()) + " components" };
  }
  if (params.NumKept < 0 || params.NumKept > a.NumComponents())
  {
    return { ErrorCode::InvalidParameter,
      "of " + std::to_string(a.NumComponents()) + " components, " + std::to_string(params.NumKept) +
        " cannot be kept" };
  }
  return {};
}

/// Domains as they are, or restricted to what they have in common.
Status ShareDomain(Spline<2>& a, Spline<2>& b, const CombineParams& params)
{
  const ParametricBox<2> boxA = a.Space->Domain();
  const ParametricBox<2> boxB = b.Space->Domain();
  ParametricBox<2> common;
  double difference = 0.0; // of a side
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double side = boxA.Upper[d] - boxA.Lower[d];
    common.Lower[d] = std::max(boxA.Lower[d], boxB.Lower[d]);
    common.Upper[d] = std::min(boxA.Upper[d], boxB.Upper[d]);
    const double low = std::fabs(boxA.Lower[d] - boxB.Lower[d]);
    const double high = std::fabs(boxA.Upper[d] - boxB.Upper[d]);
    difference = std::max({ difference, low / side, high / side });
  }
  if (difference <= Rounding)
  {
    return {}; // MakeCommon takes such knots for one
  }
  if (!(difference <= SameDomain || params.CommonDomain))
  {
    const auto text = [](const ParametricBox<2>& box)
    {
      return "[" + Digits(box.Lower[0]) + ", " + Digits(box.Upper[0]) + "] x [" +
        Digits(box.Lower[1]) + ", " + Digits(box.Upper[1]) + "]";
    };
    return { ErrorCode::InvalidTopology,
      "the domains differ, " + text(boxA) + " and " + text(boxB) +
        "; combine the splines on their common domain" };
  }
  if (!(common.Lower[0] < common.Upper[0] && common.Lower[1] < common.Upper[1]))
  {
    return { ErrorCode::InvalidTopology, "the domains have nothing in common" };
  }
  const bool tensors = a.Space->Kind == SpaceKind::Tensor && b.Space->Kind == SpaceKind::Tensor;
  for (Spline<2>* spline : { &a, &b })
  {
    auto local = tensors ? *spline : MakeLocallyRefined(*spline, params.Threads);
    auto part = !local ? local
      : tensors        ? RestrictTensor(local.Value, common)
                       : RestrictToBox(local.Value, common, params.Threads);
    if (!part)
    {
      return part.Status;
    }
    *spline = std::move(part.Value);
  }
  return {};
}

Status ShareDegree(Spline<2>& a, Spline<2>& b)
{
  for (std::size_t d = 0; d < 2; ++d)
  {
    const int p = a.Space->Elements.front().Degree[d];
    const int q = b.Space->Elements.front().Degree[d];
    Spline<2>& lower = p < q ? a : b;
    if (p == q)
    {
      continue;
    }
    if (lower.Space->Kind != SpaceKind::Tensor)
    {
      return { ErrorCode::InvalidDegree,
        "degrees " + std::to_string(p) + " and " + std::to_string(q) + " in direction " +
          std::to_string(d) + ": fit both surfaces with the same degrees" };
    }
    auto elevated = ElevateDegree<2>(lower, static_cast<int>(d), std::abs(p - q));
    if (!elevated)
    {
      return elevated.Status;
    }
    lower = std::move(elevated.Value);
  }
  return {};
}

void BoundComponents(CombinedSpline& combined, int threads)
{
  const BezierForm<2> form = MakeBezierForm(combined.Value, threads);
  const auto c = static_cast<std::size_t>(form.NumComponents);
  combined.Lower.assign(c, HUGE_VAL);
  combined.Upper.assign(c, -HUGE_VAL);
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const IntArray<2>& degree = form.Space->Elements[static_cast<std::size_t>(e)].Degree;
    const auto n = static_cast<std::size_t>(NumTensorFunctions<2>(degree));
    for (std::size_t i = 0; i < c * n; ++i)
    {
      combined.Lower[i / n] = std::min(combined.Lower[i / n], form.Block(e)[i]);
      combined.Upper[i / n] = std::max(combined.Upper[i / n], form.Block(e)[i]);
    }
  }
}
}

Result<CombinedSpline> CombineSplines(const Spline<2>& a, const Spline<2>& b, double weightA,
  double weightB, const CombineParams& params)
{
  Status status = CheckSplines(a, b, params);
  if (status && !(std::isfinite(weightA) && std::isfinite(weightB)))
  {
    status = { ErrorCode::InvalidParameter, "weights must be finite" };
  }
  if (!status)
  {
    return status;
  }
  Spline<2> first = a;
  Spline<2> second = b;
  status = ShareDegree(first, second);
  status = status ? ShareDomain(first, second, params) : status;
  status = status ? MakeCommon(first, second, params.Threads, params.MaxFunctions) : status;
  if (status && first.ControlPoints.rows() != second.ControlPoints.rows())
  {
    status = { ErrorCode::NotInSpace,
      "knots of both splines are closer than can be told apart; fit one of them anew" };
  }
  if (!status)
  {
    return status;
  }
  CombinedSpline result;
  result.Value = first;
  const Eigen::Index mixed = a.ControlPoints.cols() - params.NumKept;
  result.Value.ControlPoints.rightCols(mixed) = weightA * first.ControlPoints.rightCols(mixed) +
    weightB * second.ControlPoints.rightCols(mixed);
  BoundComponents(result, params.Threads);
  return result;
}

namespace
{
/// x, y, z once more behind themselves.
Spline<2> WithPointsTwice(const Spline<2>& surface)
{
  Spline<2> twice = surface;
  const PointMatrix& points = surface.ControlPoints;
  twice.ControlPoints.resize(points.rows(), points.cols() + 3);
  twice.ControlPoints << points.leftCols(3), points;
  return twice;
}
}

Result<CombinedSurface> CombineSurfaces(
  const Spline<2>& a, const Spline<2>& b, const SurfaceCombination& combination)
{
  const Status status = CheckSplines(a, b, {});
  if (!status)
  {
    return status;
  }
  if (a.NumComponents() < 3)
  {
    return { ErrorCode::SizeMismatch, "the surfaces have fewer than three components" };
  }
  const bool isDifference = combination.Mode == CombineMode::Difference;
  const bool heights = IsHeightField(MakeBezierForm(a, combination.Threads)) &&
    IsHeightField(MakeBezierForm(b, combination.Threads));
  std::array<double, 2> weights{ 0.5, 0.5 };
  if (combination.Mode != CombineMode::Average)
  {
    weights = isDifference ? std::array<double, 2>{ 1.0, -1.0 } : combination.Weights;
  }
  CombinedSurface result;
  result.HasDifference = isDifference && !heights;
  CombineParams params;
  params.NumKept = heights ? 2 : result.HasDifference ? 3 : 0;
  params.CommonDomain = combination.CommonDomain;
  params.MaxFunctions = combination.MaxFunctions;
  params.Threads = combination.Threads;
  auto combined = CombineSplines(result.HasDifference ? WithPointsTwice(a) : a,
    result.HasDifference ? WithPointsTwice(b) : b, weights[0], weights[1], params);
  if (!combined)
  {
    return combined.Status;
  }
  const auto begin = static_cast<std::ptrdiff_t>(params.NumKept);
  const std::ptrdiff_t end = result.HasDifference ? 6 : 3;
  result.Lower = *std::min_element(combined->Lower.begin() + begin, combined->Lower.begin() + end);
  result.Upper = *std::max_element(combined->Upper.begin() + begin, combined->Upper.begin() + end);
  result.Value = std::move(combined->Value);
  return result;
}
}
