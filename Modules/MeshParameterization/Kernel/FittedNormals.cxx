// SPDX-License-Identifier: BSD-3-Clause
#include "FittedNormals.h"

#include "VisitBlocks.h"

#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace knotwork
{
namespace
{
constexpr double Sure = 3.0;     // standard deviations
constexpr double Farthest = 5.0; // of a point that is on a plane all the same
constexpr std::size_t MostTriangles = 400;
constexpr std::size_t Chunk = 256;
constexpr double Never = 10.0; // radians: nothing is known of a direction

using Barrier = std::function<bool(std::size_t, std::size_t)>;

/// Least-squares plane of points, which grow in number.
class Plane
{
public:
  explicit Plane(const Eigen::Vector3d& origin) : Origin(origin) {}
  void Add(const Eigen::Vector3d& point)
  {
    const Eigen::Vector3d p = point - this->Origin;
    this->Count += 1.0;
    this->Sum += p;
    this->Square += p * p.transpose();
  }
  /// @param towards  a direction on the normal's side.
  void Fit(const Eigen::Vector3d& towards)
  {
    const Eigen::Vector3d mean = this->Sum / this->Count;
    this->Centre = this->Origin + mean;
    const Eigen::Matrix3d scatter = this->Square - this->Count * mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(scatter);
    this->Values = axes.eigenvalues().cwiseMax(0.0);
    this->Axes = axes.eigenvectors();
    if (this->Axes.col(0).dot(towards) < 0.0)
    {
      this->Axes.col(0) *= -1.0;
    }
  }
  Eigen::Vector3d Normal() const { return this->Axes.col(0); }
  double DeviationOf(double noise) const
  {
    return this->Values[1] > 0.0 ? noise / std::sqrt(this->Values[1]) : Never;
  }
  /// Distance of a further point in standard deviations.
  double Offset(const Eigen::Vector3d& point, double noise) const
  {
    const Eigen::Vector3d p = point - this->Centre;
    double variance = 1.0 + 1.0 / this->Count;
    for (int i = 1; i < 3; ++i)
    {
      const double along = p.dot(this->Axes.col(i));
      variance += along * along / std::max(this->Values[i], std::numeric_limits<double>::min());
    }
    return std::abs(p.dot(this->Axes.col(0))) / (noise * std::sqrt(variance));
  }
  /// Squared distances of the points over what the noise makes of them; 1 without points to spare.
  double Misfit(double noise) const
  {
    return this->Count > 3.0 ? this->Values[0] / ((this->Count - 3.0) * noise * noise) : 1.0;
  }
  /// Up to which Misfit is noise.
  double NoiseMisfit() const
  {
    return this->Count > 3.0 ? 1.0 + 2.0 * std::sqrt(2.0 / (this->Count - 3.0)) : 1.0;
  }
  const Eigen::Vector3d& Middle() const { return this->Centre; }

private:
  Eigen::Vector3d Origin;
  double Count = 0.0;
  Eigen::Vector3d Sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d Square = Eigen::Matrix3d::Zero();
  Eigen::Vector3d Centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d Values = Eigen::Vector3d::Zero();
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity();
};

/// A set of numbers >= 0 that is filled and emptied again and again.
class NumberSet
{
public:
  void Clear()
  {
    ++this->Run;
    this->Count = 0;
  }
  /// @return false: it was in there.
  bool Insert(int number)
  {
    if (2 * (this->Count + 1) > this->Slots.size())
    {
      this->Grow();
    }
    Slot& slot = this->Slots[this->Find(number)];
    const bool isNew = slot.Run != this->Run;
    slot = { this->Run, number };
    this->Count += isNew ? 1 : 0;
    return isNew;
  }
  bool Has(int number) const
  {
    return !this->Slots.empty() && this->Slots[this->Find(number)].Run == this->Run;
  }

private:
  struct Slot
  {
    unsigned Run = 0;
    int Number = 0;
  };
  /// Its slot or the free one where it belongs.
  std::size_t Find(int number) const
  {
    const std::size_t mask = this->Slots.size() - 1;
    std::size_t at = (static_cast<std::size_t>(number) * 0x9E3779B1u >> 7) & mask;
    while (this->Slots[at].Run == this->Run && this->Slots[at].Number != number)
    {
      at = (at + 1) & mask;
    }
    return at;
  }
  void Grow()
  {
    const std::vector<Slot> old = std::move(this->Slots);
    this->Slots.assign(old.empty() ? 64 : 2 * old.size(), Slot());
    for (const Slot& slot : old)
    {
      if (slot.Run == this->Run)
      {
        this->Slots[this->Find(slot.Number)] = slot;
      }
    }
  }
  std::vector<Slot> Slots; ///< a power of two of them, at least half of them free
  std::size_t Count = 0;
  unsigned Run = 1;
};

struct Patch
{
  std::vector<int> Triangles; ///< as long as triangles choose among patches
  bool IsAlone = false;       ///< one triangle
  Plane On = Plane(Eigen::Vector3d::Zero());
  double Deviation = Never;
  double Misfit = 1.0; ///< 1: as the noise says
  double Radius = 0.0;
  double Area = 0.0;
};

class Patches
{
public:
  Patches(const SurfaceParts& parts, const NormalFitParams& params, const Barrier& barrier)
    : Parts(parts), Params(params), IsBarrier(barrier)
  {
    for (std::size_t t = 0; t < parts.Mesh.Triangles.size(); ++t)
    {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const int corner : parts.Mesh.Triangles[t])
      {
        centre += parts.Mesh.Point(corner) / 3.0;
      }
      Plane plane(centre);
      for (const int corner : parts.Mesh.Triangles[t])
      {
        plane.Add(parts.Mesh.Point(corner));
      }
      plane.Fit(parts.Normals[t]);
      this->Centres.push_back(centre);
      this->Own.push_back(plane.DeviationOf(params.Noise));
    }
  }

  double OwnDeviation(std::size_t t) const { return this->Own[t]; }
  const Eigen::Vector3d& Centre(std::size_t t) const { return this->Centres[t]; }

  /// What growing a patch needs again and again.
  struct Scratch
  {
    NumberSet Points; ///< of the patch
    NumberSet Seen;   ///< triangles
  };

  Patch Grow(std::size_t start, Scratch& scratch) const
  {
    Patch patch;
    NumberSet& points = scratch.Points;
    NumberSet& seen = scratch.Seen;
    points.Clear();
    seen.Clear();
    const DiscMesh& mesh = this->Parts.Mesh;
    Plane plane(this->Centres[start]);
    Eigen::Vector3d towards = Eigen::Vector3d::Zero();
    const auto take = [&](std::size_t t)
    {
      patch.Triangles.push_back(static_cast<int>(t));
      towards += this->Parts.Areas[t] * this->Parts.Normals[t];
      patch.Area += this->Parts.Areas[t];
      for (const int corner : mesh.Triangles[t])
      {
        if (points.Insert(corner))
        {
          plane.Add(mesh.Point(corner));
        }
      }
      plane.Fit(towards);
    };
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    const auto reach = [&](std::size_t t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int other = this->Parts.Adjacency.Triangle[t][k];
        if (other >= 0 && !this->IsBarrier(t, k) && seen.Insert(other))
        {
          queue.emplace(
            (this->Centres[static_cast<std::size_t>(other)] - this->Centres[start]).norm(), other);
        }
      }
    };
    seen.Insert(static_cast<int>(start));
    take(start);
    reach(start);
    while (plane.DeviationOf(this->Params.Noise) > this->Params.Precision && !queue.empty() &&
      patch.Triangles.size() < MostTriangles)
    {
      const auto [distance, next] = queue.top();
      queue.pop();
      const auto t = static_cast<std::size_t>(next);
      if (this->Belongs(t, plane, points))
      {
        patch.Radius = distance;
        take(t);
        reach(t);
      }
    }
    patch.IsAlone = patch.Triangles.size() == 1;
    patch.On = plane;
    patch.Deviation = plane.DeviationOf(this->Params.Noise);
    patch.Misfit = std::max(1.0, plane.Misfit(this->Params.Noise) / plane.NoiseMisfit());
    return patch;
  }

private:
  bool Belongs(std::size_t t, const Plane& plane, const NumberSet& points) const
  {
    const double noise = this->Params.Noise;
    const double deviation = std::hypot(this->Own[t], plane.DeviationOf(noise));
    if (AngleBetween(this->Parts.Normals[t], plane.Normal()) > this->Params.Bend + Sure * deviation)
    {
      return false;
    }
    for (const int corner : this->Parts.Mesh.Triangles[t])
    {
      if (!points.Has(corner) && plane.Offset(this->Parts.Mesh.Point(corner), noise) > Sure)
      {
        return false;
      }
    }
    return true;
  }

  const SurfaceParts& Parts;
  const NormalFitParams& Params;
  const Barrier& IsBarrier;
  std::vector<Eigen::Vector3d> Centres;
  std::vector<double> Own; ///< standard deviation of the triangles' normals
};

/// Triangles that belong to no patch whose normal is known take that of the neighbour on whose
/// plane they lie best, where that is one of the few deviations that are large.
void JoinOutliers(const SurfaceParts& parts, const NormalFitParams& params, const Barrier& barrier,
  const std::vector<Patch>& patches, std::vector<std::size_t>& chosen)
{
  const auto isKnown = [&](std::size_t t) { return patches[chosen[t]].Deviation <= params.Known; };
  std::vector<std::size_t> open;
  for (std::size_t t = 0; t < chosen.size(); ++t)
  {
    if (!isKnown(t))
    {
      open.push_back(t);
    }
  }
  for (bool any = true; any;)
  {
    any = false;
    std::vector<std::pair<std::size_t, std::size_t>> joined;
    std::vector<std::size_t> left;
    for (const std::size_t t : open)
    {
      double least = Farthest;
      std::size_t best = t;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int other = parts.Adjacency.Triangle[t][k];
        if (other < 0 || barrier(t, k) || !isKnown(static_cast<std::size_t>(other)))
        {
          continue;
        }
        const std::size_t patch = chosen[static_cast<std::size_t>(other)];
        double offset = 0.0;
        for (const int corner : parts.Mesh.Triangles[t])
        {
          offset =
            std::max(offset, patches[patch].On.Offset(parts.Mesh.Point(corner), params.Noise));
        }
        if (offset <= least)
        {
          least = offset;
          best = patch;
        }
      }
      if (best == t)
      {
        left.push_back(t);
      }
      else
      {
        joined.emplace_back(t, best);
      }
    }
    for (const auto& [t, patch] : joined)
    {
      chosen[t] = patch;
      any = true;
    }
    open = std::move(left);
  }
}
}

Result<FittedNormals> FitNormals(
  const SurfaceParts& parts, const NormalFitParams& params, const Barrier& barrier)
{
  const std::size_t count = parts.Mesh.Triangles.size();
  FittedNormals result;
  result.Normals = parts.Normals;
  result.Deviations.assign(count, 0.0);
  result.Areas.assign(count, 0.0);
  if (!(params.Noise > 0.0))
  {
    return result;
  }
  const Patches patches(parts, params, barrier);
  std::vector<Patch> of(count);
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen(count);
  const auto choose = [&](std::size_t s)
  {
    Patch& patch = of[s];
    for (const int triangle : patch.Triangles)
    {
      const auto t = static_cast<std::size_t>(triangle);
      const double distance =
        patch.Radius > 0.0 ? (patches.Centre(t) - patches.Centre(s)).norm() / patch.Radius : 0.0;
      const double cost = patch.Misfit * (1.0 + distance * distance);
      if (cost < least[t])
      {
        least[t] = cost;
        chosen[t] = s;
      }
    }
    patch.Triangles = std::vector<int>(); // without the memory
  };
  const bool isDone = VisitBlocks(count, params.Progress,
    [&](std::size_t first, std::size_t last)
    {
      ParallelFor(last - first, Chunk, params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          Patches::Scratch scratch;
          for (std::size_t t = first + begin; t < first + end; ++t)
          {
            of[t] = patches.Grow(t, scratch);
          }
        });
      for (std::size_t s = first; s < last; ++s) // in turn: of equal ones the first
      {
        choose(s);
      }
    });
  if (!isDone)
  {
    return { ErrorCode::Aborted, "stopped while normals were fitted" };
  }
  JoinOutliers(parts, params, barrier, of, chosen);
  for (std::size_t t = 0; t < count; ++t)
  {
    const Patch& patch = of[chosen[t]];
    result.Deviations[t] = patch.Deviation;
    if (!patch.IsAlone || chosen[t] != t)
    {
      result.Normals[t] = patch.On.Normal();
      result.Areas[t] = patch.Area;
    }
  }
  return result;
}
}
