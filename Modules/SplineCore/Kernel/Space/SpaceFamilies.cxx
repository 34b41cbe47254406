// SPDX-License-Identifier: BSD-3-Clause
// The table of families.
#include "SpaceFamily.h"

#include "BezierSpace.h"
#include "ExplicitSpace.h"
#include "HierarchicalSpace.h"
#include "LRSpace.h"
#include "TensorSpace.h"
#include "UnstructuredSpace.h"

namespace knotwork
{
template <int Dim>
const SpaceFamily<Dim>& FamilyOf(SpaceKind kind)
{
  switch (kind)
  {
    case SpaceKind::Hierarchical:
      return HierarchicalFamily<Dim>();
    case SpaceKind::LocallyRefined:
      return LRFamily<Dim>();
    case SpaceKind::Unstructured:
      return UnstructuredFamily<Dim>();
    case SpaceKind::Explicit:
      return ExplicitFamily<Dim>();
    case SpaceKind::Bezier:
      return BezierFamily<Dim>();
    case SpaceKind::Tensor:
      break;
  }
  return TensorFamily<Dim>();
}

template <int Dim>
std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>& space)
{
  return FamilyOf(space).DescribeFunctions(space);
}

template const SpaceFamily<1>& FamilyOf<1>(SpaceKind);
template const SpaceFamily<2>& FamilyOf<2>(SpaceKind);
template const SpaceFamily<3>& FamilyOf<3>(SpaceKind);
template std::vector<FunctionInfo<1>> DescribeFunctions<1>(const SplineSpace<1>&);
template std::vector<FunctionInfo<2>> DescribeFunctions<2>(const SplineSpace<2>&);
template std::vector<FunctionInfo<3>> DescribeFunctions<3>(const SplineSpace<3>&);
}
