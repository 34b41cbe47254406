// SPDX-License-Identifier: BSD-3-Clause
#include "PolygonText.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

namespace knotwork
{
namespace
{
using Point = Eigen::Vector3d;

struct Polygons
{
  std::vector<Point> Points;
  std::vector<Point> Normals; ///< of points; empty unless all have one
  std::vector<std::vector<std::int32_t>> Loops;
};

/// @return false beyond what 32 bits number.
bool Append(vtkPolyData* data, Polygons& polygons)
{
  const std::size_t first = polygons.Points.size();
  constexpr auto Most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (first + static_cast<std::size_t>(data->GetNumberOfPoints()) > Most)
  {
    return false;
  }
  vtkDataArray* normals = data->GetPointData()->GetNormals();
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    polygons.Points.emplace_back();
    data->GetPoint(i, polygons.Points.back().data());
    if (normals)
    {
      polygons.Normals.emplace_back();
      normals->GetTuple(i, polygons.Normals.back().data());
    }
  }
  const auto cells = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    auto& loop = polygons.Loops.emplace_back();
    for (vtkIdType i = 0; i < count; ++i)
    {
      loop.push_back(static_cast<std::int32_t>(first + static_cast<std::size_t>(ids[i])));
    }
  }
  return polygons.Loops.size() <= Most;
}

std::string Numbers(const char* lead, const Point& point)
{
  std::array<char, 128> line;
  std::snprintf(
    line.data(), line.size(), "%s %.17g %.17g %.17g\n", lead, point[0], point[1], point[2]);
  return line.data();
}

std::string ObjText(const Polygons& polygons)
{
  std::string text;
  for (const Point& point : polygons.Points)
  {
    text += Numbers("v", point);
  }
  for (const Point& normal : polygons.Normals)
  {
    text += Numbers("vn", normal);
  }
  for (const auto& loop : polygons.Loops)
  {
    text += "f";
    for (const std::int32_t corner : loop)
    {
      const std::string number = std::to_string(static_cast<std::int64_t>(corner) + 1);
      text += " " + number;
      text += polygons.Normals.empty() ? "" : "//" + number;
    }
    text += "\n";
  }
  return text;
}

/// The bytes as this machine has them, which is little-endian wherever the program is built for.
template <typename T>
void AppendBytes(const T& value, std::string& text)
{
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  text.append(bytes.data(), bytes.size());
}

std::string PlyText(const Polygons& polygons)
{
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
    std::to_string(polygons.Points.size()) +
    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
    std::to_string(polygons.Loops.size()) + "\nproperty list int int vertex_indices\nend_header\n";
  for (const Point& point : polygons.Points)
  {
    for (const double coordinate : point)
    {
      AppendBytes(coordinate, text);
    }
  }
  for (const auto& loop : polygons.Loops)
  {
    AppendBytes(static_cast<std::int32_t>(loop.size()), text);
    for (const std::int32_t corner : loop)
    {
      AppendBytes(corner, text);
    }
  }
  return text;
}

void AppendSingle(const Point& point, std::string& text)
{
  for (const double coordinate : point)
  {
    AppendBytes(static_cast<float>(coordinate), text);
  }
}

/// A fan of triangles: polygons of ours are convex.
std::string StlText(const Polygons& polygons)
{
  constexpr std::size_t HeaderSize = 80;
  std::string text = "Knotwork";
  text.resize(HeaderSize, ' ');
  std::uint32_t count = 0;
  for (const auto& loop : polygons.Loops)
  {
    count += static_cast<std::uint32_t>(loop.size() < 3 ? 0 : loop.size() - 2);
  }
  AppendBytes(count, text);
  for (const auto& loop : polygons.Loops)
  {
    for (std::size_t i = 2; i < loop.size(); ++i)
    {
      const auto corner = [&](std::size_t k)
      { return polygons.Points[static_cast<std::size_t>(loop[k])]; };
      const Point a = corner(0);
      const Point normal = (corner(i - 1) - a).cross(corner(i) - a);
      const double length = normal.norm();
      AppendSingle(length > 0.0 ? Point(normal / length) : Point(Point::Zero()), text);
      for (const std::size_t k : { std::size_t{ 0 }, i - 1, i })
      {
        AppendSingle(corner(k), text);
      }
      AppendBytes(std::uint16_t{ 0 }, text);
    }
  }
  return text;
}
}

Result<std::string> PolygonText(vtkDataObject* data, const std::string& ending)
{
  std::vector<vtkPolyData*> parts;
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    const auto leaves = vtk::TakeSmartPointer(composite->NewIterator());
    for (leaves->InitTraversal(); !leaves->IsDoneWithTraversal(); leaves->GoToNextItem())
    {
      parts.push_back(vtkPolyData::SafeDownCast(leaves->GetCurrentDataObject()));
    }
  }
  else
  {
    parts.push_back(vtkPolyData::SafeDownCast(data));
  }
  Polygons polygons;
  for (vtkPolyData* part : parts)
  {
    if (part && !Append(part, polygons))
    {
      return { ErrorCode::TooLarge, "more than 2^31 - 1 points or polygons; write .vtp" };
    }
  }
  if (polygons.Loops.empty())
  {
    return { ErrorCode::EmptyInput, "there are no polygons, and the format has nothing else" };
  }
  if (polygons.Normals.size() != polygons.Points.size())
  {
    polygons.Normals.clear();
  }
  if (ending == ".obj")
  {
    return ObjText(polygons);
  }
  if (ending == ".ply")
  {
    return PlyText(polygons);
  }
  return ending == ".stl"
    ? StlText(polygons)
    : Result<std::string>(ErrorCode::InvalidParameter, "polygons are written as .stl .obj .ply");
}
}
