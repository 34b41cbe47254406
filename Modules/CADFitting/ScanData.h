// SPDX-License-Identifier: BSD-3-Clause
// Scans from datasets and back, private to the module.
#pragma once
#include "FitTargetData.h"
#include <knotwork/CADFitting/RigidAlignment.h>

#include <string>

class vtkInformationVector;
class vtkPointSet;
class vtkTable;

namespace knotwork
{
/// Points, and triangles where the dataset has faces (polygons are divided).
/// @return failures of CheckSampledPoints and DecodeMesh.
Result<TriangleMesh> DecodeScan(vtkPointSet* data);

struct ScanAndTarget
{
  TriangleMesh Scan;
  FitTargetPtr Target;
};

/// Of port 0 and port 1.
/// @param what  the target is called so in messages.
/// @return failures of DecodeScan and DecodeFitTarget.
Result<ScanAndTarget> DecodeScanAndTarget(vtkInformationVector** inputs, const std::string& what,
  const FitTargetOptions& options, int threads);

/// The dataset at another place: its points, the active normals of its points and cells; other
/// arrays are as they were. Coordinates are doubles. The matrix is the field array `Motion`, 16
/// numbers by rows.
void EncodeMoved(vtkPointSet* input, const RigidMotion& motion, vtkPointSet* output);

/// The point arrays `Distance` (the active scalars), `TargetPoint` and `TargetFace`.
void EncodeDistances(const TargetDistances& distances, vtkPointSet* output);

/// Columns of a row: Points, Min, Max, Mean, MeanAbsolute, Rms, with a prefix.
void AddProfile(vtkTable* table, const std::string& prefix, const DistanceProfile& profile);
}
