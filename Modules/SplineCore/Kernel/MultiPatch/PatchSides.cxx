// SPDX-License-Identifier: BSD-3-Clause
#include "PatchSides.h"

#include "FunctionMap.h"

namespace knotwork
{
template <int Dim>
std::vector<int> SideIndices(const IntArray<Dim>& count, int side)
{
  std::array<int, Dim> strides{};
  int stride = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    strides[d] = stride;
    stride *= count[d];
  }
  const std::size_t across = AcrossSide(side);
  const int first = side % 2 ? strides[across] * (count[across] - 1) : 0;
  const auto directions = SideDirections<Dim>(side);
  IntArray<Dim - 1> shape{};
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    shape[k] = count[directions[k]];
  }
  std::vector<int> points;
  ForEachOffset<Dim - 1>(shape,
    [&](const IntArray<Dim - 1>& index)
    {
      int at = first;
      for (std::size_t k = 0; k + 1 < Dim; ++k)
      {
        at += strides[directions[k]] * index[k];
      }
      points.push_back(at);
    });
  return points;
}

SideOrientation SideOrientation::Make(int number)
{
  SideOrientation made;
  made.Reversed = { (number & 1) != 0, (number & 2) != 0 };
  if ((number & 4) != 0)
  {
    made.Axis = { 1, 0 };
  }
  return made;
}

int SideOrientation::Number() const
{
  return (this->Reversed[0] ? 1 : 0) + (this->Reversed[1] ? 2 : 0) + 4 * this->Axis[0];
}

int SideOrientation::Sign() const
{
  return (this->Reversed[0] != this->Reversed[1]) != (this->Axis[0] == 1) ? -1 : 1;
}

SideOrientation SideOrientation::Inverse() const
{
  SideOrientation inverse;
  for (std::size_t k = 0; k < 2; ++k)
  {
    inverse.Axis[static_cast<std::size_t>(this->Axis[k])] = static_cast<int>(k);
    inverse.Reversed[static_cast<std::size_t>(this->Axis[k])] = this->Reversed[k];
  }
  return inverse;
}

int SideOrientation::Corner(int corner) const
{
  int other = 0;
  for (std::size_t k = 0; k < 2; ++k)
  {
    const bool upper = (corner >> k & 1) != 0;
    other |= static_cast<int>(upper != this->Reversed[k]) << this->Axis[k];
  }
  return other;
}

std::array<std::int64_t, 2> SideOrientation::OwnPoint(
  const std::array<std::int64_t, 2>& other, const std::array<std::int64_t, 2>& count) const
{
  std::array<std::int64_t, 2> own{};
  for (std::size_t k = 0; k < 2; ++k)
  {
    const std::int64_t at = other[static_cast<std::size_t>(this->Axis[k])];
    own[k] = this->Reversed[k] ? count[k] - 1 - at : at;
  }
  return own;
}

std::array<std::int64_t, 2> SideOrientation::OtherPoint(
  const std::array<std::int64_t, 2>& own, const std::array<std::int64_t, 2>& count) const
{
  std::array<std::int64_t, 2> other{};
  for (std::size_t k = 0; k < 2; ++k)
  {
    other[static_cast<std::size_t>(this->Axis[k])] =
      this->Reversed[k] ? count[k] - 1 - own[k] : own[k];
  }
  return other;
}

SideOrientation Chained(const SideOrientation& first, const SideOrientation& then)
{
  SideOrientation chained;
  for (std::size_t k = 0; k < 2; ++k)
  {
    const auto middle = static_cast<std::size_t>(first.Axis[k]);
    chained.Axis[k] = then.Axis[middle];
    chained.Reversed[k] = first.Reversed[k] != then.Reversed[middle];
  }
  return chained;
}

const std::vector<SideOrientation>& SideOrientations(int numDirections)
{
  const auto first = [](int count)
  {
    std::vector<SideOrientation> made;
    for (int number = 0; number < count; ++number)
    {
      made.push_back(SideOrientation::Make(number));
    }
    return made;
  };
  static const std::array<std::vector<SideOrientation>, 3> all{ first(1), first(2), first(8) };
  return all[static_cast<std::size_t>(numDirections)];
}

template std::vector<int> SideIndices<1>(const IntArray<1>&, int);
template std::vector<int> SideIndices<2>(const IntArray<2>&, int);
template std::vector<int> SideIndices<3>(const IntArray<3>&, int);
}
