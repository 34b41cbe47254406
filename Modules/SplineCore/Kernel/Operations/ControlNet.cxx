// SPDX-License-Identifier: BSD-3-Clause
#include "ControlNet.h"

#include "SpaceFamily.h"

namespace knotwork
{
template <int Dim>
std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space)
{
  return FamilyOf(space).ControlNetEdges(space);
}

template std::vector<NetEdge> ControlNetEdges<1>(const SplineSpace<1>&);
template std::vector<NetEdge> ControlNetEdges<2>(const SplineSpace<2>&);
template std::vector<NetEdge> ControlNetEdges<3>(const SplineSpace<3>&);
}
