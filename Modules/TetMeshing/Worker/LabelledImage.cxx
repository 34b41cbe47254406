// SPDX-License-Identifier: BSD-3-Clause
#include "LabelledImage.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr std::size_t CrossingsOfPiece = 12;
constexpr std::array<std::array<int, 3>, 6> Steps{ { { -1, 0, 0 }, { 1, 0, 0 }, { 0, -1, 0 },
  { 0, 1, 0 }, { 0, 0, -1 }, { 0, 0, 1 } } };
}

LabelledImage::LabelledImage(const std::array<int, 3>& size, const Eigen::Vector3d& spacing,
  std::vector<double> values, ImageSolid solid, double level)
  : Size(size), Spacing(spacing), Values(std::move(values)), Solid(solid), Level(level)
{
}

int LabelledImage::LabelOf(double value) const
{
  switch (this->Solid)
  {
    case ImageSolid::Below:
      return value < this->Level ? 1 : 0;
    case ImageSolid::Above:
      return value > this->Level ? 1 : 0;
    case ImageSolid::Labels:
      break;
  }
  return std::max(static_cast<int>(value), 0);
}

std::size_t LabelledImage::IndexOf(const Place& at) const
{
  return static_cast<std::size_t>(at[0]) +
    static_cast<std::size_t>(this->Size[0]) *
    (static_cast<std::size_t>(at[1]) +
      static_cast<std::size_t>(this->Size[1]) * static_cast<std::size_t>(at[2]));
}

LabelledImage::Place LabelledImage::PlaceOf(std::size_t index) const
{
  const auto x = static_cast<std::size_t>(this->Size[0]);
  const auto y = static_cast<std::size_t>(this->Size[1]);
  return { static_cast<int>(index % x), static_cast<int>(index / x % y),
    static_cast<int>(index / x / y) };
}

bool LabelledImage::IsIn(const Place& at) const
{
  bool isIn = true;
  for (std::size_t d = 0; d < 3; ++d)
  {
    isIn = isIn && at[d] >= 0 && at[d] < this->Size[d];
  }
  return isIn;
}

Eigen::Vector3d LabelledImage::PointOf(const Place& at) const
{
  return Eigen::Vector3d(at[0], at[1], at[2]).cwiseProduct(this->Spacing);
}

Eigen::Vector3d LabelledImage::Upper() const
{
  return this->PointOf({ this->Size[0] - 1, this->Size[1] - 1, this->Size[2] - 1 });
}

int LabelledImage::LabelAt(const Eigen::Vector3d& point) const
{
  Place base{};
  std::array<double, 3> share{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    const auto k = static_cast<Eigen::Index>(d);
    const double at = point[k] / this->Spacing[k];
    if (!(at >= 0.0 && at <= this->Size[d] - 1))
    {
      return 0;
    }
    base[d] = std::min(static_cast<int>(at), this->Size[d] - 2);
    share[d] = at - base[d];
  }
  std::array<double, 8> values{};
  std::array<double, 8> weights{};
  for (std::size_t c = 0; c < 8; ++c)
  {
    weights[c] = 1.0;
    Place at = base;
    for (std::size_t d = 0; d < 3; ++d)
    {
      const bool isUpper = (c >> d & 1U) != 0;
      at[d] += isUpper ? 1 : 0;
      weights[c] *= isUpper ? share[d] : 1.0 - share[d];
    }
    values[c] = this->Values[this->IndexOf(at)];
  }
  if (this->Solid != ImageSolid::Labels)
  {
    double value = 0.0;
    for (std::size_t c = 0; c < 8; ++c)
    {
      value += weights[c] * values[c];
    }
    return this->LabelOf(value);
  }
  int best = 0;
  double most = -1.0;
  for (std::size_t c = 0; c < 8; ++c)
  {
    double weight = 0.0;
    for (std::size_t k = 0; k < 8; ++k)
    {
      weight += values[k] == values[c] ? weights[k] : 0.0;
    }
    const int label = this->LabelOf(values[c]);
    if (weight > most || (weight == most && label < best))
    {
      most = weight;
      best = label;
    }
  }
  return best;
}

std::vector<std::array<Eigen::Vector3d, 2>> LabelledImage::Crossings() const
{
  DisjointSets pieces(static_cast<int>(this->Values.size()));
  for (std::size_t i = 0; i < this->Values.size(); ++i)
  {
    const Place at = this->PlaceOf(i);
    for (std::size_t d = 0; d < 3; ++d)
    {
      Place next = at;
      ++next[d];
      if (this->IsIn(next))
      {
        const std::size_t k = this->IndexOf(next);
        if (this->LabelOf(this->Values[i]) == this->LabelOf(this->Values[k]))
        {
          pieces.Unite(static_cast<int>(i), static_cast<int>(k));
        }
      }
    }
  }
  std::map<int, std::vector<std::array<Eigen::Vector3d, 2>>> found;
  for (std::size_t i = 0; i < this->Values.size(); ++i)
  {
    const int label = this->LabelOf(this->Values[i]);
    const Place at = this->PlaceOf(i);
    for (std::size_t s = 0; s < Steps.size() && label > 0; ++s)
    {
      Place next = at;
      for (std::size_t d = 0; d < 3; ++d)
      {
        next[d] += Steps[s][d];
      }
      if (!this->IsIn(next) || this->LabelOf(this->Values[this->IndexOf(next)]) != label)
      {
        found[pieces.Find(static_cast<int>(i))].push_back(
          { this->PointOf(at), this->PointOf(next) });
      }
    }
  }
  std::vector<std::array<Eigen::Vector3d, 2>> chosen;
  for (const auto& [piece, crossings] : found)
  {
    const std::size_t count = std::min(CrossingsOfPiece, crossings.size());
    for (std::size_t k = 0; k < count; ++k)
    {
      chosen.push_back(crossings[k * crossings.size() / count]);
    }
  }
  return chosen;
}
}
