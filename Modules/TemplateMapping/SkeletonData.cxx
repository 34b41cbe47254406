// SPDX-License-Identifier: BSD-3-Clause
#include "SkeletonData.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
/// A patch as point ids, and the last cell that was joined to it.
struct Chain
{
  int Id = 0;
  vtkIdType LastCell = -1;
  std::vector<vtkIdType> Points;
};

double Size(vtkPolyData* data)
{
  double bounds[6];
  data->GetBounds(bounds);
  return std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], 0.0 });
}

/// PatchId of a cell as an integer.
Result<int> PatchIdOf(vtkDataArray* ids, vtkIdType cell, const std::string& name)
{
  const double value = ids->GetComponent(cell, 0);
  if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
  {
    return { ErrorCode::InvalidTopology,
      "PatchId of cell " + std::to_string(cell) + " of the " + name + " is not an integer" };
  }
  return static_cast<int>(value);
}

Result<std::vector<Chain>> JoinCells(vtkPolyData* data, const std::string& name)
{
  if (data->GetNumberOfVerts() + data->GetNumberOfPolys() + data->GetNumberOfStrips() > 0)
  {
    return { ErrorCode::InvalidTopology,
      "the " + name + " has vertices or faces; the patches of a planar skeleton are polylines" };
  }
  vtkDataArray* ids = data->GetCellData()->GetArray("PatchId");
  if (!ids && data->GetNumberOfLines() > 0)
  {
    return { ErrorCode::InvalidTopology, "the " + name + " has no cell array PatchId" };
  }
  const double joint = 1e-9 * Size(data);
  std::vector<Chain> chains;
  std::map<int, std::size_t> chainOf;
  auto cells = vtk::TakeSmartPointer(data->GetLines()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    const vtkIdType cell = cells->GetCurrentCellId();
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    cells->GetCurrentCell(count, points);
    const Result<int> id = PatchIdOf(ids, cell, name);
    if (!id)
    {
      return id.Status;
    }
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (points[i] < 0 || points[i] >= data->GetNumberOfPoints())
      {
        return { ErrorCode::InvalidTopology,
          "cell " + std::to_string(cell) + " of the " + name + " has the point id " +
            std::to_string(points[i]) + " of " + std::to_string(data->GetNumberOfPoints()) };
      }
    }
    const auto [place, isNew] = chainOf.try_emplace(id.Value, chains.size());
    if (isNew)
    {
      chains.push_back({ id.Value, cell, {} });
    }
    Chain& chain = chains[place->second];
    const vtkIdType* first = points;
    if (!chain.Points.empty() && count > 0)
    {
      std::array<double, 3> end;
      std::array<double, 3> begin;
      data->GetPoint(chain.Points.back(), end.data());
      data->GetPoint(points[0], begin.data());
      if (!(std::sqrt(vtkMath::Distance2BetweenPoints(end.data(), begin.data())) <= joint))
      {
        return { ErrorCode::InvalidTopology,
          name + " patch " + std::to_string(id.Value) + " is open: cell " + std::to_string(cell) +
            " does not begin where cell " + std::to_string(chain.LastCell) + " ends" };
      }
      ++first;
    }
    chain.Points.insert(chain.Points.end(), first, points + count);
    chain.LastCell = cell;
  }
  return chains;
}

/// A point array by name with its number of components; nullptr where there is none.
Result<vtkDataArray*> PointArray(
  vtkPolyData* data, const char* array, int components, const std::string& name)
{
  vtkDataArray* found = data->GetPointData()->GetArray(array);
  if (found && found->GetNumberOfComponents() != components)
  {
    return { ErrorCode::SizeMismatch,
      std::string(array) + " of the " + name + " has " +
        std::to_string(found->GetNumberOfComponents()) + " components, not " +
        std::to_string(components) };
  }
  return found;
}

/// Rows of an array at the chain's points, the first columns of each.
PointMatrix Rows(vtkDataArray* array, const std::vector<vtkIdType>& ids, int columns)
{
  PointMatrix rows(array ? static_cast<Eigen::Index>(ids.size()) : 0, columns);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    for (int c = 0; c < columns; ++c)
    {
      rows(i, c) = array->GetComponent(ids[static_cast<std::size_t>(i)], c);
    }
  }
  return rows;
}

/// The plane is z = 0: of points to 1e-9 of the size, of unit normals to 1e-6.
Status CheckPlane(
  const Chain& chain, vtkDataArray* array, double tolerance, const std::string& what)
{
  for (std::size_t i = 0; array && i < chain.Points.size(); ++i)
  {
    const double z = array->GetComponent(chain.Points[i], 2);
    const std::string place = what + " " + std::to_string(i);
    if (!std::isfinite(z))
    {
      return { ErrorCode::NonFiniteInput, place };
    }
    if (std::abs(z) > tolerance)
    {
      return { ErrorCode::DimensionMismatch,
        place + " has z = " + std::to_string(z) + "; skeletons lie in the plane z = 0" };
    }
  }
  return {};
}
}

Result<Skeleton<2>> DecodeSkeleton(vtkPolyData* data, const char* name)
{
  Result<std::vector<Chain>> chains = JoinCells(data, name);
  if (!chains)
  {
    return chains.Status;
  }
  const Result<vtkDataArray*> parameters = PointArray(data, "Parameter", 1, name);
  const Result<vtkDataArray*> normals = PointArray(data, "Normals", 3, name);
  for (const Status& status : { parameters.Status, normals.Status })
  {
    if (!status)
    {
      return status;
    }
  }
  Skeleton<2> skeleton;
  for (const Chain& chain : chains.Value)
  {
    const std::string patch = std::string(name) + " patch " + std::to_string(chain.Id) + ", ";
    vtkDataArray* points = chain.Points.empty() ? nullptr : data->GetPoints()->GetData();
    if (Status status = CheckPlane(chain, points, 1e-9 * Size(data), patch + "point"); !status)
    {
      return status;
    }
    if (Status status = CheckPlane(chain, normals.Value, 1e-6, patch + "normal"); !status)
    {
      return status;
    }
    skeleton.push_back({ chain.Id, Rows(points, chain.Points, 2),
      Rows(parameters.Value, chain.Points, 1), Rows(normals.Value, chain.Points, 2), {} });
  }
  return skeleton;
}

void EncodeMappedSkeleton(const std::vector<MappedSkeletonPatch>& patches, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> cellIds;
  vtkNew<vtkIntArray> pointIds;
  vtkNew<vtkDoubleArray> parameters;
  vtkNew<vtkDoubleArray> distances;
  cellIds->SetName("PatchId");
  pointIds->SetName("PatchId");
  parameters->SetName("Parameter");
  distances->SetName("Distance");
  for (const MappedSkeletonPatch& patch : patches)
  {
    lines->InsertNextCell(static_cast<int>(patch.Points.rows()));
    cellIds->InsertNextValue(patch.Id);
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
    {
      lines->InsertCellPoint(points->InsertNextPoint(patch.Points(i, 0), patch.Points(i, 1), 0.0));
      pointIds->InsertNextValue(patch.Id);
      parameters->InsertNextValue(patch.Places(i, 0));
      distances->InsertNextValue(patch.Distances(i));
    }
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetCellData()->AddArray(cellIds);
  output->GetPointData()->AddArray(pointIds);
  output->GetPointData()->AddArray(parameters);
  output->GetPointData()->AddArray(distances);
  output->GetPointData()->SetActiveScalars("Distance");
}

void EncodeConvergence(const std::vector<TemplateMapIteration>& history, vtkTable* table)
{
  vtkNew<vtkIntArray> iterations;
  vtkNew<vtkDoubleArray> squared;
  vtkNew<vtkDoubleArray> largest;
  vtkNew<vtkDoubleArray> negative;
  vtkNew<vtkIntArray> functions;
  vtkNew<vtkDoubleArray> seconds;
  iterations->SetName("Iteration");
  squared->SetName("SquaredL2Error");
  largest->SetName("MaxError");
  negative->SetName("NegativeJacobianPercent");
  functions->SetName("Functions");
  seconds->SetName("Seconds");
  for (const TemplateMapIteration& row : history)
  {
    iterations->InsertNextValue(row.Iteration);
    squared->InsertNextValue(row.SquaredError);
    largest->InsertNextValue(row.MaxError);
    negative->InsertNextValue(100.0 * row.NegativeShare);
    functions->InsertNextValue(row.Functions);
    seconds->InsertNextValue(row.Seconds);
  }
  for (vtkDataArray* column : std::initializer_list<vtkDataArray*>{
         iterations, squared, largest, negative, functions, seconds })
  {
    table->AddColumn(column);
  }
}
}
