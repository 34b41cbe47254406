// SPDX-License-Identifier: BSD-3-Clause
#include "NarrowBands.h"

#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double LargestTurn = 150.0; // degrees
constexpr double Reach = 2.0;         // widths of a band: how far its two bounds lie apart at most

struct Bound
{
  std::size_t Triangle; ///< of the band
  std::size_t Side;
  Eigen::Vector3d Middle;
  double Length;
  Eigen::Vector3d Beyond; ///< normal of the triangle beside the band
};

/// Area over half of the circumference of sets of triangles.
struct Widths
{
  std::vector<double> Areas;
  std::vector<double> Rounds;

  explicit Widths(int count)
    : Areas(static_cast<std::size_t>(count), 0.0), Rounds(static_cast<std::size_t>(count), 0.0)
  {
  }
  double Of(int set) const
  {
    const auto s = static_cast<std::size_t>(set);
    return this->Rounds[s] > 0.0 ? 2.0 * this->Areas[s] / this->Rounds[s]
                                 : std::numeric_limits<double>::infinity();
  }
};

Widths Measure(const SurfaceParts& parts, const std::vector<int>& sets, int count)
{
  Widths widths(count);
  for (std::size_t t = 0; t < sets.size(); ++t)
  {
    const auto own = static_cast<std::size_t>(sets[t]);
    widths.Areas[own] += parts.Areas[t];
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int other = parts.Adjacency.Triangle[t][k];
      if (other < 0 || sets[static_cast<std::size_t>(other)] != sets[t])
      {
        widths.Rounds[own] += parts.SideLength(t, k);
      }
    }
  }
  return widths;
}

/// For each bound the angle between what is beyond it and beyond the bound across the band, of
/// those between the limits the largest; 0: none.
std::vector<double> TurnsOf(const std::vector<Bound>& bounds, double reach, double sharpAngle)
{
  const auto count = static_cast<Eigen::Index>(bounds.size());
  PointMatrix lower(count, 3);
  PointMatrix upper(count, 3);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const Bound& bound = bounds[static_cast<std::size_t>(i)];
    lower.row(i) = bound.Middle.array() - 0.5 * bound.Length;
    upper.row(i) = bound.Middle.array() + 0.5 * bound.Length;
  }
  const BoxTree tree(lower, upper);
  std::vector<double> turns(bounds.size(), 0.0);
  for (std::size_t i = 0; i < bounds.size(); ++i)
  {
    const Eigen::Vector3d low = bounds[i].Middle.array() - 0.5 * bounds[i].Length - reach;
    const Eigen::Vector3d high = bounds[i].Middle.array() + 0.5 * bounds[i].Length + reach;
    tree.ForNear(low.data(), high.data(),
      [&](int item)
      {
        const auto j = static_cast<std::size_t>(item);
        if (j <= i || // the other one of a pair sees it
          (bounds[j].Middle - bounds[i].Middle).norm() >
            reach + 0.5 * (bounds[i].Length + bounds[j].Length))
        {
          return;
        }
        const double turn = Degrees * AngleBetween(bounds[i].Beyond, bounds[j].Beyond);
        if (turn >= sharpAngle && turn < LargestTurn)
        {
          turns[i] = std::max(turns[i], turn);
          turns[j] = std::max(turns[j], turn);
        }
      });
  }
  return turns;
}
}

NarrowBands FindNarrowBands(const SurfaceParts& parts, const std::vector<Eigen::Vector3d>& normals,
  const EdgeAngle& angle, const NarrowBandParams& params, EdgeMarks& marks)
{
  NarrowBands bands;
  bands.InBand.assign(parts.Mesh.Triangles.size(), 0);
  if (!(params.Width > 0.0))
  {
    return bands;
  }
  const RegionLabels labels = LabelRegions(parts,
    [&](std::size_t t, std::size_t k) { return marks(t, k) || angle(t, k) >= params.BandAngle; });
  const Widths single = Measure(parts, labels.Of, labels.Count);
  DisjointSets sets(labels.Count);
  VisitInnerEdges(parts,
    [&](std::size_t t, std::size_t k)
    {
      const int a = labels.Of[t];
      const int b = labels.Of[static_cast<std::size_t>(parts.Adjacency.Triangle[t][k])];
      if (a != b && single.Of(a) <= params.Width && single.Of(b) <= params.Width &&
        angle(t, k) < params.SharpAngle)
      {
        sets.Unite(a, b);
      }
    });
  std::vector<int> joined;
  for (const int label : labels.Of)
  {
    joined.push_back(sets.Find(label));
  }
  const Widths widths = Measure(parts, joined, labels.Count);
  const auto isNarrow = [&](int t)
  { return widths.Of(joined[static_cast<std::size_t>(t)]) <= params.Width; };
  std::map<int, std::vector<Bound>> boundsOf;
  for (std::size_t t = 0; t < joined.size(); ++t)
  {
    for (std::size_t k = 0; k < 3 && isNarrow(static_cast<int>(t)); ++k)
    {
      const int other = parts.Adjacency.Triangle[t][k];
      if (other >= 0 && joined[static_cast<std::size_t>(other)] != joined[t] && !isNarrow(other))
      {
        const auto& corners = parts.Mesh.Triangles[t];
        boundsOf[joined[t]].push_back(
          { t, k, 0.5 * (parts.Mesh.Point(corners[k]) + parts.Mesh.Point(corners[(k + 1) % 3])),
            parts.SideLength(t, k), normals[static_cast<std::size_t>(other)] });
      }
    }
  }
  std::vector<char> isBand(static_cast<std::size_t>(labels.Count), 0);
  for (const auto& [set, bounds] : boundsOf)
  {
    const std::vector<double> turns = TurnsOf(bounds, Reach * widths.Of(set), params.SharpAngle);
    double length = 0.0;
    for (std::size_t i = 0; i < bounds.size(); ++i)
    {
      length += turns[i] > 0.0 ? bounds[i].Length : 0.0;
    }
    if (2.0 * length < widths.Rounds[static_cast<std::size_t>(set)])
    {
      continue;
    }
    isBand[static_cast<std::size_t>(set)] = 1;
    for (std::size_t i = 0; i < bounds.size(); ++i)
    {
      if (turns[i] > 0.0)
      {
        marks.Set(bounds[i].Triangle, bounds[i].Side, true);
        bands.Turns[EdgeOf(parts, bounds[i].Triangle, bounds[i].Side)] = turns[i];
      }
    }
  }
  for (std::size_t t = 0; t < joined.size(); ++t)
  {
    bands.InBand[t] = isBand[static_cast<std::size_t>(joined[t])];
  }
  return bands;
}
}
