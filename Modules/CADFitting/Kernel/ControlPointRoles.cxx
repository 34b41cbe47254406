// SPDX-License-Identifier: BSD-3-Clause
#include "ControlPointRoles.h"

#include "ElementMending.h"
#include "ElementPatch.h"

#include <knotwork/SplineCore/MeshTraces.h>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Functions of the quadrilaterals that are fitted, where not all are.
std::vector<int> FunctionsOfPart(const FittedMesh<2>& mesh, const SplineSpace<2>& space)
{
  return mesh.IsPart ? PartOnFacets(space, mesh.Surface.Facets).Functions : std::vector<int>();
}
}

template <int Dim>
std::vector<char> HeldControlPoints(const FittedMesh<Dim>& mesh, const FittedSpline<Dim>& spline)
{
  const SplineSpace<Dim>& space = *spline.Space;
  std::vector<char> held(At(space.NumFunctions), 0);
  if constexpr (Dim == 3)
  {
    if (mesh.IsPart)
    {
      const auto whole = TraceOnFacets(space, BoundaryFacets<3>(mesh.Topology));
      for (const int function : whole->Functions)
      {
        held[At(function)] = HeldFast;
      }
    }
    const auto trace = TraceOnFacets(space, mesh.Surface.Facets);
    for (const int function : trace->Functions)
    {
      held[At(function)] = 1;
    }
  }
  else
  {
    // rims, and where the surface lies on the target all; what is on its curves for good
    if (mesh.IsFitted && mesh.HasSurfaces)
    {
      held.assign(held.size(), mesh.IsPart ? HeldFast : char(1));
      for (const int function : FunctionsOfPart(mesh, space))
      {
        held[At(function)] = 1;
      }
      for (const int function : spline.OnCurves)
      {
        held[At(function)] = HeldFast;
      }
      return held;
    }
    const std::vector<CellSide> rims = BoundaryFacets<2>(mesh.Topology);
    if (!rims.empty())
    {
      const auto traces = TraceOnFacets(space, rims);
      for (const MeshTrace<1>& trace : traces.Value)
      {
        for (const int function : trace.Functions)
        {
          held[At(function)] = 1;
        }
      }
    }
  }
  return held;
}

template <int Dim>
ControlPointPlaces PlacesOnTarget(const FittedMesh<Dim>& mesh, const FittedSpline<Dim>& spline)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const auto count = At(space.NumFunctions);
  ControlPointPlaces places;
  places.IsHeld.assign(count, 0);
  places.IsOnSurface.assign(count, Dim == 2 ? 1 : 0);
  places.Parts.resize(count);
  if constexpr (Dim == 2)
  {
    if (mesh.IsPart)
    {
      places.IsHeld.assign(count, 1);
      for (const int function : FunctionsOfPart(mesh, space))
      {
        places.IsHeld[At(function)] = 0;
      }
    }
  }
  else
  {
    if (mesh.IsPart)
    {
      const auto whole = TraceOnFacets(space, BoundaryFacets<3>(mesh.Topology));
      for (const int function : whole->Functions)
      {
        places.IsHeld[At(function)] = 1;
      }
    }
    const auto trace = TraceOnFacets(space, mesh.Surface.Facets);
    for (std::size_t q = 0; q < mesh.Surface.Facets.size(); ++q)
    {
      const int face = mesh.Parts.FaceOf[q];
      for (const int own : trace->Space->AliveFunctions(static_cast<int>(q)))
      {
        const int function = trace->Functions[At(own)];
        places.IsHeld[At(function)] = 0;
        TargetPart& part = places.Parts[At(function)];
        const bool isFirst = places.IsOnSurface[At(function)] == 0;
        places.IsOnSurface[At(function)] = 1;
        // of two faces: on any
        part = face >= 0 && (isFirst || part.Id == face) ? TargetPart{ TargetEntity::Face, face }
                                                         : TargetPart();
      }
    }
  }
  for (const int function : spline.OnCurves)
  {
    places.IsHeld[At(function)] = 1;
  }
  return places;
}

template std::vector<char> HeldControlPoints(const FittedMesh<2>&, const FittedSpline<2>&);
template std::vector<char> HeldControlPoints(const FittedMesh<3>&, const FittedSpline<3>&);
template ControlPointPlaces PlacesOnTarget(const FittedMesh<2>&, const FittedSpline<2>&);
template ControlPointPlaces PlacesOnTarget(const FittedMesh<3>&, const FittedSpline<3>&);
}
