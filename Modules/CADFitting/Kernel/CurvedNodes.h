// SPDX-License-Identifier: BSD-3-Clause
// Points of elements, where they belong and where they are, private to the kernel.
#pragma once
#include "NodeLattice.h"

namespace knotwork
{
/// Where points belong, and how far they have come there from where they were without a target.
class CurvedNodes
{
public:
  /// @param corners  of the straight elements.
  /// @param bezier  elements are certified as their control points, rounded, make them; else as the
  /// points do that they pass through.
  CurvedNodes(const NodeLattice& lattice, const PointMatrix& corners, bool bezier);

  /// Straight positions of points of edges: between where the ends are placed.
  Eigen::RowVector3d EdgeBase(int edge, int k) const;
  /// What the edges of a face make of its points within, in their order.
  PointMatrix FaceBase(int face) const;
  /// Points within a face, in the same order.
  std::vector<int> InsideFace(int face) const;
  /// Moves a point; those of edges after their ends, those of faces after their edges.
  /// @param base  of the point: where it was without a target.
  void Place(int node, const Eigen::RowVector3d& base, const Eigen::RowVector3d& at);
  /// A point that is to stay with those around it on the boundary.
  void Hold(int node) { this->Held[static_cast<std::size_t>(node)] = 1; }

  const PointMatrix& Positions() const { return this->At; }
  /// Control points of the elements, as many.
  /// @param errors  what every number of a point may be off by.
  PointMatrix ControlPoints(Eigen::VectorXd& errors) const;
  /// The positions, or control points.
  PointMatrix Output() const;

  /// Certifies all elements. Around those that are not valid, and those of volumes whose least det
  /// J is below a twentieth of the straight element's, points inside follow those that were placed,
  /// then move to better shapes, if that leaves fewer of them; then points of these move back until
  /// there are none, and those that did without need come forward again.
  /// @param elements  of the lattice. @param relaxed  one an element: whether one of its points is
  /// not where it was placed.
  /// @return NotConverged with a straight element that is not valid; the errors of
  /// ValidateJacobian; Aborted.
  Result<JacobianCertificate> Relax(const StraightElements& elements, int threads,
    const ProgressCallback& progress, std::vector<char>& relaxed);

  BernsteinCells MakeCells(const std::vector<int>& which) const;
  /// Points inside that were moved.
  int NumFollowing() const;

private:
  /// Visits points with their bases, those that bases are made of first.
  template <class Visit>
  void ForBases(Visit&& visit);
  Result<JacobianCertificate> Certify(const std::vector<int>& which, int threads) const;
  std::vector<int> FoldedOf(
    const std::vector<int>& which, const JacobianCertificate& certificate) const;
  /// Points of elements around some that only these have and that are not held.
  std::vector<char> FreeInside(const std::vector<int>& region) const;
  /// @param folded  elements; gets those that remain. @param all  gets certificates.
  Status LetInsideFollow(int threads, std::vector<int>& folded, JacobianCertificate& all);
  Status Untangle(int threads, const ProgressCallback& progress, std::vector<int>& folded,
    JacobianCertificate& all);
  /// Moves free points, if that leaves fewer folded elements.
  Status TryPositions(const PointMatrix& wanted, const std::vector<char>& isFree, int threads,
    std::vector<int>& folded, JacobianCertificate& all);
  std::vector<int> MovedSince(const PointMatrix& old) const;
  void Update();
  /// @return false when all its points are where they are without a target.
  bool MoveBack(int element);
  /// Puts points that moved back where they were placed, one in a neighbourhood at a time, as far
  /// as the elements around stay accepted. @param all  gets certificates.
  Status ComeForward(int threads, const ProgressCallback& progress, JacobianCertificate& all);
  bool IsAccepted(int element, const CellCertificate& certificate) const;

  const NodeLattice& Lattice;
  bool Bezier;
  bool InPlane; ///< surfaces in a plane x, y or z = const
  PointMatrix Corners;
  PointMatrix At;
  PointMatrix Offsets; ///< of placed points from their bases
  std::vector<char> Placed;
  std::vector<char> Held;     ///< on the boundary, placed or not
  std::vector<double> Shares; ///< of the offsets that are taken
  /// Of elements of volumes: least det J that is accepted.
  std::vector<double> Least;
};
}
