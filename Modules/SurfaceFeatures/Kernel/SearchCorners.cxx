// SPDX-License-Identifier: BSD-3-Clause
#include "CriticalSearch.h"

#include <limits>

namespace knotwork
{
namespace
{
/// Quadrants around a corner are numbered counterclockwise from the upper right one. Ray i lies
/// between quadrants i and i + 1: up, left, down, right.
constexpr std::array<std::array<int, 2>, 4> QuadrantSigns{ { { 1, 1 }, { -1, 1 }, { -1, -1 },
  { 1, -1 } } };
/// Parameter and direction of ray i.
constexpr std::array<std::size_t, 4> RayDirection{ 1, 0, 1, 0 };
constexpr std::array<int, 4> RaySign{ 1, -1, -1, 1 };
/// Side of quadrant i's element that ray i runs along.
constexpr std::array<int, 4> RaySide{ 0, 2, 1, 3 };

struct CornerEntry
{
  RealArray<2> At;
  int Element;
  friend bool operator<(const CornerEntry& a, const CornerEntry& b)
  {
    return a.At != b.At ? a.At < b.At : a.Element < b.Element;
  }
  friend bool operator==(const CornerEntry& a, const CornerEntry& b)
  {
    return a.At == b.At && a.Element == b.Element;
  }
};

class Corner
{
public:
  Corner(const ScalarPieces& pieces, const CornerEntry* begin, const CornerEntry* end)
    : Pieces(pieces), At(begin->At)
  {
    this->Elements.fill(-1);
    for (const CornerEntry* entry = begin; entry != end; ++entry)
    {
      const PlaneBox& box = pieces[entry->Element].Box;
      for (std::size_t q = 0; q < 4; ++q)
      {
        bool covers = true;
        for (std::size_t d = 0; d < 2; ++d)
        {
          covers = covers &&
            (QuadrantSigns[q][d] > 0 ? box[d].Lo <= this->At[d] && this->At[d] < box[d].Hi
                                     : box[d].Lo < this->At[d] && this->At[d] <= box[d].Hi);
        }
        this->Elements[q] = covers ? entry->Element : this->Elements[q];
      }
    }
    for (std::size_t i = 0; i < 4; ++i)
    {
      this->Rays[i] = this->RayKind(i);
    }
  }

  /// Inside the domain, with f continuous all around.
  bool IsInside() const
  {
    return std::all_of(this->Rays.begin(), this->Rays.end(),
      [](JoinKind kind) { return kind != JoinKind::Boundary; });
  }

  /// f may have kinks in both directions, or a slit ends here.
  bool IsCandidate() const
  {
    if (std::count(this->Rays.begin(), this->Rays.end(), JoinKind::Boundary) == 1)
    {
      return true;
    }
    return (this->IsRough(0) || this->IsRough(2)) && (this->IsRough(1) || this->IsRough(3));
  }

  void Search(bool boundary, FoundPoints& result) const
  {
    if (this->IsInside())
    {
      this->SearchArc(0, 4, true, result);
      return;
    }
    if (!boundary)
    {
      return;
    }
    for (std::size_t first = 0; first < 4; ++first)
    {
      if (this->Elements[first] < 0 || this->Rays[(first + 3) % 4] != JoinKind::Boundary)
      {
        continue;
      }
      std::size_t count = 1;
      while (count < 4 && this->Rays[(first + count - 1) % 4] != JoinKind::Boundary)
      {
        ++count;
      }
      this->SearchArc(first, count, false, result);
    }
  }

private:
  JoinKind RayKind(std::size_t i) const
  {
    const int e = this->Elements[i];
    const int next = this->Elements[(i + 1) % 4];
    if (e < 0 || next < 0)
    {
      return JoinKind::Boundary;
    }
    if (e == next)
    {
      return JoinKind::Smooth;
    }
    const double x = this->At[RayDirection[i]];
    for (const PieceJoin* j = this->Pieces.BeginJoins(e); j != this->Pieces.EndJoins(e); ++j)
    {
      if (j->Side == RaySide[i] && j->Neighbor == next &&
        (RaySign[i] > 0 ? j->Along.Lo : j->Along.Hi) == x)
      {
        return j->Kind;
      }
    }
    return JoinKind::Boundary;
  }

  bool IsRough(std::size_t i) const
  {
    const bool exists = this->Elements[i] >= 0 || this->Elements[(i + 1) % 4] >= 0;
    return exists && this->Rays[i] != JoinKind::Smooth;
  }

  /// The box of quadrant q with the given extents.
  PlaneBox BoxOf(std::size_t q, const RealArray<2>& extent) const
  {
    PlaneBox box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      box[d] = QuadrantSigns[q][d] > 0 ? Interval(this->At[d], this->At[d] + extent[d])
                                       : Interval(this->At[d] - extent[d], this->At[d]);
    }
    return box;
  }

  /// Sign of the derivative in quadrant q along direction d, away from the corner.
  int Grows(std::size_t q, std::size_t d, const RealArray<2>& extent) const
  {
    const ScalarPiece& piece = this->Pieces[this->Elements[q]];
    return piece.Gradient[d].Range(piece.Local(this->BoxOf(q, extent))).Sign() *
      QuadrantSigns[q][d];
  }

  /// A derivative has one sign in all quadrants, so zero is in no hull of gradients.
  bool IsMonotone(std::size_t first, std::size_t count, std::size_t d) const
  {
    int sign = 0;
    for (std::size_t k = 0; k < count; ++k)
    {
      const std::size_t q = (first + k) % 4;
      const int here = this->Grows(q, d, {}) * QuadrantSigns[q][d];
      if (here == 0 || (sign != 0 && here != sign))
      {
        return false;
      }
      sign = here;
    }
    return true;
  }

  void SearchArc(std::size_t first, std::size_t count, bool circle, FoundPoints& result) const
  {
    ++result.NumTested;
    if (circle && (this->IsMonotone(0, 4, 0) || this->IsMonotone(0, 4, 1)))
    {
      return;
    }
    // along a straight boundary
    if (!circle && count == 2 && this->IsMonotone(first, 2, RayDirection[(first + 3) % 4]))
    {
      return;
    }
    // signs along the rays from the first one on; that of a circle is met again at its end
    std::vector<int> signs;
    bool known = true;
    for (std::size_t k = 0; k <= count; ++k)
    {
      const std::size_t ray = (first + k + 3) % 4;
      int sign = k < count ? this->Grows((first + k) % 4, RayDirection[ray], {}) : 0;
      if (sign == 0 && k > 0)
      {
        sign = this->Grows((first + k - 1) % 4, RayDirection[ray], {});
      }
      signs.push_back(sign);
      known = known && sign != 0;
    }
    FoundPoint point;
    if (!known || !this->MakeBox(first, count, point.Box))
    {
      result.Undecided.push_back(
        { this->Elements[first], { Interval(this->At[0]), Interval(this->At[1]) }, Layer::Corner });
      return;
    }
    int changes = 0;
    int lowerRuns = signs.front() < 0 ? 1 : 0;
    for (std::size_t k = 1; k < signs.size(); ++k)
    {
      changes += signs[k] != signs[k - 1] ? 1 : 0;
      lowerRuns += signs[k] < 0 && signs[k - 1] > 0 ? 1 : 0;
    }
    if (changes == (circle ? 2 : 1))
    {
      return;
    }
    if (circle && changes > 0 && signs.front() < 0)
    {
      --lowerRuns; // the first run was met again
    }
    point.Kind = changes > 0 ? CriticalKind::Saddle
      : signs.front() > 0    ? CriticalKind::Minimum
                             : CriticalKind::Maximum;
    point.Index = changes == 0 && signs.front() < 0 ? (circle ? 1 : 0) : 1 - lowerRuns;
    point.Place = circle ? CriticalPlace::Crease
      : count == 2       ? CriticalPlace::Boundary
                         : CriticalPlace::Corner;
    point.InwardSign = circle ? 0 : count == 2 ? signs[1] : changes == 0 ? signs.front() : 0;
    point.Element = this->Elements[first];
    for (std::size_t k = 0; k < count; ++k)
    {
      point.Element = std::min(point.Element, this->Elements[(first + k) % 4]);
    }
    point.Enclosure = { Interval(this->At[0]), Interval(this->At[1]) };
    point.Value = this->Pieces.ValueRange(point.Element, point.Enclosure);
    point.Reach = point.Box;
    point.Layer = Layer::Corner;
    result.Points.push_back(point);
  }

  /// A box around the corner where both derivatives keep their signs in all quadrants.
  bool MakeBox(std::size_t first, std::size_t count, PlaneBox& box) const
  {
    RealArray<2> extent;
    for (std::size_t d = 0; d < 2; ++d)
    {
      extent[d] = std::numeric_limits<double>::max();
      for (std::size_t k = 0; k < count; ++k)
      {
        const std::size_t q = (first + k) % 4;
        const Interval& side = this->Pieces[this->Elements[q]].Box[d];
        extent[d] = std::min(extent[d],
          0.5 * (QuadrantSigns[q][d] > 0 ? side.Hi - this->At[d] : this->At[d] - side.Lo));
      }
    }
    for (int step = 0; step < 16; ++step)
    {
      bool proved = true;
      for (std::size_t k = 0; k < count && proved; ++k)
      {
        const std::size_t q = (first + k) % 4;
        proved = this->Grows(q, 0, extent) != 0 && this->Grows(q, 1, extent) != 0;
      }
      if (proved)
      {
        box = this->BoxOf(first, extent);
        for (std::size_t k = 1; k < count; ++k)
        {
          const PlaneBox other = this->BoxOf((first + k) % 4, extent);
          box[0].Merge(other[0]);
          box[1].Merge(other[1]);
        }
        return true;
      }
      extent = { extent[0] / 8.0, extent[1] / 8.0 };
    }
    return false;
  }

  const ScalarPieces& Pieces;
  RealArray<2> At;
  std::array<int, 4> Elements;
  std::array<JoinKind, 4> Rays; ///< Boundary: none, or f jumps
};

/// Corners of elements, and places on sides where a neighbour's corner lies.
std::vector<CornerEntry> GatherCorners(const ScalarPieces& pieces)
{
  std::vector<CornerEntry> entries;
  for (int e = 0; e < pieces.NumPieces(); ++e)
  {
    const PlaneBox& box = pieces[e].Box;
    for (const PieceJoin* j = pieces.BeginJoins(e); j != pieces.EndJoins(e); ++j)
    {
      const auto d = static_cast<std::size_t>(j->Side / 2);
      RealArray<2> at;
      at[d] = j->Side % 2 == 1 ? box[d].Hi : box[d].Lo;
      at[1 - d] = j->Along.Lo;
      entries.push_back({ at, e });
      at[1 - d] = j->Along.Hi;
      entries.push_back({ at, e });
    }
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  return entries;
}
}

void SearchCorners(const ScalarPieces& pieces, const CriticalPointParams& params,
  FoundPoints& result, int& characteristic)
{
  const std::vector<CornerEntry> entries = GatherCorners(pieces);
  int joined = 0;
  for (const PieceJoin& join : pieces.Joins)
  {
    joined += join.Side % 2 == 1 && join.Kind != JoinKind::Boundary ? 1 : 0;
  }
  // of the open cells inside the domain
  characteristic = pieces.NumPieces() - joined;
  for (std::size_t begin = 0; begin < entries.size();)
  {
    std::size_t end = begin + 1;
    while (end < entries.size() && entries[end].At == entries[begin].At)
    {
      ++end;
    }
    const Corner corner(pieces, entries.data() + begin, entries.data() + end);
    characteristic += corner.IsInside() ? 1 : 0;
    if (corner.IsCandidate())
    {
      corner.Search(params.Boundary, result);
    }
    begin = end;
  }
}
}
