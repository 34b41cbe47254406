// SPDX-License-Identifier: BSD-3-Clause
#include "DefaultSettings.h"

#include "vtkSMSettings.h"

namespace
{
// In the form of ParaView's own settings files: what "save current color map as default for arrays
// named ..." would write. A range mode of -1 (never) keeps all values, present or not. Level 3
// draws a Bezier face as 8 x 8 pieces; linear cells stay as they are.
constexpr char Settings[] = R"({
"array_lookup_tables": { "JacobianVerdict": { "PVLookupTable": {
  "AutomaticRescaleRangeMode": -1,
  "IndexedLookup": 1,
  "Annotations": ["1", "valid", "0", "undecided", "-1", "invalid"],
  "ActiveAnnotatedValues": ["1", "0", "-1"],
  "IndexedColors": [0.75, 0.80, 0.86, 1.00, 0.65, 0.00, 0.85, 0.10, 0.10]
} }, "SurfaceType": { "PVLookupTable": {
  "AutomaticRescaleRangeMode": -1,
  "IndexedLookup": 1,
  "Annotations": ["0", "plane", "1", "cylinder", "2", "sphere", "3", "cone", "4", "torus",
    "5", "free form", "6", "extrusion", "7", "revolution"],
  "ActiveAnnotatedValues": ["0", "1", "2", "3", "4", "5", "6", "7"],
  "IndexedColors": [0.75, 0.80, 0.86, 0.36, 0.55, 0.72, 0.85, 0.55, 0.20, 0.45, 0.70, 0.45,
    0.60, 0.45, 0.70, 0.90, 0.85, 0.55, 0.30, 0.60, 0.62, 0.78, 0.42, 0.52]
} } },
"representations": {
  "UnstructuredGridRepresentation": { "NonlinearSubdivisionLevel": 3 },
  "GeometryRepresentation": { "NonlinearSubdivisionLevel": 3 }
} })";

// Below the settings of the user and of the site, which keep the last word.
constexpr double Priority = -1.0;
}

void knotwork::LoadDefaultSettings()
{
  vtkSMSettings::GetInstance()->AddCollectionFromString(Settings, Priority);
}
