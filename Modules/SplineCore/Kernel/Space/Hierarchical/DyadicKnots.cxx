// SPDX-License-Identifier: BSD-3-Clause
#include "DyadicKnots.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}
}

DyadicKnots::Position DyadicKnots::Locate(int level, std::int64_t knot) const
{
  const auto& t = this->Base->Knots();
  const int elements = this->Base->NumElements();
  Position position;
  if (knot <= this->Base->Span(0))
  {
    if (t[At(knot)] < this->Base->Begin())
    {
      position.Outer = static_cast<int>(knot);
    }
    return position;
  }
  // First knot equal to the domain's end.
  const std::int64_t end = this->LastKnot(level, elements - 1) + (std::int64_t(1) << level);
  if (knot >= end)
  {
    position.Element = elements;
    const std::int64_t base = knot - this->NumCells(level) + elements;
    if (t[At(base)] > this->Base->End())
    {
      position.Outer = static_cast<int>(base);
    }
    return position;
  }
  int first = 0, last = elements; // LastKnot(first) <= knot < LastKnot(last)
  while (last - first > 1)
  {
    const int middle = (first + last) / 2;
    (this->LastKnot(level, middle) <= knot ? first : last) = middle;
  }
  position.Element = first;
  position.Fraction = knot - this->LastKnot(level, first);
  if (position.Fraction >= std::int64_t(1) << level) // a repeated knot before the last of its kind
  {
    ++position.Element;
    position.Fraction = 0;
  }
  return position;
}

double DyadicKnots::Value(int level, const Position& position) const
{
  if (position.Outer >= 0)
  {
    return this->Base->Knots()[At(position.Outer)];
  }
  const auto& breaks = this->Base->Breaks();
  const double lower = breaks[At(position.Element)];
  if (position.Fraction == 0)
  {
    return lower;
  }
  const double length = breaks[At(position.Element) + 1] - lower;
  const double parts = static_cast<double>(std::int64_t(1) << level); // exact, as is the quotient
  return lower + length * (static_cast<double>(position.Fraction) / parts);
}

double DyadicKnots::Offset(int level, std::int64_t cell, const Position& position) const
{
  const auto& breaks = this->Base->Breaks();
  const std::size_t origin = At(cell >> level);
  const double parts = static_cast<double>(std::int64_t(1) << level);
  const double fraction = static_cast<double>(cell & ((std::int64_t(1) << level) - 1));
  const double lower = breaks[origin], upper = breaks[origin + 1], length = upper - lower;
  if (position.Outer >= 0)
  {
    const double knot = this->Base->Knots()[At(position.Outer)];
    return knot < lower ? -fraction - (lower - knot) / length * parts
                        : parts - fraction + (knot - upper) / length * parts;
  }
  const std::size_t e = At(position.Element);
  const double f = static_cast<double>(position.Fraction);
  if (e == origin)
  {
    return f - fraction;
  }
  if (e > origin)
  {
    const double inside = position.Fraction > 0 ? f * (breaks[e + 1] - breaks[e]) : 0.0;
    return parts - fraction + ((breaks[e] - upper) * parts + inside) / length;
  }
  const double inside = (parts - f) * (breaks[e + 1] - breaks[e]);
  return -fraction - ((lower - breaks[e + 1]) * parts + inside) / length;
}

DyadicKnots::CellRange DyadicKnots::Support(int level, std::int64_t function) const
{
  const Position begin = this->Locate(level, function);
  const Position end = this->Locate(level, function + this->Degree() + 1);
  // A knot left of the domain has Element = Fraction = 0, one right of it Element = NumElements.
  const auto cell = [level](const Position& q)
  { return (static_cast<std::int64_t>(q.Element) << level) + q.Fraction; };
  return { cell(begin), cell(end) - 1 };
}

double DyadicKnots::Break(int level, std::int64_t cell) const
{
  Position position;
  position.Element = static_cast<int>(cell >> level);
  position.Fraction = cell & ((std::int64_t(1) << level) - 1);
  return this->Value(level, position);
}

double DyadicKnots::Greville(int level, std::int64_t function) const
{
  const int p = this->Degree();
  double sum = 0.0;
  for (int k = 1; k <= p; ++k)
  {
    sum += this->Value(level, this->Locate(level, function + k));
  }
  return sum / p;
}

int DyadicKnots::ExtractionClass(int level, std::int64_t cell) const
{
  const std::int64_t p = this->Degree(), parts = std::int64_t(1) << level;
  const std::int64_t fraction = cell & (parts - 1);
  if (parts <= 2 * p || fraction < p)
  {
    return static_cast<int>(fraction);
  }
  // The p cells at the right end are p + 1 ... 2p; between both ends all knots are uniform.
  return static_cast<int>(std::max(p, 2 * p + 1 - (parts - fraction)));
}

void DyadicKnots::Extraction(int level, std::int64_t cell, double* matrix) const
{
  const int p = this->Degree();
  const std::int64_t first = this->FirstFunction(level, cell) + 1;
  double knots[2 * MaxDegree];
  for (int k = 0; k < 2 * p; ++k)
  {
    knots[k] = this->Offset(level, cell, this->Locate(level, first + k));
  }
  ExtractionFromLocalKnots(p, knots, matrix);
}

DyadicKnots::TwoScaleRow DyadicKnots::Parents(int level, std::int64_t child) const
{
  const int p = this->Degree();
  const Position begin = this->Locate(level, child);
  // All distances in cells of the child's level from the first cell of its support.
  const std::int64_t cell = (static_cast<std::int64_t>(begin.Element) << level) + begin.Fraction;

  // Last coarse knot not above the child's first knot.
  std::int64_t span = 0;
  if (begin.Outer >= 0)
  {
    const auto& t = this->Base->Knots();
    span = begin.Outer;
    while (t[At(span) + 1] == t[At(span)])
    {
      ++span;
    }
  }
  else
  {
    span = this->LastKnot(level - 1, begin.Element) + (begin.Fraction >> 1);
  }

  // coarse[k] is knot span - p + k of the coarser level; those before knot 0 are never used.
  double coarse[2 * MaxDegree + 1] = {};
  const std::int64_t origin = span - p;
  const int valid = static_cast<int>(std::max<std::int64_t>(0, -origin));
  for (int k = valid; k <= 2 * p; ++k)
  {
    Position position = this->Locate(level - 1, origin + k);
    position.Fraction *= 2;
    coarse[k] = this->Offset(level, cell, position);
  }
  double row[MaxDegree + 2] = {}; // row[k] belongs to coarse function span - p + k
  row[p] = 1.0;
  for (int k = 1; k <= p; ++k)
  {
    const double x = this->Offset(level, cell, this->Locate(level, child + k));
    for (int i = std::max(p - k, valid); i <= p; ++i)
    {
      double value = 0.0;
      if (i > p - k)
      {
        value += (x - coarse[i]) / (coarse[i + k] - coarse[i]) * row[i];
      }
      if (i < p)
      {
        value += (coarse[i + 1 + k] - x) / (coarse[i + 1 + k] - coarse[i + 1]) * row[i + 1];
      }
      row[i] = value;
    }
  }
  int first = valid, last = p;
  while (first < last && row[first] == 0.0)
  {
    ++first;
  }
  while (last > first && row[last] == 0.0)
  {
    --last;
  }
  TwoScaleRow result;
  result.First = origin + first;
  result.Count = last - first + 1;
  std::copy(row + first, row + last + 1, result.Weight);
  return result;
}
}
