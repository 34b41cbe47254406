// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADModel/CADTopology.h>

#include <Eigen/Core>

#include <vector>

namespace knotwork
{
/// A face's surface over a plane: its parameters, each scaled by the mean length of the surface's
/// derivative, so that lengths there are near to those in space. A face has its loops to their left
/// in it.
class FaceChart
{
public:
  FaceChart(const CADTopology& model, int face);

  int Face() const { return this->Index; }
  bool IsPlane() const { return this->Model->Faces[static_cast<std::size_t>(this->Index)].IsPlane; }
  Eigen::Vector2d FromParameters(const Eigen::Vector2d& parameters) const
  {
    return parameters.cwiseProduct(this->Scale);
  }
  Eigen::Vector3d Point(const Eigen::Vector2d& place) const
  {
    return this->Model->FacePoint(this->Index, place.cwiseQuotient(this->Scale));
  }
  /// To where the plane's triangles run counterclockwise; zero where the surface has none.
  Eigen::Vector3d Normal(const Eigen::Vector2d& place) const;
  double Curvature(const Eigen::Vector2d& place) const
  {
    return this->Model->FaceCurvature(this->Index, place.cwiseQuotient(this->Scale));
  }
  /// Length of the image of a straight line, by four chords.
  double Length(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  /// Moves a place to the one nearest to a point; its point on the surface.
  Eigen::Vector3d Project(const Eigen::Vector3d& point, Eigen::Vector2d& place) const;

private:
  const CADTopology* Model;
  int Index;
  Eigen::Vector2d Scale = Eigen::Vector2d::Ones();
};

/// A point of a face's boundary in its chart.
struct LoopPoint
{
  Eigen::Vector2d Place;
  int Node = 0;            ///< of the mesh
  int Use = 0;             ///< of the loop, that begins at it or holds it
  bool IsCorner = false;   ///< a use begins here
  bool BeginsPole = false; ///< the next point is the same in space
};

using ChartLoop = std::vector<LoopPoint>;

/// Points of the model's edges: those of vertices come first, then those inside of edges.
struct EdgeNodes
{
  std::vector<int> Counts; ///< of segments, one an edge
  std::vector<int> First;  ///< node behind the begin of an edge
  /// Where the nodes of an edge are, Counts and one, as shares of its length; empty: equally far.
  std::vector<std::vector<double>> Shares;

  EdgeNodes(const CADTopology& model, std::vector<int> counts);
  int NodeOf(const CADTopology& model, int edge, int i) const;
  double ShareOf(int edge, int i) const;
  int NumNodes = 0;
};

/// The loops of a face with all points of their edges.
std::vector<ChartLoop> ChartLoops(
  const CADTopology& model, const FaceChart& chart, const EdgeNodes& nodes);
}
