// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTrimmedSurface
 * @brief   makes trimmed spline faces of a triangle mesh with plane coordinates
 *
 * Input 0 is a triangle mesh (vtkPolyData or vtkUnstructuredGrid) with the point array `UV`, as
 * vtkMeshParameterization makes it: no triangle is flipped in the plane. With a cell array
 * `ChartId` every chart becomes a face; points where charts meet are shared, or have the same
 * value of the point array `CutPointId`.
 *
 * Output 0 are the faces as a watertight triangulation with normals, `FaceId` and their parameters
 * (`UV`, or `CornerUV` of the cells when there are several faces). Outputs 1 and 2 are the faces
 * themselves, their surfaces and their trimming curves as spline grids (TrimmedGrids.h). Output 3
 * is the input with the point array `Deviation` and the cell array `DeviationBound`: distances to
 * the surface, proved inside the triangles. Output 4 is a table of one row with all numbers.
 *
 * Faces that miss the tolerance, or are not proved regular, and loops that are not proved simple
 * are an output with a warning.
 *
 * @source Ruiz, Mejia, Cadavid (2015). The module's page has methods, certificates, limits, errors.
 */
#ifndef vtkTrimmedSurface_h
#define vtkTrimmedSurface_h
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACETRIMMING_EXPORT vtkTrimmedSurface : public vtkSplineAlgorithm
{
public:
  static vtkTrimmedSurface* New();
  vtkTypeMacro(vtkTrimmedSurface, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    NURBS = 0,      ///< "NURBS" a surface over the largest grid in the chart, continued by rings
    RBF,            ///< "RBF" thin-plate radial basis functions, followed by a spline
    HYBRID,         ///< control points are values of the radial basis functions
    PENALIZED,      ///< least squares with thin-plate energy
    CONTINUED_LINES ///< all grid points in the chart, rows and columns continued outwards
  };

  ///@{
  /** How the surfaces are made, one of Methods. PENALIZED: least squares with thin-plate energy,
   * for meshes of any size. RBF: thin-plate radial basis functions; HYBRID: their values as
   * control points. NURBS and CONTINUED_LINES extrapolate, which may fold beside the mesh, and are
   * here to compare with: NURBS, as it is published, a surface through the largest grid in the
   * chart, ring by ring; CONTINUED_LINES rows and columns of grid points. Default PENALIZED. */
  vtkSetClampMacro(Method, int, NURBS, CONTINUED_LINES);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** Largest distance between mesh and faces, unit of the points; 0: a thousandth of the
   * diagonal of the mesh's box. Default 0, valid range >= 0. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Largest distance between triangles and faces, unit of the points; 0: a quarter of the
   * tolerance. Default 0, valid range >= 0. Advanced. For Triangulation on. */
  vtkSetClampMacro(ChordalTolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Spans of a net in its longer direction; 0: as many as the tolerance asks for. Default 0,
   * valid range [0, 2000]. Advanced. */
  vtkSetClampMacro(Elements, int, 0, 2000);
  vtkGetMacro(Elements, int);
  ///@}
  ///@{
  /** Spans of a net in a direction at most, when their number follows the tolerance. Default
   * 400, valid range [1, 2000]. Advanced. */
  vtkSetClampMacro(MaximumElements, int, 1, 2000);
  vtkGetMacro(MaximumElements, int);
  ///@}
  ///@{
  /** Degree of the surfaces. Default 3, valid range [1, 9]. Advanced. */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Margin of the surfaces around their charts, part of the longest side. Default 0.02, valid
   * range [0, 1]. Advanced. */
  vtkSetClampMacro(Margin, double, 0.0, 1.0);
  vtkGetMacro(Margin, double);
  ///@}
  ///@{
  /** Weight of the thin-plate energy of PENALIZED, independent of units; less on finer nets.
   * Default 1e-7, valid range [1e-15, 1000]. Advanced. For Method PENALIZED. */
  vtkSetClampMacro(Smoothing, double, 1e-15, 1e3);
  vtkGetMacro(Smoothing, double);
  ///@}
  ///@{
  /** Radial basis functions of RBF and HYBRID at most: all points up to so many, else the greedy
   * choice of so many. Default 2000, valid range [10, 20000]. Advanced. For Method RBF, HYBRID. */
  vtkSetClampMacro(Centres, int, 10, 20000);
  vtkGetMacro(Centres, int);
  ///@}
  ///@{
  /** Angle in degrees by which a boundary turns at a point at least to have a corner there,
   * where edges end. Default 20, valid range [1, 180]. */
  vtkSetClampMacro(CornerAngle, double, 1.0, 180.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Functions that the net of a surface may have: 200000 take about 1.5e9 bytes. A net by need
   * ends before it; Elements that would make more are an error. Default 200000, valid range >=
   * 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}
  ///@{
  /** Work of PENALIZED at most, with what its faces cost until a CAD file of them is checked:
   * about as many seconds of one core, but counted, so that the same run ends at the same place
   * on every machine, with the best surfaces so far. Default 50, valid range [1e-6, 1000000]. */
  vtkSetClampMacro(Effort, double, 1e-6, 1e6);
  vtkGetMacro(Effort, double);
  ///@}
  ///@{
  /** Seconds of the wall clock at most, then the best surfaces so far are taken; 0: no limit.
   * The result then depends on the machine's speed. Default 0, valid range [0, 1000000000].
   * Advanced. */
  vtkSetClampMacro(TimeLimit, double, 0.0, 1e9);
  vtkGetMacro(TimeLimit, double);
  ///@}
  ///@{
  /** Whether the faces are triangulated, output 0; off saves the time when only the faces are
   * wanted. Default on. Advanced. */
  vtkSetMacro(Triangulation, bool);
  vtkGetMacro(Triangulation, bool);
  vtkBooleanMacro(Triangulation, bool);
  ///@}

  /**
   * Measured seconds of the last run. They are in no output: outputs are the same from run to run.
   */
  vtkGetMacro(Seconds, double);

protected:
  vtkTrimmedSurface();
  ~vtkTrimmedSurface() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkTrimmedSurface(const vtkTrimmedSurface&) = delete;
  void operator=(const vtkTrimmedSurface&) = delete;

  double Seconds = 0.0;
  int Method = PENALIZED;
  double Tolerance = 0.0;
  double ChordalTolerance = 0.0;
  int Elements = 0;
  int MaximumElements = 400;
  int Degree = 3;
  double Margin = 0.02;
  double Smoothing = 1e-7;
  int Centres = 2000;
  double CornerAngle = 20.0;
  int MaximumFunctions = 200000;
  double Effort = 50.0;
  double TimeLimit = 0.0;
  bool Triangulation = true;
};
#endif
