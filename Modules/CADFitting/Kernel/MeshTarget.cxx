// SPDX-License-Identifier: BSD-3-Clause
#include "MeshTarget.h"

#include "TriangleSamples.h"

#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Geometry>

#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A connected part of a mesh.
struct SurfacePart
{
  DiscMesh Surface;
  MeshFeatures Features;
};

class MeshTarget final : public FitTarget
{
public:
  explicit MeshTarget(std::vector<SurfacePart> parts)
  {
    this->Closed = true;
    PointMatrix points(0, 3);
    std::vector<MeshTriangle> triangles;
    for (const SurfacePart& part : parts)
    {
      const auto first = static_cast<int>(points.rows());
      points.conservativeResize(first + part.Surface.Points.rows(), 3);
      points.bottomRows(part.Surface.Points.rows()) = part.Surface.Points;
      for (const MeshTriangle& triangle : part.Surface.Triangles)
      {
        triangles.push_back({ first + triangle[0], first + triangle[1], first + triangle[2] });
      }
      for (const int region : part.Features.Regions)
      {
        this->Regions.push_back(this->FaceCount + region);
      }
      this->FaceCount += part.Features.NumRegions;
      this->Closed = this->Closed && part.Surface.Loops.empty();
      this->AddCurves(part);
    }
    this->Whole = TriangleIndex<3>(std::move(points), std::move(triangles));
    this->IndexCurves();
    this->MakeNormals();
    this->DivideFaces();
  }

  Status Find(
    const TargetPart& part, const PointMatrixView& queries, TargetPoints& result) const override
  {
    if (part.Entity == TargetEntity::Curve || part.Entity == TargetEntity::Vertex)
    {
      this->FindOnLines(part, queries, result);
      return {};
    }
    result.Points.resize(queries.rows(), 3);
    result.Normals.resize(queries.rows(), 3);
    result.Faces.resize(static_cast<std::size_t>(queries.rows()));
    const bool isWhole = part.Entity == TargetEntity::Surface || this->Parts.empty();
    const TriangleIndex<3>& index = isWhole ? this->Whole : this->Parts[At(part.Id)];
    FindOn(index, queries, result.Points,
      [&](Eigen::Index i, const TriangleFoot& foot)
      {
        const int triangle =
          isWhole ? foot.Triangle : this->TrianglesOf[At(part.Id)][At(foot.Triangle)];
        result.Normals.row(i) = this->Normals.row(triangle);
        result.Faces[static_cast<std::size_t>(i)] = this->Regions[At(triangle)];
      });
    return {};
  }

  TargetSamples Samples(int atLeast) const override
  {
    TriangleSamples found = SampleTriangles(this->Whole.Points(), this->Whole.Triangles(), atLeast);
    TargetSamples samples;
    samples.Points = std::move(found.Points);
    samples.Areas = std::move(found.Areas);
    for (const int triangle : found.Triangles)
    {
      samples.Faces.push_back(this->Regions[At(triangle)]);
    }
    return samples;
  }

  const TriangleIndex<3>* Triangles() const override { return &this->Whole; }

private:
  void AddCurves(const SurfacePart& part)
  {
    const PointMatrix& points = part.Surface.Points;
    std::map<int, int> cornerOf;
    for (const int corner : part.Features.Corners)
    {
      cornerOf[corner] = static_cast<int>(this->VertexList.rows());
      this->VertexList.conservativeResize(this->VertexList.rows() + 1, 3);
      this->VertexList.bottomRows<1>() = points.row(corner);
    }
    for (const FeatureChain& chain : part.Features.Chains)
    {
      TargetCurve& curve = this->CurveList.emplace_back();
      if (!chain.Closed)
      {
        curve.Ends = { cornerOf.at(chain.Points.front()), cornerOf.at(chain.Points.back()) };
      }
      curve.Points.resize(static_cast<Eigen::Index>(chain.Points.size()), 3);
      for (std::size_t i = 0; i < chain.Points.size(); ++i)
      {
        curve.Points.row(static_cast<Eigen::Index>(i)) = points.row(chain.Points[i]);
      }
    }
  }

  /// After CurveList is set.
  void IndexCurves()
  {
    for (const TargetCurve& curve : this->CurveList)
    {
      std::vector<MeshTriangle> pieces;
      const int count = static_cast<int>(curve.Points.rows());
      for (int i = 0; i + 1 < count; ++i)
      {
        pieces.push_back({ i, i + 1, i + 1 });
      }
      if (curve.IsClosed())
      {
        pieces.push_back({ count - 1, 0, 0 });
      }
      this->CurveIndex.emplace_back(curve.Points, std::move(pieces));
    }
  }
  void FindOnLines(
    const TargetPart& part, const PointMatrixView& queries, TargetPoints& result) const
  {
    result.Points.resize(queries.rows(), 3);
    result.Normals.setZero(queries.rows(), 3);
    result.Faces.assign(static_cast<std::size_t>(queries.rows()), -1);
    if (part.Entity == TargetEntity::Vertex)
    {
      result.Points.rowwise() = this->VertexList.row(part.Id);
      return;
    }
    FindOn(this->CurveIndex[At(part.Id)], queries, result.Points,
      [](Eigen::Index, const TriangleFoot&) {});
  }

  template <class Visit>
  static void FindOn(const TriangleIndex<3>& index, const PointMatrixView& queries,
    PointMatrix& points, Visit&& visit)
  {
    std::vector<TriangleFoot> feet;
    index.Nearest(queries, feet);
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const TriangleFoot& foot = feet[static_cast<std::size_t>(i)];
      points.row(i) = index.PointAt(foot.Triangle, foot.Second, foot.Third);
      visit(i, foot);
    }
  }

  void MakeNormals()
  {
    const auto count = static_cast<Eigen::Index>(this->Whole.Triangles().size());
    this->Normals.resize(count, 3);
    for (Eigen::Index t = 0; t < count; ++t)
    {
      const auto corner = [&](int k)
      { return Eigen::Map<const Eigen::Vector3d>(this->Whole.Corner(static_cast<int>(t), k)); };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      this->Normals.row(t) = normal.normalized();
    }
  }

  /// An index a face, with the points that it has; none of a single face.
  void DivideFaces()
  {
    if (this->FaceCount < 2)
    {
      return;
    }
    this->TrianglesOf.resize(At(this->FaceCount));
    for (std::size_t t = 0; t < this->Regions.size(); ++t)
    {
      this->TrianglesOf[At(this->Regions[t])].push_back(static_cast<int>(t));
    }
    std::vector<int> number(static_cast<std::size_t>(this->Whole.Points().rows()), -1);
    for (const std::vector<int>& triangles : this->TrianglesOf)
    {
      std::vector<int> points;
      std::vector<MeshTriangle> own;
      for (const int t : triangles)
      {
        MeshTriangle& triangle = own.emplace_back(this->Whole.Triangles()[At(t)]);
        for (int& corner : triangle)
        {
          if (number[At(corner)] < 0)
          {
            number[At(corner)] = static_cast<int>(points.size());
            points.push_back(corner);
          }
          corner = number[At(corner)];
        }
      }
      PointMatrix places(static_cast<Eigen::Index>(points.size()), 3);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        places.row(static_cast<Eigen::Index>(i)) = this->Whole.Points().row(points[i]);
        number[At(points[i])] = -1;
      }
      this->Parts.emplace_back(std::move(places), std::move(own));
    }
  }

  std::vector<TriangleIndex<3>> CurveIndex; ///< of straight pieces, as triangles without area
  TriangleIndex<3> Whole;
  std::vector<int> Regions;                  ///< of every triangle
  PointMatrix Normals;                       ///< of every triangle
  std::vector<TriangleIndex<3>> Parts;       ///< a face
  std::vector<std::vector<int>> TrianglesOf; ///< a face: numbers of its triangles
};
}

Result<FitTargetPtr> MakeMeshTarget(const TriangleMesh& mesh, const MeshFeatureParams& params)
{
  const std::vector<MeshComponent> components = ConnectedComponents(mesh);
  if (components.empty())
  {
    return { ErrorCode::EmptyInput, "the target has no triangles" };
  }
  std::vector<SurfacePart> parts;
  for (const MeshComponent& component : components)
  {
    SurfacePart& part = parts.emplace_back();
    auto surface = CheckComponent(mesh, component);
    if (!surface)
    {
      return surface.Status;
    }
    part.Surface = std::move(surface.Value);
    auto features = FindMeshFeatures(part.Surface, params);
    if (!features)
    {
      return features.Status;
    }
    part.Features = std::move(features.Value);
  }
  return FitTargetPtr(std::make_shared<MeshTarget>(std::move(parts)));
}
}
