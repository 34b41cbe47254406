// SPDX-License-Identifier: BSD-3-Clause
#include "CADFunctions.h"

extern "C" __attribute__((visibility("default"))) const knotwork::CADFunctions*
KnotworkCADFunctions()
{
  using namespace knotwork;
  static const CADFunctions functions{ &ReadCAD, &WriteCAD, &CheckCAD, &CheckWrittenCAD,
    &ModifyCADText, &SuggestCADOperations, &CADTopology::Read, &CADTopology::JoinComposites,
    &CADTopology::TouchingSolids, &CADTopology::EdgePoint, &CADTopology::UseParameters,
    &CADTopology::FacePoint, &CADTopology::FaceNormal, &CADTopology::FaceCurvature,
    &CADTopology::Project, &CADPieces::Read, &CADPieces::Topology, &CADPieces::Cuts,
    &CADPieces::Cut };
  return &functions;
}
