// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADFit
 * @brief   one smooth spline on a mesh that lies on a CAD part, a scan or another shape
 *
 * Input 0 is a conforming mesh (vtkPolyData or vtkUnstructuredGrid) of linear quadrilaterals, in
 * space or in the plane, or of linear hexahedra. Input 1, optional, is the target: triangles,
 * closed or open; spline surfaces, trimmed faces of a CAD file (vtkCADReader) or volumes, whose
 * boundary is meant; curves. Without it the mesh itself is the target, unless Target is
 * IMPLICIT_FUNCTION.
 *
 * The surface of the mesh is classified on the target's faces, sharp edges and corners; its points
 * are moved there, folded cells untangled, and edges on the target's sharp edges become features of
 * a space on the mesh, on which the mesh and its closest points on the target are projected.
 * Elements that are not proved valid are mended.
 *
 * Output 0 is a spline grid of one patch of kind unstructured with the cell arrays of the mesh,
 * `Distance` (largest of the element's surface from the target; 0 inside), `DistanceBound` (proved;
 * of a target of triangles, with BoundedElements), `Verdict` (1 valid, 2 reversed, 0 undecided, -1
 * invalid) and `MinJacobianLower`. Output 1 is a table of one row,
 * output 2 one of the target's entities with their distances, output 3 points on the target with
 * their `Distance` from the spline and `Face`, output 4 points at curves and corners of the target
 * that the mesh has no edges or points for.
 *
 * @source Thomas, Scott, Evans, Tew, Evans, CMAME 284 (2015) 55-105. The module's page has methods,
 * limits and errors.
 */
#ifndef vtkCADFit_h
#define vtkCADFit_h
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class vtkImplicitFunction;

class VTKKNOTWORKCADFITTING_EXPORT vtkCADFit : public vtkSplineAlgorithm
{
public:
  static vtkCADFit* New();
  vtkTypeMacro(vtkCADFit, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Targets
  {
    INPUT = 0,
    IMPLICIT_FUNCTION
  };
  enum Policies
  {
    AUTOMATIC = 0,
    FULL,
    MOTORCYCLE,
    MINIMAL
  };
  enum SheetLengths
  {
    UNIFORM = 0,
    MEAN,
    AUTOMATIC_LENGTHS ///< "Automatic"
  };
  enum Paths
  {
    AUTOMATIC_PATH = 0, ///< "Automatic"
    UNSTRUCTURED,
    COMPOSITE,
    COONS,
    MULTILINEAR,
    AFFINE
  };
  enum PatchWeights
  {
    WEIGHTED = 0,
    PLAIN
  };
  enum SmoothingMethods
  {
    OFF = 0,
    NET,
    CERTIFICATE
  };

  ///@{
  /** Degree of the spline in all directions. Default 3, valid range [1, 9]. */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** What the spline is fitted to, one of Targets: INPUT, the target that is input, or without one
   * the mesh itself; IMPLICIT_FUNCTION, where that function is zero. Default INPUT. */
  vtkSetClampMacro(TargetType, int, INPUT, IMPLICIT_FUNCTION);
  vtkGetMacro(TargetType, int);
  ///@}
  ///@{
  /** The function of TargetType IMPLICIT_FUNCTION. Default none. */
  virtual void SetImplicitFunction(vtkImplicitFunction* function);
  vtkGetObjectMacro(ImplicitFunction, vtkImplicitFunction);
  ///@}
  ///@{
  /** Where the spline is less smooth than C^(p-1), one of Policies: FULL, C^0 along the whole base
   * complex of the extraordinary points, the most accurate; MOTORCYCLE, of quadrilaterals, C^0
   * along tracks that end where they meet others; MINIMAL, C^0 next to extraordinary points, then
   * C^1, C^2 and so on; AUTOMATIC, FULL where that creases at most 40 % of the inner edges or
   * faces, else MOTORCYCLE or, of hexahedra, MINIMAL. Default AUTOMATIC. */
  vtkSetClampMacro(Policy, int, AUTOMATIC, MINIMAL);
  vtkGetMacro(Policy, int);
  ///@}
  ///@{
  /** Knot intervals of the sheets of parallel edges, one of SheetLengths: UNIFORM, all 1; MEAN, as
   * the mean lengths of their edges; AUTOMATIC_LENGTHS, UNIFORM, or MEAN where elements are not
   * proved valid and that is better. Default AUTOMATIC_LENGTHS. Advanced. */
  vtkSetClampMacro(Lengths, int, UNIFORM, AUTOMATIC_LENGTHS);
  vtkGetMacro(Lengths, int);
  ///@}
  ///@{
  /** How the spline is made, one of Paths: UNSTRUCTURED, element by element; COMPOSITE, by the
   * tensor-product patches of the space; COONS, insides of patches from their boundaries, with
   * policy FULL and not of surfaces on a target; MULTILINEAR, from the corners of patches, without
   * a target; AFFINE, the same of elements that are images of one lattice; AUTOMATIC_PATH, AFFINE,
   * MULTILINEAR, then COMPOSITE where these give what UNSTRUCTURED does. One that does not apply
   * gives way to UNSTRUCTURED with a warning. Default AUTOMATIC_PATH. Advanced. */
  vtkSetClampMacro(Path, int, AUTOMATIC_PATH, AFFINE);
  vtkGetMacro(Path, int);
  ///@}
  ///@{
  /** How coefficients of patches become those of the spline on Path COMPOSITE, one of PatchWeights:
   * WEIGHTED, means by the shares of the function's integral; PLAIN, the shortest rows, which need
   * not exist with policies other than FULL. Default WEIGHTED. Advanced. For Path AUTOMATIC_PATH,
   * COMPOSITE. */
  vtkSetClampMacro(CompositeWeights, int, WEIGHTED, PLAIN);
  vtkGetMacro(CompositeWeights, int);
  ///@}
  ///@{
  /** Edges of a target of triangles between normals that differ by this angle in degrees are
   * sharp. Default 40, valid range [1, 179]. Group "Sharp Edges". */
  vtkSetClampMacro(SharpAngle, double, 1.0, 179.0);
  vtkGetMacro(SharpAngle, double);
  ///@}
  ///@{
  /** The same of edges that continue sharp ones, and of edges between faces of a CAD model or
   * spline surfaces; not above SharpAngle. Default 20, valid range [1, 179]. Group "Sharp Edges".
   */
  vtkSetClampMacro(WeakAngle, double, 1.0, 179.0);
  vtkGetMacro(WeakAngle, double);
  ///@}
  ///@{
  /** Turn in degrees of sharp edges and rims from which on they have a corner. Default 60, valid
   * range [1, 180]. Advanced. Group "Sharp Edges". */
  vtkSetClampMacro(CornerAngle, double, 1.0, 180.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Faces of a CAD model that count as one, by their numbers: `0,1,2;5,6` are two groups. Edges
   * inside of a group are not sharp at any angle. Default empty. Advanced. Group "Sharp Edges". */
  vtkSetStringMacro(FaceGroups);
  vtkGetStringMacro(FaceGroups);
  ///@}
  ///@{
  /** Edges between quadrilaterals whose normals differ by more than this angle in degrees are
   * features, C^0, whatever the target has there. 180: none is. Of quadrilaterals only. Default
   * 180, valid range [0, 180]. Advanced. Group "Sharp Edges". */
  vtkSetClampMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}
  ///@{
  /** Cell array of the mesh; edges, or faces of hexahedra, between cells of different values are
   * features. Empty or `None`: none is. Default empty. Group "Sharp Edges". */
  vtkSetStringMacro(FeatureArray);
  vtkGetStringMacro(FeatureArray);
  ///@}
  ///@{
  /** Whether every polygon is split at its middle into quadrilaterals. Default off. Advanced. */
  vtkSetMacro(SplitPolygons, bool);
  vtkGetMacro(SplitPolygons, bool);
  vtkBooleanMacro(SplitPolygons, bool);
  ///@}
  ///@{
  /** Whether the surface is fitted to the target's faces. Default on. Group "Fit". */
  vtkSetMacro(FitSurfaces, bool);
  vtkGetMacro(FitSurfaces, bool);
  vtkBooleanMacro(FitSurfaces, bool);
  ///@}
  ///@{
  /** Whether edges on sharp edges and rims are fitted to these, after the surface. Default on.
   * Group "Fit". */
  vtkSetMacro(FitCurves, bool);
  vtkGetMacro(FitCurves, bool);
  vtkBooleanMacro(FitCurves, bool);
  ///@}
  ///@{
  /** Whether points at the target's corners are put there, at last. Default on. Group "Fit". */
  vtkSetMacro(FitPoints, bool);
  vtkGetMacro(FitPoints, bool);
  vtkBooleanMacro(FitPoints, bool);
  ///@}
  ///@{
  /** Cell array of the mesh: cells with a value other than 0, of hexahedra their faces on the
   * mesh's surface, are fitted to the target; others stay where the mesh has them. Faces of
   * hexahedra must end at edges where the spline is C^0 (FeatureArray makes such). Distances are
   * those of the fitted cells. Empty or `None`: all are fitted. Default empty. Group "Fit". */
  vtkSetStringMacro(FitArray);
  vtkGetStringMacro(FitArray);
  ///@}
  ///@{
  /** Whether the volume is fitted anew with the coefficients that its surface has, the surface with
   * those of its curves and these with those of their corners, each as near to what it was before
   * as that allows; off: all others stay as they are. Default off. Advanced. Group "Fit". */
  vtkSetMacro(Constrain, bool);
  vtkGetMacro(Constrain, bool);
  vtkBooleanMacro(Constrain, bool);
  ///@}
  ///@{
  /** Times that the surface is projected onto the target, from the second on from where it was
   * fitted to before. Default 1, valid range [1, 100]. Advanced. Group "Fit". */
  vtkSetClampMacro(Projections, int, 1, 100);
  vtkGetMacro(Projections, int);
  ///@}
  ///@{
  /** Gauss points of an element a direction beyond Degree + 1, at which closest points are taken:
   * more for a target with finer detail. Default 1, valid range [0, 16]. Group "Fit". */
  vtkSetClampMacro(ExtraPoints, int, 0, 16);
  vtkGetMacro(ExtraPoints, int);
  ///@}
  ///@{
  /** Whether cells that are folded, as they are given or on the target, are untangled: their points
   * slide on the target. Default on. Group "Validity". */
  vtkSetMacro(Untangle, bool);
  vtkGetMacro(Untangle, bool);
  vtkBooleanMacro(Untangle, bool);
  ///@}
  ///@{
  /** Cells around folded ones, ring by ring, whose points may move. Default 2, valid range
   * [0, 100]. For Untangle on. Advanced. Group "Validity". */
  vtkSetClampMacro(UntangleRings, int, 0, 100);
  vtkGetMacro(UntangleRings, int);
  ///@}
  ///@{
  /** Whether a layer of hexahedra is put under the whole surface where a hexahedron has two faces
   * on one face of the target: no map is valid along their common edge. Default on. Group
   * "Validity". */
  vtkSetMacro(Layer, bool);
  vtkGetMacro(Layer, bool);
  vtkBooleanMacro(Layer, bool);
  ///@}
  ///@{
  /** Which elements are mended after the fit, one of SmoothingMethods: OFF, none; NET, those whose
   * control nets are inverted, which is no proof; CERTIFICATE, those that are not proved valid.
   * Default CERTIFICATE. Group "Validity". */
  vtkSetClampMacro(Smoothing, int, OFF, CERTIFICATE);
  vtkGetMacro(Smoothing, int);
  ///@}
  ///@{
  /** Elements around those that are mended, ring by ring, whose control points may move. Default 2,
   * valid range [0, 100]. Advanced. For Smoothing not OFF. Group "Validity". */
  vtkSetClampMacro(SmoothingRings, int, 0, 100);
  vtkGetMacro(SmoothingRings, int);
  ///@}
  ///@{
  /** Points on the target at which its distance from the spline is measured, at least; 0: it is
   * not. Default 20000, valid range [0, 100000000]. */
  vtkSetClampMacro(TargetSamples, int, 0, 100000000);
  vtkGetMacro(TargetSamples, int);
  ///@}
  ///@{
  /** Elements of the surface up to which its distances from a target of triangles, and back, are
   * bounded by proofs; 0: they are not. Default 100000, valid range [0, 100000000]. Advanced. */
  vtkSetClampMacro(BoundedElements, int, 0, 100000000);
  vtkGetMacro(BoundedElements, int);
  ///@}
  ///@{
  /** The target (input port 1). */
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}

  vtkMTimeType GetMTime() override;

protected:
  vtkCADFit();
  ~vtkCADFit() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkCADFit(const vtkCADFit&) = delete;
  void operator=(const vtkCADFit&) = delete;

  int Degree = 3;
  int TargetType = INPUT;
  vtkImplicitFunction* ImplicitFunction = nullptr;
  int Policy = AUTOMATIC;
  int Lengths = AUTOMATIC_LENGTHS;
  int Path = AUTOMATIC_PATH;
  int CompositeWeights = WEIGHTED;
  double SharpAngle = 40.0;
  double WeakAngle = 20.0;
  double CornerAngle = 60.0;
  char* FaceGroups = nullptr;
  double FeatureAngle = 180.0;
  char* FeatureArray = nullptr;
  bool SplitPolygons = false;
  bool FitSurfaces = true;
  bool FitCurves = true;
  bool FitPoints = true;
  char* FitArray = nullptr;
  bool Constrain = false;
  int Projections = 1;
  int ExtraPoints = 1;
  bool Untangle = true;
  int UntangleRings = 2;
  bool Layer = true;
  int Smoothing = CERTIFICATE;
  int SmoothingRings = 2;
  int TargetSamples = 20000;
  int BoundedElements = 100000;
};
#endif
