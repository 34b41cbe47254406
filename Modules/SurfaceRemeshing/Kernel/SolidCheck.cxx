// SPDX-License-Identifier: BSD-3-Clause
#include "SolidCheck.h"

#include "SoupTopology.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <set>

namespace knotwork
{
namespace
{
constexpr std::size_t NamedPlaces = 3; ///< in messages

class SolidChecker
{
public:
  SolidChecker(const TriangleMesh& mesh, int threads) : Mesh(mesh), Threads(threads) {}

  Result<SolidSurface> Check()
  {
    for (const auto& check : { &SolidChecker::CheckNumbers, &SolidChecker::CheckAreas,
           &SolidChecker::CheckEdges, &SolidChecker::CheckPairs })
    {
      if (Status status = (this->*check)(); !status)
      {
        return status;
      }
    }
    return this->Surface();
  }

private:
  Eigen::Vector3d Point(int i) const { return this->Mesh.Points.row(i).transpose(); }
  std::string Middle(const std::vector<int>& points) const
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int point : points)
    {
      sum += this->Point(point) / static_cast<double>(points.size());
    }
    return PointText(sum.data(), 3);
  }
  std::string MiddleOf(int triangle) const
  {
    const MeshTriangle& t = this->Mesh.Triangles[static_cast<std::size_t>(triangle)];
    return this->Middle({ t[0], t[1], t[2] });
  }

  /// "2 things, at (0, 0, 0), (1, 0, 0)".
  template <typename List, typename Place>
  static std::string Named(const char* what, const List& list, Place&& place)
  {
    std::string text = std::to_string(list.size()) + " " + what +
      (list.size() > NamedPlaces ? ", some of them at " : ", at ");
    for (std::size_t i = 0; i < std::min(list.size(), NamedPlaces); ++i)
    {
      text += (i > 0 ? ", " : "") + place(list[i]);
    }
    return text;
  }

  Status CheckNumbers()
  {
    if (this->Mesh.Triangles.empty())
    {
      return { ErrorCode::EmptyInput, "the surface has no triangles" };
    }
    for (Eigen::Index i = 0; i < this->Mesh.Points.rows(); ++i)
    {
      if (!this->Mesh.Points.row(i).allFinite())
      {
        return { ErrorCode::NonFiniteInput,
          "point " + std::to_string(i) + " is not finite; remove it and its triangles" };
      }
    }
    if (!AllWithinLimit(this->Mesh.Points))
    {
      return { ErrorCode::NonFiniteInput, BeyondLimit() };
    }
    for (std::size_t t = 0; t < this->Mesh.Triangles.size(); ++t)
    {
      for (const int corner : this->Mesh.Triangles[t])
      {
        if (corner < 0 || corner >= this->Mesh.Points.rows())
        {
          return { ErrorCode::InvalidTopology,
            "triangle " + std::to_string(t) + " has a corner " + std::to_string(corner) +
              ", which is no point" };
        }
      }
    }
    this->Triangles = ReplaceCorners(this->Mesh.Triangles, FirstOfEqualPoints(this->Mesh.Points));
    return {};
  }

  Status CheckAreas()
  {
    const std::vector<char> degenerate =
      FindDegenerate(this->Mesh.Points, this->Triangles, this->Threads);
    std::vector<int> flat;
    for (std::size_t t = 0; t < degenerate.size(); ++t)
    {
      if (degenerate[t])
      {
        flat.push_back(static_cast<int>(t));
      }
    }
    if (!flat.empty())
    {
      return this->Defect(Named("triangles without an area", flat,
        [this](int t) { return this->MiddleOf(t) + " (triangle " + std::to_string(t) + ")"; }));
    }
    std::vector<std::pair<MeshTriangle, int>> sorted;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      MeshTriangle corners = this->Triangles[t];
      std::sort(corners.begin(), corners.end());
      sorted.emplace_back(corners, static_cast<int>(t));
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> twice;
    for (std::size_t i = 1; i < sorted.size(); ++i)
    {
      if (sorted[i].first == sorted[i - 1].first)
      {
        twice.push_back(sorted[i].second);
      }
    }
    return twice.empty()
      ? Status()
      : this->Defect(Named("triangles stand there twice", twice,
          [this](int t) { return this->MiddleOf(t) + " (triangle " + std::to_string(t) + ")"; }));
  }

  Status CheckEdges()
  {
    const SoupDefects defects = FindDefects(this->Triangles, this->Mesh.Points.rows());
    const auto middle = [this](const std::pair<int, int>& edge) {
      return this->Middle({ edge.first, edge.second });
    };
    if (!defects.OpenEdges.empty())
    {
      return this->Defect(Named("open edges", defects.OpenEdges, middle));
    }
    std::set<std::pair<int, int>> crowded; // walls between regions are turned as they like
    for (const auto& [first, second] : defects.CrowdedEdges)
    {
      crowded.insert(std::minmax(first, second));
    }
    std::vector<std::pair<int, int>> turned;
    for (const auto& edge : defects.TwistedEdges)
    {
      if (crowded.count(std::minmax(edge.first, edge.second)) == 0)
      {
        turned.push_back(edge);
      }
    }
    return turned.empty()
      ? Status()
      : this->Defect(
          Named("edges whose two triangles are turned against each other", turned, middle));
  }

  Status CheckPairs()
  {
    const auto pairs = FindIntersections(this->Mesh.Points, this->Triangles, this->Threads);
    return pairs.empty()
      ? Status()
      : this->Defect(Named("pairs of triangles intersect", pairs,
          [this](const std::pair<int, int>& pair)
          {
            return this->MiddleOf(pair.first) + " (triangles " + std::to_string(pair.first) +
              " and " + std::to_string(pair.second) + ")";
          }));
  }

  Result<SolidSurface> Surface() const
  {
    SolidSurface surface;
    std::vector<int> number(static_cast<std::size_t>(this->Mesh.Points.rows()), -1);
    surface.Triangles = this->Triangles;
    for (MeshTriangle& corners : surface.Triangles)
    {
      for (int& corner : corners)
      {
        int& place = number[static_cast<std::size_t>(corner)];
        if (place < 0)
        {
          place = static_cast<int>(surface.PointIds.size());
          surface.PointIds.push_back(corner);
        }
        corner = place;
      }
    }
    surface.Points.resize(static_cast<Eigen::Index>(surface.PointIds.size()), 3);
    for (std::size_t i = 0; i < surface.PointIds.size(); ++i)
    {
      surface.Points.row(static_cast<Eigen::Index>(i)) = this->Mesh.Points.row(surface.PointIds[i]);
    }
    surface.Diagonal =
      (surface.Points.colwise().maxCoeff() - surface.Points.colwise().minCoeff()).norm();
    return surface;
  }

  Status Defect(const std::string& what) const
  {
    return { ErrorCode::InvalidTopology, "the surface bounds no solid: " + what + "; repair it" };
  }

  const TriangleMesh& Mesh;
  int Threads;
  std::vector<MeshTriangle> Triangles;
};
}

Result<SolidSurface> CheckSolid(const TriangleMesh& mesh, int threads)
{
  return SolidChecker(mesh, threads).Check();
}
}
