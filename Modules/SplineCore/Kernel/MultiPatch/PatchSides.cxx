// SPDX-License-Identifier: BSD-3-Clause
#include "PatchSides.h"

#include "FunctionMap.h"

namespace knotwork
{
template <int Dim>
std::vector<std::size_t> FreeDirections(const PatchEntity<Dim>& entity)
{
  std::vector<std::size_t> free;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    if (entity[d] < 0)
    {
      free.push_back(d);
    }
  }
  return free;
}

template <int Dim>
std::vector<int> EntityIndices(const IntArray<Dim>& count, const PatchEntity<Dim>& entity)
{
  IntArray<Dim> shape{};
  std::array<int, Dim> strides{};
  int first = 0;
  int stride = 1;
  std::size_t size = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    shape[d] = entity[d] < 0 ? count[d] : 1;
    size *= static_cast<std::size_t>(shape[d]);
    strides[d] = stride;
    first += entity[d] == 1 ? stride * (count[d] - 1) : 0;
    stride *= count[d];
  }
  std::vector<int> points;
  points.reserve(size);
  ForEachOffset<Dim>(shape,
    [&](const IntArray<Dim>& index)
    {
      int at = first;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        at += strides[d] * index[d];
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

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template std::vector<std::size_t> FreeDirections<Dim>(const PatchEntity<Dim>&);                  \
  template std::vector<int> EntityIndices<Dim>(const IntArray<Dim>&, const PatchEntity<Dim>&);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
