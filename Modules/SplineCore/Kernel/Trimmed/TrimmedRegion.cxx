// SPDX-License-Identifier: BSD-3-Clause
#include "TrimmedRegion.h"

#include "Bernstein.h"
#include "BezierForm.h"

#include <cmath>
#include <limits>

namespace knotwork
{
/// A Bezier curve that is a part of a piece, with its box.
struct TrimmedRegion::Part
{
  int Degree = 1;
  int Planes = 2;
  double Data[3 * (MaxDegree + 1)];
  RealArray<2> Lower{}; ///< of the Euclidean control points, not widened
  RealArray<2> Upper{};

  RealArray<2> End(int i) const
  {
    const int n = this->Degree + 1;
    const double w = this->Planes == 3 ? this->Data[2 * n + i] : 1.0;
    return { this->Data[i] / w, this->Data[n + i] / w };
  }
  RealArray<2> Begin() const { return this->End(0); }
  RealArray<2> Finish() const { return this->End(this->Degree); }

  void Measure()
  {
    this->Lower = this->Upper = this->Begin();
    for (int i = 1; i <= this->Degree; ++i)
    {
      const RealArray<2> point = this->End(i);
      for (std::size_t d = 0; d < 2; ++d)
      {
        this->Lower[d] = std::min(this->Lower[d], point[d]);
        this->Upper[d] = std::max(this->Upper[d], point[d]);
      }
    }
  }

  double Size() const
  {
    return std::max(this->Upper[0] - this->Lower[0], this->Upper[1] - this->Lower[1]);
  }

  bool Meets(const RealArray<2>& lower, const RealArray<2>& upper, double slack) const
  {
    return this->Lower[0] - slack <= upper[0] && lower[0] <= this->Upper[0] + slack &&
      this->Lower[1] - slack <= upper[1] && lower[1] <= this->Upper[1] + slack;
  }

  /// Makes this the first half and `second` the other one; both share the point between them.
  void Halve(Part& second)
  {
    const int n = this->Degree + 1;
    second = *this;
    for (int plane = 0; plane < this->Planes; ++plane)
    {
      HalveBernstein(this->Degree, second.Data + plane * n, this->Data + plane * n);
    }
    this->Measure();
    second.Measure();
  }
};

namespace
{
/// Of the largest coordinate: covers the rounding of 50 halvings of a curve of degree 9.
constexpr double RelativeSlack = 0x1p-43;
/// Parts are halved at most so often: then they are smaller than the slack.
constexpr int MaxDepth = 48;

/// Crossings of the ray from (.., height) to the right with a curve that lies to the right of its
/// origin: +1 upwards, -1 downwards.
int Crossings(double from, double to, double height)
{
  return (from <= height ? 1 : 0) - (to <= height ? 1 : 0);
}
}

Result<TrimmedRegion> TrimmedRegion::Create(const std::vector<TrimmedLoop>& loops)
{
  TrimmedRegion region;
  for (std::size_t l = 0; l < loops.size(); ++l)
  {
    if (const Status status = region.AddLoop(loops[l], "loop " + std::to_string(l)); !status)
    {
      return status;
    }
  }
  region.Index();
  return region;
}

Status TrimmedRegion::AddLoop(const TrimmedLoop& loop, const std::string& place)
{
  if (loop.Curves.empty())
  {
    return { ErrorCode::EmptyInput, place + " has no curves" };
  }
  const std::size_t first = this->Pieces.size();
  for (std::size_t c = 0; c < loop.Curves.size(); ++c)
  {
    const TrimmingCurve& use = loop.Curves[c];
    const Spline<1> curve = use.ParameterCurve();
    const std::string curvePlace = place + ", curve " + std::to_string(c);
    if (const Status status = curve.Check(); !status)
    {
      return { status.Code, curvePlace + ": " + status.Detail };
    }
    if (curve.NumComponents() != 2 || curve.Space->Kind != SpaceKind::Tensor)
    {
      return { ErrorCode::DimensionMismatch,
        curvePlace + ": a tensor spline with 2 parameters a control point is needed" };
    }
    const BezierForm<1> form = MakeBezierForm<1>(curve, 1);
    const int n = curve.Space->NumElements();
    for (int k = 0; k < n; ++k)
    {
      const int e = use.Reversed ? n - 1 - k : k;
      const int degree = curve.Space->Elements[static_cast<std::size_t>(e)].Degree[0];
      this->AddPiece(degree, form.Rational, form.Block(e), use.Reversed);
    }
  }
  // close the gaps, also those of rounding
  const std::size_t last = this->Pieces.size();
  for (std::size_t k = first; k < last; ++k)
  {
    const RealArray<2> from = this->MakePart(static_cast<int>(k)).Finish();
    const RealArray<2> to = this->MakePart(static_cast<int>(k + 1 < last ? k + 1 : first)).Begin();
    if (from != to)
    {
      this->AddLine(from, to);
    }
  }
  return {};
}

void TrimmedRegion::AddPiece(int degree, bool rational, const double* planes, bool reversed)
{
  const int n = degree + 1;
  this->Pieces.push_back({ degree, rational, this->Data.size() });
  for (int plane = 0; plane < (rational ? 3 : 2); ++plane)
  {
    for (int i = 0; i < n; ++i)
    {
      this->Data.push_back(planes[plane * n + (reversed ? degree - i : i)]);
    }
  }
}

void TrimmedRegion::AddLine(const RealArray<2>& from, const RealArray<2>& to)
{
  const double planes[4] = { from[0], to[0], from[1], to[1] };
  this->AddPiece(1, false, planes, false);
}

TrimmedRegion::Part TrimmedRegion::MakePart(int piece) const
{
  const Piece& from = this->Pieces[static_cast<std::size_t>(piece)];
  Part part;
  part.Degree = from.Degree;
  part.Planes = from.Rational ? 3 : 2;
  std::copy_n(this->Data.data() + from.Offset, part.Planes * (part.Degree + 1), part.Data);
  part.Measure();
  return part;
}

void TrimmedRegion::Index()
{
  const Eigen::Index n = static_cast<Eigen::Index>(this->Pieces.size());
  PointMatrix lower(n, 2);
  PointMatrix upper(n, 2);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Part part = this->MakePart(static_cast<int>(i));
    for (int d = 0; d < 2; ++d)
    {
      lower(i, d) = part.Lower[static_cast<std::size_t>(d)];
      upper(i, d) = part.Upper[static_cast<std::size_t>(d)];
      largest = std::max({ largest, std::abs(lower(i, d)), std::abs(upper(i, d)) });
    }
  }
  this->Slack = RelativeSlack * largest;
  this->Tree =
    BoxTree((lower.array() - this->Slack).matrix(), (upper.array() + this->Slack).matrix());
}

RegionPlace TrimmedRegion::Classify(const RealArray<2>& lower, const RealArray<2>& upper) const
{
  if (this->IsWholePlane())
  {
    return RegionPlace::Inside;
  }
  const double enough =
    std::max(std::min(upper[0] - lower[0], upper[1] - lower[1]) / 8.0, this->Slack);
  const auto holds = [&](const RealArray<2>& point)
  {
    return lower[0] <= point[0] && point[0] <= upper[0] && lower[1] <= point[1] &&
      point[1] <= upper[1];
  };
  const auto meets = [&](const auto& self, Part& part, int depth) -> bool
  {
    if (!part.Meets(lower, upper, this->Slack))
    {
      return false;
    }
    if (part.Size() <= enough || depth >= MaxDepth || holds(part.Begin()) || holds(part.Finish()))
    {
      return true;
    }
    Part second;
    part.Halve(second);
    return self(self, part, depth + 1) || self(self, second, depth + 1);
  };
  bool boundary = false;
  this->Tree.ForNear(lower.data(), upper.data(),
    [&](int item)
    {
      if (!boundary)
      {
        Part part = this->MakePart(item);
        boundary = meets(meets, part, 0);
      }
    });
  if (boundary)
  {
    return RegionPlace::Boundary;
  }
  return this->Contains({ 0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1]) });
}

RegionPlace TrimmedRegion::Contains(const RealArray<2>& point) const
{
  if (this->IsWholePlane())
  {
    return RegionPlace::Inside;
  }
  bool onCurve = false;
  const int winding = this->WindingNumber(point, onCurve);
  if (onCurve)
  {
    return RegionPlace::Boundary;
  }
  return winding != 0 ? RegionPlace::Inside : RegionPlace::Outside;
}

int TrimmedRegion::WindingNumber(const RealArray<2>& point, bool& onCurve) const
{
  onCurve = false;
  const auto count = [&](const auto& self, Part& part, int depth) -> int
  {
    // the part that is not left, above or below counts by its ends, unless it is around the point
    if (part.Upper[0] + this->Slack < point[0] || part.Upper[1] + this->Slack < point[1] ||
      part.Lower[1] - this->Slack > point[1])
    {
      return 0;
    }
    if (part.Lower[0] - this->Slack > point[0])
    {
      return Crossings(part.Begin()[1], part.Finish()[1], point[1]);
    }
    if (part.Size() <= this->Slack || depth >= MaxDepth)
    {
      onCurve = true;
      return 0;
    }
    Part second;
    part.Halve(second);
    const int left = self(self, part, depth + 1);
    return left + (onCurve ? 0 : self(self, second, depth + 1));
  };
  int winding = 0;
  const double lower[2] = { point[0], point[1] };
  const double upper[2] = { std::numeric_limits<double>::infinity(), point[1] };
  this->Tree.ForNear(lower, upper,
    [&](int item)
    {
      if (!onCurve)
      {
        Part part = this->MakePart(item);
        winding += count(count, part, 0);
      }
    });
  return winding;
}
}
