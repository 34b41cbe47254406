// SPDX-License-Identifier: BSD-3-Clause
#include "AnalysisData.h"

#include <knotwork/JacobianValidation/CellConversion.h>
#include <knotwork/JacobianValidation/CellsFromGrid.h>
#include <knotwork/SplineGrid/BezierCells.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineBlocks.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr const char* GroupArray = "PhysicalGroup";

int DimensionOf(int cellType)
{
  const vtkSmartPointer<vtkCell> cell =
    vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(cellType));
  return cell ? cell->GetCellDimension() : 0;
}

/// Dimension of every cell.
std::vector<int> CellDimensions(vtkUnstructuredGrid* grid)
{
  std::map<int, int> known;
  std::vector<int> dimensions;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const int type = grid->GetCellType(cell);
    const auto found = known.emplace(type, -1);
    if (found.second)
    {
      found.first->second = DimensionOf(type);
    }
    dimensions.push_back(found.first->second);
  }
  return dimensions;
}

/// Cells of a dimension alone, with all points and arrays.
vtkSmartPointer<vtkUnstructuredGrid> CellsOf(
  vtkUnstructuredGrid* grid, const std::vector<vtkIdType>& cells)
{
  auto part = vtkSmartPointer<vtkUnstructuredGrid>::New();
  part->SetPoints(grid->GetPoints());
  part->GetPointData()->ShallowCopy(grid->GetPointData());
  part->GetCellData()->CopyAllOn();
  part->GetCellData()->CopyAllocate(grid->GetCellData());
  part->AllocateEstimate(static_cast<vtkIdType>(cells.size()), 8);
  vtkNew<vtkIdList> ids;
  for (const vtkIdType cell : cells)
  {
    grid->GetCellPoints(cell, ids);
    const vtkIdType at = part->InsertNextCell(grid->GetCellType(cell), ids);
    part->GetCellData()->CopyData(grid->GetCellData(), cell, at);
  }
  return part;
}

using GroupsOfCorners = std::map<std::vector<vtkIdType>, std::vector<long long>>;

/// Groups of cells of one dimension less, by their corners; ascending.
GroupsOfCorners ReadGroups(
  vtkUnstructuredGrid* grid, const std::vector<int>& dimensions, int dimension)
{
  GroupsOfCorners groups;
  vtkDataArray* array = grid->GetCellData()->GetArray(GroupArray);
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; array && cell < grid->GetNumberOfCells(); ++cell)
  {
    if (dimensions[static_cast<std::size_t>(cell)] != dimension - 1)
    {
      continue;
    }
    grid->GetCellPoints(cell, ids);
    const int count = grid->GetCell(cell)->GetNumberOfEdges();
    const int corners = dimension == 2 ? 2 : count; // a face has as many corners as edges
    std::vector<vtkIdType> key(ids->begin(), ids->begin() + corners);
    std::sort(key.begin(), key.end());
    auto& own = groups[key];
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      if (const auto group = static_cast<long long>(array->GetComponent(cell, c)); group != 0)
      {
        own.push_back(group);
      }
    }
  }
  return groups;
}

/// Names of groups of cells of a dimension.
std::map<std::string, long long> ReadGroupNames(vtkUnstructuredGrid* grid, int dimension)
{
  std::map<std::string, long long> groups;
  auto* names =
    vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("PhysicalGroupNames"));
  vtkDataArray* ids = grid->GetFieldData()->GetArray("PhysicalGroupIds");
  for (vtkIdType i = 0; names && ids && ids->GetNumberOfComponents() == 2 &&
       i < std::min(names->GetNumberOfValues(), ids->GetNumberOfTuples());
       ++i)
  {
    if (static_cast<int>(ids->GetComponent(i, 0)) == dimension)
    {
      groups[names->GetValue(i)] = static_cast<long long>(ids->GetComponent(i, 1));
    }
  }
  return groups;
}

template <int Dim>
Result<AnalysisBody> BodyOfPatches(SplineModel model)
{
  AnalysisBody body;
  const MultiPatch<Dim> patches = GluedPatches<Dim>(model);
  auto space = MakeGalerkinSpace(patches);
  if (!space)
  {
    return space.Status;
  }
  body.Space = std::move(space.Value);
  int element = 0;
  for (const Spline<Dim>& patch : patches.Patches)
  {
    std::vector<int> numbers(static_cast<std::size_t>(patch.Space->NumFunctions), -1);
    for (int e = 0; e < patch.Space->NumElements(); ++e, ++element)
    {
      const std::vector<int> own = patch.Space->AliveFunctions(e);
      for (std::size_t a = 0; a < own.size(); ++a)
      {
        numbers[static_cast<std::size_t>(own[a])] = body.Space.Alive(element)[a];
      }
    }
    body.Functions.push_back(std::move(numbers));
  }
  for (const SplinePatch& patch : model.Patches)
  {
    body.Space.Labels.insert(body.Space.Labels.end(), patch.Cells.begin(), patch.Cells.end());
  }
  if (body.Space.Labels.size() != static_cast<std::size_t>(body.Space.NumElements()))
  {
    body.Space.Labels.clear();
  }
  auto facets = BoundaryFacets(body.Space);
  if (!facets)
  {
    return facets.Status;
  }
  body.Boundary.Facets = std::move(facets.Value);
  body.Model = std::move(model);
  return body;
}

/// Corners of a facet as points of the dataset: functions that are 1 there.
std::vector<vtkIdType> FacetCorners(const AnalysisBody& body, const CellSide& facet)
{
  const auto e = static_cast<std::size_t>(facet.Cell);
  const CellShape shape = body.Space.Shapes[e];
  const CellDegree& degree = body.Space.Degrees[e];
  const int n = NumCellCoefficients(shape, degree);
  std::vector<vtkIdType> corners;
  for (const auto& place : SideCorners(shape, degree, facet.Side))
  {
    const int column = CellCoefficient(shape, degree, place[0], place[1], place[2]);
    for (int a = 0; a < body.Space.NumAlive(facet.Cell); ++a)
    {
      if (std::abs(body.Space.Operator(facet.Cell)[a * n + column] - 1.0) < 1e-9)
      {
        corners.push_back(body.Points[static_cast<std::size_t>(body.Space.Alive(facet.Cell)[a])]);
      }
    }
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}
}

template <int Dim>
MultiPatch<Dim> GluedPatches(const SplineModel& model)
{
  MultiPatch<Dim> patches;
  for (const SplinePatch& patch : model.Patches)
  {
    patches.Patches.push_back(std::get<Spline<Dim>>(patch.Geometry));
  }
  patches.Topology = model.Topology;
  if (patches.Topology.Interfaces.empty())
  {
    patches.Topology.Interfaces = FindInterfaces(patches.Patches);
  }
  return patches;
}
template MultiPatch<2> GluedPatches<2>(const SplineModel& model);
template MultiPatch<3> GluedPatches<3>(const SplineModel& model);

bool IsOfSplines(vtkDataObject* data)
{
  int largest = 0;
  bool isBezier = false;
  for (const auto& [block, grid] : GridsByBlock(data))
  {
    const std::vector<int> dimensions = CellDimensions(grid);
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    {
      const int dimension = dimensions[static_cast<std::size_t>(cell)];
      const bool own = BezierCellDimension(grid->GetCellType(cell)) == dimension;
      isBezier = dimension > largest ? own : isBezier && (own || dimension < largest);
      largest = std::max(largest, dimension);
    }
  }
  return isBezier;
}

Result<AnalysisBody> MakeBody(SplineModel model)
{
  if (model.Patches.empty())
  {
    return { ErrorCode::EmptyInput, "the input has no patches; give a surface or volume" };
  }
  const std::size_t dimension = model.Patches.front().Geometry.index();
  for (const SplinePatch& patch : model.Patches)
  {
    if (patch.Geometry.index() != dimension || dimension == 0)
    {
      return { ErrorCode::DimensionMismatch,
        "patch " + std::to_string(patch.Id) + " has " + std::to_string(patch.Geometry.index() + 1) +
          " parameter(s); give planar surfaces alone, or volumes alone" };
    }
  }
  return dimension == 1 ? BodyOfPatches<2>(std::move(model)) : BodyOfPatches<3>(std::move(model));
}

Result<AnalysisBody> MakeBody(vtkUnstructuredGrid* grid)
{
  AnalysisBody body;
  const std::vector<int> dimensions = CellDimensions(grid);
  const int dimension =
    dimensions.empty() ? 0 : *std::max_element(dimensions.begin(), dimensions.end());
  if (dimension < 2)
  {
    return { ErrorCode::EmptyInput,
      "the input has no elements; give triangles and quadrilaterals in the plane, or tetrahedra "
      "and "
      "hexahedra" };
  }
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (dimensions[static_cast<std::size_t>(cell)] == dimension)
    {
      body.Cells.push_back(cell);
    }
  }
  body.NumLeftOut = static_cast<int>(dimensions.size() - body.Cells.size());
  const auto part = CellsOf(grid, body.Cells);
  const auto read = ReadGridCells({ part });
  if (!read)
  {
    return read.Status;
  }
  const BernsteinCells& cells = read->Cells;
  if (cells.Rational)
  {
    return { ErrorCode::InvalidTopology,
      "rational simplices, or such cells among others, are not analysed; give splines alone" };
  }
  body.Space.Dimension = dimension;
  body.Space.IsNodal = true;
  body.Space.Labels.assign(body.Cells.begin(), body.Cells.end());
  GalerkinSpaceBuilder builder(body.Space);
  std::map<std::tuple<int, vtkIdType, CellDegree>, PointMatrix> operators;
  std::vector<int> numbers(static_cast<std::size_t>(grid->GetNumberOfPoints()), -1);
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < part->GetNumberOfCells(); ++i)
  {
    const auto cell = static_cast<int>(i);
    const std::string place =
      "cell " + std::to_string(body.Cells[static_cast<std::size_t>(i)]) + ": ";
    const CellShape shape = cells.Shapes[static_cast<std::size_t>(cell)];
    if (shape == CellShape::Wedge)
    {
      return { ErrorCode::InvalidTopology,
        place + "wedges are not analysed; divide them into tetrahedra" };
    }
    part->GetCellPoints(i, ids);
    const int type = part->GetCellType(i);
    if (type == VTK_PYRAMID || type == VTK_QUADRATIC_PYRAMID || type == VTK_TRIQUADRATIC_PYRAMID)
    {
      return { ErrorCode::InvalidTopology,
        place + "pyramids are not analysed; divide them into tetrahedra" };
    }
    const CellDegree degree = cells.Degrees[static_cast<std::size_t>(cell)];
    PointMatrix& matrix = operators[{ type, ids->GetNumberOfIds(), degree }];
    if (matrix.size() == 0)
    {
      const auto conversion = MakeCellConversion(type, shape, degree, ids->GetNumberOfIds());
      if (!conversion)
      {
        return { conversion.Status.Code, place + conversion.Status.Detail };
      }
      if (conversion->Points.empty())
      {
        matrix = conversion->Matrix.cast<double>().transpose();
      }
      else
      {
        const auto n = static_cast<Eigen::Index>(conversion->Points.size());
        matrix.setZero(n, n);
        for (Eigen::Index k = 0; k < n; ++k)
        {
          matrix(conversion->Points[static_cast<std::size_t>(k)], k) = 1.0;
        }
      }
    }
    std::vector<int> functions;
    for (const vtkIdType point : *ids)
    {
      int& number = numbers[static_cast<std::size_t>(point)];
      if (number < 0)
      {
        number = static_cast<int>(body.Points.size());
        body.Points.push_back(point);
      }
      functions.push_back(number);
    }
    builder.Add(shape, degree, 0, {}, {}, functions, builder.Keep(matrix));
  }
  body.Space.Points.resize(static_cast<Eigen::Index>(body.Points.size()), dimension);
  for (std::size_t i = 0; i < body.Points.size(); ++i)
  {
    double x[3];
    grid->GetPoint(body.Points[i], x);
    if (dimension == 2 && x[2] != 0.0)
    {
      return { ErrorCode::DimensionMismatch,
        "point " + std::to_string(body.Points[i]) +
          " is not in the plane z = 0; elements of surfaces in space are not analysed" };
    }
    for (int d = 0; d < dimension; ++d)
    {
      body.Space.Points(static_cast<Eigen::Index>(i), d) = x[d];
    }
  }
  auto facets = BoundaryFacets(body.Space);
  if (!facets)
  {
    return facets.Status;
  }
  body.Boundary.Facets = std::move(facets.Value);
  if (const GroupsOfCorners groups = ReadGroups(grid, dimensions, dimension); !groups.empty())
  {
    for (const CellSide& facet : body.Boundary.Facets)
    {
      const auto found = groups.find(FacetCorners(body, facet));
      body.Boundary.Groups.push_back(
        found == groups.end() ? std::vector<long long>() : found->second);
    }
    body.Boundary.Names = ReadGroupNames(grid, dimension - 1);
  }
  if (dimension == 3)
  {
    for (const auto& [corners, groups] : ReadGroups(grid, dimensions, 2))
    {
      std::array<int, 2> ends{ numbers[static_cast<std::size_t>(corners.front())],
        numbers[static_cast<std::size_t>(corners.back())] };
      std::sort(ends.begin(), ends.end());
      body.Boundary.EdgeGroups[ends] = groups;
    }
    body.Boundary.EdgeNames = ReadGroupNames(grid, 1);
  }
  return body;
}

namespace
{
void EncodeMesh(const AnalysisBody& body, const std::vector<AnalysisField>& fields,
  const std::vector<AnalysisCellField>& cellFields, vtkUnstructuredGrid* input,
  vtkUnstructuredGrid* output)
{
  output->ShallowCopy(input);
  for (const AnalysisField& field : fields)
  {
    const int columns = static_cast<int>(field.Coefficients.cols());
    const auto array =
      NamedArray<vtkDoubleArray>(field.Name.c_str(), columns, input->GetNumberOfPoints());
    array->Fill(0.0);
    for (std::size_t i = 0; i < body.Points.size(); ++i)
    {
      array->SetTuple(body.Points[i], field.Coefficients.row(static_cast<Eigen::Index>(i)).data());
    }
    output->GetPointData()->AddArray(array);
  }
  for (const AnalysisCellField& field : cellFields)
  {
    const auto array =
      NamedArray<vtkDoubleArray>(field.Name.c_str(), 1, output->GetNumberOfCells());
    array->Fill(0.0);
    for (std::size_t i = 0; i < body.Cells.size(); ++i)
    {
      array->SetValue(body.Cells[i], field.Values[static_cast<Eigen::Index>(i)]);
    }
    output->GetCellData()->AddArray(array);
  }
}
}

Status EncodeBody(AnalysisBody& body, const std::vector<AnalysisField>& fields,
  const std::vector<AnalysisCellField>& cellFields, vtkDataObject* input, vtkDataObject* output)
{
  if (body.Model.Patches.empty())
  {
    EncodeMesh(body, fields, cellFields, vtkUnstructuredGrid::SafeDownCast(input),
      vtkUnstructuredGrid::SafeDownCast(output));
    return {};
  }
  for (std::size_t p = 0; p < body.Model.Patches.size(); ++p)
  {
    SplinePatch& patch = body.Model.Patches[p];
    const std::vector<int>& functions = body.Functions[p];
    for (const AnalysisField& field : fields)
    {
      SplineField own{ field.Name,
        PointMatrix::Zero(static_cast<Eigen::Index>(functions.size()), field.Coefficients.cols()) };
      for (std::size_t f = 0; f < functions.size(); ++f)
      {
        own.Coefficients.row(static_cast<Eigen::Index>(f)) = field.Coefficients.row(functions[f]);
      }
      const auto same = std::find_if(patch.Fields.begin(), patch.Fields.end(),
        [&](const SplineField& other) { return other.Name == own.Name; });
      if (same != patch.Fields.end())
      {
        *same = std::move(own);
      }
      else
      {
        patch.Fields.push_back(std::move(own));
      }
    }
  }
  if (const Status status = EncodeSplineModel(body.Model, input, output); !status)
  {
    return status;
  }
  const auto from = GridsByBlock(input);
  for (const auto& [block, grid] : GridsByBlock(output))
  {
    std::vector<vtkIdType> sources;
    std::vector<std::size_t> rows;
    std::size_t first = 0;
    for (const SplinePatch& patch : body.Model.Patches)
    {
      const auto count = static_cast<std::size_t>(
        std::visit([](const auto& spline) { return spline.Space->NumElements(); }, patch.Geometry));
      for (std::size_t e = 0; e < count && patch.Block == block; ++e)
      {
        sources.push_back(patch.Cells.empty() ? -1 : patch.Cells[e]);
        rows.push_back(first + e);
      }
      first += count;
    }
    PassCellData(from.at(block), sources, grid);
    for (const AnalysisCellField& field : cellFields)
    {
      grid->GetCellData()->AddArray(ArrayOf<vtkDoubleArray>(field.Name.c_str(), rows,
        [&](std::size_t row) { return field.Values[static_cast<Eigen::Index>(row)]; }));
    }
  }
  return {};
}
}
