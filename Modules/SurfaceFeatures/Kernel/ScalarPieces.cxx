// SPDX-License-Identifier: BSD-3-Clause
#include "ScalarPieces.h"

#include "PieceLayout.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Parallel.h>

namespace knotwork
{
namespace
{
constexpr double Unit = 0x1p-53;
/// Largest degree of a field: the numerator of a rational gradient has 2 p.
constexpr int MaxFieldDegree = 2 * MaxDegree;

/// Coefficients on [lower, upper] of n + 1 numbers `stride` apart, by de Casteljau's algorithm. The
/// lower end is rounded down.
void RestrictLine(int n, int stride, const Interval& part, double* c)
{
  if (part.Hi < 1.0)
  {
    const double t = part.Hi;
    for (int r = 1; r <= n; ++r)
    {
      for (int i = n; i >= r; --i)
      {
        c[i * stride] = (1.0 - t) * c[(i - 1) * stride] + t * c[i * stride];
      }
    }
  }
  if (part.Lo > 0.0)
  {
    const double t = part.Lo == part.Hi ? 1.0 : part.Lo / part.Hi * (1.0 - 0x1p-52);
    for (int r = 1; r <= n; ++r)
    {
      for (int i = 0; i <= n - r; ++i)
      {
        c[i * stride] = (1.0 - t) * c[i * stride] + t * c[(i + 1) * stride];
      }
    }
  }
}

BernsteinField Derivative(const BernsteinField& field, int direction, double width)
{
  BernsteinField d;
  const int p = field.Degree[static_cast<std::size_t>(direction)];
  if (p == 0)
  {
    d.Degree = field.Degree;
    d.C.assign(field.C.size(), 0.0);
    return d;
  }
  d.Degree = field.Degree;
  --d.Degree[static_cast<std::size_t>(direction)];
  d.C = BernsteinDerivative<2>(field.Degree, field.C, direction);
  for (double& c : d.C)
  {
    c /= width;
  }
  d.Error = 2.0 * p / width * field.Error * (1.0 + 0x1p-40);
  d.Close(6.0);
  return d;
}

/// w a_d - a w_d.
BernsteinField GradientNumerator(const BernsteinField& a, const BernsteinField& w,
  const BernsteinField& ad, const BernsteinField& wd, int direction)
{
  BernsteinField g;
  g.Degree = { a.Degree[0] + w.Degree[0], a.Degree[1] + w.Degree[1] };
  --g.Degree[static_cast<std::size_t>(direction)];
  g.C = BernsteinProduct<2>(w.Degree, w.C, ad.Degree, ad.C);
  const std::vector<double> second = BernsteinProduct<2>(a.Degree, a.C, wd.Degree, wd.C);
  for (std::size_t i = 0; i < g.C.size(); ++i)
  {
    g.C[i] -= second[i];
  }
  const double size = w.Magnitude * ad.Magnitude + a.Magnitude * wd.Magnitude;
  const double roundings = 8.0 * static_cast<double>(a.C.size()) + 16.0;
  g.Error = (w.Magnitude * ad.Error + w.Error * ad.Magnitude + a.Magnitude * wd.Error +
              a.Error * wd.Magnitude + w.Error * ad.Error + a.Error * wd.Error) *
      (1.0 + 0x1p-40) +
    roundings * Unit * size;
  g.Close(2.0);
  return g;
}

/// The element's plane of the form in the order of the plane's directions.
std::vector<double> Turned(const double* block, const IntArray<2>& degree, const IntArray<2>& axis,
  const std::array<bool, 2>& reversed)
{
  const int p = degree[0];
  const int q = degree[1];
  std::vector<double> c(static_cast<std::size_t>((p + 1) * (q + 1)));
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const int a = reversed[0] ? p - i : i;
      const int b = reversed[1] ? q - j : j;
      const int at = axis[0] == 0 ? a + (p + 1) * b : b + (q + 1) * a;
      c[static_cast<std::size_t>(at)] = block[i + (p + 1) * j];
    }
  }
  return c;
}

struct Source
{
  BezierForm<2> Form; ///< planes: values, sizes of values(, weights)
  std::vector<PlacedElement> Placed;
};

void MakePiece(const Source& source, int e, ScalarPieces& pieces)
{
  const auto at = static_cast<std::size_t>(e);
  const auto& element = source.Form.Space->Elements[at];
  ScalarPiece& piece = pieces.Pieces[at];
  IntArray<2> axis{ 0, 1 };
  std::array<bool, 2> reversed{};
  ParametricBox<2> box = element.Box;
  if (!pieces.HasDomain)
  {
    axis = pieces.Axis[at];
    reversed = pieces.Reversed[at];
    const PlacedElement& placed = source.Placed[at];
    for (std::size_t d = 0; d < 2; ++d)
    {
      box.Lower[d] = placed.Cell[d];
      box.Upper[d] = placed.Cell[d] + 1;
    }
  }
  const int n = NumTensorFunctions<2>(element.Degree);
  const double* block = source.Form.Block(e);
  const IntArray<2> degree =
    axis[0] == 0 ? element.Degree : IntArray<2>{ element.Degree[1], element.Degree[0] };
  // sums of products of positive numbers: the error is relative to the size of what is summed
  const double roundings = 64.0 * (degree[0] + degree[1] + 2);
  const double size = *std::max_element(block + n, block + 2 * n);
  piece.Box = { Interval(box.Lower[0], box.Upper[0]), Interval(box.Lower[1], box.Upper[1]) };
  piece.Value.Degree = degree;
  piece.Value.C = Turned(block, element.Degree, axis, reversed);
  piece.Value.Error = roundings * Unit * size;
  piece.Value.Close(0.0);
  std::array<BernsteinField, 2> first;
  for (int d = 0; d < 2; ++d)
  {
    const auto k = static_cast<std::size_t>(d);
    first[k] = Derivative(piece.Value, d, piece.Box[k].Width());
  }
  if (pieces.Rational)
  {
    piece.Weight.Degree = degree;
    piece.Weight.C = Turned(block + 2 * n, element.Degree, axis, reversed);
    piece.Weight.Close(roundings);
    for (int d = 0; d < 2; ++d)
    {
      const auto k = static_cast<std::size_t>(d);
      const BernsteinField slope = Derivative(piece.Weight, d, piece.Box[k].Width());
      piece.Gradient[k] = GradientNumerator(piece.Value, piece.Weight, first[k], slope, d);
    }
  }
  else
  {
    piece.Gradient = std::move(first);
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (int k = 0; k < 2; ++k)
    {
      piece.Jacobian[d][static_cast<std::size_t>(k)] =
        Derivative(piece.Gradient[d], k, piece.Box[static_cast<std::size_t>(k)].Width());
    }
  }
}

/// Shift and scale so that values are at most about one, and the absolute values beside them.
Spline<2> Normalized(const Spline<2>& spline, int component, ScalarPieces& pieces)
{
  const auto column = spline.ControlPoints.col(component).array();
  const double low = column.minCoeff();
  const double high = column.maxCoeff();
  pieces.Shift = low + 0.5 * (high - low);
  const double size = std::max(high - pieces.Shift, pieces.Shift - low);
  pieces.Scale = size > 0.0 ? std::ldexp(1.0, std::ilogb(size)) : 1.0;
  Spline<2> f;
  f.Space = spline.Space;
  f.Weights = spline.Weights;
  f.ControlPoints.resize(spline.ControlPoints.rows(), 2);
  f.ControlPoints.col(0) = ((column - pieces.Shift) / pieces.Scale).matrix();
  f.ControlPoints.col(1) = f.ControlPoints.col(0).cwiseAbs();
  return f;
}
}

void BernsteinField::Close(double roundings)
{
  double size = 0.0;
  for (const double c : this->C)
  {
    size = std::max(size, std::abs(c));
  }
  this->Magnitude = size;
  this->Error += roundings * Unit * size;
}

Interval BernsteinField::Range(const PlaneBox& local) const
{
  const int p = this->Degree[0];
  const int q = this->Degree[1];
  double c[(MaxFieldDegree + 1) * (MaxFieldDegree + 1)];
  std::copy(this->C.begin(), this->C.end(), c);
  for (int j = 0; j <= q; ++j)
  {
    RestrictLine(p, 1, local[0], c + j * (p + 1));
  }
  for (int i = 0; i <= p; ++i)
  {
    RestrictLine(q, p + 1, local[1], c + i);
  }
  Interval range(c[0]);
  for (std::size_t i = 1; i < this->C.size(); ++i)
  {
    range.Lo = std::min(range.Lo, c[i]);
    range.Hi = std::max(range.Hi, c[i]);
  }
  // a step of the algorithm rounds four times at most, two sweeps of p and q steps
  const double error = this->Noise();
  return { RoundDown(range.Lo - error), RoundUp(range.Hi + error) };
}

double BernsteinField::Evaluate(const RealArray<2>& local) const
{
  double u[MaxFieldDegree + 1];
  double v[MaxFieldDegree + 1];
  BernsteinValues(this->Degree[0], local[0], u);
  BernsteinValues(this->Degree[1], local[1], v);
  double sum = 0.0;
  const double* c = this->C.data();
  for (int j = 0; j <= this->Degree[1]; ++j)
  {
    double row = 0.0;
    for (int i = 0; i <= this->Degree[0]; ++i)
    {
      row += u[i] * *c++;
    }
    sum += v[j] * row;
  }
  return sum;
}

PlaneBox ScalarPiece::Local(const PlaneBox& box) const
{
  const auto local = [](double x, const Interval& side, double slack)
  {
    if (x <= side.Lo)
    {
      return 0.0;
    }
    if (x >= side.Hi)
    {
      return 1.0;
    }
    // the quotient is off by less than 2^-51
    return std::min(std::max((x - side.Lo) / side.Width() + slack, 0.0), 1.0);
  };
  PlaneBox result;
  for (std::size_t d = 0; d < 2; ++d)
  {
    result[d] =
      Interval(local(box[d].Lo, this->Box[d], -0x1p-50), local(box[d].Hi, this->Box[d], 0x1p-50));
  }
  return result;
}

Interval ScalarPieces::ValueRange(int e, const PlaneBox& box) const
{
  const ScalarPiece& piece = (*this)[e];
  const PlaneBox local = piece.Local(box);
  Interval value = piece.Value.Range(local);
  if (this->Rational)
  {
    value = value / piece.Weight.Range(local);
  }
  return value * Interval(this->Scale) + Interval(this->Shift);
}

Result<ScalarPieces> MakeScalarPieces(const Spline<2>& spline, int component, int threads)
{
  ScalarPieces pieces;
  Source source;
  pieces.Rational = spline.IsRational();
  pieces.HasDomain = spline.Space->HasDomain();
  if (!pieces.HasDomain)
  {
    Result<std::vector<PlacedElement>> placed = PlaceElements(*spline.Space);
    if (!placed)
    {
      return placed.Status;
    }
    source.Placed = std::move(placed.Value);
    for (const PlacedElement& element : source.Placed)
    {
      pieces.Axis.push_back(element.Axis);
      pieces.Reversed.push_back(element.Reversed);
    }
  }
  source.Form = MakeBezierForm(Normalized(spline, component, pieces), threads);
  pieces.Pieces.resize(spline.Space->Elements.size());
  ParallelFor(pieces.Pieces.size(), 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        MakePiece(source, static_cast<int>(e), pieces);
      }
    });
  JoinPieces(pieces, threads);
  return pieces;
}
}
