// SPDX-License-Identifier: BSD-3-Clause
#include "CellMeshData.h"

#include "InputChecks.h"
#include "MeshVertices.h"
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/Numbers.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
int DimensionOf(int type)
{
  switch (type)
  {
    case VTK_QUAD:
    case VTK_PIXEL:
    case VTK_POLYGON:
    case VTK_TRIANGLE:
      return 2;
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
      return 3;
    default:
      return 0;
  }
}

/// Corners in the order around a polygon, or of a hexahedron as CellMesh numbers them.
void OrderCorners(int type, std::vector<int>& corners)
{
  if (type == VTK_PIXEL)
  {
    std::swap(corners[2], corners[3]);
  }
  else if (type == VTK_HEXAHEDRON)
  {
    std::swap(corners[2], corners[3]);
    std::swap(corners[6], corners[7]);
  }
}

std::string NameOfCell(vtkIdType cell, int type)
{
  return "cell " + std::to_string(cell) + " is a " + vtkCellTypes::GetClassNameFromTypeId(type);
}

/// Corners of Bezier cells that tell which vertices of a mesh they are.
class CornerTable
{
public:
  explicit CornerTable(vtkPointSet* data)
    : Data(data), Vertices(data->GetCellData()->GetArray(name::MeshVertices))
  {
  }

  /// The linear cell with the corners of a Bezier cell; other types stay.
  int LinearType(int type) const
  {
    switch (this->Vertices ? type : VTK_EMPTY_CELL)
    {
      case VTK_BEZIER_TRIANGLE:
        return VTK_TRIANGLE;
      case VTK_BEZIER_QUADRILATERAL:
        return VTK_QUAD;
      case VTK_BEZIER_HEXAHEDRON:
        return VTK_HEXAHEDRON;
      case VTK_BEZIER_CURVE: // the others are refused by these names
        return VTK_LINE;
      case VTK_BEZIER_TETRAHEDRON:
        return VTK_TETRA;
      case VTK_BEZIER_WEDGE:
        return VTK_WEDGE;
      default:
        return type;
    }
  }

  bool IsMeant(vtkIdType cell) const
  {
    const int type = this->Data->GetCellType(cell);
    return this->LinearType(type) != type;
  }

  /// Replaces the points of a Bezier cell by the vertices at its corners.
  Status Take(vtkIdType cell, int type, std::vector<int>& points)
  {
    const std::size_t count = type == VTK_TRIANGLE ? 3 : type == VTK_QUAD ? 4 : 8;
    if (points.size() < count || this->Vertices->GetNumberOfComponents() < static_cast<int>(count))
    {
      return { ErrorCode::InvalidTopology,
        CellText(cell) + " has fewer than " + std::to_string(count) +
          " corners; read the mesh again" };
    }
    points.resize(count);
    for (std::size_t k = 0; k < count; ++k)
    {
      const double vertex = this->Vertices->GetComponent(cell, static_cast<int>(k));
      if (!(vertex >= 0.0 && vertex < std::numeric_limits<int>::max()))
      {
        return { ErrorCode::InvalidTopology,
          CellText(cell) + " has no vertex at corner " + std::to_string(k) + " (cell array " +
            name::MeshVertices + "); read the mesh again" };
      }
      const int number = static_cast<int>(vertex);
      const vtkIdType point = points[k];
      const auto [known, isNew] = this->Points.emplace(number, point);
      if (!isNew && !this->AreNear(known->second, point))
      {
        return { ErrorCode::InvalidTopology,
          CellText(cell) + " has vertex " + std::to_string(number) + " at " + this->Place(point) +
            ", another cell has it at " + this->Place(known->second) +
            ": a smooth spline needs one place a vertex, which a mesh that is periodic in the "
            "plane does not have; cut it open, or bend it so that both places are one" };
      }
      points[k] = number;
    }
    return {};
  }

  /// Numbers the vertices that cells have from 0, in their order.
  /// @return the point of each.
  std::vector<vtkIdType> Renumber(
    std::vector<std::vector<int>>& polygons, std::vector<int>& hexahedra) const
  {
    std::vector<vtkIdType> points;
    std::map<int, int> numbers;
    for (const auto& [vertex, point] : this->Points)
    {
      numbers.emplace_hint(numbers.end(), vertex, static_cast<int>(points.size()));
      points.push_back(point);
    }
    const auto renumber = [&numbers](std::vector<int>& corners)
    {
      for (int& corner : corners)
      {
        corner = numbers.at(corner);
      }
    };
    std::for_each(polygons.begin(), polygons.end(), renumber);
    renumber(hexahedra);
    return points;
  }

private:
  static std::string CellText(vtkIdType cell) { return "cell " + std::to_string(cell); }

  bool AreNear(vtkIdType one, vtkIdType other) const
  {
    constexpr double Rounded = 1e-6; // files have eight digits, of each of both
    double a[3];
    double b[3];
    this->Data->GetPoint(one, a);
    this->Data->GetPoint(other, b);
    const double tolerance = Rounded * this->Data->GetLength();
    return one == other ||
      (std::abs(a[0] - b[0]) <= tolerance && std::abs(a[1] - b[1]) <= tolerance &&
        std::abs(a[2] - b[2]) <= tolerance);
  }

  std::string Place(vtkIdType point) const
  {
    double at[3];
    this->Data->GetPoint(point, at);
    return PointText(at, 3);
  }

  vtkPointSet* Data;
  vtkDataArray* Vertices;
  std::map<int, vtkIdType> Points; ///< of every vertex
};

/// Columns of coordinates and of the floating-point arrays, which are named.
void TakePoints(vtkPointSet* data, DecodedMeshCells& decoded)
{
  std::vector<vtkDataArray*> arrays;
  vtkPointData* pointData = data->GetPointData();
  Eigen::Index columns = 3;
  for (int a = 0; a < pointData->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = pointData->GetArray(a);
    if (array && array->GetName() &&
      (array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT))
    {
      arrays.push_back(array);
      decoded.Fields.push_back(
        { array->GetName(), PointMatrix(0, array->GetNumberOfComponents()) });
      columns += array->GetNumberOfComponents();
    }
  }
  const bool isOwn = decoded.Vertices.empty();
  const auto count =
    isOwn ? data->GetNumberOfPoints() : static_cast<vtkIdType>(decoded.Vertices.size());
  decoded.Points.resize(count, columns);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const vtkIdType point = isOwn ? i : decoded.Vertices[static_cast<std::size_t>(i)];
    double* row = decoded.Points.row(i).data();
    data->GetPoint(point, row);
    row += 3;
    for (vtkDataArray* array : arrays)
    {
      array->GetTuple(point, row);
      row += array->GetNumberOfComponents();
    }
  }
}

Status CheckPoints(const DecodedMeshCells& decoded)
{
  for (Eigen::Index i = 0; i < decoded.Points.rows(); ++i)
  {
    if (!decoded.Points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput,
        "point " + std::to_string(i) +
          " or a field there is not finite (NaN or infinity); correct or remove it" };
    }
  }
  return {};
}

Status Split(const std::vector<std::vector<int>>& polygons, DecodedMeshCells& decoded)
{
  auto split = SplitAtMidpoints(static_cast<int>(decoded.Points.rows()), polygons);
  if (!split)
  {
    return split.Status;
  }
  const Eigen::Index old = decoded.Points.rows();
  decoded.Points.conservativeResize(split->Mesh.NumPoints, Eigen::NoChange);
  for (std::size_t i = 0; i < split->Means.size(); ++i)
  {
    auto row = decoded.Points.row(old + static_cast<Eigen::Index>(i));
    row.setZero();
    for (const int point : split->Means[i])
    {
      row += decoded.Points.row(point) / static_cast<double>(split->Means[i].size());
    }
  }
  decoded.Cells.assign(split->Polygon.begin(), split->Polygon.end());
  decoded.NumSplit = static_cast<int>(std::count_if(
    polygons.begin(), polygons.end(), [](const auto& polygon) { return polygon.size() != 4; }));
  decoded.Mesh = std::move(split->Mesh);
  return {};
}

/// Quadrilaterals by corners around them.
void TakeQuadrilaterals(const std::vector<std::vector<int>>& polygons, DecodedMeshCells& decoded)
{
  CellMesh<2> mesh;
  mesh.NumPoints = static_cast<int>(decoded.Points.rows());
  for (const std::vector<int>& corners : polygons)
  {
    mesh.Corners.insert(mesh.Corners.end(), { corners[0], corners[1], corners[3], corners[2] });
  }
  decoded.Mesh = std::move(mesh);
}

}

Result<DecodedMeshCells> DecodeMeshCells(vtkPointSet* data, bool split)
{
  const vtkIdType cells = data ? data->GetNumberOfCells() : 0;
  if (cells == 0)
  {
    return { ErrorCode::EmptyInput, "the mesh has no cells" };
  }
  if (std::max(cells, data->GetNumberOfPoints()) > std::numeric_limits<int>::max() / 64)
  {
    return { ErrorCode::TooLarge,
      std::to_string(cells) + " cells, " + std::to_string(data->GetNumberOfPoints()) + " points" };
  }
  Status status = CheckCellSizes(data);
  CornerTable corners(data);
  const bool isCurved = status && corners.IsMeant(0); // cells of other sizes crash VTK
  status = status && !isCurved ? CheckSampledPoints(data, "the mesh") : status;
  if (!status)
  {
    return status;
  }
  const int dimension = DimensionOf(corners.LinearType(data->GetCellType(0)));
  std::vector<std::vector<int>> polygons;
  CellMesh<3> hexahedra;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const int type = corners.LinearType(data->GetCellType(cell));
    data->GetCellPoints(cell, ids);
    std::vector<int> points(ids->begin(), ids->end());
    const bool isStray = isCurved && !corners.IsMeant(cell);
    const int taken = isStray ? 0 : DimensionOf(type);
    if (isCurved && taken != 0)
    {
      if (Status told = corners.Take(cell, type, points); !told)
      {
        return told;
      }
    }
    const bool fits = taken == 3 || points.size() == 4 || split;
    if (taken == 0 || (taken == dimension && !fits))
    {
      return { ErrorCode::InvalidTopology,
        NameOfCell(cell, type) + " of " + std::to_string(points.size()) +
          " points, the mesh must be of linear quadrilaterals or of linear hexahedra alone; " +
          (taken == 2 ? "split polygons (SplitPolygons, --split-polygons)"
                      : "remove or convert it") };
    }
    if (taken != dimension)
    {
      return { ErrorCode::InvalidTopology,
        NameOfCell(cell, type) + ", but " + NameOfCell(0, data->GetCellType(0)) +
          ": take either the surface or the volume" };
    }
    OrderCorners(type, points);
    if (dimension == 2)
    {
      polygons.push_back(std::move(points));
    }
    else
    {
      hexahedra.Corners.insert(hexahedra.Corners.end(), points.begin(), points.end());
    }
  }
  if (dimension == 3 && split)
  {
    return { ErrorCode::InvalidParameter, "polygons can be split, hexahedra cannot" };
  }
  Result<DecodedMeshCells> decoded;
  if (isCurved)
  {
    decoded->Vertices = corners.Renumber(polygons, hexahedra.Corners);
  }
  TakePoints(data, decoded.Value);
  if (Status finite = CheckPoints(decoded.Value); !finite)
  {
    return finite;
  }
  decoded->Cells.resize(static_cast<std::size_t>(cells));
  std::iota(decoded->Cells.begin(), decoded->Cells.end(), vtkIdType{ 0 });
  if (dimension == 3)
  {
    hexahedra.NumPoints = static_cast<int>(decoded->Points.rows());
    decoded->Mesh = std::move(hexahedra);
  }
  else if (split)
  {
    decoded.Status = Split(polygons, decoded.Value);
  }
  else
  {
    TakeQuadrilaterals(polygons, decoded.Value);
  }
  return decoded;
}

template <int Dim>
Result<MeshTopology<Dim>> MakeConforming(const CellMesh<Dim>& mesh, const DecodedMeshCells& decoded)
{
  // first, as it says more than the topology does of points that hang on edges
  const Status status = CheckConforming<Dim>(mesh, decoded.Points.leftCols(3));
  return status ? MeshTopology<Dim>::Make(mesh) : Result<MeshTopology<Dim>>(status);
}

Result<std::vector<double>> CellLabels(
  vtkPointSet* data, const std::string& name, const DecodedMeshCells& mesh)
{
  vtkDataArray* array = data->GetCellData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfComponents() != 1)
  {
    return { ErrorCode::InvalidParameter,
      "the mesh has no cell array '" + name + "' of one number a cell" };
  }
  std::vector<double> labels;
  for (const vtkIdType cell : mesh.Cells)
  {
    labels.push_back(array->GetTuple1(cell));
  }
  return labels;
}

template <int Dim>
Result<std::vector<CellSide>> FindFeatures(vtkPointSet* data, const DecodedMeshCells& decoded,
  const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, double angle,
  const std::string& array)
{
  Result<std::vector<CellSide>> features;
  if (angle < 180.0)
  {
    if constexpr (Dim == 3)
    {
      return { ErrorCode::InvalidParameter,
        "FeatureAngle is for quadrilaterals; mark the sides of features of hexahedra by a cell "
        "array (FeatureArray)" };
    }
    else
    {
      features = SharpEdges(mesh, topology, decoded.Points.leftCols(3), angle);
      if (!features)
      {
        return features.Status;
      }
    }
  }
  if (array.empty() || array == "None")
  {
    return features;
  }
  const auto labels = CellLabels(data, array, decoded);
  if (!labels)
  {
    return labels.Status;
  }
  const auto between = FacetsBetween<Dim>(topology, labels.Value);
  features->insert(features->end(), between->begin(), between->end());
  return between ? features : between;
}

template Result<MeshTopology<2>> MakeConforming<2>(const CellMesh<2>&, const DecodedMeshCells&);
template Result<MeshTopology<3>> MakeConforming<3>(const CellMesh<3>&, const DecodedMeshCells&);
template Result<std::vector<CellSide>> FindFeatures<2>(vtkPointSet*, const DecodedMeshCells&,
  const CellMesh<2>&, const MeshTopology<2>&, double, const std::string&);
template Result<std::vector<CellSide>> FindFeatures<3>(vtkPointSet*, const DecodedMeshCells&,
  const CellMesh<3>&, const MeshTopology<3>&, double, const std::string&);
}
