// SPDX-License-Identifier: BSD-3-Clause
#include "SkeletonData.h"

#include "BezierSkeleton.h"
#include "SkeletonCells.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
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

double Size(vtkDataSet* data)
{
  double bounds[6];
  data->GetBounds(bounds);
  return std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], 0.0 });
}

Result<std::vector<Chain>> JoinCells(
  vtkDataSet* data, const SkeletonCells& cells, const std::string& name)
{
  const double joint = 1e-9 * Size(data);
  std::vector<Chain> chains;
  std::map<int, std::size_t> chainOf;
  for (vtkIdType cell = 0; cell < cells.Count(); ++cell)
  {
    const vtkIdType* points = cells.Points(cell);
    const vtkIdType count = cells.NumPoints(cell);
    const int id = cells.PatchId(cell);
    const auto [place, isNew] = chainOf.try_emplace(id, chains.size());
    if (isNew)
    {
      chains.push_back({ id, cell, {} });
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
          name + " patch " + std::to_string(id) + " is open: cell " + std::to_string(cell) +
            " does not begin where cell " + std::to_string(chain.LastCell) + " ends" };
      }
      ++first;
    }
    chain.Points.insert(chain.Points.end(), first, points + count);
    chain.LastCell = cell;
  }
  return chains;
}

/// The corners of a polygon.
PointMatrix Corners(vtkDataSet* data, const SkeletonCells& cells, vtkIdType cell)
{
  PointMatrix corners(cells.NumPoints(cell), 3);
  for (Eigen::Index k = 0; k < corners.rows(); ++k)
  {
    data->GetPoint(cells.Points(cell)[k], corners.row(k).data());
  }
  return corners;
}

/// Whether the triangles from corner 0 make up a polygon: seen along its mean normal (Newell's), it
/// turns one way only, and no corner is off its mean plane by more than a tenth of its size.
bool IsFan(const PointMatrix& corners)
{
  using Row = Eigen::RowVector3d;
  const Eigen::Index n = corners.rows();
  const Row middle = corners.colwise().mean();
  const auto corner = [&](Eigen::Index k) -> Row { return corners.row(k % n) - middle; };
  Row normal = Row::Zero();
  double ofTriangles = 0.0;
  for (Eigen::Index k = 0; k < n; ++k)
  {
    normal += corner(k).cross(corner(k + 1));
    ofTriangles += (corner(k) - corner(0)).cross(corner(k + 1) - corner(0)).norm();
  }
  const double size = (corners.colwise().maxCoeff() - corners.colwise().minCoeff()).norm();
  const double area = normal.norm();
  if (!std::isfinite(ofTriangles) || ofTriangles <= 1e-12 * size * size)
  {
    return true; // not finite: found later; no area: triangles without area do no harm
  }
  if (area < 0.5 * ofTriangles)
  {
    return false;
  }
  normal /= area;
  const double rounding = -1e-9 * size * size;
  for (Eigen::Index k = 0; k < n; ++k)
  {
    const Row side = corner(k + 1) - corner(k);
    const Row next = corner(k + 2) - corner(k + 1);
    const Row fromFirst = corner(k) - corner(0);
    if (side.cross(next).dot(normal) < rounding || fromFirst.cross(side).dot(normal) < rounding ||
      std::abs(corner(k).dot(normal)) > 0.1 * size)
    {
      return false;
    }
  }
  return true;
}

/// Triangles of a patch as point ids of the dataset.
struct Faces
{
  int Id = 0;
  std::vector<std::array<vtkIdType, 3>> Triangles;
};

Result<std::vector<Faces>> SplitCells(
  vtkDataSet* data, const SkeletonCells& cells, const std::string& name)
{
  std::vector<Faces> patches;
  std::map<int, std::size_t> patchOf;
  for (vtkIdType cell = 0; cell < cells.Count(); ++cell)
  {
    const int id = cells.PatchId(cell);
    const auto [place, isNew] = patchOf.try_emplace(id, patches.size());
    if (isNew)
    {
      patches.push_back({ id, {} });
    }
    std::vector<std::array<vtkIdType, 3>>& triangles = patches[place->second].Triangles;
    const vtkIdType* p = cells.Points(cell);
    const vtkIdType n = cells.NumPoints(cell);
    const auto fault = [&](const std::string& what)
    {
      return Status{ ErrorCode::InvalidTopology,
        name + " patch " + std::to_string(id) + ": cell " + std::to_string(cell) + " " + what };
    };
    if (n < 3)
    {
      return fault("has " + std::to_string(n) + " points; a face needs at least 3");
    }
    if (cells.Kind(cell) == SkeletonCellKind::TriangleStrip)
    {
      for (vtkIdType k = 0; k + 2 < n; ++k)
      {
        const std::array<vtkIdType, 3> t{ p[k + k % 2], p[k + 1 - k % 2], p[k + 2] };
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) // others only lead the strip on
        {
          triangles.push_back(t);
        }
      }
      continue;
    }
    std::vector<vtkIdType> sorted(p, p + n);
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    {
      return fault("has a corner twice; remove it (vtkCleanPolyData)");
    }
    if (n > 3 && !IsFan(Corners(data, cells, cell)))
    {
      return fault("is a polygon of " + std::to_string(n) +
        " corners that is not flat and convex; cut it into triangles (vtkTriangleFilter)");
    }
    for (vtkIdType k = 1; k + 1 < n; ++k)
    {
      triangles.push_back({ p[0], p[k], p[k + 1] });
    }
  }
  return patches;
}

/// A point array by name with its number of components; nullptr where there is none.
Result<vtkDataArray*> PointArray(
  vtkDataSet* data, const char* array, int components, const std::string& name)
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

vtkDataArray* PointsOf(vtkDataSet* data)
{
  return vtkPointSet::SafeDownCast(data)->GetPoints()->GetData();
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
        place + " has z = " + std::to_string(z) +
          "; curves lie in the plane z = 0, skeletons in space are faces" };
    }
  }
  return {};
}

Result<Skeleton<2>> DecodePolylines(
  vtkDataSet* data, const SkeletonCells& cells, const std::string& name)
{
  Result<std::vector<Chain>> chains = JoinCells(data, cells, name);
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
    const std::string patch = name + " patch " + std::to_string(chain.Id) + ", ";
    vtkDataArray* points = chain.Points.empty() ? nullptr : PointsOf(data);
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

Result<Skeleton<3>> DecodeFaces(
  vtkDataSet* data, const SkeletonCells& cells, const std::string& name)
{
  const Result<std::vector<Faces>> patches = SplitCells(data, cells, name);
  if (!patches)
  {
    return patches.Status;
  }
  const Result<vtkDataArray*> parameters = PointArray(data, "Parameter", 2, name);
  const Result<vtkDataArray*> normals = PointArray(data, "Normals", 3, name);
  for (const Status& status : { parameters.Status, normals.Status })
  {
    if (!status)
    {
      return status;
    }
  }
  Skeleton<3> skeleton;
  for (const Faces& faces : patches.Value)
  {
    std::vector<vtkIdType> ids;
    for (const auto& triangle : faces.Triangles)
    {
      ids.insert(ids.end(), triangle.begin(), triangle.end());
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const auto local = [&](vtkIdType point)
    { return static_cast<int>(std::lower_bound(ids.begin(), ids.end(), point) - ids.begin()); };
    SkeletonPatch<3> patch{ faces.Id, Rows(PointsOf(data), ids, 3), Rows(parameters.Value, ids, 2),
      Rows(normals.Value, ids, 3), {} };
    for (const auto& [a, b, c] : faces.Triangles)
    {
      patch.Simplices.push_back({ local(a), local(b), local(c) });
    }
    skeleton.push_back(std::move(patch));
  }
  return skeleton;
}

/// "curves" or "faces".
std::string CellsOf(int dimension)
{
  return dimension == 2 ? "curves" : "faces";
}
}

Result<int> SkeletonDimension(vtkDataSet* templateData, vtkDataSet* target)
{
  const Result<SkeletonCells> first = SkeletonCells::Read(templateData, "template");
  const Result<SkeletonCells> second = SkeletonCells::Read(target, "target");
  for (const Status& status : { first.Status, second.Status })
  {
    if (!status)
    {
      return status;
    }
  }
  const int one = first.Value.Dimension();
  const int other = second.Value.Dimension();
  if (one > 0 && other > 0 && one != other)
  {
    return { ErrorCode::InvalidTopology,
      "the template consists of " + CellsOf(one) + ", the target of " + CellsOf(other) +
        ": both must be curves of the plane or both faces in space" };
  }
  return std::max(one, other);
}

template <int Dim>
Result<Skeleton<Dim>> DecodeSkeleton(
  vtkDataSet* data, const char* name, int samples, std::vector<std::string>* warnings)
{
  Result<SkeletonCells> cells = SkeletonCells::Read(data, name);
  if (!cells)
  {
    return cells.Status;
  }
  if (cells.Value.Count() == 0)
  {
    return Skeleton<Dim>{};
  }
  if (cells.Value.Dimension() != Dim)
  {
    return { ErrorCode::InvalidTopology,
      std::string("the ") + name + " has " + CellsOf(cells.Value.Dimension()) +
        "; the patches of a skeleton " + (Dim == 2 ? "of the plane are " : "in space are ") +
        CellsOf(Dim) };
  }
  if (Status status = cells->ReadPatchIds(data, name); !status)
  {
    return status;
  }
  if (cells.Value.IsBezier())
  {
    return DecodeBezierSkeleton<Dim>(
      vtkUnstructuredGrid::SafeDownCast(data), cells.Value, name, samples, warnings);
  }
  if constexpr (Dim == 2)
  {
    return DecodePolylines(data, cells.Value, name);
  }
  else
  {
    return DecodeFaces(data, cells.Value, name);
  }
}

template Result<Skeleton<2>> DecodeSkeleton<2>(
  vtkDataSet*, const char*, int, std::vector<std::string>*);
template Result<Skeleton<3>> DecodeSkeleton<3>(
  vtkDataSet*, const char*, int, std::vector<std::string>*);

void EncodeMappedSkeleton(const std::vector<MappedSkeletonPatch>& patches, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkCellArray> triangles;
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
    const vtkIdType first = points->GetNumberOfPoints();
    const bool planar = patch.Points.cols() == 2;
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
    {
      points->InsertNextPoint(
        patch.Points(i, 0), patch.Points(i, 1), planar ? 0.0 : patch.Points(i, 2));
      pointIds->InsertNextValue(patch.Id);
      distances->InsertNextValue(patch.Distances(i));
      if (planar)
      {
        parameters->InsertNextValue(patch.Places(i, 0));
      }
    }
    if (planar)
    {
      lines->InsertNextCell(static_cast<int>(patch.Points.rows()));
      cellIds->InsertNextValue(patch.Id);
      for (vtkIdType i = first; i < points->GetNumberOfPoints(); ++i)
      {
        lines->InsertCellPoint(i);
      }
    }
    for (const std::array<int, 3>& t : patch.Triangles)
    {
      triangles->InsertNextCell({ first + t[0], first + t[1], first + t[2] });
      cellIds->InsertNextValue(patch.Id);
    }
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->SetPolys(triangles);
  output->GetCellData()->AddArray(cellIds);
  output->GetPointData()->AddArray(pointIds);
  if (parameters->GetNumberOfTuples() > 0)
  {
    output->GetPointData()->AddArray(parameters);
  }
  output->GetPointData()->AddArray(distances);
  output->GetPointData()->SetActiveScalars("Distance");
}
void EncodeConvergence(const std::vector<TemplateMapIteration>& history, vtkTable* table)
{
  vtkNew<vtkIntArray> iterations;
  vtkNew<vtkDoubleArray> squared;
  vtkNew<vtkDoubleArray> largest;
  vtkNew<vtkDoubleArray> negative;
  vtkNew<vtkDoubleArray> lengths;
  vtkNew<vtkIntArray> held;
  vtkNew<vtkIntArray> functions;
  iterations->SetName("Iteration");
  squared->SetName("SquaredL2Error");
  largest->SetName("MaxError");
  negative->SetName("NegativeJacobianPercent");
  lengths->SetName("StepLength");
  held->SetName("HeldElements");
  functions->SetName("Functions");
  for (const TemplateMapIteration& row : history)
  {
    iterations->InsertNextValue(row.Iteration);
    squared->InsertNextValue(row.SquaredError);
    largest->InsertNextValue(row.MaxError);
    negative->InsertNextValue(100.0 * row.NegativeShare);
    lengths->InsertNextValue(row.StepLength);
    held->InsertNextValue(row.HeldElements);
    functions->InsertNextValue(row.Functions);
  }
  for (vtkDataArray* column : std::initializer_list<vtkDataArray*>{
         iterations, squared, largest, negative, lengths, held, functions })
  {
    table->AddColumn(column);
  }
}
}
