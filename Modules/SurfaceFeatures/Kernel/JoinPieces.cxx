// SPDX-License-Identifier: BSD-3-Clause
#include "ScalarPieces.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>

#include <limits>

namespace knotwork
{
namespace
{
/// A side of a piece on a line of constant parameter.
struct LineSide
{
  double Line = 0.0;
  Interval Along;
  int Element = 0;
};

/// A part of a line with the pieces below and above it; -1: none.
struct LinePart
{
  int Normal = 0;
  int Below = -1;
  int Above = -1;
  Interval Along;
  JoinKind Kind = JoinKind::Boundary;
};

void PairLine(int normal, const LineSide* below, const LineSide* belowEnd, const LineSide* above,
  const LineSide* aboveEnd, std::vector<LinePart>& parts)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double at = -infinity;
  while (below != belowEnd || above != aboveEnd)
  {
    const double b = below == belowEnd ? infinity : std::max(below->Along.Lo, at);
    const double a = above == aboveEnd ? infinity : std::max(above->Along.Lo, at);
    LinePart part;
    part.Normal = normal;
    part.Along.Lo = std::min(a, b);
    part.Along.Hi = std::max(a, b); // what is not paired ends where the other begins
    if (b <= a)
    {
      part.Below = below->Element;
      part.Along.Hi = a == b ? below->Along.Hi : std::min(part.Along.Hi, below->Along.Hi);
    }
    if (a <= b)
    {
      part.Above = above->Element;
      part.Along.Hi = std::min(part.Along.Hi, above->Along.Hi);
    }
    at = part.Along.Hi;
    parts.push_back(part);
    below += below != belowEnd && below->Along.Hi <= at ? 1 : 0;
    above += above != aboveEnd && above->Along.Hi <= at ? 1 : 0;
  }
}

/// Pairs the sides normal to a direction.
void PairSides(const ScalarPieces& pieces, int normal, std::vector<LinePart>& parts)
{
  const auto n = static_cast<std::size_t>(normal);
  std::array<std::vector<LineSide>, 2> sides; // of the pieces below and above
  for (int e = 0; e < pieces.NumPieces(); ++e)
  {
    const PlaneBox& box = pieces[e].Box;
    sides[0].push_back({ box[n].Hi, box[1 - n], e });
    sides[1].push_back({ box[n].Lo, box[1 - n], e });
  }
  for (std::vector<LineSide>& list : sides)
  {
    std::sort(list.begin(), list.end(),
      [](const LineSide& a, const LineSide& b)
      { return a.Line != b.Line ? a.Line < b.Line : a.Along.Lo < b.Along.Lo; });
  }
  const LineSide* at[2] = { sides[0].data(), sides[1].data() };
  const LineSide* end[2] = { at[0] + sides[0].size(), at[1] + sides[1].size() };
  while (at[0] != end[0] || at[1] != end[1])
  {
    double line = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k)
    {
      line = at[k] == end[k] ? line : std::min(line, at[k]->Line);
    }
    const LineSide* next[2] = { at[0], at[1] };
    for (int k = 0; k < 2; ++k)
    {
      while (next[k] != end[k] && next[k]->Line == line)
      {
        ++next[k];
      }
    }
    PairLine(normal, at[0], next[0], at[1], next[1], parts);
    at[0] = next[0];
    at[1] = next[1];
  }
}

/// A field on a part of a side; the error includes that of the part's ends.
BernsteinField OnSide(const ScalarPiece& piece, const BernsteinField& field, int normal, bool upper,
  const Interval& along)
{
  const auto n = static_cast<std::size_t>(normal);
  const int p = field.Degree[0];
  const int size = field.Degree[1 - n];
  BernsteinField line;
  line.Degree = { size, 0 };
  const int first = !upper ? 0 : normal == 0 ? p : (p + 1) * field.Degree[1];
  for (int i = 0; i <= size; ++i)
  {
    line.C.push_back(field.C[static_cast<std::size_t>(first + i * (normal == 0 ? p + 1 : 1))]);
  }
  const Interval& side = piece.Box[1 - n];
  const double low = along.Lo <= side.Lo ? 0.0 : (along.Lo - side.Lo) / side.Width();
  const double high = along.Hi >= side.Hi ? 1.0 : (along.Hi - side.Lo) / side.Width();
  if (low > 0.0 || high < 1.0)
  {
    line.C = BernsteinRestrict<1>({ size }, line.C, 0, low, high);
  }
  line.Error = field.Error;
  line.Magnitude = field.Magnitude;
  // de Casteljau's steps, and a slope of at most 2 size times the error of the ends
  line.Error += (8.0 * size * 0x1p-53 + 2.0 * size * 0x1p-50) * field.Magnitude;
  return line;
}

bool Agree(const BernsteinField& a, const BernsteinField& b)
{
  const int degree = std::max(a.Degree[0], b.Degree[0]);
  const std::vector<double> x = BernsteinElevate<1>({ a.Degree[0] }, a.C, { degree });
  const std::vector<double> y = BernsteinElevate<1>({ b.Degree[0] }, b.C, { degree });
  const double tolerance = a.Error + b.Error + 8.0 * degree * 0x1p-53 * (a.Magnitude + b.Magnitude);
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    if (!(std::abs(x[i] - y[i]) <= tolerance))
    {
      return false;
    }
  }
  return true;
}

JoinKind Compare(const ScalarPieces& pieces, const LinePart& part)
{
  const ScalarPiece& below = pieces[part.Below];
  const ScalarPiece& above = pieces[part.Above];
  const auto agree = [&](const BernsteinField& a, const BernsteinField& b)
  {
    return Agree(OnSide(below, a, part.Normal, true, part.Along),
      OnSide(above, b, part.Normal, false, part.Along));
  };
  if (!agree(below.Value, above.Value) || (pieces.Rational && !agree(below.Weight, above.Weight)))
  {
    return JoinKind::Boundary;
  }
  const auto n = static_cast<std::size_t>(part.Normal);
  return agree(below.Gradient[n], above.Gradient[n]) ? JoinKind::Smooth : JoinKind::Crease;
}
}

void JoinPieces(ScalarPieces& pieces, int threads)
{
  std::vector<LinePart> parts;
  PairSides(pieces, 0, parts);
  PairSides(pieces, 1, parts);
  ParallelFor(parts.size(), 128, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (parts[i].Below >= 0 && parts[i].Above >= 0)
        {
          parts[i].Kind = Compare(pieces, parts[i]);
        }
      }
    });
  struct Entry
  {
    int Element;
    PieceJoin Join;
  };
  std::vector<Entry> entries;
  for (const LinePart& part : parts)
  {
    const bool joined = part.Kind != JoinKind::Boundary;
    if (part.Below >= 0)
    {
      entries.push_back(
        { part.Below, { 2 * part.Normal + 1, joined ? part.Above : -1, part.Kind, part.Along } });
    }
    if (part.Above >= 0)
    {
      entries.push_back(
        { part.Above, { 2 * part.Normal, joined ? part.Below : -1, part.Kind, part.Along } });
    }
  }
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b)
    {
      if (a.Element != b.Element)
      {
        return a.Element < b.Element;
      }
      return a.Join.Side != b.Join.Side ? a.Join.Side < b.Join.Side
                                        : a.Join.Along.Lo < b.Join.Along.Lo;
    });
  pieces.JoinStart.assign(static_cast<std::size_t>(pieces.NumPieces()) + 1, 0);
  pieces.Joins.clear();
  for (const Entry& entry : entries)
  {
    ++pieces.JoinStart[static_cast<std::size_t>(entry.Element) + 1];
    pieces.Joins.push_back(entry.Join);
  }
  for (std::size_t e = 1; e < pieces.JoinStart.size(); ++e)
  {
    pieces.JoinStart[e] += pieces.JoinStart[e - 1];
  }
}
}
