// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceTrimming/BackMap.h>
#include <knotwork/SurfaceTrimming/FaceCertificate.h>
#include <knotwork/SurfaceTrimming/TrimLoops.h>
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

namespace knotwork
{
struct TrimParams
{
  /// Its Tolerance, Effort, TimeLimit, Threads and Progress are set from those below.
  BackMapParams BackMap;
  double CornerAngle = 20.0;
  /// Largest distance between mesh and face, unit of the points; 0: a thousandth of the diagonal of
  /// the points' box.
  double Tolerance = 0.0;
  /// Of the triangulation; 0: a quarter of Tolerance.
  double ChordalTolerance = 0.0;
  bool Triangulation = true;        ///< whether Mesh is made
  std::vector<LoopVertex> Vertices; ///< as of LoopParams
  /// As in BackMapParams, of all surfaces of Penalized together: charts have equal shares, and what
  /// is left goes to those that were stopped. What loops, proofs and a CAD file will take is kept
  /// back for them; they are made in any case, and so are triangles, which are not counted.
  double Effort = 50.0;
  double TimeLimit = 0.0;
  int Threads = 0;
  ProgressCallback Progress;
};

struct TrimmedSurface
{
  TrimmedModel Model; ///< a face a chart
  TrimmedMesh Mesh;
  TrimLoops Loops;               ///< without its Loops, which are in Model
  std::vector<BackMap> BackMaps; ///< without their surfaces, which are in Model
  std::vector<ChartDeviation> Deviations;
  std::vector<FaceCertificate> Certificates;
  double Tolerance = 0.0; ///< that was asked for
  double MaxDeviation =
    0.0; ///< bound of the distance from mesh to faces and back, boundary included
  double RmsDeviation = 0.0;
  double MinNormal = 0.0; ///< least of the certificates
  bool WithinTolerance = false;
  /// Of the first chart whose surface was stopped above its tolerance, or of attempts to prove
  /// faces regular; finished when there is none.
  BackMapStop Stop = BackMapStop::Finished;
  int StoppedChart = -1;
  std::string StopReason; ///< place of a contradiction
  double Work = 0.0;      ///< in the unit of TrimParams::Effort
};

/// Trimmed spline faces of charts: surface, loops, certificates, triangulation.
/// @return failures of the steps.
Result<TrimmedSurface> TrimSurface(const std::vector<ChartMesh>& charts, const TrimParams& params);
}
