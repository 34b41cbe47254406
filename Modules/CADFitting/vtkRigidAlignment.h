// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkRigidAlignment
 * @brief   moves a scan onto a CAD part, a spline or a mesh by a rigid motion
 *
 * Input 0 is the scan: triangles (polygons are divided) or points alone (a vtkPointSet). Input 1 is
 * the target: trimmed faces of a CAD file (vtkCADReader), spline surfaces or volumes, whose
 * boundary is meant, or triangles.
 *
 * The pose is searched for by principal axes in all proper orders and signs and, where these are
 * ambiguous, by evenly spread rotations; then the distances from tangent planes at the closest
 * points are made least, without outliers.
 *
 * Output 0 is the scan at its new place with the point arrays Distance (positive outside of a
 * closed target, else where its normals point to), TargetPoint (that it is measured from) and
 * TargetFace, and the field array Motion: 16 numbers, the matrix by rows. Active normals turn with
 * the points.
 *
 * Output 1 is a table of one row: Converged, Iterations, LastStep, Inliers, InlierFraction,
 * InlierRms, OutlierDistance (-1: none), Points, Min, Max, Mean, MeanAbsolute, Rms, Percentiles (of
 * the absolute distances: 50, 90, 95, 99, 99.9, 100 percent), Ambiguous, EqualPoses (poses at which
 * the scan lies as well; 0: a continuum), FreeMotions, TargetSize, Signed, Motion.
 *
 * @source Besl, McKay (1992); Chen, Medioni (1992); Low (2004); Zhang (1994). The module's page has
 * limits and errors.
 */
#ifndef vtkRigidAlignment_h
#define vtkRigidAlignment_h
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADFITTING_EXPORT vtkRigidAlignment : public vtkSplineAlgorithm
{
public:
  static vtkRigidAlignment* New();
  vtkTypeMacro(vtkRigidAlignment, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutlierRules
  {
    TUKEY = 0,
    TRIMMED,
    NO_OUTLIERS ///< "None"
  };

  ///@{
  /** Whether the pose is searched for; off: the scan lies near its place already, within a tenth of
   * the target's size. Default on. */
  vtkSetMacro(Coarse, bool);
  vtkGetMacro(Coarse, bool);
  vtkBooleanMacro(Coarse, bool);
  ///@}
  ///@{
  /** What becomes of points that lie far from the target, one of OutlierRules: TUKEY, they weigh
   * less with their distance, nothing beyond 4.685 times the noise that is found; TRIMMED, the
   * share TrimmedShare of the points is left out; NO_OUTLIERS, all points weigh alike. Default
   * TUKEY. */
  vtkSetClampMacro(Outliers, int, TUKEY, NO_OUTLIERS);
  vtkGetMacro(Outliers, int);
  ///@}
  ///@{
  /** Share of the points that is left out, those that are farthest. Default 0.2, valid range
   * [0, 0.9]. For Outliers TRIMMED. */
  vtkSetClampMacro(TrimmedShare, double, 0.0, 0.9);
  vtkGetMacro(TrimmedShare, double);
  ///@}
  ///@{
  /** Points of the scan that the motion is found with at most; distances are measured at all.
   * Default 10000, valid range [100, 100000000]. */
  vtkSetClampMacro(Samples, int, 100, 100000000);
  vtkGetMacro(Samples, int);
  ///@}
  ///@{
  /** Iterations of the refinement at most. Default 200, valid range [1, 100000]. Advanced. */
  vtkSetClampMacro(MaximumIterations, int, 1, 100000);
  vtkGetMacro(MaximumIterations, int);
  ///@}
  ///@{
  /** Motion of a step, relative to the target's size, at which it has settled; a tenth of noise /
   * sqrt(points) where that is more. Default 1e-9, valid range [1e-14, 0.01]. Advanced. */
  vtkSetClampMacro(Tolerance, double, 1e-14, 0.01);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** The target (input port 1). */
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}

protected:
  vtkRigidAlignment();
  ~vtkRigidAlignment() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkRigidAlignment(const vtkRigidAlignment&) = delete;
  void operator=(const vtkRigidAlignment&) = delete;

  bool Coarse = true;
  int Outliers = TUKEY;
  double TrimmedShare = 0.2;
  int Samples = 10000;
  int MaximumIterations = 200;
  double Tolerance = 1e-9;
};
#endif
