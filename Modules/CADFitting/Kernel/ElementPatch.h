// SPDX-License-Identifier: BSD-3-Clause
// Some elements of a spline by themselves, private to the kernel.
#pragma once
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Elements within so many rings of some, by common points of the mesh; ascending.
template <int Dim>
std::vector<int> Rings(const CellMesh<Dim>& mesh, const std::vector<int>& elements, int rings);

/// Connected parts of some elements, by common points of the mesh.
template <int Dim>
std::vector<std::vector<int>> ConnectedParts(
  const CellMesh<Dim>& mesh, const std::vector<int>& elements);

/// Functions of some elements, and which of them have all their elements there and are not held.
struct PatchFunctions
{
  std::vector<int> Functions;
  std::vector<int> NumberOf; ///< among them, one a function of the space; -1: none
  std::vector<char> IsFree;  ///< one a function of the patch
};

/// @param isHeld  one a function of the space.
template <int Dim>
PatchFunctions FunctionsOf(
  const SplineSpace<Dim>& space, const std::vector<int>& patch, const std::vector<char>& isHeld);

/// The space on some of its elements, with functions numbered anew.
template <int Dim>
SplineSpace<Dim> Restrict(
  const SplineSpace<Dim>& space, const std::vector<int>& patch, const PatchFunctions& functions);

/// The space on some quadrilaterals, element i on facet i. @param facets  side -1 each.
MeshTrace<2> PartOnFacets(const SplineSpace<2>& space, const std::vector<CellSide>& facets);
/// A spline there.
Spline<2> PartOf(const Spline<2>& spline, const MeshTrace<2>& part);
}
