// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"

#include <functional>

namespace knotwork
{
/// Barycentric map of a mesh whose longest boundary loop goes to a circle and whose holes are
/// closed by one point each: no triangle flips (but for rounding, where triangles become tiny).
/// @source Tutte, Proc. London Math. Soc. 13 (1963) 743-767; Floater, CAGD 14 (1997) 231-250.
Result<FlatMesh> BarycentricMap(const DiscMesh& mesh);

/// The conformal map or, when it flips triangles, the barycentric one; normalized.
Result<FlatMesh> MapWithoutFlips(const DiscMesh& mesh);

struct RelaxParams
{
  int MaxIterations = 100;
  double LeastDecrease = 1e-6; ///< of the energy in an iteration, relative: where iterations end
  /// Sees the map after each iteration; false ends them.
  std::function<bool(const PointMatrix& uv)> GoOn;
};

/// Lets the symmetric Dirichlet energy int |J|^2 + |J^-1|^2 of a map without flips become least; no
/// step flips a triangle.
/// @return NotConverged: the map has flips already.
/// @source Rabinovich, Poranne, Panozzo, Sorkine-Hornung, ACM TOG 36 (2017) 16.
Status RelaxMap(const DiscMesh& mesh, const RelaxParams& params, PointMatrix& uv);

/// MapWithoutFlips and RelaxMap.
Result<FlatMesh> InjectiveMap(const DiscMesh& mesh, int maxIterations);
}
