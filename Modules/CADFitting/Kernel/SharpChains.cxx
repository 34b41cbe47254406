// SPDX-License-Identifier: BSD-3-Clause
#include "SharpChains.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// End k of edge e is 2 e + k.
class ChainJoiner
{
public:
  ChainJoiner(const std::vector<PointMatrix>& lines, const std::vector<int>& bodies,
    double tolerance, double cornerAngle)
    : Lines(lines), Bodies(bodies),
      Limit(std::cos(cornerAngle * static_cast<double>(EIGEN_PI) / 180.0)),
      PlaceOf(2 * lines.size())
  {
    for (int end = 0; end < static_cast<int>(this->PlaceOf.size()); ++end)
    {
      const int body = bodies[At(end / 2)];
      const auto found = std::find_if(this->Places.begin(), this->Places.end(),
        [&](const Place& place)
        { return place.Body == body && (place.Point - this->PointOf(end)).norm() <= tolerance; });
      this->PlaceOf[At(end)] = static_cast<int>(found - this->Places.begin());
      if (found == this->Places.end())
      {
        this->Places.push_back({ this->PointOf(end), body });
        this->EndsAt.emplace_back();
      }
      this->EndsAt[At(this->PlaceOf[At(end)])].push_back(end);
    }
  }

  SharpChains Join()
  {
    std::vector<int> cornerOf(this->Places.size(), -1);
    for (std::size_t place = 0; place < this->Places.size(); ++place)
    {
      if (this->IsCorner(this->EndsAt[place]))
      {
        cornerOf[place] = static_cast<int>(this->Result.Vertices.rows());
        this->Result.Vertices.conservativeResize(this->Result.Vertices.rows() + 1, 3);
        this->Result.Vertices.bottomRows<1>() = this->Places[place].Point;
        this->Result.VertexBodies.push_back(this->Places[place].Body);
      }
    }
    this->Result.Vertices.conservativeResize(this->Result.Vertices.rows(), 3);
    this->IsDone.assign(this->Lines.size(), 0);
    // from corners on, then what closes without one
    for (const bool fromCorners : { true, false })
    {
      for (int end = 0; end < static_cast<int>(this->PlaceOf.size()); ++end)
      {
        const bool isCorner = cornerOf[At(this->PlaceOf[At(end)])] >= 0;
        if (this->IsDone[At(end / 2)] == 0 && isCorner == fromCorners)
        {
          this->Walk(end, cornerOf);
        }
      }
    }
    return std::move(this->Result);
  }

private:
  struct Place
  {
    Eigen::RowVector3d Point;
    int Body;
  };
  Eigen::RowVector3d PointOf(int end) const
  {
    const PointMatrix& line = this->Lines[At(end / 2)];
    return line.row(end % 2 == 0 ? 0 : line.rows() - 1);
  }
  /// Direction into the edge.
  Eigen::RowVector3d Into(int end) const
  {
    const PointMatrix& line = this->Lines[At(end / 2)];
    const Eigen::Index last = line.rows() - 1;
    return (end % 2 == 0 ? line.row(1) - line.row(0) : line.row(last - 1) - line.row(last))
      .normalized();
  }
  bool IsCorner(const std::vector<int>& ends) const
  {
    return ends.size() != 2 || -this->Into(ends[0]).dot(this->Into(ends[1])) <= this->Limit;
  }
  void Walk(int begin, const std::vector<int>& cornerOf)
  {
    TargetCurve& curve = this->Result.Curves.emplace_back();
    std::vector<int>& members = this->Result.Members.emplace_back();
    curve.Body = this->Bodies[At(begin / 2)];
    curve.Ends[0] = cornerOf[At(this->PlaceOf[At(begin)])];
    std::vector<Eigen::RowVector3d> points{ this->PointOf(begin) };
    for (int end = begin;;)
    {
      const int edge = end / 2;
      this->IsDone[At(edge)] = 1;
      members.push_back(edge);
      const PointMatrix& line = this->Lines[At(edge)];
      for (Eigen::Index i = 1; i < line.rows(); ++i)
      {
        points.emplace_back(line.row(end % 2 == 0 ? i : line.rows() - 1 - i));
      }
      const int far = end ^ 1;
      const int place = this->PlaceOf[At(far)];
      curve.Ends[1] = cornerOf[At(place)];
      if (curve.Ends[1] >= 0)
      {
        break;
      }
      const std::vector<int>& ends = this->EndsAt[At(place)];
      end = ends[0] == far ? ends[1] : ends[0];
      if (this->IsDone[At(end / 2)] != 0)
      {
        points.pop_back(); // is the first
        break;
      }
    }
    curve.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      curve.Points.row(static_cast<Eigen::Index>(i)) = points[i];
    }
  }

  const std::vector<PointMatrix>& Lines;
  const std::vector<int>& Bodies;
  double Limit;
  std::vector<int> PlaceOf; ///< of every end
  std::vector<Place> Places;
  std::vector<std::vector<int>> EndsAt;
  std::vector<char> IsDone;
  SharpChains Result;
};
}

SharpChains JoinChains(const std::vector<PointMatrix>& lines, const std::vector<int>& bodies,
  double tolerance, double cornerAngle)
{
  return ChainJoiner(lines, bodies, tolerance, cornerAngle).Join();
}
}
