// SPDX-License-Identifier: BSD-3-Clause
#include "CellGluing.h"

#include "CollapsedSides.h"
#include "GluedBoundary.h"
#include "PatchGluing.h"
#include "SideMatching.h"

namespace knotwork
{
CellGluing GlueCells(const BernsteinCells& cells, const CellComplex& complex,
  const std::vector<int>& signs, const InjectivityParams& params)
{
  GluingState state(cells, complex, signs, params);
  JoinKnownPoints(state);
  for (int c = 0; c < cells.NumCells(); ++c)
  {
    for (int s = 0; s < NumSides(state.Shape(c)); ++s)
    {
      state.Open.push_back({ c, s });
    }
  }
  GlueBoxes(state);
  RemoveCollapsed(state);
  GlueEqual(state);
  GlueNear(state);
  FindInnerPoint(state);
  AssembleBoundary(state);
  return std::move(state.Out);
}
}
