// SPDX-License-Identifier: BSD-3-Clause
#include "LROperations.h"

#include "BezierForm.h"
#include "Numbers.h"
#include "SizeLimit.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Status CheckLocallyRefined(const Spline<2>& spline)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  return spline.Space->Kind == SpaceKind::LocallyRefined
    ? Status()
    : Status(ErrorCode::DimensionMismatch, "the spline is not locally refined");
}

Status CheckDirection(int direction)
{
  return direction == 0 || direction == 1
    ? Status()
    : Status(ErrorCode::InvalidParameter,
        "there is no direction " + std::to_string(direction) + ", choose 0 or 1");
}

/// The spline of functions in any order; rows are points of the given spline.
Result<Spline<2>> Assemble(
  LRBasis basis, const Spline<2>& spline, const std::vector<int>& rows, int threads)
{
  std::vector<int> order(rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b)
    {
      for (int d = 1; d >= 0; --d)
      {
        const int n = basis.Degree[At(d)] + 2;
        const auto [x, y] =
          std::mismatch(basis.Local(a, d), basis.Local(a, d) + n, basis.Local(b, d));
        if (x != basis.Local(a, d) + n)
        {
          return *x < *y;
        }
      }
      return false;
    });
  Spline<2> result;
  const auto n = static_cast<Eigen::Index>(rows.size());
  result.ControlPoints.resize(n, spline.ControlPoints.cols());
  result.Weights.resize(spline.IsRational() ? n : 0);
  LRBasis sorted = basis;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const int from = order[static_cast<std::size_t>(i)];
    const int row = rows[At(from)];
    result.ControlPoints.row(i) = spline.ControlPoints.row(row);
    if (spline.IsRational())
    {
      result.Weights[i] = spline.Weights[row];
    }
    sorted.Scaling[static_cast<std::size_t>(i)] = basis.Scaling[At(from)];
    std::copy_n(
      basis.Local(from, 0), basis.Stride(), sorted.LocalKnots.begin() + i * basis.Stride());
  }
  Result<SplineSpacePtr<2>> space = MakeLRSpace(std::move(sorted), threads);
  result.Space = space.Value;
  return space ? Result<Spline<2>>(std::move(result)) : space.Status;
}

std::vector<int> AllRows(const LRBasis& basis)
{
  std::vector<int> rows(At(basis.NumFunctions()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// A line between two knots, which become 0 and the end.
LRLine Clipped(const LRLine& line, int low, int high)
{
  LRLine clipped;
  for (std::size_t k = 0; k < line.size(); ++k)
  {
    const int end = k + 1 < line.size() ? line[k + 1].Knot : high;
    if (end > low && line[k].Knot < high)
    {
      clipped.push_back({ std::max(line[k].Knot, low) - low, line[k].Multiplicity });
    }
  }
  return clipped;
}

/// The blossom of a polynomial in Bernstein form on [low, high].
double Blossom(
  const double* bernstein, int degree, double low, double high, const double* arguments)
{
  double c[MaxDegree + 1];
  std::copy(bernstein, bernstein + degree + 1, c);
  for (int r = 0; r < degree; ++r)
  {
    const double t = (arguments[r] - low) / (high - low);
    for (int i = 0; i < degree - r; ++i)
    {
      c[i] = (1.0 - t) * c[i] + t * c[i + 1];
    }
  }
  return c[0];
}

/// Elements along a line on which a parameter is constant, in ascending order, and the knots there.
struct Crossing
{
  std::vector<int> Elements;
  std::vector<double> Knots; // with multiplicities
};

Crossing FindCrossing(const SplineSpace<2>& space, int direction, double value)
{
  const LRData& data = *space.LocallyRefined;
  const std::size_t d = At(direction);
  const std::size_t e = At(1 - direction);
  const std::vector<double>& knots = data.Basis.Knots[d];
  // the column of the mesh at the value
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, value);
  const auto column = static_cast<int>(above - knots.begin()) - 1;
  Crossing crossing;
  for (int i = 0; i < space.NumElements(); ++i)
  {
    const auto& box = data.ElementKnots[At(i)];
    if (box[d] <= column && column < box[d + 2])
    {
      crossing.Elements.push_back(i);
    }
  }
  std::sort(crossing.Elements.begin(), crossing.Elements.end(),
    [&](int a, int b) { return data.ElementKnots[At(a)][e] < data.ElementKnots[At(b)][e]; });
  for (std::size_t k = 0; k < data.Basis.Knots[e].size(); ++k)
  {
    const int m = LRMultiplicity(data.Basis.Lines[e][k], column, column + 1);
    crossing.Knots.insert(crossing.Knots.end(), At(m), data.Basis.Knots[e][k]);
  }
  return crossing;
}
}

Result<Spline<2>> ExpandToTensor(const Spline<2>& spline, int threads, int maxFunctions)
{
  if (Status status = CheckLocallyRefined(spline); !status)
  {
    return status;
  }
  const SplineSpace<2>& space = *spline.Space;
  const double size = 1.0 * space.Knots[0].NumFunctions() * space.Knots[1].NumFunctions();
  if (Status status = CheckSize(size, std::max(maxFunctions, space.NumFunctions)); !status)
  {
    return status;
  }
  std::vector<LRSegment> segments;
  for (int d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space.Knots[At(d)];
    const KnotVector& across = space.Knots[At(1 - d)];
    for (int b = 1; b < knots.NumElements(); ++b)
    {
      segments.push_back(
        { d, knots.Breaks()[At(b)], across.Begin(), across.End(), knots.Multiplicity(b) });
    }
  }
  Result<Spline<2>> expanded = InsertSegments(spline, segments, threads);
  if (!expanded)
  {
    return expanded;
  }
  Result<SplineSpacePtr<2>> tensor = MakeTensorSpace<2>(space.Knots);
  expanded->Space = tensor.Value; // functions have the same order
  return tensor ? std::move(expanded) : tensor.Status;
}

Result<Spline<2>> SwapParameters(const Spline<2>& spline, int threads)
{
  if (Status status = CheckLocallyRefined(spline); !status)
  {
    return status;
  }
  LRBasis basis = spline.Space->LocallyRefined->Basis;
  const int first = basis.Degree[0] + 2;
  for (auto f = basis.LocalKnots.begin(); f != basis.LocalKnots.end(); f += basis.Stride())
  {
    std::rotate(f, f + first, f + basis.Stride());
  }
  std::swap(basis.Degree[0], basis.Degree[1]);
  std::swap(basis.Knots[0], basis.Knots[1]);
  std::swap(basis.Lines[0], basis.Lines[1]);
  const std::vector<int> rows = AllRows(basis);
  return Assemble(std::move(basis), spline, rows, threads);
}

Result<Spline<2>> ReverseParameter(const Spline<2>& spline, int direction, int threads)
{
  Status status = CheckLocallyRefined(spline);
  status = status ? CheckDirection(direction) : status;
  if (!status)
  {
    return status;
  }
  LRBasis basis = spline.Space->LocallyRefined->Basis;
  const std::size_t d = At(direction);
  std::vector<double>& knots = basis.Knots[d];
  const double begin = knots.front();
  const double end = knots.back();
  std::reverse(knots.begin(), knots.end());
  for (double& knot : knots)
  {
    knot = knot == begin ? end : knot == end ? begin : begin + end - knot;
  }
  const auto last = static_cast<int>(knots.size()) - 1;
  std::reverse(basis.Lines[d].begin(), basis.Lines[d].end());
  for (LRLine& line : basis.Lines[1 - d])
  {
    LRLine reversed;
    int next = last; // where the piece ended
    for (std::size_t k = line.size(); k-- > 0;)
    {
      reversed.push_back({ last - next, line[k].Multiplicity });
      next = line[k].Knot;
    }
    line = std::move(reversed);
  }
  const int offset = direction == 0 ? 0 : basis.Degree[0] + 2;
  for (auto f = basis.LocalKnots.begin(); f != basis.LocalKnots.end(); f += basis.Stride())
  {
    std::reverse(f + offset, f + offset + basis.Degree[d] + 2);
    std::for_each(f + offset, f + offset + basis.Degree[d] + 2, [last](int& k) { k = last - k; });
  }
  const std::vector<int> rows = AllRows(basis);
  return Assemble(std::move(basis), spline, rows, threads);
}

Result<Spline<2>> MoveDomain(const Spline<2>& spline, const ParametricBox<2>& domain, int threads)
{
  if (Status status = CheckLocallyRefined(spline); !status)
  {
    return status;
  }
  LRBasis basis = spline.Space->LocallyRefined->Basis;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double low = domain.Lower[d];
    const double high = domain.Upper[d];
    const std::string direction = " in direction " + std::to_string(d);
    if (!(low < high) || !std::isfinite(high - low))
    {
      return { ErrorCode::InvalidParameter,
        "the domain is [" + Digits(low) + ", " + Digits(high) + "]" + direction +
          ", which has no finite length" };
    }
    std::vector<double>& knots = basis.Knots[d];
    const double begin = knots.front();
    const double end = knots.back();
    for (double& knot : knots)
    {
      // ends are exact, and so is a domain that stays what it is
      const double share = (knot - begin) / (end - begin);
      knot = knot == end ? high : begin == low && end == high ? knot : low + share * (high - low);
    }
    const auto same =
      std::adjacent_find(knots.begin(), knots.end(), [](double a, double b) { return !(a < b); });
    if (same != knots.end())
    {
      return { ErrorCode::InvalidKnots,
        "two knots become " + Digits(*same) + direction +
          "; choose a domain nearer to zero, or a longer one" };
    }
  }
  Spline<2> result = spline;
  Result<SplineSpacePtr<2>> space = MakeLRSpace(std::move(basis), threads);
  result.Space = space.Value;
  return space ? Result<Spline<2>>(std::move(result)) : space.Status;
}

Result<Spline<2>> RestrictToBox(const Spline<2>& spline, const ParametricBox<2>& box, int threads)
{
  if (Status status = CheckLocallyRefined(spline); !status)
  {
    return status;
  }
  const ParametricBox<2> domain = spline.Space->Domain();
  const IntArray<2>& degree = spline.Space->LocallyRefined->Basis.Degree;
  std::vector<LRSegment> segments;
  for (int d = 0; d < 2; ++d)
  {
    const double low = box.Lower[At(d)];
    const double high = box.Upper[At(d)];
    if (!(domain.Lower[At(d)] <= low && low < high && high <= domain.Upper[At(d)]))
    {
      return { ErrorCode::OutsideDomain,
        "the box is [" + Digits(low) + ", " + Digits(high) + "] in direction " + std::to_string(d) +
          (low < high ? "" : ", which has no length") + "; the domain is [" +
          Digits(domain.Lower[At(d)]) + ", " + Digits(domain.Upper[At(d)]) + "]" };
    }
    for (const double value : { low, high })
    {
      segments.push_back(
        { d, value, domain.Lower[At(1 - d)], domain.Upper[At(1 - d)], degree[At(d)] + 1 });
    }
  }
  const Result<Spline<2>> cut = InsertSegments(spline, segments, threads);
  if (!cut)
  {
    return cut.Status;
  }
  const LRBasis& all = cut.Value.Space->LocallyRefined->Basis;
  std::array<std::array<int, 2>, 2> range{};
  LRBasis basis;
  basis.Degree = all.Degree;
  const auto nearest = [](const std::vector<double>& knots, double value)
  {
    const auto best = std::min_element(knots.begin(), knots.end(),
      [value](double a, double b) { return std::fabs(a - value) < std::fabs(b - value); });
    return static_cast<int>(best - knots.begin());
  };
  for (std::size_t d = 0; d < 2; ++d)
  {
    range[d] = { nearest(all.Knots[d], box.Lower[d]), nearest(all.Knots[d], box.Upper[d]) };
    basis.Knots[d].assign(
      all.Knots[d].begin() + range[d][0], all.Knots[d].begin() + range[d][1] + 1);
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (int k = range[d][0]; k <= range[d][1]; ++k)
    {
      basis.Lines[d].push_back(Clipped(all.Lines[d][At(k)], range[1 - d][0], range[1 - d][1]));
    }
  }
  std::vector<int> rows;
  for (int f = 0; f < all.NumFunctions(); ++f)
  {
    bool inside = true;
    for (int d = 0; d < 2; ++d)
    {
      const int* local = all.Local(f, d);
      inside =
        inside && local[0] >= range[At(d)][0] && local[all.Degree[At(d)] + 1] <= range[At(d)][1];
    }
    if (!inside)
    {
      continue;
    }
    rows.push_back(f);
    basis.Scaling.push_back(all.Scaling[At(f)]);
    for (int d = 0; d < 2; ++d)
    {
      for (int i = 0; i < all.Degree[At(d)] + 2; ++i)
      {
        basis.LocalKnots.push_back(all.Local(f, d)[i] - range[At(d)][0]);
      }
    }
  }
  return Assemble(std::move(basis), cut.Value, rows, threads);
}

Result<Spline<1>> IsoCurve(const Spline<2>& spline, int direction, double value, int threads)
{
  Status status = CheckLocallyRefined(spline);
  status = status ? CheckDirection(direction) : status;
  if (!status)
  {
    return status;
  }
  const SplineSpace<2>& space = *spline.Space;
  const ParametricBox<2> domain = space.Domain();
  const std::size_t d = At(direction);
  const std::size_t e = 1 - d;
  if (!(value >= domain.Lower[d] && value <= domain.Upper[d]))
  {
    return { ErrorCode::OutsideDomain, Digits(value) };
  }
  const Crossing crossing = FindCrossing(space, direction, value);
  const IntArray<2>& degree = space.LocallyRefined->Basis.Degree;
  const int p = degree[e];
  Result<KnotVector> knots = KnotVector::Create(p, crossing.Knots);
  if (!knots)
  {
    return knots.Status;
  }
  Result<SplineSpacePtr<1>> curveSpace = MakeTensorSpace<1>({ knots.Value });
  if (!curveSpace)
  {
    return curveSpace.Status;
  }
  const BezierForm<2> form = MakeBezierForm(spline, threads);
  const int planes = form.NumPlanes();
  PointMatrix points(knots.Value.NumFunctions(), planes);
  const std::vector<double>& t = knots.Value.Knots();
  for (Eigen::Index j = 0; j < points.rows(); ++j)
  {
    // a coefficient is the blossom, at the function's inner knots, of any piece in its support
    const auto support = knots.Value.Support(static_cast<int>(j));
    const int element = crossing.Elements[At((support[0] + support[1]) / 2)];
    const ParametricBox<2>& box = space.Elements[At(element)].Box;
    const double across = (value - box.Lower[d]) / (box.Upper[d] - box.Lower[d]);
    const int n = NumTensorFunctions<2>(degree);
    for (int c = 0; c < planes; ++c)
    {
      const double* block = form.Block(element) + c * n;
      double line[MaxDegree + 1];
      for (int i = 0; i <= p; ++i)
      {
        double other[MaxDegree + 1];
        double arguments[MaxDegree];
        for (int k = 0; k <= degree[d]; ++k)
        {
          other[k] =
            direction == 0 ? block[k + (degree[0] + 1) * i] : block[i + (degree[0] + 1) * k];
        }
        std::fill_n(arguments, degree[d], across);
        line[i] = Blossom(other, degree[d], 0.0, 1.0, arguments);
      }
      points(j, c) = Blossom(line, p, box.Lower[e], box.Upper[e], t.data() + j + 1);
    }
  }
  Spline<1> curve;
  curve.Space = curveSpace.Value;
  curve.SetHomogeneousPoints(points, spline.IsRational());
  return curve;
}
}
