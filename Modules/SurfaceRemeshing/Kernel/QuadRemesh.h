// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <functional>
#include <vector>

namespace knotwork
{
/// Faces of a program, as they come.
struct PolygonMesh
{
  PointMatrix Points; ///< n x 3
  std::vector<std::vector<int>> Faces;
};

/// How a program is asked for quadrilaterals.
struct QuadRequest
{
  int Faces = 2000;
  bool KeepSharp = true;
};

/// Makes quadrilaterals of the triangles of one closed surface, whatever program does it. Nothing
/// of what it returns is believed.
/// @return NotConverged: this request failed, another one may not; TooLarge: it took too long or
/// too much memory, after two of these a part is given up; any other failure ends the search.
using QuadMaker =
  std::function<Result<PolygonMesh>(const TriangleMesh& mesh, const QuadRequest& request)>;

/// Where quadrilaterals come from.
enum class QuadWay
{
  Automatic, ///< from the program; of parts where that fails, from the triangles
  Program,
  Triangles ///< collapsed, then each divided at its middle into three; the program is not asked
};

struct QuadRemeshParams
{
  int Faces =
    2000; ///< wanted of all parts together, [8, 1000000]; shared by areas, 100 a part at least
  bool KeepSharp = true; ///< sharp edges are to be kept where that gives quadrilaterals that hold
  /// Farthest that the result may be from the input, and the input from the result, share of the
  /// diagonal of the input's box, ]0, 1].
  double Limit = 0.05;
  int Smoothing = 10; ///< times that points move on the input at most, [0, 1000]
  QuadWay Way = QuadWay::Automatic;
  ProgressCallback Progress;
};

/// A request and what came of it.
struct QuadTry
{
  int Part = 0;
  QuadRequest Request;
  bool OfTriangles = false; ///< divided; else the program was asked
  std::string Refusal;      ///< empty: the answer was taken
};

struct QuadRemesh
{
  PointMatrix Points;
  std::vector<std::array<int, 4>> Quads;  ///< counterclockwise as the triangles are
  std::vector<int> PartIds;               ///< of quadrilaterals
  std::vector<double> ScaledJacobians;    ///< the same: smallest sine of their angles
  std::vector<QuadTry> Tries;             ///< of all parts
  int Parts = 0;                          ///< closed surfaces
  int DividedParts = 0;                   ///< of these: made by dividing triangles
  int LooseParts = 0;                     ///< beside these, left out: QuadriFlow leaves small balls
  int EulerNumber = 0;                    ///< points - edges + quadrilaterals
  int ExtraordinaryPoints = 0;            ///< where other than four quadrilaterals meet
  double LeastScaledJacobian = 1.0;       ///< of all quadrilaterals
  double LeastScaledJacobianBefore = 1.0; ///< before points moved
  double DistanceFromInput = 0.0;         ///< farthest that the result is from the input
  double DistanceToInput = 0.0;           ///< farthest that the input is from the result
  double Diagonal = 0.0;                  ///< of the input's box
  double Volume = 0.0;                    ///< that the quadrilaterals enclose
  double InputVolume = 0.0;               ///< that the triangles enclose
};

/// Quadrilaterals on closed triangles by a program that may fail, crash, or say that it succeeded
/// when it did not. Every part is asked for alone, scaled so that its shortest edge is at least
/// 0.002 long, in three sizes, with sharp edges kept and without, until an answer holds: all faces
/// quadrilaterals that have areas, no edge of other than two of them, which run it oppositely,
/// points of one fan, one part of the Euler number of the triangles, turned as these are, within
/// Limit both ways. Distances are those of the quadrilaterals' halves, bounds above the largest
/// distance by at most 2e-3 of the diagonal. Points then move on the triangles to raise the
/// smallest scaled Jacobians, not where the result is sharp, nor where that loses distance.
/// A part of which no answer holds is made of its triangles, which always has the topology: edges
/// are collapsed until a third of Faces is left (then twice, four and eight times as many, where
/// that does not hold, or triangles meet that did not before), and every triangle is divided at its
/// middle into three quadrilaterals.
/// @return EmptyInput; NonFiniteInput; InvalidTopology: triangles that are no closed manifold;
/// InvalidParameter; TooLarge; NotConverged: with the refusal of every try; Aborted; failures of
/// the maker.
/// @complexity that of the maker, and O(n log n)
Result<QuadRemesh> RemeshToQuads(
  const TriangleMesh& mesh, const QuadMaker& maker, const QuadRemeshParams& params = {});
}
