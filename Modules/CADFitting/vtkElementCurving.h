// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkElementCurving
 * @brief   finite elements of higher order whose edges and faces follow a CAD part
 *
 * Input 0 is a conforming mesh (vtkPolyData or vtkUnstructuredGrid) of triangles and quadrilaterals
 * in space, or of tetrahedra, wedges and hexahedra, of any order: their corners are taken. Cells of
 * fewer dimensions than others are left out. Input 1 is the target: faces of a CAD file
 * (vtkCADReader), spline surfaces, volumes, whose boundary is meant, or triangles.
 *
 * Points of the boundary go to the target's corners, sharp edges and faces, points inside follow
 * them. Every element is certified, and the points of one that is not valid go back towards the
 * straight element until it and its neighbours are.
 *
 * Output 0 has Lagrange or Bezier cells with the cell arrays of the mesh, `Verdict` (1: valid),
 * `MinJacobianLower`, `Relaxed` (1: a point is not where it belongs) and `Distance` (largest
 * sampled one of the element's boundary from the target; 0 inside). Output 1 is a table of one row.
 *
 * @source Johnen, Remacle, Geuzaine, JCP 233 (2013) 359-372. The module's page has methods, limits
 * and errors.
 */
#ifndef vtkElementCurving_h
#define vtkElementCurving_h
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADFITTING_EXPORT vtkElementCurving : public vtkSplineAlgorithm
{
public:
  static vtkElementCurving* New();
  vtkTypeMacro(vtkElementCurving, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Bases
  {
    LAGRANGE = 0,
    BEZIER
  };

  ///@{
  /** Order of the elements in all directions. Default 2, valid range [2, 4]. */
  vtkSetClampMacro(Order, int, 2, 4);
  vtkGetMacro(Order, int);
  ///@}
  ///@{
  /** What the points of the cells are, one of Bases: LAGRANGE, points that they pass through;
   * BEZIER, control points. Default LAGRANGE. */
  vtkSetClampMacro(Basis, int, LAGRANGE, BEZIER);
  vtkGetMacro(Basis, int);
  ///@}
  ///@{
  /** Edges of a target of triangles between normals that differ by this angle in degrees are
   * sharp. Default 40, valid range [1, 179]. */
  vtkSetClampMacro(SharpAngle, double, 1.0, 179.0);
  vtkGetMacro(SharpAngle, double);
  ///@}
  ///@{
  /** The same of edges that continue sharp ones, and of edges between faces of a CAD model or
   * spline surfaces; not above SharpAngle. Default 20, valid range [1, 179]. */
  vtkSetClampMacro(WeakAngle, double, 1.0, 179.0);
  vtkGetMacro(WeakAngle, double);
  ///@}
  ///@{
  /** Turn in degrees of sharp edges and rims from which on they have a corner. Default 60, valid
   * range [1, 180]. Advanced. */
  vtkSetClampMacro(CornerAngle, double, 1.0, 180.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Faces of a CAD model that count as one, by their numbers: `0,1,2;5,6` are two groups. Edges
   * inside of a group are not sharp at any angle. Default empty. Advanced. */
  vtkSetStringMacro(FaceGroups);
  vtkGetStringMacro(FaceGroups);
  ///@}
  ///@{
  /** Cell array of the mesh; faces between cells of different values belong on the target, too.
   * Empty or `None`: none does. Default empty. */
  vtkSetStringMacro(FeatureArray);
  vtkGetStringMacro(FeatureArray);
  ///@}
  ///@{
  /** The target (input port 1). */
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}

protected:
  vtkElementCurving();
  ~vtkElementCurving() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkElementCurving(const vtkElementCurving&) = delete;
  void operator=(const vtkElementCurving&) = delete;

  int Order = 2;
  int Basis = LAGRANGE;
  double SharpAngle = 40.0;
  double WeakAngle = 20.0;
  double CornerAngle = 60.0;
  char* FaceGroups = nullptr;
  char* FeatureArray = nullptr;
};
#endif
