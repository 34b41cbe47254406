// SPDX-License-Identifier: BSD-3-Clause
#include "DefaultSettings.h"

#include "vtkSMSettings.h"

namespace
{
// In the form of ParaView's own settings files: what "save current color map as default for arrays
// named ..." would write. A range mode of -1 (never) keeps the three values, present or not. Level
// 3 draws a Bezier face as 8 x 8 pieces; linear cells stay as they are.
constexpr char Settings[] = R"({
"array_lookup_tables": { "JacobianVerdict": { "PVLookupTable": {
  "AutomaticRescaleRangeMode": -1,
  "IndexedLookup": 1,
  "Annotations": ["1", "valid", "0", "undecided", "-1", "invalid"],
  "ActiveAnnotatedValues": ["1", "0", "-1"],
  "IndexedColors": [0.75, 0.80, 0.86, 1.00, 0.65, 0.00, 0.85, 0.10, 0.10]
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
