// SPDX-License-Identifier: BSD-3-Clause
// What the steps of a repair hand on to each other, private to the kernel.
#pragma once
#include "SoupTopology.h"
#include "SurfaceRepair.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace knotwork
{
/// Triangles on their way.
struct RepairSoup
{
  PointMatrix Points;
  std::vector<MeshTriangle> Triangles;
  std::vector<int> Sources;  ///< of the input's triangles, -1: in a hole
  std::vector<int> PointIds; ///< of the input's points, -1: new

  Eigen::Vector3d Point(int i) const { return this->Points.row(i).transpose(); }
  Eigen::Vector3d MiddleOf(const std::pair<int, int>& edge) const
  {
    return 0.5 * (this->Point(edge.first) + this->Point(edge.second));
  }
  Eigen::Vector3d MiddleOf(int triangle) const
  {
    const MeshTriangle& t = this->Triangles[static_cast<std::size_t>(triangle)];
    return (this->Point(t[0]) + this->Point(t[1]) + this->Point(t[2])) / 3.0;
  }
  double AreaOf(int triangle) const
  {
    return TriangleArea(this->Points, this->Triangles[static_cast<std::size_t>(triangle)]);
  }
  bool HasEqualCorners(int triangle) const
  {
    const auto& [a, b, c] = this->Triangles[static_cast<std::size_t>(triangle)];
    return a == b || b == c || c == a;
  }
  SoupDefects Defects() const { return FindDefects(this->Triangles, this->Points.rows()); }
  /// Keeps triangles of which keep(number) is true.
  template <typename Keep>
  void Filter(Keep&& keep)
  {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      if (keep(static_cast<int>(t)))
      {
        this->Triangles[kept] = this->Triangles[t];
        this->Sources[kept++] = this->Sources[t];
      }
    }
    this->Triangles.resize(kept);
    this->Sources.resize(kept);
  }
};

/// Mean of points.
Eigen::Vector3d MiddleOfRim(const RepairSoup& soup, const std::vector<int>& rim);
/// Diagonal of the box of points, at least one.
double DiagonalOf(const PointMatrix& points, const std::vector<int>& numbers);
/// Numbers of points that triangles have as corners, ascending.
std::vector<int> UsedPoints(const std::vector<MeshTriangle>& triangles);
/// Corners, ascending.
MeshTriangle Sorted(MeshTriangle corners);

/// What all steps of a repair know, and what they did.
struct OngoingRepair
{
  const SurfaceRepairParams& Params;
  double Diagonal = 0.0; ///< of the input's box
  bool Closed = true;    ///< no holes stay
  std::vector<RepairAction> Actions = {};
  std::vector<std::array<Eigen::Vector3d, 3>> Fillings = {}; ///< triangles that closed holes
  double Done = 0.0;
  double Shown = 0.0; ///< of the progress

  bool GoesOn() const { return !this->Params.Progress || this->Params.Progress(this->Shown); }
  void Add(RepairKind kind, const Eigen::Vector3d& place, double size = 0.0)
  {
    this->Actions.push_back({ kind, place, size });
  }
  /// Adds one action a pair of triangles.
  void AddIntersections(const RepairSoup& soup, const std::vector<std::pair<int, int>>& pairs);
};

/// A place in a message.
std::string PlaceText(const Eigen::Vector3d& point);
/// Up to five of several places: "2 holes, at (0, 1, 2), (1, 2, 3)".
std::string PlacesText(const std::string& what, const std::vector<Eigen::Vector3d>& places);
}
