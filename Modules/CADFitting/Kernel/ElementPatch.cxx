// SPDX-License-Identifier: BSD-3-Clause
#include "ElementPatch.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

template <int Dim>
std::vector<int> Rings(const CellMesh<Dim>& mesh, const std::vector<int>& elements, int rings)
{
  std::vector<char> inside(At(mesh.NumCells()), 0);
  for (const int e : elements)
  {
    inside[At(e)] = 1;
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    std::vector<char> touched(At(mesh.NumPoints), 0);
    for (int e = 0; e < mesh.NumCells(); ++e)
    {
      for (int k = 0; inside[At(e)] != 0 && k < (1 << Dim); ++k)
      {
        touched[At(mesh.Cell(e)[k])] = 1;
      }
    }
    for (int e = 0; e < mesh.NumCells(); ++e)
    {
      for (int k = 0; k < (1 << Dim); ++k)
      {
        inside[At(e)] |= touched[At(mesh.Cell(e)[k])];
      }
    }
  }
  std::vector<int> grown;
  for (int e = 0; e < mesh.NumCells(); ++e)
  {
    if (inside[At(e)] != 0)
    {
      grown.push_back(e);
    }
  }
  return grown;
}

template <int Dim>
std::vector<std::vector<int>> ConnectedParts(
  const CellMesh<Dim>& mesh, const std::vector<int>& elements)
{
  DisjointSets sets(mesh.NumPoints);
  for (const int e : elements)
  {
    for (int k = 1; k < (1 << Dim); ++k)
    {
      sets.Unite(mesh.Cell(e)[0], mesh.Cell(e)[k]);
    }
  }
  std::map<int, std::vector<int>> parts;
  for (const int e : elements)
  {
    parts[sets.Find(mesh.Cell(e)[0])].push_back(e);
  }
  std::vector<std::vector<int>> all;
  for (auto& [first, part] : parts)
  {
    all.push_back(std::move(part));
  }
  return all;
}

template <int Dim>
PatchFunctions FunctionsOf(
  const SplineSpace<Dim>& space, const std::vector<int>& patch, const std::vector<char>& isHeld)
{
  PatchFunctions result;
  result.NumberOf.assign(At(space.NumFunctions), -1);
  std::vector<char> isIn(At(space.NumElements()), 0);
  for (const int e : patch)
  {
    isIn[At(e)] = 1;
  }
  std::vector<char> isOut(At(space.NumFunctions), 0);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    for (const int f : space.AliveFunctions(e))
    {
      if (isIn[At(e)] == 0)
      {
        isOut[At(f)] = 1;
      }
      else if (result.NumberOf[At(f)] < 0)
      {
        result.NumberOf[At(f)] = static_cast<int>(result.Functions.size());
        result.Functions.push_back(f);
      }
    }
  }
  for (const int f : result.Functions)
  {
    result.IsFree.push_back(isOut[At(f)] == 0 && isHeld[At(f)] == 0 ? 1 : 0);
  }
  return result;
}

template <int Dim>
SplineSpace<Dim> Restrict(
  const SplineSpace<Dim>& space, const std::vector<int>& patch, const PatchFunctions& functions)
{
  SplineSpace<Dim> part;
  part.Kind = SpaceKind::Bezier;
  part.FactorData = space.FactorData;
  part.NumFunctions = static_cast<int>(functions.Functions.size());
  std::vector<int> rowOf(
    static_cast<std::size_t>(
      space.NumLocalFunctions > 0 ? space.NumLocalFunctions : space.NumFunctions),
    -1);
  std::vector<int> rows;
  for (const int e : patch)
  {
    auto element = space.Elements[At(e)];
    const int* locals = space.LocalFunctions(e);
    element.FirstLocal = part.LocalFunctionIds.size();
    for (int i = 0; i < NumTensorFunctions<Dim>(element.Degree); ++i)
    {
      int& row = rowOf[At(locals[i])];
      if (row < 0)
      {
        row = static_cast<int>(rows.size());
        rows.push_back(locals[i]);
      }
      part.LocalFunctionIds.push_back(row);
    }
    part.Elements.push_back(element);
  }
  part.NumLocalFunctions = static_cast<int>(rows.size());
  part.RowStart.push_back(0);
  for (const int row : rows)
  {
    if (space.IsIdentityMap())
    {
      part.RowFunction.push_back(functions.NumberOf[At(row)]);
      part.RowCoefficient.push_back(1.0);
    }
    else
    {
      std::vector<std::pair<int, double>> entries;
      for (std::size_t k = space.RowStart[At(row)]; k < space.RowStart[At(row) + 1]; ++k)
      {
        entries.emplace_back(functions.NumberOf[At(space.RowFunction[k])], space.RowCoefficient[k]);
      }
      std::sort(entries.begin(), entries.end());
      for (const auto& [function, coefficient] : entries)
      {
        part.RowFunction.push_back(function);
        part.RowCoefficient.push_back(coefficient);
      }
    }
    part.RowStart.push_back(part.RowFunction.size());
  }
  return part;
}

MeshTrace<2> PartOnFacets(const SplineSpace<2>& space, const std::vector<CellSide>& facets)
{
  std::vector<int> patch;
  MeshTrace<2> part;
  for (const CellSide& facet : facets)
  {
    patch.push_back(facet.Cell);
    part.Elements.push_back({ facet, { 0, 1 }, {} });
  }
  PatchFunctions functions =
    FunctionsOf<2>(space, patch, std::vector<char>(At(space.NumFunctions), 0));
  part.Space = std::make_shared<const SplineSpace<2>>(Restrict<2>(space, patch, functions));
  part.Functions = std::move(functions.Functions);
  return part;
}

Spline<2> PartOf(const Spline<2>& spline, const MeshTrace<2>& part)
{
  Spline<2> result;
  result.Space = part.Space;
  result.ControlPoints.resize(
    static_cast<Eigen::Index>(part.Functions.size()), spline.ControlPoints.cols());
  for (std::size_t i = 0; i < part.Functions.size(); ++i)
  {
    result.ControlPoints.row(static_cast<Eigen::Index>(i)) =
      spline.ControlPoints.row(part.Functions[i]);
  }
  return result;
}

template std::vector<int> Rings(const CellMesh<2>&, const std::vector<int>&, int);
template std::vector<int> Rings(const CellMesh<3>&, const std::vector<int>&, int);
template std::vector<std::vector<int>> ConnectedParts(const CellMesh<2>&, const std::vector<int>&);
template std::vector<std::vector<int>> ConnectedParts(const CellMesh<3>&, const std::vector<int>&);
template PatchFunctions FunctionsOf(
  const SplineSpace<2>&, const std::vector<int>&, const std::vector<char>&);
template PatchFunctions FunctionsOf(
  const SplineSpace<3>&, const std::vector<int>&, const std::vector<char>&);
template SplineSpace<2> Restrict(
  const SplineSpace<2>&, const std::vector<int>&, const PatchFunctions&);
template SplineSpace<3> Restrict(
  const SplineSpace<3>&, const std::vector<int>&, const PatchFunctions&);
}
