// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrid.h"

#include <knotwork/SplineCore/LatticeInterpolation.h>
#include <knotwork/SplineGrid/BezierCells.h>
#include <knotwork/SplineGrid/HigherOrderCells.h>
#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkFieldData.h"
#include "vtkGenericCell.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
constexpr const char* NodeNumbers = "NodeNumber";
constexpr const char* ElementNumbers = "ElementNumber";
constexpr const char* PhysicalGroup = "PhysicalGroup";
constexpr const char* GeometricEntity = "GeometricEntity";
constexpr const char* GroupNames = "PhysicalGroupNames";
constexpr const char* GroupIds = "PhysicalGroupIds";

struct CellRow
{
  int Type;
  ElementShape Shape;
  int Degree; ///< 0: by the number of points
  bool IsComplete;
};

// VTK's cells; of two for one kind of element the first is what is made
constexpr CellRow CellRows[] = { { VTK_LINE, ElementShape::Segment, 1, true },
  { VTK_QUADRATIC_EDGE, ElementShape::Segment, 2, true },
  { VTK_TRIANGLE, ElementShape::Triangle, 1, true },
  { VTK_QUADRATIC_TRIANGLE, ElementShape::Triangle, 2, true },
  { VTK_QUAD, ElementShape::Quadrilateral, 1, true },
  { VTK_BIQUADRATIC_QUAD, ElementShape::Quadrilateral, 2, true },
  { VTK_QUADRATIC_QUAD, ElementShape::Quadrilateral, 2, false },
  { VTK_TETRA, ElementShape::Tetrahedron, 1, true },
  { VTK_QUADRATIC_TETRA, ElementShape::Tetrahedron, 2, true },
  { VTK_HEXAHEDRON, ElementShape::Hexahedron, 1, true },
  { VTK_TRIQUADRATIC_HEXAHEDRON, ElementShape::Hexahedron, 2, true },
  { VTK_QUADRATIC_HEXAHEDRON, ElementShape::Hexahedron, 2, false },
  { VTK_WEDGE, ElementShape::Wedge, 1, true },
  { VTK_BIQUADRATIC_QUADRATIC_WEDGE, ElementShape::Wedge, 2, true },
  { VTK_QUADRATIC_WEDGE, ElementShape::Wedge, 2, false },
  { VTK_PYRAMID, ElementShape::Pyramid, 1, true },
  { VTK_QUADRATIC_PYRAMID, ElementShape::Pyramid, 2, false },
  { VTK_LAGRANGE_CURVE, ElementShape::Segment, 0, true },
  { VTK_LAGRANGE_TRIANGLE, ElementShape::Triangle, 0, true },
  { VTK_LAGRANGE_QUADRILATERAL, ElementShape::Quadrilateral, 0, true },
  { VTK_LAGRANGE_TETRAHEDRON, ElementShape::Tetrahedron, 0, true },
  { VTK_LAGRANGE_HEXAHEDRON, ElementShape::Hexahedron, 0, true } };

int CellTypeOf(const ElementKind& kind)
{
  for (const CellRow& row : CellRows)
  {
    const bool fits = row.Degree == kind.Degree || (row.Degree == 0 && kind.Degree > 2);
    if (row.Shape == kind.Shape && row.IsComplete == kind.IsComplete && fits)
    {
      return row.Type;
    }
  }
  return VTK_EMPTY_CELL;
}

/// Places of the points of a cell, from the parameters that the cell's own class gives them.
std::vector<std::array<int, 3>> PlacesOf(int type, vtkIdType numPoints, int degree)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  std::vector<vtkIdType> ids;
  for (vtkIdType i = 0; i < numPoints; ++i)
  {
    ids.push_back(points->InsertNextPoint(static_cast<double>(i), 0.0, 0.0));
  }
  grid->SetPoints(points);
  grid->Allocate(1);
  grid->InsertNextCell(type, numPoints, ids.data());
  vtkNew<vtkGenericCell> cell;
  grid->GetCell(0, cell);
  const double* parameters = cell->GetParametricCoords();
  std::vector<std::array<int, 3>> places(static_cast<std::size_t>(numPoints));
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    for (std::size_t d = 0; d < 3; ++d)
    {
      places[i][d] = static_cast<int>(std::lround(parameters[3 * i + d] * degree));
    }
  }
  return places;
}

/// Where each of VTK's points stands in the order of a file; empty when one stands nowhere.
std::vector<std::size_t> OrderOf(const ElementKind& kind, int type)
{
  std::vector<std::size_t> order;
  for (const auto& place : PlacesOf(type, static_cast<vtkIdType>(kind.Places.size()), kind.Degree))
  {
    const auto found = std::find(kind.Places.begin(), kind.Places.end(), place);
    if (found == kind.Places.end())
    {
      return {};
    }
    order.push_back(static_cast<std::size_t>(found - kind.Places.begin()));
  }
  return order;
}

void AddNumbers(vtkFieldData* data, const char* name, const std::vector<std::int64_t>& numbers)
{
  const auto array = NamedArray<vtkIdTypeArray>(name, 1, static_cast<vtkIdType>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), array->GetPointer(0));
  data->AddArray(array);
}

void AddIntegers(vtkFieldData* data, const char* name, const std::vector<int>& numbers)
{
  const auto array = NamedArray<vtkIntArray>(name, 1, static_cast<vtkIdType>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), array->GetPointer(0));
  data->AddArray(array);
}

void AddGroups(const ElementMesh& mesh, vtkUnstructuredGrid* grid)
{
  std::size_t most = 1;
  for (const auto& list : mesh.GroupLists)
  {
    most = std::max(most, list.size());
  }
  const auto count = static_cast<vtkIdType>(mesh.KindOf.size());
  const auto groups = NamedArray<vtkIntArray>(PhysicalGroup, static_cast<int>(most), count);
  groups->FillValue(0);
  for (vtkIdType c = 0; c < count; ++c)
  {
    const auto& list =
      mesh.GroupLists[static_cast<std::size_t>(mesh.GroupListOf[static_cast<std::size_t>(c)])];
    for (std::size_t k = 0; k < list.size(); ++k)
    {
      groups->SetTypedComponent(c, static_cast<int>(k), list[k]);
    }
  }
  grid->GetCellData()->AddArray(groups);
  if (mesh.Groups.empty())
  {
    return;
  }
  const auto names = NamedArray<vtkStringArray>(GroupNames);
  const auto ids = NamedArray<vtkIntArray>(GroupIds, 2);
  for (const ElementGroup& group : mesh.Groups)
  {
    names->InsertNextValue(group.Name.c_str());
    ids->InsertNextTuple2(group.Dimension, group.Id);
  }
  grid->GetFieldData()->AddArray(names);
  grid->GetFieldData()->AddArray(ids);
}

Status AddSets(const ElementMesh& mesh, vtkUnstructuredGrid* grid)
{
  double bytes = 0.0;
  for (const ElementSet& set : mesh.Sets)
  {
    bytes += static_cast<double>(set.OfNodes ? mesh.NodeNumbers.size() : mesh.KindOf.size());
  }
  if (bytes > 4e9)
  {
    return { ErrorCode::TooLarge,
      "the arrays of " + std::to_string(mesh.Sets.size()) +
        " sets would take more than 4 GB; leave out sets that are not needed" };
  }
  for (const ElementSet& set : mesh.Sets)
  {
    vtkFieldData* data = set.OfNodes ? static_cast<vtkFieldData*>(grid->GetPointData())
                                     : static_cast<vtkFieldData*>(grid->GetCellData());
    const std::string name = data->HasArray(set.Name.c_str()) ? set.Name + " set" : set.Name;
    const auto array = NamedArray<vtkUnsignedCharArray>(name.c_str(), 1,
      static_cast<vtkIdType>(set.OfNodes ? mesh.NodeNumbers.size() : mesh.KindOf.size()));
    array->FillValue(0);
    for (const std::int64_t member : set.Members)
    {
      array->SetValue(member, 1);
    }
    data->AddArray(array);
  }
  return {};
}

/// Values of an array of one component, 0 where it is not there.
std::vector<std::int64_t> NumbersOf(vtkDataArray* array, vtkIdType count)
{
  std::vector<std::int64_t> numbers;
  auto* exact = vtkIdTypeArray::SafeDownCast(array); // components as doubles have 53 bits
  exact = exact && exact->GetNumberOfComponents() == 1 ? exact : nullptr;
  for (vtkIdType i = 0; array && array->GetNumberOfTuples() == count && i < count; ++i)
  {
    numbers.push_back(
      exact ? exact->GetValue(i) : static_cast<std::int64_t>(array->GetComponent(i, 0)));
  }
  return numbers;
}

/// The same, or 1, 2, ... where these are no numbers for things.
std::vector<std::int64_t> UniqueNumbersOf(vtkDataArray* array, vtkIdType count)
{
  std::vector<std::int64_t> numbers = NumbersOf(array, count);
  std::vector<std::int64_t> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  if (numbers.empty() || sorted.front() < 1 ||
    std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
  {
    numbers.resize(static_cast<std::size_t>(count));
    for (vtkIdType i = 0; i < count; ++i)
    {
      numbers[static_cast<std::size_t>(i)] = i + 1;
    }
  }
  return numbers;
}

/// Numbers that meshers give to parts of what they mesh, from 0 on, as groups with names; of each
/// dimension those of the first array that has any.
vtkSmartPointer<vtkDataArray> GroupsOfParts(vtkUnstructuredGrid* grid, ElementMesh& mesh)
{
  std::array<bool, 4> isNamed{};
  vtkSmartPointer<vtkIntArray> groups;
  for (const char* name : { "CADFaceId", "BoundaryId", "SolidId", "Region" })
  {
    vtkDataArray* parts = grid->GetCellData()->GetArray(name);
    if (!parts || parts->GetNumberOfComponents() != 1)
    {
      continue;
    }
    if (!groups)
    {
      groups = NamedArray<vtkIntArray>(PhysicalGroup);
      groups->SetNumberOfValues(grid->GetNumberOfCells());
      groups->FillValue(0); // in none
    }
    std::set<std::array<int, 2>> known; // dimension and part
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
    {
      const int dimension = grid->GetCell(c)->GetCellDimension();
      const int part = static_cast<int>(parts->GetTuple1(c));
      if (part >= 0 && !isNamed[static_cast<std::size_t>(dimension)])
      {
        groups->SetValue(c, part + 1);
        known.insert({ dimension, part });
      }
    }
    for (const auto& [dimension, part] : known)
    {
      isNamed[static_cast<std::size_t>(dimension)] = true;
      mesh.Groups.push_back(
        { std::string(name) + " " + std::to_string(part), dimension, part + 1 });
    }
  }
  return groups;
}

void ReadGroups(vtkUnstructuredGrid* grid, ElementMesh& mesh)
{
  vtkSmartPointer<vtkDataArray> groups = grid->GetCellData()->GetArray(PhysicalGroup);
  groups = groups ? groups.Get() : grid->GetCellData()->GetArray("Attribute");
  groups = groups ? groups : GroupsOfParts(grid, mesh);
  std::map<std::vector<int>, int> rows;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    std::vector<int> list;
    for (int k = 0; groups && k < groups->GetNumberOfComponents(); ++k)
    {
      if (const int group = static_cast<int>(groups->GetComponent(c, k)); group != 0)
      {
        list.push_back(group);
      }
    }
    const auto [row, isNew] = rows.emplace(list, static_cast<int>(mesh.GroupLists.size()));
    mesh.GroupListOf.push_back(row->second);
    if (isNew)
    {
      mesh.GroupLists.push_back(std::move(list));
    }
  }
  auto* names = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(GroupNames));
  vtkDataArray* ids = grid->GetFieldData()->GetArray(GroupIds);
  for (vtkIdType i = 0; names && ids && ids->GetNumberOfComponents() == 2 &&
       i < std::min(names->GetNumberOfValues(), ids->GetNumberOfTuples());
       ++i)
  {
    mesh.Groups.push_back({ names->GetValue(i), static_cast<int>(ids->GetComponent(i, 0)),
      static_cast<int>(ids->GetComponent(i, 1)) });
  }
  const auto ofNodes =
    NumbersOf(grid->GetPointData()->GetArray(PhysicalGroup), grid->GetNumberOfPoints());
  mesh.NodeGroups.assign(ofNodes.begin(), ofNodes.end());
}

/// Kinds of the cells, by type and number of points.
class KindFinder
{
public:
  explicit KindFinder(ElementMesh& mesh) : Mesh(mesh) {}

  Result<int> Find(vtkIdType cell, int type, vtkIdType numPoints)
  {
    const auto [found, isNew] = this->Rows.emplace(
      std::make_pair(type, numPoints), static_cast<int>(this->Mesh.Kinds.size()));
    if (isNew)
    {
      ElementKind kind;
      if (Status status = KindOfCell(cell, type, numPoints, kind); !status)
      {
        return status;
      }
      this->Mesh.Kinds.push_back(std::move(kind));
    }
    return found->second;
  }

private:
  static Status KindOfCell(vtkIdType cell, int type, vtkIdType numPoints, ElementKind& kind)
  {
    const auto* row = std::find_if(std::begin(CellRows), std::end(CellRows),
      [type](const CellRow& one) { return one.Type == type; });
    if (row == std::end(CellRows))
    {
      return {
        ErrorCode::InvalidTopology,
        "cell " + std::to_string(cell) + " has VTK's cell type " + std::to_string(type) +
          ", which meshes of solvers do not have; write linear, quadratic, Lagrange or Bezier cells"
      };
    }
    kind.Shape = row->Shape;
    kind.IsComplete = row->IsComplete;
    kind.Degree = row->Degree;
    for (int p = 1; row->Degree == 0 && p <= 10; ++p)
    {
      const vtkIdType n = p + 1;
      const std::map<ElementShape, vtkIdType> sizes = { { ElementShape::Segment, n },
        { ElementShape::Triangle, n * (n + 1) / 2 }, { ElementShape::Quadrilateral, n * n },
        { ElementShape::Tetrahedron, n * (n + 1) * (n + 2) / 6 },
        { ElementShape::Hexahedron, n * n * n } };
      kind.Degree = sizes.at(kind.Shape) == numPoints ? p : kind.Degree;
    }
    if (kind.Degree == 0)
    {
      return { ErrorCode::InvalidTopology,
        "cell " + std::to_string(cell) + " has " + std::to_string(numPoints) +
          " points, which is no degree of 1 to 10 in all directions; make its degrees equal" };
    }
    kind.Places = PlacesOf(type, numPoints, kind.Degree);
    return {};
  }

  ElementMesh& Mesh;
  std::map<std::pair<int, vtkIdType>, int> Rows;
};

/// VTK's Lagrange cell of the same points as a Bezier cell, or the type itself.
int NodalType(int type)
{
  const bool isBezier = type >= VTK_BEZIER_CURVE && type <= VTK_BEZIER_PYRAMID;
  return isBezier ? type - VTK_BEZIER_CURVE + VTK_LAGRANGE_CURVE : type;
}

/// Nodes of the same polynomials in the place of the coefficients of Bezier cells.
class NodesOfBezierCells
{
public:
  explicit NodesOfBezierCells(vtkUnstructuredGrid* grid, PointMatrix& points)
    : Bezier(grid), Points(points), IsSet(static_cast<std::size_t>(points.rows()), 0)
  {
  }

  /// @return InvalidTopology for rational cells, and for points that cells share where they differ.
  Status Set(vtkIdType cell, const ElementKind& kind, const vtkIdType* ids, vtkIdType size)
  {
    CellShape shape{};
    CellDegree degree{};
    switch (kind.Shape)
    {
      case ElementShape::Segment:
        shape = CellShape::Curve;
        break;
      case ElementShape::Triangle:
        shape = CellShape::Triangle;
        break;
      case ElementShape::Quadrilateral:
        shape = CellShape::Quadrilateral;
        break;
      case ElementShape::Tetrahedron:
        shape = CellShape::Tetrahedron;
        break;
      default:
        shape = CellShape::Hexahedron;
    }
    std::fill_n(degree.begin(), NumParameters(shape), kind.Degree);
    const std::vector<int> order = HigherOrderPointOrder(shape, kind.Degree);
    BernsteinCells one;
    one.NumComponents = 3;
    double* const block = one.Block(one.Add(shape, degree));
    double weight = 0.0;
    double extent = 0.0;
    for (vtkIdType i = 0; i < size; ++i)
    {
      double x[4];
      if (Status status = this->Bezier.ReadPoint("", cell, ids[i], x); !status)
      {
        return status;
      }
      weight = i == 0 ? x[3] : weight;
      if (x[3] != weight)
      {
        return { ErrorCode::InvalidTopology,
          CellName(cell) +
            " is rational, and elements of solvers are polynomials; write .vtu, or approximate it "
            "by a polynomial spline first" };
      }
      for (vtkIdType d = 0; d < 3; ++d)
      {
        block[d * size + order[static_cast<std::size_t>(i)]] = x[d];
        extent = std::max(extent, std::abs(x[d]));
      }
    }
    const auto lattice = LatticeParameters(shape, degree);
    for (vtkIdType i = 0; i < size; ++i)
    {
      Eigen::RowVector3d node;
      EvaluateCell(
        one, 0, lattice[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])], node.data());
      auto row = this->Points.row(ids[i]);
      char& isSet = this->IsSet[static_cast<std::size_t>(ids[i])];
      if (isSet && (row - node).cwiseAbs().maxCoeff() > Rounding * extent)
      {
        return { ErrorCode::InvalidTopology,
          CellName(cell) + " and one before share point " + std::to_string(ids[i]) +
            ", but not the side that it is on; give them points of their own" };
      }
      row = isSet ? Eigen::RowVector3d(row) : node;
      isSet = 1;
    }
    return {};
  }

private:
  static constexpr double Rounding = 1e-12; ///< of coordinates: of nodes from two sides
  BezierCells Bezier;
  PointMatrix& Points;
  std::vector<char> IsSet;
};

/// Whether a cell has one degree in all its directions.
bool HasOneDegree(vtkDataArray* degrees, vtkIdType cell, const ElementKind& kind)
{
  bool same = true;
  for (int d = 0; degrees && kind.Degree > 0 && d < DimensionOf(kind.Shape); ++d)
  {
    const double degree = degrees->GetComponent(cell, d);
    same = same && (degree == 0.0 || degree == kind.Degree);
  }
  return same;
}
}

Status EncodeElements(const ElementMesh& mesh, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.Points.rows());
  for (Eigen::Index row = 0; row < mesh.Points.rows(); ++row)
  {
    points->SetPoint(row, mesh.Points.row(row).data());
  }
  grid->SetPoints(points);
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> orders;
  for (const ElementKind& kind : mesh.Kinds)
  {
    types.push_back(CellTypeOf(kind));
    orders.push_back(
      kind.Shape == ElementShape::Point ? std::vector<std::size_t>() : OrderOf(kind, types.back()));
  }
  const std::size_t count = mesh.KindOf.size();
  grid->AllocateExact(static_cast<vtkIdType>(count), static_cast<vtkIdType>(mesh.Nodes.size()));
  std::vector<vtkIdType> ids;
  for (std::size_t e = 0; e < count; ++e)
  {
    const auto kind = static_cast<std::size_t>(mesh.KindOf[e]);
    ids.clear();
    for (const std::size_t place : orders[kind])
    {
      ids.push_back(mesh.Nodes[static_cast<std::size_t>(mesh.Begin[e]) + place]);
    }
    grid->InsertNextCell(types[kind], static_cast<vtkIdType>(ids.size()), ids.data());
  }
  AddNumbers(grid->GetCellData(), ElementNumbers, mesh.ElementNumbers);
  AddNumbers(grid->GetPointData(), NodeNumbers, mesh.NodeNumbers);
  if (!mesh.Entities.empty())
  {
    AddIntegers(grid->GetCellData(), GeometricEntity, mesh.Entities);
  }
  if (!mesh.NodeGroups.empty())
  {
    AddIntegers(grid->GetPointData(), PhysicalGroup, mesh.NodeGroups);
  }
  AddGroups(mesh, grid);
  return AddSets(mesh, grid);
}

Result<ElementMesh> DecodeElements(vtkUnstructuredGrid* grid)
{
  ElementMesh mesh;
  const vtkIdType count = grid->GetNumberOfCells();
  if (count == 0)
  {
    return { ErrorCode::EmptyInput, "there are no cells to write" };
  }
  KindFinder kinds(mesh);
  vtkDataArray* degrees = grid->GetCellData()->GetHigherOrderDegrees();
  for (vtkIdType c = 0; c < count; ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(c, size, ids);
    const Result<int> kind = kinds.Find(c, NodalType(grid->GetCellType(c)), size);
    if (!kind)
    {
      return kind.Status;
    }
    if (!HasOneDegree(degrees, c, mesh.Kinds[static_cast<std::size_t>(kind.Value)]))
    {
      return { ErrorCode::InvalidTopology,
        "cell " + std::to_string(c) + " has other degrees in its directions; make them equal" };
    }
    mesh.KindOf.push_back(kind.Value);
    mesh.Begin.push_back(static_cast<std::int64_t>(mesh.Nodes.size()));
    mesh.Nodes.insert(mesh.Nodes.end(), ids, ids + size);
  }
  mesh.Begin.push_back(static_cast<std::int64_t>(mesh.Nodes.size()));
  mesh.Points.resize(grid->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    grid->GetPoint(i, mesh.Points.row(i).data());
    if (!mesh.Points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput,
        "point " + std::to_string(i) + " has a coordinate that is not finite; correct it" };
    }
  }
  mesh.ElementNumbers = UniqueNumbersOf(grid->GetCellData()->GetArray(ElementNumbers), count);
  mesh.NodeNumbers =
    UniqueNumbersOf(grid->GetPointData()->GetArray(NodeNumbers), grid->GetNumberOfPoints());
  NodesOfBezierCells nodes(grid, mesh.Points);
  for (vtkIdType c = 0; c < count; ++c)
  {
    if (NodalType(grid->GetCellType(c)) != grid->GetCellType(c))
    {
      const auto cell = static_cast<std::size_t>(c);
      const ElementKind& kind = mesh.Kinds[static_cast<std::size_t>(mesh.KindOf[cell])];
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      grid->GetCellPoints(c, size, ids);
      if (Status status = nodes.Set(c, kind, ids, size); !status)
      {
        return status;
      }
    }
  }
  const auto entities = NumbersOf(grid->GetCellData()->GetArray(GeometricEntity), count);
  mesh.Entities.assign(entities.begin(), entities.end());
  ReadGroups(grid, mesh);
  return mesh;
}
}
