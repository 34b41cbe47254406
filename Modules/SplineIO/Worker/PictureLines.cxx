// SPDX-License-Identifier: BSD-3-Clause
#include "PictureLines.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkMath.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace knotwork
{
namespace
{
constexpr double SharpCosine = 0.7071067811865476; // of 45 degrees

struct Use
{
  vtkIdType Cell;
  bool IsForward; ///< runs from the smaller number to the larger in that cell
  int Count;
  bool EndsPatch;
  bool EndsElement;
};

using Edge = std::pair<vtkIdType, vtkIdType>;

struct EdgeHash
{
  std::size_t operator()(const Edge& edge) const
  {
    return static_cast<std::uint64_t>(edge.first) * 0x9e3779b97f4a7c15ULL ^
      static_cast<std::uint64_t>(edge.second);
  }
};

vtkSmartPointer<vtkPolyData> LinesOf(vtkPolyData* polygons, std::vector<Edge>& edges)
{
  std::sort(edges.begin(), edges.end()); // a hash map has no order of its own
  auto lines = vtkSmartPointer<vtkPolyData>::New();
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const Edge& edge : edges)
  {
    const std::array<vtkIdType, 2> ends{ edge.first, edge.second };
    cells->InsertNextCell(2, ends.data());
  }
  lines->SetPoints(polygons->GetPoints());
  lines->SetLines(cells);
  return lines;
}

/// Patch and element of a polygon.
class Owners
{
public:
  Owners(vtkPolyData* polygons, const char* elements)
    : Offset(polygons->GetNumberOfVerts() + polygons->GetNumberOfLines())
  {
    vtkCellData* data = polygons->GetCellData();
    for (const char* name : { "PatchId", "FaceId", "RegionId" })
    {
      if (!this->Patches)
      {
        this->Patches = data->GetArray(name);
      }
    }
    this->Elements = elements ? data->GetArray(elements) : nullptr;
  }
  double Patch(vtkIdType polygon) const { return this->Value(this->Patches, polygon, 0.0); }
  double Element(vtkIdType polygon) const
  {
    return this->Value(this->Elements, polygon, static_cast<double>(polygon));
  }

private:
  double Value(vtkDataArray* array, vtkIdType polygon, double other) const
  {
    return array ? array->GetComponent(this->Offset + polygon, 0) : other;
  }

  vtkIdType Offset; ///< cell arrays begin with what stands before polygons
  vtkDataArray* Patches = nullptr;
  vtkDataArray* Elements = nullptr;
};
}

PictureLines FindPictureLines(vtkPolyData* polygons, const char* elements, bool findSharp)
{
  const Owners owners(polygons, elements);
  vtkCellArray* cells = polygons->GetPolys();
  const vtkIdType count = cells->GetNumberOfCells();
  std::vector<std::array<double, 3>> normals(findSharp ? static_cast<std::size_t>(count) : 0);
  std::unordered_map<Edge, Use, EdgeHash> edges;
  edges.reserve(2 * static_cast<std::size_t>(count));
  std::set<std::pair<double, double>> found;
  for (vtkIdType c = 0; c < count; ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* points = nullptr;
    cells->GetCellAtId(c, size, points);
    if (findSharp)
    {
      vtkPolygon::ComputeNormal(polygons->GetPoints(), static_cast<int>(size), points,
        normals[static_cast<std::size_t>(c)].data());
    }
    if (elements)
    {
      found.emplace(owners.Patch(c), owners.Element(c));
    }
    for (vtkIdType i = 0; i < size; ++i)
    {
      const auto ends = std::minmax(points[i], points[(i + 1) % size]);
      const bool isForward = ends.first == points[i];
      const auto [entry, isNew] =
        edges.try_emplace(Edge(ends), Use{ c, isForward, 0, false, false });
      Use& use = entry->second;
      ++use.Count;
      if (isNew)
      {
        continue;
      }
      const double sense = use.IsForward == isForward ? -1.0 : 1.0; // of unlike orientation
      const bool isSharp = findSharp &&
        sense *
            vtkMath::Dot(normals[static_cast<std::size_t>(use.Cell)].data(),
              normals[static_cast<std::size_t>(c)].data()) <
          SharpCosine;
      use.EndsPatch = use.EndsPatch || isSharp || owners.Patch(use.Cell) != owners.Patch(c);
      use.EndsElement = owners.Element(use.Cell) != owners.Element(c);
    }
  }
  std::vector<Edge> ofPatches;
  std::vector<Edge> ofElements;
  for (const auto& [edge, use] : edges)
  {
    if (use.Count != 2 || use.EndsPatch)
    {
      ofPatches.push_back(edge);
    }
    else if (use.EndsElement)
    {
      ofElements.push_back(edge);
    }
  }
  return { LinesOf(polygons, ofPatches), LinesOf(polygons, ofElements),
    elements ? static_cast<long long>(found.size()) : static_cast<long long>(count) };
}
}
