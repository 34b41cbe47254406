// SPDX-License-Identifier: BSD-3-Clause
#include "STEPLoops.h"

#include <StepShape_EdgeLoop.hxx>
#include <StepShape_HArray1OfOrientedEdge.hxx>
#include <StepShape_OrientedEdge.hxx>

#include <algorithm>

namespace knotwork
{
namespace
{
/// Whether the second use goes back where the first one came from.
bool TurnsBack(
  const Handle(StepShape_OrientedEdge) & use, const Handle(StepShape_OrientedEdge) & next)
{
  return !use.IsNull() && !next.IsNull() && !use->EdgeElement().IsNull() &&
    use->EdgeElement() == next->EdgeElement() && use->Orientation() != next->Orientation();
}
}

void BeginLoopsAtPoles(const Handle(Interface_InterfaceModel) & model)
{
  for (int i = 1; i <= model->NbEntities(); ++i)
  {
    const auto loop = Handle(StepShape_EdgeLoop)::DownCast(model->Value(i));
    if (loop.IsNull() || loop->NbEdgeList() < 3)
    {
      continue;
    }
    auto& uses = loop->EdgeList()->ChangeArray1();
    if (!TurnsBack(uses.Last(), uses.First()))
    {
      const auto turn = std::adjacent_find(uses.begin(), uses.end(), TurnsBack);
      std::rotate(uses.begin(), turn == uses.end() ? uses.begin() : turn + 1, uses.end());
    }
  }
}
}
