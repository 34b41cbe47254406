// SPDX-License-Identifier: BSD-3-Clause
#include "GalerkinSpace.h"

#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/FunctionInfo.h>
#include <knotwork/SplineCore/LatticeInterpolation.h>

#include <algorithm>
#include <map>
#include <string>

namespace knotwork
{
namespace
{
/// As GalerkinSpace::InnerSides.
template <int Dim>
unsigned InnerSidesOf(const SplineSpace<Dim>& space, int element)
{
  unsigned inner = 0;
  for (int side = 0; space.HasDomain() && side < 2 * Dim; ++side)
  {
    const auto& box = space.Elements[static_cast<std::size_t>(element)].Box;
    inner |= SideValue(box, side) != SideValue(space.Domain(), side) ? 1U << side : 0U;
  }
  return inner;
}

/// As GalerkinSpace::SmoothSides.
template <int Dim>
unsigned SmoothSidesOf(const SplineSpace<Dim>& space, int element, unsigned inner)
{
  unsigned smooth = 0;
  const auto& own = space.Elements[static_cast<std::size_t>(element)];
  const bool knows = space.Kind == SpaceKind::Tensor || space.Kind == SpaceKind::Hierarchical;
  for (int side = 0; knows && side < 2 * Dim; ++side)
  {
    const std::size_t d = AcrossSide(side);
    const std::vector<double>& breaks = space.Knots[d].Breaks();
    const double value = SideValue(own.Box, side);
    const auto found = std::lower_bound(breaks.begin(), breaks.end(), value);
    // knots of finer levels are simple
    const int multiplicity = found != breaks.end() && *found == value
      ? space.Knots[d].Multiplicity(static_cast<int>(found - breaks.begin()))
      : 1;
    smooth |= own.Degree[d] > multiplicity ? inner & 1U << side : 0U;
  }
  return smooth;
}

/// Where the operators of a patch's elements are kept. Those of elements whose local functions are
/// the alive ones, in their order, follow from the factors of the directions, which the space keeps
/// once: they are made once.
template <int Dim>
class OperatorPlaces
{
public:
  OperatorPlaces(const SplineSpace<Dim>& space, GalerkinSpaceBuilder& builder)
    : Space(space), Builder(builder)
  {
  }

  std::size_t At(int element, const std::vector<int>& alive)
  {
    const IntArray<Dim>& degree = this->Space.Elements[static_cast<std::size_t>(element)].Degree;
    const int* local = this->Space.LocalFunctions(element);
    if (!this->Space.IsIdentityMap() ||
      !std::equal(alive.begin(), alive.end(), local, local + NumTensorFunctions<Dim>(degree)))
    {
      return this->Builder.Keep(this->Space.ExtractionOperator(element));
    }
    const Factors factors{ degree, this->Space.Factors(element) };
    const auto known = this->Known.find(factors);
    return known != this->Known.end()
      ? known->second
      : this->Known.emplace(factors, this->Builder.Keep(this->Space.ExtractionOperator(element)))
          .first->second;
  }

private:
  using Factors = std::pair<IntArray<Dim>, std::array<const double*, Dim>>;
  const SplineSpace<Dim>& Space;
  GalerkinSpaceBuilder& Builder;
  std::map<Factors, std::size_t> Known;
};

template <int Dim>
void AddPatch(const Spline<Dim>& spline, int patch, const std::vector<int>& numbers,
  GalerkinSpace& space, GalerkinSpaceBuilder& builder)
{
  OperatorPlaces<Dim> places(*spline.Space, builder);
  for (int e = 0; e < spline.Space->NumElements(); ++e)
  {
    const IntArray<Dim>& p = spline.Space->Elements[static_cast<std::size_t>(e)].Degree;
    CellDegree degree{};
    std::copy(p.begin(), p.end(), degree.begin());
    std::vector<int> functions = spline.Space->AliveFunctions(e);
    const std::size_t place = places.At(e, functions);
    for (int& f : functions)
    {
      f = numbers[static_cast<std::size_t>(f)];
    }
    ParametricBox<3> box;
    if (spline.Space->HasDomain())
    {
      const auto& own = spline.Space->Elements[static_cast<std::size_t>(e)].Box;
      std::copy(own.Lower.begin(), own.Lower.end(), box.Lower.begin());
      std::copy(own.Upper.begin(), own.Upper.end(), box.Upper.begin());
    }
    const unsigned inner = InnerSidesOf(*spline.Space, e);
    builder.Add(Dim == 2 ? CellShape::Quadrilateral : CellShape::Hexahedron, degree, patch,
      { inner, SmoothSidesOf(*spline.Space, e, inner) }, box, functions, place);
  }
  for (int f = 0; f < spline.Space->NumFunctions; ++f)
  {
    const int to = numbers[static_cast<std::size_t>(f)];
    space.Points.row(to) = spline.ControlPoints.row(f).leftCols(Dim);
    if (space.Weights.size() > 0)
    {
      space.Weights[to] = spline.IsRational() ? spline.Weights[f] : 1.0;
    }
  }
}

template <int Dim>
Status CheckPatch(const Spline<Dim>& spline, int patch)
{
  const std::string place = "patch " + std::to_string(patch) + ": ";
  if (!spline.Space || spline.Space->NumElements() == 0)
  {
    return { ErrorCode::EmptyInput, place + "it has no elements; give a spline" };
  }
  if (const Status status = spline.Check(); !status)
  {
    return { status.Code, place + status.Detail };
  }
  if (spline.NumComponents() < Dim ||
    !spline.ControlPoints.rightCols(spline.NumComponents() - Dim).isZero(0.0))
  {
    return { ErrorCode::DimensionMismatch,
      place + "it does not fill a part of the " +
        (Dim == 2 ? "plane z = 0; give a planar surface" : "space; give a volume") };
  }
  return {};
}

/// Level and place on a side of a function that is not 0 there; the place is that on the first side
/// of an interface.
using TraceIndex = std::array<std::int64_t, 3>;

/// Functions of a tensor-product or THB patch that are not 0 on a side: those of the row along it
/// of every level. @param orientation  how the side lies on the first one; null: it is the first.
template <int Dim>
std::map<TraceIndex, int> SideTrace(
  const SplineSpace<Dim>& space, int side, const SideOrientation* orientation)
{
  const auto directions = SideDirections<Dim>(side);
  // every element is halved by a simple knot, which makes one function more
  const auto countOf = [&space](std::size_t d, int level) -> std::int64_t
  {
    return space.Knots[d].NumFunctions() +
      std::int64_t{ space.Knots[d].NumElements() } * ((std::int64_t{ 1 } << level) - 1);
  };
  std::map<TraceIndex, int> trace;
  const auto functions = DescribeFunctions(space);
  for (std::size_t f = 0; f < functions.size(); ++f)
  {
    const int level = functions[f].Level;
    const auto& index = functions[f].Index;
    const std::size_t across = AcrossSide(side);
    if (index[across] != (side % 2 == 0 ? 0 : countOf(across, level) - 1))
    {
      continue;
    }
    std::array<std::int64_t, 2> place{};
    std::array<std::int64_t, 2> count{ 1, 1 };
    for (std::size_t k = 0; k < directions.size(); ++k)
    {
      place[k] = index[directions[k]];
      count[k] = countOf(directions[k], level);
    }
    place = orientation ? orientation->OtherPoint(place, count) : place;
    trace[{ level, place[0], place[1] }] = static_cast<int>(f);
  }
  return trace;
}

/// Functions of both sides of an interface become one.
template <int Dim>
Status Unite(const MultiPatch<Dim>& patches, const PatchInterface& interface,
  const std::vector<int>& first, DisjointSets& sets)
{
  const std::array<PatchSide, 2>& sides = interface.Sides;
  const std::string place = "sides " + std::to_string(sides[0].Side) + " of patch " +
    std::to_string(sides[0].Patch) + " and " + std::to_string(sides[1].Side) + " of patch " +
    std::to_string(sides[1].Patch);
  std::array<std::map<TraceIndex, int>, 2> traces;
  for (std::size_t k = 0; k < 2; ++k)
  {
    const SplineSpace<Dim>& space =
      *patches.Patches[static_cast<std::size_t>(sides[k].Patch)].Space;
    if (interface.Partial ||
      (space.Kind != SpaceKind::Tensor && space.Kind != SpaceKind::Hierarchical))
    {
      return { ErrorCode::InvalidTopology,
        place + " do not meet as whole sides of tensor-product or THB patches; join them by hand" };
    }
    traces[k] = SideTrace(space, sides[k].Side, k == 0 ? nullptr : &interface.Orientation);
  }
  const auto isPartner = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (!std::equal(
        traces[0].begin(), traces[0].end(), traces[1].begin(), traces[1].end(), isPartner))
  {
    return { ErrorCode::InvalidTopology,
      place + " have other functions; refine both in the same way" };
  }
  const Spline<Dim>& onto = patches.Patches[static_cast<std::size_t>(sides[0].Patch)];
  const Spline<Dim>& from = patches.Patches[static_cast<std::size_t>(sides[1].Patch)];
  const double size = onto.ControlPoints.cwiseAbs().maxCoeff();
  for (auto a = traces[0].begin(), b = traces[1].begin(); a != traces[0].end(); ++a, ++b)
  {
    const double weightA = onto.IsRational() ? onto.Weights[a->second] : 1.0;
    const double weightB = from.IsRational() ? from.Weights[b->second] : 1.0;
    if ((onto.ControlPoints.row(a->second) - from.ControlPoints.row(b->second)).norm() >
        1e-9 * size ||
      std::abs(weightA - weightB) > 1e-9 * weightA)
    {
      return { ErrorCode::InvalidTopology,
        place + " have other control points or weights; stitch them" };
    }
    sets.Unite(first[static_cast<std::size_t>(sides[0].Patch)] + a->second,
      first[static_cast<std::size_t>(sides[1].Patch)] + b->second);
  }
  return {};
}
}

std::size_t GalerkinSpaceBuilder::Keep(const PointMatrix& matrix)
{
  const auto size = static_cast<std::size_t>(matrix.size());
  const std::string key(reinterpret_cast<const char*>(matrix.data()), size * sizeof(double));
  const auto place = this->Known.emplace(key, this->Space.OperatorData.size());
  if (place.second)
  {
    this->Space.OperatorData.insert(
      this->Space.OperatorData.end(), matrix.data(), matrix.data() + size);
  }
  return place.first->second;
}

void GalerkinSpaceBuilder::Add(CellShape shape, const CellDegree& degree, int patch,
  const std::array<unsigned, 2>& sides, const ParametricBox<3>& box,
  const std::vector<int>& functions, std::size_t place)
{
  this->Space.Shapes.push_back(shape);
  this->Space.Degrees.push_back(degree);
  this->Space.Patches.push_back(patch);
  this->Space.InnerSides.push_back(sides[0]);
  this->Space.SmoothSides.push_back(sides[1]);
  this->Space.Boxes.push_back(box);
  this->Space.Functions.insert(this->Space.Functions.end(), functions.begin(), functions.end());
  this->Space.FirstFunction.push_back(this->Space.Functions.size());
  this->Space.Operators.push_back(place);
}

template <int Dim>
Result<GalerkinSpace> MakeGalerkinSpace(const Spline<Dim>& spline)
{
  MultiPatch<Dim> patches;
  patches.Patches.push_back(spline);
  return MakeGalerkinSpace(patches);
}

template <int Dim>
Result<GalerkinSpace> MakeGalerkinSpace(const MultiPatch<Dim>& patches)
{
  if (patches.Patches.empty())
  {
    return { ErrorCode::EmptyInput, "there are no patches; give one at least" };
  }
  if (const Status status =
        CheckTopology(patches.Topology, static_cast<int>(patches.Patches.size()), Dim);
      !status)
  {
    return status;
  }
  std::vector<int> first{ 0 };
  bool rational = false;
  for (std::size_t i = 0; i < patches.Patches.size(); ++i)
  {
    if (const Status status = CheckPatch(patches.Patches[i], static_cast<int>(i)); !status)
    {
      return status;
    }
    first.push_back(first.back() + patches.Patches[i].Space->NumFunctions);
    rational = rational || patches.Patches[i].IsRational();
  }
  DisjointSets sets(first.back());
  for (const PatchInterface& interface : patches.Topology.Interfaces)
  {
    if (const Status status = Unite(patches, interface, first, sets); !status)
    {
      return status;
    }
  }
  std::vector<int> number(static_cast<std::size_t>(first.back()));
  int count = 0;
  for (int f = 0; f < first.back(); ++f)
  {
    const int root = sets.Find(f);
    number[static_cast<std::size_t>(f)] =
      root == f ? count++ : number[static_cast<std::size_t>(root)];
  }
  GalerkinSpace space;
  space.Dimension = Dim;
  if (const SplineSpace<Dim>& only = *patches.Patches[0].Space;
      patches.Patches.size() == 1 && only.Kind == SpaceKind::Tensor && count == first.back())
  {
    space.Knots.assign(only.Knots.begin(), only.Knots.end());
  }
  space.Points.setZero(count, Dim);
  space.Weights.setOnes(rational ? count : 0);
  GalerkinSpaceBuilder builder(space);
  for (std::size_t i = 0; i < patches.Patches.size(); ++i)
  {
    const std::vector<int> own(number.begin() + first[i], number.begin() + first[i + 1]);
    AddPatch(patches.Patches[i], static_cast<int>(i), own, space, builder);
  }
  return space;
}

Result<GalerkinSpace> MakeGalerkinSpace(const LagrangeMesh& mesh)
{
  if (mesh.Shapes.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no elements; give one at least" };
  }
  if (mesh.Orders.size() != mesh.Shapes.size())
  {
    return { ErrorCode::SizeMismatch, "there must be one order an element" };
  }
  if (!mesh.Nodes.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "a node has a coordinate that is no number; mend it" };
  }
  GalerkinSpace space;
  space.Dimension = NumParameters(mesh.Shapes[0]);
  space.Points = mesh.Nodes;
  space.IsNodal = true;
  GalerkinSpaceBuilder builder(space);
  std::map<std::pair<CellShape, int>, PointMatrix> operators;
  std::size_t next = 0;
  for (std::size_t e = 0; e < mesh.Shapes.size(); ++e)
  {
    const std::string place = "element " + std::to_string(e) + ": ";
    const CellShape shape = mesh.Shapes[e];
    const int p = mesh.Orders[e];
    if (shape == CellShape::Wedge || NumParameters(shape) != space.Dimension ||
      space.Dimension < 2 || mesh.Nodes.cols() != space.Dimension)
    {
      return { ErrorCode::DimensionMismatch,
        place +
          "elements must be triangles and quadrilaterals of nodes with 2 coordinates, or "
          "tetrahedra and hexahedra of nodes with 3" };
    }
    if (p < 1 || p > MaxDegree)
    {
      return { ErrorCode::InvalidDegree, place + "its order must be in [1, 9]" };
    }
    const CellDegree degree{ p, p, space.Dimension == 3 ? p : 0 };
    const auto size = static_cast<std::size_t>(NumCellCoefficients(shape, degree));
    if (next + size > mesh.NodeIds.size())
    {
      return { ErrorCode::SizeMismatch, place + "node ids are missing" };
    }
    std::vector<int> nodes(mesh.NodeIds.begin() + static_cast<std::ptrdiff_t>(next),
      mesh.NodeIds.begin() + static_cast<std::ptrdiff_t>(next + size));
    next += size;
    for (const int node : nodes)
    {
      if (node < 0 || node >= mesh.Nodes.rows())
      {
        return { ErrorCode::InvalidTopology,
          place + "node " + std::to_string(node) + " does not exist" };
      }
    }
    PointMatrix& matrix = operators[{ shape, p }];
    if (matrix.size() == 0)
    {
      const auto n = static_cast<Eigen::Index>(size);
      matrix = LatticeInterpolation(shape, degree)
                 .Coefficients(LongMatrix::Identity(n, n))
                 .cast<double>()
                 .transpose();
    }
    builder.Add(shape, degree, 0, {}, {}, nodes, builder.Keep(matrix));
  }
  return space;
}

BernsteinCells MakeBernsteinCells(const GalerkinSpace& space)
{
  BernsteinCells cells;
  cells.NumComponents = space.Dimension;
  cells.Rational = space.Weights.size() > 0;
  std::size_t values = 0;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto index = static_cast<std::size_t>(e);
    values += static_cast<std::size_t>(
      cells.NumPlanes() * NumCellCoefficients(space.Shapes[index], space.Degrees[index]));
  }
  cells.Data.reserve(values);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto index = static_cast<std::size_t>(e);
    const int cell = cells.Add(space.Shapes[index], space.Degrees[index]);
    const int n = NumCellCoefficients(space.Shapes[index], space.Degrees[index]);
    double* block = cells.Block(cell);
    for (int a = 0; a < space.NumAlive(e); ++a)
    {
      const int f = space.Alive(e)[a];
      const double weight = cells.Rational ? space.Weights[f] : 1.0;
      for (int plane = 0; plane < cells.NumPlanes(); ++plane)
      {
        const double value = plane < space.Dimension ? weight * space.Points(f, plane) : weight;
        for (int j = 0; j < n; ++j)
        {
          block[plane * n + j] += value * space.Operator(e)[a * n + j];
        }
      }
    }
  }
  return cells;
}

int NumElementSides(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Curve:
      return 2;
    case CellShape::Triangle:
      return 3;
    case CellShape::Quadrilateral:
    case CellShape::Tetrahedron:
      return 4;
    case CellShape::Wedge:
      return 5;
    case CellShape::Hexahedron:
      break;
  }
  return 6;
}

template <int Dim>
Result<std::vector<CellSide>> FacetsOfSide(const SplineSpace<Dim>& space, int side)
{
  if (!space.HasDomain())
  {
    return { ErrorCode::DimensionMismatch,
      "the space has no parameter domain and no sides; ask for its boundary facets" };
  }
  if (side < 0 || side >= 2 * Dim)
  {
    return { ErrorCode::InvalidParameter,
      "side " + std::to_string(side) + " is not in [0, " + std::to_string(2 * Dim - 1) + "]" };
  }
  const double value = SideValue(space.Domain(), side);
  std::vector<CellSide> facets;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    if (SideValue(space.Elements[static_cast<std::size_t>(e)].Box, side) == value)
    {
      facets.push_back({ e, side });
    }
  }
  return facets;
}

template Result<GalerkinSpace> MakeGalerkinSpace(const Spline<2>&);
template Result<GalerkinSpace> MakeGalerkinSpace(const Spline<3>&);
template Result<GalerkinSpace> MakeGalerkinSpace(const MultiPatch<2>&);
template Result<GalerkinSpace> MakeGalerkinSpace(const MultiPatch<3>&);
template Result<std::vector<CellSide>> FacetsOfSide(const SplineSpace<2>&, int);
template Result<std::vector<CellSide>> FacetsOfSide(const SplineSpace<3>&, int);
}
