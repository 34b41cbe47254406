// SPDX-License-Identifier: BSD-3-Clause
#include "FaceChart.h"

namespace knotwork
{
FaceChart::FaceChart(const CADTopology& model, int face) : Model(&model), Index(face)
{
  // differences at places of the boundary
  constexpr int Places = 8;
  const auto& loops = model.Faces[static_cast<std::size_t>(face)].Loops;
  std::vector<Eigen::Vector2d> places;
  for (std::size_t loop = 0; loop < loops.size(); ++loop)
  {
    for (std::size_t use = 0; use < loops[loop].size(); ++use)
    {
      for (int i = 0; i < Places; ++i)
      {
        places.push_back(model.UseParameters(
          face, static_cast<int>(loop), static_cast<int>(use), static_cast<double>(i) / Places));
      }
    }
  }
  Eigen::Vector2d lower = places.front();
  Eigen::Vector2d upper = places.front();
  for (const Eigen::Vector2d& place : places)
  {
    lower = lower.cwiseMin(place);
    upper = upper.cwiseMax(place);
  }
  const Eigen::Vector2d step = (upper - lower) / 64.0;
  for (int direction = 0; direction < 2; ++direction)
  {
    double sum = 0.0;
    Eigen::Vector2d move = Eigen::Vector2d::Zero();
    move[direction] = step[direction];
    for (const Eigen::Vector2d& place : places)
    {
      // towards the middle, to stay on the surface
      const double sign = place[direction] > 0.5 * (lower + upper)[direction] ? -1.0 : 1.0;
      sum += (model.FacePoint(face, place + sign * move) - model.FacePoint(face, place)).norm();
    }
    const double mean = sum / static_cast<double>(places.size());
    this->Scale[direction] = step[direction] > 0.0 && mean > 0.0 ? mean / step[direction] : 1.0;
  }
}

Eigen::Vector3d FaceChart::Normal(const Eigen::Vector2d& place) const
{
  const Eigen::Vector3d outward =
    this->Model->FaceNormal(this->Index, place.cwiseQuotient(this->Scale));
  return this->Model->Faces[static_cast<std::size_t>(this->Index)].Reversed
    ? Eigen::Vector3d(-outward)
    : outward;
}

double FaceChart::Length(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const
{
  const int chords = this->IsPlane() ? 1 : 4;
  double length = 0.0;
  Eigen::Vector3d before = this->Point(from);
  for (int i = 1; i <= chords; ++i)
  {
    const Eigen::Vector3d next = this->Point(from + (to - from) * i / chords);
    length += (next - before).norm();
    before = next;
  }
  return length;
}

Eigen::Vector3d FaceChart::Project(const Eigen::Vector3d& point, Eigen::Vector2d& place) const
{
  const CADPlace found = this->Model->Project(this->Index, point, place.cwiseQuotient(this->Scale));
  place = this->FromParameters(found.Parameters);
  return found.Point;
}

EdgeNodes::EdgeNodes(const CADTopology& model, std::vector<int> counts)
  : Counts(std::move(counts)), Shares(Counts.size()),
    NumNodes(static_cast<int>(model.Vertices.size()))
{
  for (const int count : this->Counts)
  {
    this->First.push_back(this->NumNodes);
    this->NumNodes += count - 1;
  }
}

int EdgeNodes::NodeOf(const CADTopology& model, int edge, int i) const
{
  const auto e = static_cast<std::size_t>(edge);
  if (i == 0 || i == this->Counts[e])
  {
    return model.Edges[e].Vertices[i == 0 ? 0 : 1];
  }
  return this->First[e] + i - 1;
}

double EdgeNodes::ShareOf(int edge, int i) const
{
  const auto e = static_cast<std::size_t>(edge);
  return this->Shares[e].empty() ? static_cast<double>(i) / this->Counts[e]
                                 : this->Shares[e][static_cast<std::size_t>(i)];
}

std::vector<ChartLoop> ChartLoops(
  const CADTopology& model, const FaceChart& chart, const EdgeNodes& nodes)
{
  std::vector<ChartLoop> loops;
  const auto& uses = model.Faces[static_cast<std::size_t>(chart.Face())].Loops;
  for (std::size_t l = 0; l < uses.size(); ++l)
  {
    ChartLoop loop;
    for (std::size_t u = 0; u < uses[l].size(); ++u)
    {
      const CADTopologyUse& use = uses[l][u];
      const int count = use.Edge < 0 ? 1 : nodes.Counts[static_cast<std::size_t>(use.Edge)];
      for (int i = 0; i < count; ++i)
      {
        LoopPoint point;
        const double share = use.Edge < 0 ? static_cast<double>(i) / count
          : use.Reversed                  ? 1.0 - nodes.ShareOf(use.Edge, count - i)
                                          : nodes.ShareOf(use.Edge, i);
        point.Place = chart.FromParameters(
          model.UseParameters(chart.Face(), static_cast<int>(l), static_cast<int>(u), share));
        point.Node =
          use.Edge < 0 ? use.Vertex : nodes.NodeOf(model, use.Edge, use.Reversed ? count - i : i);
        point.Use = static_cast<int>(u);
        point.IsCorner = i == 0;
        point.BeginsPole = use.Edge < 0;
        loop.push_back(point);
      }
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}
}
