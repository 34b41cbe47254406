// SPDX-License-Identifier: BSD-3-Clause
#include "UniquenessBox.h"

#include <knotwork/SplineCore/PatchSides.h>

namespace knotwork
{
namespace
{
constexpr std::size_t MaxPieces = 64;

RealArray<2> LocalPoint(const ScalarPiece& piece, const RealArray<2>& z)
{
  return { (z[0] - piece.Box[0].Lo) / piece.Box[0].Width(),
    (z[1] - piece.Box[1].Lo) / piece.Box[1].Width() };
}

/// The piece that holds a point, from another one on across smooth sides; -1: there is none near.
int PieceAt(const ScalarPieces& pieces, int from, const RealArray<2>& z)
{
  int at = from;
  for (int step = 0; step < 8; ++step)
  {
    const PlaneBox& box = pieces[at].Box;
    int side = -1;
    for (int d = 0; d < 2; ++d)
    {
      const auto k = static_cast<std::size_t>(d);
      side = z[k] < box[k].Lo ? 2 * d : z[k] > box[k].Hi ? 2 * d + 1 : side;
    }
    if (side < 0)
    {
      return at;
    }
    const std::size_t along = SideDirections<2>(side)[0];
    const double x = std::min(std::max(z[along], box[along].Lo), box[along].Hi);
    int next = -1;
    for (const PieceJoin* join = pieces.BeginJoins(at); join != pieces.EndJoins(at); ++join)
    {
      if (join->Side == side && join->Kind == JoinKind::Smooth && join->Along.Lo <= x &&
        x <= join->Along.Hi)
      {
        next = join->Neighbor;
      }
    }
    if (next < 0)
    {
      return -1;
    }
    at = next;
  }
  return -1;
}

/// Pieces that a box around z meets; the box is cut to where it is smooth. False: z is cut off.
bool GatherPieces(const ScalarPieces& pieces, int home, const RealArray<2>& z, PlaneBox& box,
  std::vector<int>& elements)
{
  bool cut = true;
  while (cut)
  {
    cut = false;
    elements.assign(1, home);
    for (std::size_t i = 0; i < elements.size() && !cut; ++i)
    {
      const int e = elements[i];
      for (const PieceJoin* join = pieces.BeginJoins(e); join != pieces.EndJoins(e); ++join)
      {
        const auto d = static_cast<std::size_t>(join->Side / 2);
        const bool upper = join->Side % 2 == 1;
        const double line = upper ? pieces[e].Box[d].Hi : pieces[e].Box[d].Lo;
        const bool crosses = (upper ? box[d].Hi > line : box[d].Lo < line) &&
          join->Along.Lo < box[1 - d].Hi && join->Along.Hi > box[1 - d].Lo;
        if (!crosses)
        {
          continue;
        }
        if (join->Kind == JoinKind::Smooth)
        {
          if (std::find(elements.begin(), elements.end(), join->Neighbor) == elements.end())
          {
            elements.push_back(join->Neighbor);
          }
          continue;
        }
        (upper ? box[d].Hi : box[d].Lo) = line;
        cut = true;
        break;
      }
    }
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (!(box[d].Lo < z[d] && z[d] < box[d].Hi))
      {
        return false;
      }
    }
    if (elements.size() > MaxPieces)
    {
      return false;
    }
  }
  return true;
}

Interval GradientAt(const ScalarPieces& pieces, int home, const RealArray<2>& z, std::size_t d)
{
  const ScalarPiece& piece = pieces[home];
  return piece.Gradient[d].Range(piece.Local({ Interval(z[0]), Interval(z[1]) }));
}

/// Proves the zero in a box that is as small as rounding allows.
void ShrinkTo(const ScalarPieces& pieces, int home, const RealArray<2>& z,
  const std::vector<int>& elements, PlaneBox& enclosure)
{
  for (double share = 0x1p-46; share < 0x1p-10; share *= 16.0)
  {
    PlaneBox box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double radius = share * std::max(pieces[home].Box[d].Width(), 0x1p-4 * std::abs(z[d]));
      box[d] = Interval(z[d] - radius, z[d] + radius);
      if (!enclosure[d].Holds(box[d]))
      {
        return;
      }
    }
    const KrawczykStep step = Krawczyk(pieces, home, z, box, BoundHessian(pieces, elements, box));
    if (step.Valid && box[0].HoldsInside(step.K[0]) && box[1].HoldsInside(step.K[1]))
    {
      enclosure = step.K;
      return;
    }
  }
}

/// Makes the enclosure of the point smaller.
void Tighten(const ScalarPieces& pieces, const std::vector<int>& elements, PlaneBox& x)
{
  for (int step = 0; step < 30; ++step)
  {
    const RealArray<2> z{ x[0].Middle(), x[1].Middle() };
    const auto home =
      std::find_if(elements.begin(), elements.end(), [&](int e) { return pieces[e].Holds(z); });
    if (home == elements.end())
    {
      return;
    }
    const KrawczykStep next = Krawczyk(pieces, *home, z, x, BoundHessian(pieces, elements, x));
    if (!next.Valid || !Meet(next.K, x))
    {
      return;
    }
    bool smaller = false;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double width = x[d].Width();
      x[d].Lo = std::max(x[d].Lo, next.K[d].Lo);
      x[d].Hi = std::min(x[d].Hi, next.K[d].Hi);
      smaller = smaller || x[d].Width() < 0.9 * width;
    }
    if (!smaller)
    {
      return;
    }
  }
}

void SetEigenvalues(const ScalarPieces& pieces, FoundPoint& point)
{
  const ScalarPiece& piece = pieces[point.Element];
  const RealArray<2> local =
    LocalPoint(piece, { point.Enclosure[0].Middle(), point.Enclosure[1].Middle() });
  const double w = pieces.Rational ? piece.Weight.Evaluate(local) : 1.0;
  const double a = piece.Jacobian[0][0].Evaluate(local) / (w * w);
  const double b = piece.Jacobian[0][1].Evaluate(local) / (w * w);
  const double c = piece.Jacobian[1][1].Evaluate(local) / (w * w);
  const double middle = 0.5 * (a + c);
  const double radius = std::hypot(0.5 * (a - c), b);
  point.Eigenvalues = { middle - radius, middle + radius };
}
}

IntervalMatrix BoundHessian(
  const ScalarPieces& pieces, const std::vector<int>& elements, const PlaneBox& box)
{
  IntervalMatrix hull;
  bool first = true;
  for (const int e : elements)
  {
    const ScalarPiece& piece = pieces[e];
    if (!Meet(piece.Box, box))
    {
      continue;
    }
    const PlaneBox local = piece.Local(box);
    for (std::size_t d = 0; d < 2; ++d)
    {
      for (std::size_t k = 0; k < 2; ++k)
      {
        // the mixed derivatives of a polynomial piece are the same
        const bool same = d == 1 && k == 0 && !pieces.Rational;
        const Interval range = same ? hull[1] : piece.Jacobian[d][k].Range(local);
        Interval& entry = hull[2 * d + k];
        if (first)
        {
          entry = range;
        }
        entry.Merge(range);
      }
    }
    first = false;
  }
  return hull;
}

Interval Determinant(const IntervalMatrix& m)
{
  return m[0] * m[3] - m[1] * m[2];
}

KrawczykStep Krawczyk(const ScalarPieces& pieces, int home, const RealArray<2>& z,
  const PlaneBox& box, const IntervalMatrix& hessian)
{
  KrawczykStep step;
  IntervalMatrix middle;
  for (std::size_t i = 0; i < 4; ++i)
  {
    middle[i] = Interval(hessian[i].Middle());
  }
  step.Sign = Determinant(middle).Sign();
  const double det = middle[0].Lo * middle[3].Lo - middle[1].Lo * middle[2].Lo;
  const double y[4] = { middle[3].Lo / det, -middle[1].Lo / det, -middle[2].Lo / det,
    middle[0].Lo / det };
  if (step.Sign == 0 || !std::isfinite(y[0] + y[1] + y[2] + y[3]))
  {
    return step;
  }
  const std::array<Interval, 2> f{ GradientAt(pieces, home, z, 0), GradientAt(pieces, home, z, 1) };
  step.Valid = true;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const Interval a(y[2 * d]);
    const Interval b(y[2 * d + 1]);
    Interval k = Interval(z[d]) - (a * f[0] + b * f[1]);
    for (std::size_t j = 0; j < 2; ++j)
    {
      const Interval entry = Interval(d == j ? 1.0 : 0.0) - (a * hessian[j] + b * hessian[2 + j]);
      k = k + entry * (box[j] - Interval(z[j]));
    }
    step.K[d] = k;
  }
  return step;
}

bool ProveUniqueness(const ScalarPieces& pieces, int home, const RealArray<2>& z, PlaneBox box,
  bool reach, FoundPoint& point)
{
  std::vector<int> elements{ home };
  if (!reach)
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      box[d].Lo = std::max(box[d].Lo, pieces[home].Box[d].Lo);
      box[d].Hi = std::min(box[d].Hi, pieces[home].Box[d].Hi);
    }
  }
  else if (!GatherPieces(pieces, home, z, box, elements))
  {
    return false;
  }
  const KrawczykStep step = Krawczyk(pieces, home, z, box, BoundHessian(pieces, elements, box));
  if (!step.Valid || !box[0].HoldsInside(step.K[0]) || !box[1].HoldsInside(step.K[1]))
  {
    return false;
  }
  point.Reach = box;
  point.Enclosure = step.K;
  ShrinkTo(pieces, home, z, elements, point.Enclosure);
  Tighten(pieces, elements, point.Enclosure);
  point.Index = step.Sign;
  if (step.Sign < 0)
  {
    point.Kind = CriticalKind::Saddle;
  }
  else
  {
    // at the zero the matrix is symmetric with a positive determinant: definite
    const int sign = BoundHessian(pieces, elements, point.Enclosure)[0].Sign();
    if (sign == 0)
    {
      return false;
    }
    point.Kind = sign > 0 ? CriticalKind::Minimum : CriticalKind::Maximum;
  }
  point.Box = OffLines(pieces, elements, box, point.Enclosure);
  point.Element = -1;
  const RealArray<2> middle{ point.Enclosure[0].Middle(), point.Enclosure[1].Middle() };
  bool first = true;
  for (const int e : elements)
  {
    const PlaneBox& piece = pieces[e].Box;
    if (!Meet(piece, point.Enclosure))
    {
      continue;
    }
    const Interval value = pieces.ValueRange(e, point.Enclosure);
    point.Value = first ? value : point.Value;
    point.Value.Merge(value);
    first = false;
    if (pieces[e].Holds(middle) && (point.Element < 0 || e < point.Element))
    {
      point.Element = e;
      point.Place =
        piece[0].HoldsInside(point.Enclosure[0]) && piece[1].HoldsInside(point.Enclosure[1])
        ? CriticalPlace::Interior
        : CriticalPlace::Edge;
    }
  }
  if (point.Element < 0)
  {
    return false;
  }
  SetEigenvalues(pieces, point);
  return true;
}

bool FindZero(const ScalarPieces& pieces, const RealArray<2>& limit, RealArray<2>& z, int& home)
{
  const RealArray<2> start = z;
  int at = home;
  for (int step = 0; step < 24; ++step)
  {
    const ScalarPiece& piece = pieces[at];
    const RealArray<2> local = LocalPoint(piece, z);
    for (const double t : local)
    {
      if (!(t >= -1.0 && t <= 2.0))
      {
        return false;
      }
    }
    const double f = piece.Gradient[0].Evaluate(local);
    const double g = piece.Gradient[1].Evaluate(local);
    const double a = piece.Jacobian[0][0].Evaluate(local);
    const double b = piece.Jacobian[0][1].Evaluate(local);
    const double c = piece.Jacobian[1][0].Evaluate(local);
    const double d = piece.Jacobian[1][1].Evaluate(local);
    const double det = a * d - b * c;
    const RealArray<2> move{ (d * f - b * g) / det, (a * g - c * f) / det };
    bool small = true;
    for (std::size_t k = 0; k < 2; ++k)
    {
      z[k] -= move[k];
      if (!(std::abs(z[k] - start[k]) <= limit[k]))
      {
        return false;
      }
      small = small && std::abs(move[k]) <= 0x1p-48 * piece.Box[k].Width();
    }
    const int next = PieceAt(pieces, at, z);
    if (small || step == 23)
    {
      home = next;
      return next >= 0;
    }
    at = next < 0 ? at : next;
  }
  return false;
}
}
