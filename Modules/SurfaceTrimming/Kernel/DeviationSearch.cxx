// SPDX-License-Identifier: BSD-3-Clause
#include "DeviationSearch.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Of the numbers that enter a value: some hundred roundings.
constexpr double UnitRounding = 0x1p-45;
constexpr double LeastArea = 0x1p-51; // relative, below which an area is rounding alone
/// Halvings a triangle, and how many more a part that the elements make.
constexpr int MaxHalvings = 1000;
constexpr int HalvingsAPart = 4;
/// Sides of a part relative to the triangle's box are not more unequal than this.
constexpr double LargestAspect = 4.0;

RealArray<2> Difference(const RealArray<2>& a, const RealArray<2>& b)
{
  return { a[0] - b[0], a[1] - b[1] };
}

double Cross(const RealArray<2>& a, const RealArray<2>& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

double Length(const RealArray<3>& a)
{
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}
}

ChartTriangle CornersOf(const ChartMesh& chart, std::size_t triangle)
{
  ChartTriangle result;
  for (std::size_t c = 0; c < 3; ++c)
  {
    const int row = chart.Triangles[triangle][c];
    result.UV[c] = { chart.UV(row, 0), chart.UV(row, 1) };
    result.Points[c] = { chart.Points(row, 0), chart.Points(row, 1), chart.Points(row, 2) };
  }
  return result;
}

DeviationSearch::DeviationSearch(const BezierForm<2>& surface, double relativeGap, double enough)
  : Surface(surface), RelativeGap(relativeGap), Enough(enough),
    Degree(surface.Space->Elements.front().Degree)
{
  const IntArray<2> p = this->Degree;
  if (surface.Rational)
  {
    this->Degree = { p[0] + 1, p[1] + 1 }; // times X
  }
  this->Count = NumTensorFunctions<2>(this->Degree);
  this->Planes = surface.NumPlanes();
  this->SlotSize = static_cast<std::size_t>(this->Planes * this->Count);
  for (std::size_t d = 0; d < 2; ++d)
  {
    const int n = this->Degree[d] + 1;
    for (std::size_t k = 0; k < 2; ++k)
    {
      this->Halves[d][k].resize(static_cast<std::size_t>(n * n));
      BernsteinRestriction(
        this->Degree[d], k == 0 ? 0.0 : 0.5, k == 0 ? 0.5 : 1.0, this->Halves[d][k].data());
    }
  }

  // magnitudes for the rounding of values
  const int n = NumTensorFunctions<2>(p);
  for (int e = 0; e < surface.Space->NumElements(); ++e)
  {
    const double* block = surface.Block(e);
    const ParametricBox<2>& box = surface.Space->Elements[static_cast<std::size_t>(e)].Box;
    double ratio = 1.0;
    if (surface.Rational)
    {
      const auto ends = std::minmax_element(block + 3 * n, block + 4 * n);
      ratio = *ends.second / *ends.first;
    }
    const auto coordinate = [&](int plane, int i)
    { return block[plane * n + i] / (surface.Rational ? block[3 * n + i] : 1.0); };
    double steps[2] = { 0.0, 0.0 };
    for (int plane = 0; plane < 3; ++plane)
    {
      for (int i = 0; i < n; ++i)
      {
        const double x = coordinate(plane, i);
        this->Largest = std::max(this->Largest, std::abs(x) * ratio);
        if (i % (p[0] + 1) < p[0])
        {
          steps[0] = std::max(steps[0], std::abs(coordinate(plane, i + 1) - x));
        }
        if (i / (p[0] + 1) < p[1])
        {
          steps[1] = std::max(steps[1], std::abs(coordinate(plane, i + p[0] + 1) - x));
        }
      }
    }
    double slope = 0.0;
    for (std::size_t d = 0; d < 2; ++d)
    {
      slope += 2.0 * p[d] * steps[d] * ratio * ratio / (box.Upper[d] - box.Lower[d]);
    }
    this->Slope = std::max(this->Slope, slope);
  }
}

TriangleDeviation DeviationSearch::Bound(const ChartTriangle& triangle, double found)
{
  this->Open.clear();
  this->Elements.clear();
  this->FreeSlots.clear();
  this->NumSlots = 0;
  this->Found = found;
  this->Settled = 0.0;
  this->SetTriangle(triangle);

  const auto& knots = this->Surface.Space->Knots;
  IntArray<2> first;
  IntArray<2> last;
  for (std::size_t d = 0; d < 2; ++d)
  {
    first[d] = knots[d].FindElement(this->Lower[d]);
    last[d] = knots[d].FindElement(this->Upper[d]);
    if (last[d] > first[d] &&
      knots[d].Breaks()[static_cast<std::size_t>(last[d])] >= this->Upper[d])
    {
      --last[d]; // the triangle ends on the break
    }
  }
  for (int j = first[1]; j <= last[1]; ++j)
  {
    for (int i = first[0]; i <= last[0]; ++i)
    {
      this->AddElement(i + j * knots[0].NumElements());
    }
  }
  int halvings = MaxHalvings + HalvingsAPart * static_cast<int>(this->Open.size());
  const auto less = [](const Part& a, const Part& b) { return a.Upper < b.Upper; };
  std::make_heap(this->Open.begin(), this->Open.end(), less);
  while (!this->Open.empty() && this->Open.front().Upper > this->Goal() && halvings-- > 0)
  {
    std::pop_heap(this->Open.begin(), this->Open.end(), less);
    const Part part = this->Open.back();
    this->Open.pop_back();
    this->Halve(part);
  }
  const double open = this->Open.empty() ? 0.0 : this->Open.front().Upper;
  return { std::max({ this->Settled, open, this->Found }) * (1.0 + 0x1p-40) + this->Rounding,
    this->Found };
}

double DeviationSearch::Goal() const
{
  const double wanted = std::max((1.0 + this->RelativeGap) * this->Found, this->Enough);
  return std::max(wanted * (1.0 - 0x1p-40) - this->Rounding, this->Rounding);
}

void DeviationSearch::SetTriangle(const ChartTriangle& triangle)
{
  this->Triangle = triangle;
  const auto& uv = triangle.UV;
  double furthest = 0.0; // parameter
  double longest = 0.0;  // side in the plane
  double side = 0.0;     // coordinate of a side in space
  double largest = this->Largest;
  for (std::size_t d = 0; d < 2; ++d)
  {
    this->Lower[d] = std::min({ uv[0][d], uv[1][d], uv[2][d] });
    this->Upper[d] = std::max({ uv[0][d], uv[1][d], uv[2][d] });
    furthest = std::max({ furthest, std::abs(this->Lower[d]), std::abs(this->Upper[d]) });
    longest = std::max(longest, this->Upper[d] - this->Lower[d]);
  }
  const RealArray<2> a = Difference(uv[1], uv[0]);
  const RealArray<2> b = Difference(uv[2], uv[0]);
  // A needle's computed area may be anything within its rounding, negative too: then X is known up
  // to the needle's length only.
  const double twice = std::max(std::abs(Cross(a, b)), LeastArea * longest * longest);
  double slope = this->Slope;
  for (std::size_t c = 0; c < 3; ++c)
  {
    const double x = triangle.Points[0][c];
    const double p = triangle.Points[1][c] - x;
    const double q = triangle.Points[2][c] - x;
    this->Gradient[0][c] = (p * b[1] - q * a[1]) / twice;
    this->Gradient[1][c] = (q * a[0] - p * b[0]) / twice;
    slope += std::abs(this->Gradient[0][c]) + std::abs(this->Gradient[1][c]);
    side = std::max({ side, std::abs(p), std::abs(q) });
    largest = std::max(largest, std::abs(x) + std::max(std::abs(p), std::abs(q)));
  }
  // The affine map is off by the rounding of the triangle's area, relative to it.
  const double thinness = longest * longest / twice;
  this->Rounding = UnitRounding * (largest + side * thinness + slope * furthest);
  this->EdgeSlack = UnitRounding * (1.0 + furthest / longest);
}

void DeviationSearch::AddElement(int element)
{
  const ParametricBox<2>& box =
    this->Surface.Space->Elements[static_cast<std::size_t>(element)].Box;
  ElementPart local;
  Part part;
  local.Element = element;
  RealArray<2> size;
  double longest = 0.0;
  for (std::size_t d = 0; d < 2; ++d)
  {
    size[d] = box.Upper[d] - box.Lower[d];
    longest = std::max(longest, this->Upper[d] - this->Lower[d]);
    local.Extent[d] = (this->Upper[d] - this->Lower[d]) / size[d];
    const double slack =
      0x1p-50 * (1.0 + std::max(std::abs(box.Lower[d]), std::abs(box.Upper[d])) / size[d]);
    const double lower = (this->Lower[d] - box.Lower[d]) / size[d] - slack;
    const double upper = (this->Upper[d] - box.Lower[d]) / size[d] + slack;
    part.Lower[d] = std::clamp(lower, 0.0, 1.0);
    part.Size[d] = std::clamp(upper, 0.0, 1.0) - part.Lower[d];
  }
  for (std::size_t c = 0; c < 3; ++c)
  {
    const RealArray<2>& from = this->Triangle.UV[c];
    const RealArray<2> edge = Difference(this->Triangle.UV[(c + 1) % 3], from);
    const double scale = 1.0 / (std::hypot(edge[0], edge[1]) * longest);
    const RealArray<2> offset = Difference(box.Lower, from);
    local.Edges[c] = { Cross(edge, offset) * scale, -edge[1] * size[0] * scale,
      edge[0] * size[1] * scale };
    const RealArray<2> origin = Difference(box.Lower, this->Triangle.UV[0]);
    local.X[c] = { this->Triangle.Points[0][c] + this->Gradient[0][c] * origin[0] +
        this->Gradient[1][c] * origin[1],
      this->Gradient[0][c] * size[0], this->Gradient[1][c] * size[1] };
  }
  part.Element = static_cast<int>(this->Elements.size());
  this->Elements.push_back(local);
  if (!this->MeetsTriangle(part))
  {
    return;
  }
  part.Slot = this->NewSlot();
  if (this->Surface.Rational)
  {
    this->FillRational(part, this->At(part));
  }
  else
  {
    this->Fill(part, this->At(part));
  }
  this->Measure(part);
  this->Open.push_back(part);
}

RealArray<3> DeviationSearch::PointOnTriangle(const ElementPart& element, double s, double t) const
{
  RealArray<3> x;
  for (std::size_t c = 0; c < 3; ++c)
  {
    x[c] = element.X[c][0] + element.X[c][1] * s + element.X[c][2] * t;
  }
  return x;
}

void DeviationSearch::Fill(const Part& part, double* to)
{
  const ElementPart& element = this->Elements[static_cast<std::size_t>(part.Element)];
  const double* from = this->Surface.Block(element.Element);
  double matrix[2][(MaxDegree + 1) * (MaxDegree + 1)];
  for (std::size_t d = 0; d < 2; ++d)
  {
    BernsteinRestriction(this->Degree[d], part.Lower[d], part.Lower[d] + part.Size[d], matrix[d]);
  }
  for (int plane = 0; plane < 3; ++plane)
  {
    ApplyFactors<2>(
      this->Degree, { matrix[0], matrix[1] }, from + plane * this->Count, to + plane * this->Count);
  }
  // the coefficients of a linear function are its values at i / p
  int at = 0;
  for (int j = 0; j <= this->Degree[1]; ++j)
  {
    const double t = part.Lower[1] + part.Size[1] * j / this->Degree[1];
    for (int i = 0; i <= this->Degree[0]; ++i, ++at)
    {
      const double s = part.Lower[0] + part.Size[0] * i / this->Degree[0];
      const RealArray<3> x = this->PointOnTriangle(element, s, t);
      for (int plane = 0; plane < 3; ++plane)
      {
        to[plane * this->Count + at] -= x[static_cast<std::size_t>(plane)];
      }
    }
  }
}

void DeviationSearch::FillRational(const Part& part, double* to)
{
  const ElementPart& element = this->Elements[static_cast<std::size_t>(part.Element)];
  const IntArray<2> p{ this->Degree[0] - 1, this->Degree[1] - 1 };
  const std::size_t n = static_cast<std::size_t>(NumTensorFunctions<2>(p));
  const double* from = this->Surface.Block(element.Element);
  double matrix[2][(MaxDegree + 1) * (MaxDegree + 1)];
  for (std::size_t d = 0; d < 2; ++d)
  {
    BernsteinRestriction(p[d], part.Lower[d], part.Lower[d] + part.Size[d], matrix[d]);
  }
  std::vector<double> planes[4];
  for (std::size_t plane = 0; plane < 4; ++plane)
  {
    planes[plane].resize(n);
    ApplyFactors<2>(p, { matrix[0], matrix[1] }, from + plane * n, planes[plane].data());
  }
  std::array<RealArray<3>, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
  {
    corners[k] = this->PointOnTriangle(element, part.Lower[0] + (k & 1 ? part.Size[0] : 0.0),
      part.Lower[1] + (k & 2 ? part.Size[1] : 0.0));
  }
  for (std::size_t plane = 0; plane < 4; ++plane)
  {
    std::vector<double> values = BernsteinElevate<2>(p, planes[plane], this->Degree);
    if (plane < 3)
    {
      const std::vector<double> x{ corners[0][plane], corners[1][plane], corners[2][plane],
        corners[3][plane] };
      const std::vector<double> product = BernsteinProduct<2>(p, planes[3], { 1, 1 }, x);
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        values[i] -= product[i];
      }
    }
    std::copy(values.begin(), values.end(), to + plane * values.size());
  }
}

void DeviationSearch::Measure(Part& part)
{
  const double* x = this->At(part);
  const double* y = x + this->Count;
  const double* z = y + this->Count;
  const double* w = z + this->Count; // when rational
  const auto square = [&](int i)
  {
    const double norm = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
    return this->Planes == 4 ? norm / (w[i] * w[i]) : norm;
  };
  double largest = 0.0;
  for (int i = 0; i < this->Count; ++i)
  {
    largest = std::max(largest, square(i));
  }
  part.Upper = std::sqrt(largest);
  if (part.Upper <= this->Found)
  {
    return;
  }
  bool inside = true;
  for (int k = 0; k < 4; ++k)
  {
    const int right = k & 1;
    const int top = k >> 1;
    const bool on = this->IsOnTriangle(this->Elements[static_cast<std::size_t>(part.Element)],
      part.Lower[0] + right * part.Size[0], part.Lower[1] + top * part.Size[1]);
    inside = inside && on;
    const double value =
      square(right * this->Degree[0] + top * (this->Count - this->Degree[0] - 1));
    if (on && value > this->Found * this->Found)
    {
      this->Found = std::sqrt(value);
    }
  }
  if (!inside && part.Upper > this->Goal())
  {
    this->MeasureClipped(part);
  }
}

void DeviationSearch::MeasureClipped(Part& part)
{
  Polygon polygon;
  this->Clip(part, polygon);
  if (polygon.Size == 0)
  {
    return; // only rounding lets them meet
  }
  // Linear parts of all planes: means, and mean differences of opposite sides.
  const int row = this->Degree[0] + 1;
  const int column = this->Degree[1] + 1;
  double linear[4][3] = { {}, {}, {}, { 1.0 } };
  double rest = 0.0; // largest square of a coefficient of what is not linear
  double restOfWeight = 0.0;
  for (int plane = 0; plane < this->Planes; ++plane)
  {
    const double* a = this->At(part) + plane * this->Count;
    double sum = 0.0;
    double sides[2] = { 0.0, 0.0 };
    for (int i = 0; i < this->Count; ++i)
    {
      sum += a[i];
    }
    for (int j = 0; j < column; ++j)
    {
      sides[0] += a[(j + 1) * row - 1] - a[j * row];
    }
    for (int i = 0; i < row; ++i)
    {
      sides[1] += a[this->Count - row + i] - a[i];
    }
    linear[plane][1] = sides[0] / column;
    linear[plane][2] = sides[1] / row;
    linear[plane][0] = sum / this->Count - 0.5 * (linear[plane][1] + linear[plane][2]);
  }
  for (int j = 0; j < column; ++j)
  {
    for (int i = 0; i < row; ++i)
    {
      double square = 0.0;
      for (int plane = 0; plane < this->Planes; ++plane)
      {
        const double* l = linear[plane];
        const double difference = this->At(part)[plane * this->Count + j * row + i] - l[0] -
          l[1] * i / this->Degree[0] - l[2] * j / this->Degree[1];
        if (plane == 3)
        {
          restOfWeight = std::max(restOfWeight, std::abs(difference));
        }
        else
        {
          square += difference * difference;
        }
      }
      rest = std::max(rest, square);
    }
  }
  rest = std::sqrt(rest);
  double upper = 0.0;
  for (int k = 0; k < polygon.Size; ++k)
  {
    const auto value = [&](int plane)
    {
      const double* l = linear[plane];
      const RealArray<2>& point = polygon.Points[static_cast<std::size_t>(k)];
      return l[0] + l[1] * point[0] + l[2] * point[1];
    };
    const double length = Length({ value(0), value(1), value(2) });
    const double least = value(3) - restOfWeight;
    upper = std::max(
      upper, least > 0.0 ? (length + rest) / least : std::numeric_limits<double>::infinity());
    this->Found = std::max(this->Found, (length - rest) / (value(3) + restOfWeight));
  }
  part.Upper = std::min(part.Upper, upper);
}

void DeviationSearch::Clip(const Part& part, Polygon& polygon) const
{
  polygon.Size = 4;
  polygon.Points = { { { 0.0, 0.0 }, { 1.0, 0.0 }, { 1.0, 1.0 }, { 0.0, 1.0 } } };
  for (const RealArray<3>& edge : this->Elements[static_cast<std::size_t>(part.Element)].Edges)
  {
    const double constant =
      edge[0] + edge[1] * part.Lower[0] + edge[2] * part.Lower[1] + this->EdgeSlack;
    const auto side = [&](const RealArray<2>& point)
    { return constant + edge[1] * part.Size[0] * point[0] + edge[2] * part.Size[1] * point[1]; };
    const Polygon whole = polygon;
    polygon.Size = 0;
    for (int k = 0; k < whole.Size; ++k)
    {
      const RealArray<2>& a = whole.Points[static_cast<std::size_t>(k)];
      const RealArray<2>& b = whole.Points[static_cast<std::size_t>((k + 1) % whole.Size)];
      const double atA = side(a);
      const double atB = side(b);
      if (atA >= 0.0)
      {
        polygon.Points[static_cast<std::size_t>(polygon.Size++)] = a;
      }
      if ((atA >= 0.0) != (atB >= 0.0))
      {
        const double t = atA / (atA - atB);
        polygon.Points[static_cast<std::size_t>(polygon.Size++)] = { a[0] + t * (b[0] - a[0]),
          a[1] + t * (b[1] - a[1]) };
      }
    }
  }
}

bool DeviationSearch::IsOnTriangle(const ElementPart& element, double s, double t) const
{
  for (const RealArray<3>& edge : element.Edges)
  {
    if (edge[0] + edge[1] * s + edge[2] * t < -this->EdgeSlack)
    {
      return false;
    }
  }
  return true;
}

bool DeviationSearch::MeetsTriangle(const Part& part) const
{
  // Parts lie in the triangle's box, so only the edges' normals can separate them from it.
  const ElementPart& element = this->Elements[static_cast<std::size_t>(part.Element)];
  for (const RealArray<3>& edge : element.Edges)
  {
    const double s = part.Lower[0] + (edge[1] > 0.0 ? part.Size[0] : 0.0);
    const double t = part.Lower[1] + (edge[2] > 0.0 ? part.Size[1] : 0.0);
    if (edge[0] + edge[1] * s + edge[2] * t < -this->EdgeSlack)
    {
      return false;
    }
  }
  return true;
}

std::size_t DeviationSearch::HalvingDirection(const Part& part)
{
  const ElementPart& element = this->Elements[static_cast<std::size_t>(part.Element)];
  const double sides[2] = { part.Size[0] / element.Extent[0], part.Size[1] / element.Extent[1] };
  for (std::size_t d = 0; d < 2; ++d)
  {
    if (sides[d] > LargestAspect * sides[1 - d])
    {
      return d;
    }
  }
  // where the coefficients vary most
  const double* a = this->At(part);
  const int row = this->Degree[0] + 1;
  double variation[2] = { 0.0, 0.0 };
  for (int plane = 0; plane < 3; ++plane, a += this->Count)
  {
    for (int i = 0; i < this->Count; i += row)
    {
      for (int k = i; k + 1 < i + row; ++k)
      {
        variation[0] += (a[k + 1] - a[k]) * (a[k + 1] - a[k]);
      }
    }
    for (int i = 0; i + row < this->Count; ++i)
    {
      variation[1] += (a[i + row] - a[i]) * (a[i + row] - a[i]);
    }
  }
  // sums of squared steps shrink with their number
  return variation[0] * this->Degree[0] >= variation[1] * this->Degree[1] ? 0 : 1;
}

void DeviationSearch::Halve(const Part& part)
{
  const std::size_t d = this->HalvingDirection(part);
  for (std::size_t k = 0; k < 2; ++k)
  {
    Part half = part;
    half.Size[d] *= 0.5;
    half.Lower[d] += k == 0 ? 0.0 : half.Size[d];
    if (!this->MeetsTriangle(half))
    {
      continue;
    }
    half.Slot = this->NewSlot();
    std::array<const double*, 2> factors{};
    factors[d] = this->Halves[d][k].data();
    for (int plane = 0; plane < this->Planes; ++plane)
    {
      ApplyFactors<2>(this->Degree, factors, this->At(part) + plane * this->Count,
        this->At(half) + plane * this->Count);
    }
    this->Measure(half);
    this->Keep(half);
  }
  this->FreeSlots.push_back(part.Slot);
}

void DeviationSearch::Keep(const Part& part)
{
  if (part.Upper <= this->Goal())
  {
    this->Settled = std::max(this->Settled, part.Upper);
    this->FreeSlots.push_back(part.Slot);
    return;
  }
  this->Open.push_back(part);
  std::push_heap(this->Open.begin(), this->Open.end(),
    [](const Part& a, const Part& b) { return a.Upper < b.Upper; });
}

int DeviationSearch::NewSlot()
{
  if (!this->FreeSlots.empty())
  {
    const int slot = this->FreeSlots.back();
    this->FreeSlots.pop_back();
    return slot;
  }
  const std::size_t needed = static_cast<std::size_t>(++this->NumSlots) * this->SlotSize;
  if (this->Coefficients.size() < needed)
  {
    this->Coefficients.resize(2 * needed);
  }
  return this->NumSlots - 1;
}
}
