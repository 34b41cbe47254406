// SPDX-License-Identifier: BSD-3-Clause
// A trimmed face as a tree of pieces, private to FindFaceIntersections.
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/SampleIndex.h>
#include <knotwork/SplineCore/TrimmedRegion.h>

#include <Eigen/Core>

namespace knotwork
{
using Point3 = Eigen::Vector3d;

/// A rectangle of a face's parameters with the box of its control points.
struct FacePiece
{
  ParametricBox<2> Parameters;
  Point3 Lower;
  Point3 Upper;
  RegionPlace Place = RegionPlace::Boundary;
  std::array<int, 2> Begin{}; ///< elements in both directions
  std::array<int, 2> End{};
  int Children = -1; ///< first of those that are not outside; -1: not divided
  int NumChildren = 0;
  /// Of a piece within one element: homogeneous Bernstein control points, plane by plane.
  std::vector<double> Control;
  /// Of a piece within one element: a direction across it, and its extent there.
  Point3 Across = Point3::Zero();
  double Least = 0.0;
  double Most = 0.0;

  double Size() const { return (this->Upper - this->Lower).norm(); }
};

/// What all searches on a face share.
class FaceShape
{
public:
  /// @param spacing  of points on the edges.
  static Result<FaceShape> Create(const TrimmedFace& face, double spacing, int threads);

  const ParametricBox<2>& Domain() const { return this->Box; }
  const Point3& Lower() const { return this->BoxLower; }
  const Point3& Upper() const { return this->BoxUpper; }
  /// Whether anything of the surface lies inside the loops, or may.
  bool IsEmpty() const { return this->Empty; }

  FacePiece Root() const;
  /// Adds the halves that are not outside to pieces.
  void Divide(int piece, std::vector<FacePiece>& pieces) const;
  /// Control points of a piece within one element, 3 x n.
  Eigen::Matrix3Xd ControlPoints(const FacePiece& piece) const;

  /// Whether the surface over a rectangle of parameters is proved not to meet itself.
  bool IsSimple(const ParametricBox<2>& box) const;

  /// Distance of a point from the nearest of the points on the edges.
  double DistanceToEdges(const Point3& point) const;

  bool Contains(const RealArray<2>& parameters) const
  {
    return this->Region.Contains(parameters) == RegionPlace::Inside;
  }
  /// S, S_u, S_v as columns.
  Eigen::Matrix3d Evaluate(const RealArray<2>& parameters) const;

private:
  int Element(int i, int j) const { return i + j * this->Number[0]; }
  void SampleEdges(const TrimmedFace& face, double spacing, int threads);
  void SetExtent(FacePiece& piece) const;
  /// Control points of an element over a part of it, as FacePiece::Control.
  void Restrict(int element, const ParametricBox<2>& box, std::vector<double>& control) const;

  BezierForm<2> Form;
  TrimmedRegion Region;
  ParametricBox<2> Box;
  std::array<int, 2> Number{};
  std::array<std::vector<double>, 2> Breaks;
  Eigen::Matrix3Xd ElementLower;
  Eigen::Matrix3Xd ElementUpper;
  std::vector<RegionPlace> ElementPlaces;
  Point3 BoxLower;
  Point3 BoxUpper;
  bool Empty = true;
  SampleIndex Edges;
};
}
