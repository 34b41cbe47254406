// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDeviationMap
 * @brief   compares a scan with a CAD model, a spline or a mesh, both ways
 *
 * Input 0 is the scan at its place: triangles (polygons are divided) or points alone. Input 1 is
 * the model: trimmed faces of a CAD file (vtkCADReader), spline surfaces or volumes, whose boundary
 * is meant, or triangles.
 *
 * Distances are positive where the scan lies outside of the model, of an open one on the side that
 * its normals point to, both ways.
 *
 * Output 0 is the scan with the point arrays Distance, TargetPoint (of the model) and TargetFace.
 * Output 1 are triangles of the model, whose points lie on it, with the point arrays Distance (from
 * the scan's triangles, or its points where it has none; NaN beyond MaximumDistance) and ScanPoint.
 * Output 2 is a table with a row a percentile: Percent, ScanToModel, ModelToScan (of absolute
 * distances; those of the model by area). Output 3 is a table of one row: ScanPoints, ScanMin,
 * ScanMax, ScanMean, ScanMeanAbsolute, ScanRms, the same with Model, PointsWithout, Signed.
 */
#ifndef vtkDeviationMap_h
#define vtkDeviationMap_h
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADFITTING_EXPORT vtkDeviationMap : public vtkSplineAlgorithm
{
public:
  static vtkDeviationMap* New();
  vtkTypeMacro(vtkDeviationMap, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Points of the model at least. Default 20000, valid range [100, 10000000]. */
  vtkSetClampMacro(Samples, int, 100, 10000000);
  vtkGetMacro(Samples, int);
  ///@}
  ///@{
  /** Points of the model that are farther from the scan have no distance: nobody scanned them; 0:
   * all have one. Default 0, valid range >= 0. */
  vtkSetClampMacro(MaximumDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumDistance, double);
  ///@}
  ///@{
  /** The model (input port 1). */
  void SetModelConnection(vtkAlgorithmOutput* output);
  void SetModelData(vtkDataObject* model);
  ///@}

protected:
  vtkDeviationMap();
  ~vtkDeviationMap() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkDeviationMap(const vtkDeviationMap&) = delete;
  void operator=(const vtkDeviationMap&) = delete;

  int Samples = 20000;
  double MaximumDistance = 0.0;
};
#endif
