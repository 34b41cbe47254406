// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplinePointDistance
 * @brief   signed distances of points from spline surfaces, and classes of them
 *
 * Input 0 are the points (a vtkPointSet), input 1 the surfaces: all surface patches of a spline
 * grid or of a collection of them, of any kind.
 *
 * VERTICAL is z of a point minus z of the surface at its x and y; CLOSEST is the distance from the
 * closest point, positive on the side that the surface's normal points to. AUTOMATIC takes VERTICAL
 * when all surfaces are height fields (x and y are the parameters), else CLOSEST.
 *
 * With tolerances t_1 < ... < t_k a point's class is 0 when its distance is at most t_1, else the
 * number of tolerances below it, negative for points below the surface.
 *
 * Output 0 is input 0 with the point arrays Distance (NaN where no surface lies above or below the
 * point), DistanceClass, SurfacePoint (where the distance is measured from), SurfacePatchId and
 * SurfaceElementId (-1 without a distance). Output 1 is a table with a row a class (Class, Lower,
 * Upper, Points, Share, Min, Max, Mean, MeanAbsolute, Rms), output 2 a table of one row with the
 * same of all points. Of several processes (MPI) each measures its piece of the points from the
 * whole of the surfaces; the tables are those of all points in the first process and empty
 * elsewhere (means differ by rounding from those of one process).
 */
#ifndef vtkSplinePointDistance_h
#define vtkSplinePointDistance_h
#include "vtkKnotworkSurfaceFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <vector> // for tolerances

class VTKKNOTWORKSURFACEFITTING_EXPORT vtkSplinePointDistance : public vtkSplineAlgorithm
{
public:
  static vtkSplinePointDistance* New();
  vtkTypeMacro(vtkSplinePointDistance, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    AUTOMATIC = 0,
    VERTICAL,
    CLOSEST
  };

  ///@{
  /** What is measured, one of Kinds: VERTICAL, z of a point minus z of the surface; CLOSEST, the
   * distance from the closest point with the sign of the normal's side; AUTOMATIC, the first one
   * when all surfaces are height fields. Default AUTOMATIC. */
  vtkSetClampMacro(Kind, int, AUTOMATIC, CLOSEST);
  vtkGetMacro(Kind, int);
  ///@}
  ///@{
  /** Limits of the classes, > 0 and ascending, unit of the points. Default none. */
  void AddTolerance(double tolerance);
  void ClearTolerances();
  ///@}
  ///@{
  /** The surfaces (input port 1). */
  void SetSurfaceConnection(vtkAlgorithmOutput* output);
  void SetSurfaceData(vtkDataObject* surface);
  ///@}

protected:
  vtkSplinePointDistance();
  ~vtkSplinePointDistance() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  bool SumsUpPieces() const override { return true; }
  int WholeInputPort() const override { return 1; }
  knotwork::Status Merge(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplinePointDistance(const vtkSplinePointDistance&) = delete;
  void operator=(const vtkSplinePointDistance&) = delete;

  int Kind = AUTOMATIC;
  std::vector<double> Tolerances;
};
#endif
