// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

#include <optional>
#include <string_view>

namespace knotwork
{
/// A number, or an expression in x, y, z and, on facets, the outward unit normal nx, ny, nz. What
/// begins with @ names a function; where a list belongs, "@name" is "@name.0", "@name.1" ...
struct ProblemValue
{
  double Number = 0.0;
  std::string Expression; ///< empty: the number
};
/// A component without a value is left free.
using ProblemValues = std::vector<std::optional<ProblemValue>>;

/// What a condition acts on.
enum class RegionKind
{
  Facets, ///< of the boundary
  Edges,  ///< of boundary facets, in space
  Point   ///< a node, or where a spline is its control point
};

/// All that is given must hold; nothing given: the whole boundary.
struct ProblemRegion
{
  RegionKind Kind = RegionKind::Facets;
  int Patch = -1; ///< -1: any
  int Side = -1;  ///< of the patch (PatchSides.h); -1: any
  int Other = -1; ///< of edges: the second of the sides that they are on; -1: any
  /// Lower and upper ends of x, then of y and z: facets and edges that lie in it with all of their
  /// samples.
  std::optional<std::array<double, 6>> Box;
  std::string Where; ///< expression that is not 0 at all samples
  std::optional<long long> Group;
  std::string GroupName;
  std::array<double, 3> At{}; ///< of a point
};

enum class ConditionKind
{
  Value,    ///< the solution: a value, or displacements
  Load,     ///< flux or traction on facets
  Pressure, ///< traction against the normal
  Force     ///< at a point, or for each length along edges
};

struct ProblemCondition
{
  ProblemRegion Region;
  ConditionKind Kind = ConditionKind::Value;
  ProblemValues Values; ///< as many as the solution has, one of a pressure
};

/// A problem without a body: what a file says, before any mesh or spline is known.
struct ProblemDescription
{
  GalerkinEquation Equation = GalerkinEquation::Poisson;
  std::vector<GalerkinMaterial> Materials{ GalerkinMaterial{} };
  std::vector<long long> MaterialNumbers; ///< one a material: what the array has; empty: positions
  std::string MaterialArray;              ///< of cells; empty: the first material
  ProblemValues Source;                   ///< empty: none
  std::vector<ProblemCondition> Conditions;
  ProblemValues Exact; ///< the known solution, to compare with; empty: there is none
};

/// Reads a problem from JSON; the module's page has the keys. @param equation  what is solved.
/// @param material  the one that stands for what the text does not give.
/// @return InvalidFormat that names the key and what belongs there; an unknown key is an error.
Result<ProblemDescription> ReadProblem(
  std::string_view text, GalerkinEquation equation, const GalerkinMaterial& material);

/// A compiled expression, of a position and a normal (3 coordinates each).
using ScalarFunction = std::function<double(const double* x, const double* normal)>;
/// @return InvalidParameter: the text is no expression.
using CompileExpression = std::function<Result<ScalarFunction>(const std::string&)>;

/// The known solution as a function; unset where the problem has none. @param dimension  of the
/// body. @return InvalidParameter when an expression is wrong.
Result<PointFunction> MakeExact(
  const ProblemDescription& description, int dimension, const CompileExpression& compile);

/// Facets that conditions choose from.
struct BoundaryGroups
{
  std::vector<CellSide> Facets;               ///< BoundaryFacets
  std::vector<std::vector<long long>> Groups; ///< of each; empty: there are none
  std::map<std::string, long long> Names;     ///< of groups
  /// Of edges in space, by the functions that are 1 at their ends, ascending.
  std::map<std::array<int, 2>, std::vector<long long>> EdgeGroups;
  std::map<std::string, long long> EdgeNames;
};

/// What a condition has chosen: facets, or functions on edges and at points.
struct ConditionPlace
{
  std::vector<CellSide> Facets;
  std::vector<ElementEdge> Edges; ///< each once
  std::vector<int> Functions;
};

/// The problem of a body. @param places  where not null: what each condition has chosen.
/// @return InvalidParameter when a condition selects nothing, with what there is to select, or when
/// an expression is wrong; InvalidTopology, SizeMismatch for wrong groups.
Result<GalerkinProblem> MakeProblem(const ProblemDescription& description,
  const GalerkinSpace& space, const BoundaryGroups& boundary, const CompileExpression& compile,
  std::vector<ConditionPlace>* places = nullptr);
}
