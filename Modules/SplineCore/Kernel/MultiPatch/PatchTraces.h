// SPDX-License-Identifier: BSD-3-Clause
// Traces of splines on the sides, edges and corners of their patches.
#pragma once
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/PatchSides.h>

#include <map>

namespace knotwork
{
/// Level and index in the level's tensor-product basis; the last entries are 0 when not needed.
using FunctionKey = std::array<std::int64_t, 3>;

/// Whether functions of the space are those of the entity: with p + 1 equal knots at the ends it
/// fixes; not known for locally refined spaces.
template <int Dim>
bool HasTrace(const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity);

/// Functions of level `level` of dyadic refinement: every halved element adds one.
std::int64_t NumLevelFunctions(const KnotVector& knots, int level);

/// Functions that do not vanish on an entity, by level and index along the free directions. With
/// clamped ends these are exactly the functions of the trace space, truncation included: children
/// of a function with end index in a fixed direction have the end index or vanish there.
template <int Dim>
std::map<FunctionKey, int> TraceFunctions(
  const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity);

/// Hierarchy boxes of the trace.
template <int Dim, int Free>
std::vector<HierarchyBox<Free>> TraceBoxes(
  const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity);

/// The space of traces, and which function of the patch's space each of its functions is.
template <int Free>
struct Trace
{
  SplineSpacePtr<Free> Space;
  std::vector<int> Functions;
};
/// @param entity  with so many free directions. @pre HasTrace.
/// @return InvalidTopology when the functions are not those of a space.
template <int Dim, int Free>
Result<Trace<Free>> MakeTrace(const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity);

/// A spline's coefficients there.
template <int Dim, int Free>
Spline<Free> TraceOf(const Spline<Dim>& spline, const Trace<Free>& trace);

/// Knots of the free directions of an entity.
template <int Dim>
std::vector<const KnotVector*> TraceKnots(
  const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity);

/// Key in entity b of a function of entity a, on which b lies so; the knots are b's.
FunctionKey OrientedKey(const FunctionKey& key, const SideOrientation& orientation,
  const std::vector<const KnotVector*>& knots);

/// A side, edge or corner of one of several patches.
template <int Dim>
struct PatchTrace
{
  int Patch = 0;
  PatchEntity<Dim> Entity{};
  int Free = 0;  ///< directions
  int Owner = 0; ///< the first entity that it is one with (maybe itself)
  SideOrientation OnOwner;
};

/// All sides, edges and corners that have traces, and which of them are one: control points and
/// weights agree as PointClusters.h says, knots up to an affine change and 1e-9.
template <int Dim>
std::vector<PatchTrace<Dim>> FindSharedTraces(const std::vector<Spline<Dim>>& patches);
}
