// SPDX-License-Identifier: BSD-3-Clause
#include "ContourRoots.h"

#include "SignRoots.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t Chunk = 256;

/// Values and weights along a piece, as its first element has them.
struct PieceValues
{
  int Degree = 0;
  double Value[MaxDegree + 1];
  double Weight[MaxDegree + 1];
};

PieceValues ValuesOn(const BezierForm<2>& form, int component, const SidePiece& piece)
{
  PieceValues result;
  const int e = piece.Element[0];
  const int side = piece.Side[0];
  const IntArray<2> degree = form.Space->Elements[static_cast<std::size_t>(e)].Degree;
  const int size = NumTensorFunctions<2>(degree);
  result.Degree = degree[SideDirections<2>(side)[0]];
  for (int k = 0; k <= result.Degree; ++k)
  {
    const int place = SideCoefficient(degree, side, k);
    result.Value[k] = form.Block(e)[component * size + place];
    result.Weight[k] = form.Rational ? form.Block(e)[form.NumComponents * size + place] : 1.0;
  }
  if (piece.Begin[0] != 0.0 || piece.End[0] != 1.0)
  {
    double factor[(MaxDegree + 1) * (MaxDegree + 1)];
    BernsteinRestriction(result.Degree, piece.Begin[0], piece.End[0], factor);
    ApplyFactors<1>({ result.Degree }, { factor }, result.Value, result.Value);
    if (form.Rational)
    {
      ApplyFactors<1>({ result.Degree }, { factor }, result.Weight, result.Weight);
    }
  }
  return result;
}

double ValueAt(const BezierForm<2>& form, int component, const SideVertex& vertex)
{
  const IntArray<2> degree = form.Space->Elements[static_cast<std::size_t>(vertex.Element)].Degree;
  const int size = NumTensorFunctions<2>(degree);
  const double* block = form.Block(vertex.Element);
  const double value = BernsteinEvaluate<2>(degree, block + component * size, vertex.Local.data());
  return form.Rational
    ? value / BernsteinEvaluate<2>(degree, block + form.NumComponents * size, vertex.Local.data())
    : value;
}
}

std::array<double, 2> CoefficientRange(std::size_t n, const double* values, const double* weights)
{
  std::array<double, 2> range{ HUGE_VAL, -HUGE_VAL };
  for (std::size_t k = 0; k < n; ++k)
  {
    const double ratio = weights ? values[k] / weights[k] : values[k];
    range = { std::min(range[0], ratio), std::max(range[1], ratio) };
  }
  return range;
}

SideRoots FindSideRoots(const BezierForm<2>& form, int component, const ElementSides& sides,
  const std::vector<ShiftedLevel>& levels, int threads)
{
  SideRoots result;
  result.VertexValues.resize(sides.Vertices.size());
  ParallelFor(sides.Vertices.size(), 4 * Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        result.VertexValues[v] = ValueAt(form, component, sides.Vertices[v]);
      }
    });

  struct Found
  {
    std::vector<int> Levels;
    std::vector<double> Places;
  };
  const std::size_t n = sides.Pieces.size();
  std::vector<Found> found((n + Chunk - 1) / Chunk);
  result.Start.assign(n + 1, 0);
  ParallelFor(n, Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Found& mine = found[begin / Chunk];
      for (std::size_t p = begin; p < end; ++p)
      {
        const SidePiece& piece = sides.Pieces[p];
        const PieceValues on = ValuesOn(form, component, piece);
        std::array<double, 2> range =
          CoefficientRange(static_cast<std::size_t>(on.Degree + 1), on.Value, on.Weight);
        std::array<double, 2> ends;
        for (std::size_t k = 0; k < 2; ++k)
        {
          ends[k] = result.VertexValues[static_cast<std::size_t>(piece.Vertex[k])];
          range = { std::min(range[0], ends[k]), std::max(range[1], ends[k]) };
        }
        for (std::size_t l = 0; l < levels.size(); ++l)
        {
          const double level = levels[l].Value;
          if (range[0] >= level || range[1] < level)
          {
            continue;
          }
          double g[MaxDegree + 1];
          for (int k = 0; k <= on.Degree; ++k)
          {
            g[k] = on.Value[k] - level * on.Weight[k];
          }
          SetEndSigns(on.Degree, g, ends[0] >= level, ends[1] >= level);
          FindSignChanges(on.Degree, g, mine.Places);
          mine.Levels.resize(mine.Places.size(), static_cast<int>(l));
        }
        result.Start[p + 1] = mine.Places.size(); // of the chunk so far
      }
    });
  for (std::size_t c = 0; c < found.size(); ++c)
  {
    const std::size_t before = result.Places.size();
    for (std::size_t p = c * Chunk; p < std::min(n, (c + 1) * Chunk); ++p)
    {
      result.Start[p + 1] += before;
    }
    result.Places.insert(result.Places.end(), found[c].Places.begin(), found[c].Places.end());
    result.Levels.insert(result.Levels.end(), found[c].Levels.begin(), found[c].Levels.end());
  }
  return result;
}

void SideRoots::Collect(const ElementSides& sides, int element, int side, int level, double value,
  BorderSide& border) const
{
  border.Roots.clear();
  const int vertex = sides.Corners[static_cast<std::size_t>(4 * element + PatchCorner<2>(side, 0))];
  border.Positive = this->VertexValues[static_cast<std::size_t>(vertex)] >= value;
  const std::size_t list = static_cast<std::size_t>(NumSides * element + side);
  double previous = 0.0;
  for (std::size_t n = sides.Start[list]; n < sides.Start[list + 1]; ++n)
  {
    const std::size_t p = static_cast<std::size_t>(sides.PieceIds[n]);
    const auto first = this->Levels.begin() + static_cast<std::ptrdiff_t>(this->Start[p]);
    const auto last = this->Levels.begin() + static_cast<std::ptrdiff_t>(this->Start[p + 1]);
    const auto range = std::equal_range(first, last, level);
    const std::size_t begin = static_cast<std::size_t>(range.first - this->Levels.begin());
    const std::size_t end = static_cast<std::size_t>(range.second - this->Levels.begin());
    if (begin == end)
    {
      continue;
    }
    const SidePiece& piece = sides.Pieces[p];
    const std::size_t role =
      static_cast<std::size_t>(sides.Role(static_cast<int>(p), element, side));
    const bool reversed = piece.End[role] < piece.Begin[role];
    for (std::size_t i = begin; i < end; ++i)
    {
      const std::size_t root = reversed ? begin + end - 1 - i : i;
      const double place =
        piece.Begin[role] + this->Places[root] * (piece.End[role] - piece.Begin[role]);
      previous = std::clamp(place, previous, 1.0 - 0x1p-53);
      border.Roots.push_back({ previous, static_cast<int>(root) });
    }
  }
}
}
