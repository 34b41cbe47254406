// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <cstdint>
#include <vector>

/// One numbering of sides, of their corners and of their orientations for all modules.
///
/// Side 2 d + e of a patch (of one to three parameters) is where parameter d is at its lower
/// (e = 0) or upper end (e = 1); in the plane west, east, south, north. Its directions are those of
/// the patch without d, in increasing order. Bit k of the number of a corner, of a patch or of a
/// side, is the end in direction k.
namespace knotwork
{
/// A side of one of several patches; Side = -1: none.
struct PatchSide
{
  int Patch = -1;
  int Side = -1;

  bool operator==(const PatchSide& other) const
  {
    return this->Patch == other.Patch && this->Side == other.Side;
  }
  bool operator<(const PatchSide& other) const
  {
    return this->Patch != other.Patch ? this->Patch < other.Patch : this->Side < other.Side;
  }
};

/// Parameter that is constant on a side.
inline std::size_t AcrossSide(int side)
{
  return static_cast<std::size_t>(side / 2);
}

/// Its value there.
template <int Dim>
double SideValue(const ParametricBox<Dim>& domain, int side)
{
  return (side % 2 == 0 ? domain.Lower : domain.Upper)[AcrossSide(side)];
}

/// Directions of the patch that a side has.
template <int Dim>
std::array<std::size_t, Dim - 1> SideDirections(int side)
{
  std::array<std::size_t, Dim - 1> directions{};
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    directions[k] = k < AcrossSide(side) ? k : k + 1;
  }
  return directions;
}

/// A side, edge or corner of a patch, or all of it: per direction free (-1) or fixed at the lower
/// (0) or upper (1) end.
template <int Dim>
using PatchEntity = std::array<int, Dim>;

template <int Dim>
PatchEntity<Dim> EntityOfSide(int side)
{
  PatchEntity<Dim> entity;
  entity.fill(-1);
  entity[AcrossSide(side)] = side % 2;
  return entity;
}

template <int Dim>
std::vector<std::size_t> FreeDirections(const PatchEntity<Dim>& entity);

/// Points on an entity of a grid of so many points a direction, by number in the grid; first
/// direction fastest in both.
template <int Dim>
std::vector<int> EntityIndices(const IntArray<Dim>& count, const PatchEntity<Dim>& entity);

/// Corner of the patch at a corner of its side.
template <int Dim>
int PatchCorner(int side, int sideCorner)
{
  const auto directions = SideDirections<Dim>(side);
  int corner = (side % 2) << (side / 2);
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    corner |= (sideCorner >> k & 1) << directions[k];
  }
  return corner;
}

/// +1 when the outward normal and then the side's directions are a right-handed frame of the
/// parameters, else -1.
inline int SideSign(int side)
{
  return (side % 2 == 1) == (side / 2 % 2 == 0) ? 1 : -1;
}

/// How a side lies on another one: its direction k is direction Axis[k] of the other, run backwards
/// when Reversed[k]. Sides of one direction (of none) have the identity in the rest.
struct SideOrientation
{
  std::array<int, 2> Axis{ 0, 1 };
  std::array<bool, 2> Reversed{ false, false };

  /// Orientation s in [0, 8): bits 0 and 1 are Reversed, bit 2 exchanges the directions.
  static SideOrientation Make(int number);
  int Number() const;
  /// Of the frames: -1 for a reflection.
  int Sign() const;
  SideOrientation Inverse() const;
  /// Corner of the other side at a corner of this one.
  int Corner(int corner) const;
  /// Grid point of this side that lies at one of the other. @param count  points a direction of
  /// this side.
  std::array<std::int64_t, 2> OwnPoint(
    const std::array<std::int64_t, 2>& other, const std::array<std::int64_t, 2>& count) const;
  std::array<std::int64_t, 2> OtherPoint(
    const std::array<std::int64_t, 2>& own, const std::array<std::int64_t, 2>& count) const;
  /// Points a direction of the other side.
  std::array<std::int64_t, 2> OtherCount(const std::array<std::int64_t, 2>& count) const
  {
    return this->Axis[0] == 1 ? std::array<std::int64_t, 2>{ count[1], count[0] } : count;
  }

  bool operator==(const SideOrientation& other) const { return this->Number() == other.Number(); }
  bool operator!=(const SideOrientation& other) const { return !(*this == other); }
};

/// `first` lies on a side that lies so on a third one: how `first` lies on the third.
SideOrientation Chained(const SideOrientation& first, const SideOrientation& then);

/// All orientations of sides of 0, 1 or 2 directions by number: 1, 2 or 8.
const std::vector<SideOrientation>& SideOrientations(int numDirections);
}
