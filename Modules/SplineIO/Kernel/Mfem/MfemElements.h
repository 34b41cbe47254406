// SPDX-License-Identifier: BSD-3-Clause
// The finite elements of nodes, by their names in files.
#pragma once
#include "MfemMesh.h"

namespace knotwork
{
/// Nodes of an interval's polynomials; Bernstein has coefficients instead.
enum class MfemBasis
{
  GaussLegendre,
  GaussLobatto,
  Bernstein,
  OpenUniform,
  ClosedUniform,
  OpenHalfUniform
};

struct MfemCollection
{
  bool IsNurbs = false;
  bool IsContinuous = false; ///< neighbours share the nodes between them
  MfemBasis Basis = MfemBasis::GaussLobatto;
  int Degree = 1;
};

/// @return InvalidParameter for a name that is not read; InvalidDegree; DimensionMismatch.
Result<MfemCollection> ParseMfemCollection(std::string_view name, int dimension);

/// Makes Bernstein coefficients of values at the nodes of one shape, both with the first direction
/// fastest.
class MfemConversion
{
public:
  MfemConversion(MfemShape shape, const MfemCollection& collection);
  int NumNodes() const { return this->Size; }
  PointMatrix Apply(PointMatrix values) const;

private:
  int Size = 1;
  std::vector<Eigen::MatrixXd> Factors; ///< their Kronecker product, the first fastest
};
}
