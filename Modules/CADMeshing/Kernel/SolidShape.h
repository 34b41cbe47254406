// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SolidSweeps.h"

#include <map>
#include <set>

namespace knotwork
{
/// An edge of a solid, and the uses of it by the solid's faces.
struct SolidEdge
{
  struct Use
  {
    int Face;
    int Loop;
    int Index;
  };
  std::vector<Use> Uses;
  bool IsFlat = false; ///< the solid's normals on both sides are nearly the same
};

/// Places on the rim of the source that come to places of an edge: one more than segments, at
/// equal shares of the edge.
using Followed = std::vector<Eigen::Vector3d>;

/// What is known of a solid for all of its sweeps.
class SolidShape
{
public:
  SolidShape(const CADTopology& model, const FaceMesher& mesher, int body);

  /// Faces from which the solid may be swept.
  std::vector<std::vector<int>> Sources() const;
  /// One way to sweep it. @return whether there is one.
  /// @param sweep     result; where edges inside of the target alone prevent it, with its target.
  /// @param blockers  result: faces that prevent it.
  /// @param goesOn    linking faces may lie behind others where these go on flatly.
  bool Sweep(
    const std::vector<int>& source, bool goesOn, SolidSweep& sweep, std::set<int>& blockers) const;

private:
  struct Progress;

  std::map<int, int> UsesWithin(const std::set<int>& faces) const;
  bool Advance(int face, std::size_t side, Progress& progress) const;
  void Link(const std::set<int>& source, bool goesOn, Progress& progress) const;
  bool AddLayers(const std::set<int>& source, const Progress& progress, SolidSweep& sweep) const;
  bool MatchImprints(SolidSweep& sweep) const;
  Eigen::Vector3d AreaVector(int face) const;
  std::vector<int> CapOf(int face) const;
  std::set<int> BentFaces(const std::vector<int>& end) const;
  bool IsConnected(const std::set<int>& faces) const;
  bool HasSameCorners(const SolidSweep& sweep, const Progress& progress) const;
  std::vector<int> ChainUp(int vertex, const Progress& progress, int& end) const;
  double Score(const SolidSweep& sweep) const;

  const CADTopology& Model;
  const FaceMesher& Mesher;
  int Body;
  std::set<int> Faces;
  std::map<int, bool> IsReversed; ///< faces
  std::map<int, SolidEdge> Edges;
};

struct SolidShape::Progress
{
  std::map<int, Followed> Front;      ///< edges
  std::map<int, std::vector<int>> Up; ///< from a vertex along a linking face: edges
  std::map<int, int> Above;           ///< the vertex that they lead to
  std::set<int> Linking;
};
}
