// SPDX-License-Identifier: BSD-3-Clause
// What the library knotwork-opencascade.so gives to those that load it.
#pragma once
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/CADModel/CADModify.h>
#include <knotwork/CADModel/CADPieces.h>
#include <knotwork/CADModel/CADSuggest.h>
#include <knotwork/CADModel/CADTopology.h>

namespace knotwork
{
/// The functions of CADModel's kernel that need OpenCASCADE.
struct CADFunctions
{
  decltype(&ReadCAD) Read;
  decltype(&WriteCAD) Write;
  decltype(&CheckCAD) Check;
  decltype(&CheckWrittenCAD) CheckWritten;
  decltype(&ModifyCADText) ModifyText;
  decltype(&SuggestCADOperations) Suggest;
  decltype(&CADTopology::Read) ReadTopology;
  decltype(&CADTopology::JoinComposites) JoinComposites;
  decltype(&CADTopology::TouchingSolids) TouchingSolids;
  decltype(&CADTopology::EdgePoint) EdgePoint;
  decltype(&CADTopology::UseParameters) UseParameters;
  decltype(&CADTopology::FacePoint) FacePoint;
  decltype(&CADTopology::FaceNormal) FaceNormal;
  decltype(&CADTopology::FaceCurvature) FaceCurvature;
  decltype(&CADTopology::Project) Project;
  decltype(&CADPieces::Read) ReadPieces;
  decltype(&CADPieces::Topology) TopologyOfPieces;
  decltype(&CADPieces::Cuts) CutsOfPieces;
  decltype(&CADPieces::Cut) CutPieces;
};
}

/// The one function that the library exports.
extern "C" const knotwork::CADFunctions* KnotworkCADFunctions();
