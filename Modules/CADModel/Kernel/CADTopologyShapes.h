// SPDX-License-Identifier: BSD-3-Clause
// OpenCASCADE's shapes behind CADTopology.
#pragma once
#include "CADTopology.h"
#include "CompositeChart.h"

#include <Eigen/Geometry>

#include <BRepAdaptor_Curve.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
inline Eigen::Vector3d ToEigen(const gp_Pnt& point)
{
  return { point.X(), point.Y(), point.Z() };
}

inline Eigen::Vector3d ToEigen(const gp_Vec& vector)
{
  return { vector.X(), vector.Y(), vector.Z() };
}

/// An edge's curve with its length, asked for by share of it.
class MeasuredCurve
{
public:
  explicit MeasuredCurve(const TopoDS_Edge& edge)
    : Curve(edge), First(Curve.FirstParameter()), Last(Curve.LastParameter()),
      Length(GCPnts_AbscissaPoint::Length(Curve))
  {
  }

  double ParameterAt(double share) const
  {
    if (share <= 0.0 || share >= 1.0)
    {
      return share <= 0.0 ? this->First : this->Last;
    }
    const double guess = this->First + share * (this->Last - this->First);
    if (this->Curve.GetType() == GeomAbs_Line || this->Curve.GetType() == GeomAbs_Circle)
    {
      return guess;
    }
    const GCPnts_AbscissaPoint found(this->Curve, share * this->Length, this->First, guess);
    return found.IsDone() ? std::clamp(found.Parameter(), this->First, this->Last) : guess;
  }
  Eigen::Vector3d PointAt(double share) const
  {
    return ToEigen(this->Curve.Value(this->ParameterAt(share)));
  }
  double Turning() const
  {
    constexpr int Places = 64;
    double turning = 0.0;
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int i = 0; i <= Places; ++i)
    {
      gp_Pnt point;
      gp_Vec tangent;
      this->Curve.D1(this->First + (this->Last - this->First) * i / Places, point, tangent);
      const Eigen::Vector3d now = ToEigen(tangent);
      if (i > 0 && now.norm() > 0.0 && before.norm() > 0.0)
      {
        turning += std::atan2(before.cross(now).norm(), before.dot(now));
      }
      before = now;
    }
    return turning;
  }

  BRepAdaptor_Curve Curve;
  double First;
  double Last;
  double Length;
};

/// The use of an edge by a face in its own parameters.
struct UseShape
{
  TopoDS_Edge Edge; ///< as the face has it
  Handle(Geom2d_Curve) Curve;
  double First = 0.0;
  double Last = 1.0;
  bool Backward = false;                  ///< the loop runs against the curve
  std::shared_ptr<MeasuredCurve> Measure; ///< of the same edge; none at a pole
};

struct JoinedFaces;

struct TopologyFaceShape
{
  TopoDS_Face Face;
  Handle(Geom_Surface) Surface;
  std::shared_ptr<GeomAdaptor_Surface> Adaptor;
  std::vector<std::vector<UseShape>> Loops;
  double Size = 0.0;                         ///< of its box
  std::shared_ptr<const JoinedFaces> Joined; ///< a composite's; Face and Surface are none then
};

/// Parameters of a composite where an edge of its outline runs.
struct OutlineUse
{
  std::vector<double> Shares; ///< of the edge's length, from where the loop enters it; from 0 to 1
  std::vector<Eigen::Vector2d> Places;
};

/// Faces that are one.
struct JoinedFaces
{
  CompositeChart Chart;
  std::vector<TopologyFaceShape> Faces;
  std::vector<bool> Reversed; ///< of CADTopologyFace, of every face
  std::vector<std::vector<OutlineUse>> Loops;
};

struct CADTopology::Shapes
{
  std::vector<std::shared_ptr<MeasuredCurve>> Edges;
  std::vector<TopologyFaceShape> Faces;
  // for merging
  std::vector<std::vector<int>> BodiesOfEdges;
  std::vector<double> VertexTolerances;
  double Tolerance = 0.0;
  NCollection_DataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> VertexIds;
  NCollection_DataMap<TopoDS_Shape, std::pair<int, bool>, TopTools_ShapeMapHasher>
    EdgeIds; ///< and whether the edge runs against the one that counts
  std::map<std::vector<int>, std::vector<int>> FacesOfEdges;

  int AddVertex(const TopoDS_Vertex& vertex, CADTopology& model);
  std::pair<int, bool> AddEdge(const TopoDS_Edge& edge, int body, CADTopology& model);
  std::pair<int, bool> FindEqual(
    const MeasuredCurve& curve, const std::array<int, 2>& vertices, int body, CADTopology& model);
  Status AddFace(
    const TopoDS_Face& face, int id, int body, const std::string& name, CADTopology& model);
  bool IsSameFace(const TopoDS_Face& face, const TopologyFaceShape& other) const;
  /// Pairs of solids, the lower first. May throw OpenCASCADE's exceptions.
  std::set<std::array<int, 2>> FindContacts(const CADTopology& model) const;
};
}
