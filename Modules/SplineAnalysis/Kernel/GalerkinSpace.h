// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/MultiPatch.h>

#include <map>
#include <string>

namespace knotwork
{
/// Functions on elements that fill a part of the plane or of space, with the map that carries them:
/// what splines of every family and Lagrange elements are to Galerkin's method. On an element the
/// functions are products of its extraction operator with the Bernstein polynomials of its shape,
/// divided by their weighted sum when rational; the same functions make the geometry.
/// @source  Borden et al., IJNME 87 (2011) 15-47.
struct GalerkinSpace
{
  int Dimension = 0;       ///< of elements and of points: 2 or 3
  PointMatrix Points;      ///< a row a function: its control point or node
  Eigen::VectorXd Weights; ///< positive; size 0 when polynomial
  std::vector<CellShape> Shapes;
  std::vector<CellDegree> Degrees;
  std::vector<int> Patches; ///< that each element is of; 0 where there are none
  bool IsNodal = false;     ///< elements of a mesh: functions are 1 at a node of their own
  /// What messages call the elements, cells of a dataset perhaps; empty: their numbers.
  std::vector<long long> Labels;
  /// Bit s of an element: its side s lies inside the parameter domain of its patch, where
  /// neighbours of other levels may meet it in part. 0 where there is no domain.
  std::vector<unsigned> InnerSides;
  /// Bit s of an element: all functions are C^1 across its side s, which lies inside that domain.
  /// Known of tensor-product and THB patches; 0 elsewhere.
  std::vector<unsigned> SmoothSides;
  /// In that domain; empty boxes where there is none.
  std::vector<ParametricBox<3>> Boxes;
  std::vector<std::size_t> FirstFunction{ 0 }; ///< NumElements + 1 offsets into Functions
  std::vector<int> Functions;                  ///< alive on the elements
  /// Offset of each element's operator in OperatorData, a row a function, a column a Bernstein
  /// polynomial; equal operators are stored once.
  std::vector<std::size_t> Operators;
  std::vector<double> OperatorData;
  /// Of one tensor-product patch, whose functions and elements keep their numbers, the first
  /// direction fastest: one a direction. Else empty.
  std::vector<KnotVector> Knots;

  int NumFunctions() const { return static_cast<int>(this->Points.rows()); }
  int NumElements() const { return static_cast<int>(this->Shapes.size()); }
  int NumAlive(int element) const
  {
    const auto e = static_cast<std::size_t>(element);
    return static_cast<int>(this->FirstFunction[e + 1] - this->FirstFunction[e]);
  }
  long long Label(int element) const
  {
    return this->Labels.empty() ? element : this->Labels[static_cast<std::size_t>(element)];
  }
  const int* Alive(int element) const
  {
    return this->Functions.data() + this->FirstFunction[static_cast<std::size_t>(element)];
  }
  const double* Operator(int element) const
  {
    return this->OperatorData.data() + this->Operators[static_cast<std::size_t>(element)];
  }
};

/// Puts elements into a space, one after the other; operators of equal bits are kept once.
class GalerkinSpaceBuilder
{
public:
  explicit GalerkinSpaceBuilder(GalerkinSpace& space) : Space(space) {}
  /// @param matrix  an element's operator, a row a function. @return its place in OperatorData.
  std::size_t Keep(const PointMatrix& matrix);
  /// @param sides  as GalerkinSpace::InnerSides and SmoothSides. @param functions  alive ones.
  /// @param place  of the element's operator.
  void Add(CellShape shape, const CellDegree& degree, int patch,
    const std::array<unsigned, 2>& sides, const ParametricBox<3>& box,
    const std::vector<int>& functions, std::size_t place);

private:
  GalerkinSpace& Space;
  std::map<std::string, std::size_t> Known;
};

/// The space of a spline: elements and functions keep their numbers. @param spline  of at least Dim
/// components; those behind are dropped when they are 0.
/// @return Spline::Check's codes; DimensionMismatch for a surface that is not in the plane z = 0.
/// @complexity O(elements (p+1)^(2 Dim)).
template <int Dim>
Result<GalerkinSpace> MakeGalerkinSpace(const Spline<Dim>& spline);

/// The space of several patches, C^0 across the interfaces of the topology: functions of both sides
/// that lie on each other are one. Elements are those of the patches in order.
/// @return the codes of the first; InvalidTopology for an interface that is partial, whose sides do
/// not have the same functions, control points and weights, or of a patch that is neither a
/// tensor-product nor a THB one.
template <int Dim>
Result<GalerkinSpace> MakeGalerkinSpace(const MultiPatch<Dim>& patches);

/// A mesh of Lagrange elements: triangles, quadrilaterals, tetrahedra or hexahedra, straight or
/// curved, any of them of degree 1 to 9.
struct LagrangeMesh
{
  PointMatrix Nodes; ///< n x 2 or 3
  std::vector<CellShape> Shapes;
  std::vector<int> Orders; ///< one an element
  /// Nodes of all elements, each in the order of CellCoefficient, evenly spaced in the parameters.
  std::vector<int> NodeIds;
};
/// The space of a mesh: functions are 1 at their node and 0 at the others.
/// @return EmptyInput; SizeMismatch; NonFiniteInput; InvalidDegree; InvalidTopology for a node id
/// out of range; DimensionMismatch for a shape of another dimension, and for wedges and curves.
Result<GalerkinSpace> MakeGalerkinSpace(const LagrangeMesh& mesh);

/// The elements' geometry in Bernstein form, for certificates and measures.
BernsteinCells MakeBernsteinCells(const GalerkinSpace& space);

/// Sides of an element. Tensor-product shapes: as in PatchSides.h; Triangle: u = 0, v = 0, u + v =
/// 1; Tetrahedron: u = 0, v = 0, w = 0, u + v + w = 1.
int NumElementSides(CellShape shape);
/// Corners of a side, as lattice indices of CellCoefficient.
std::vector<std::array<int, 3>> SideCorners(CellShape shape, const CellDegree& degree, int side);

/// Sides of elements that no other element has, ascending, of any space: sides inside a patch's
/// domain are inner ones, also where elements of several levels meet there.
/// @return InvalidTopology for a side of three elements.
/// @complexity O(n log n) for n sides of elements.
Result<std::vector<CellSide>> BoundaryFacets(const GalerkinSpace& space);

/// Facets on a side of a patch with a parameter domain, in the element numbers of the patch.
/// @return DimensionMismatch for a family without a domain; InvalidParameter for the side.
template <int Dim>
Result<std::vector<CellSide>> FacetsOfSide(const SplineSpace<Dim>& space, int side);
}
