// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineRefine
 * @brief   splits elements and raises degrees; the map stays what it is
 *
 * Elements are halved in every direction, either everywhere or where they are marked:
 *
 * - UNIFORM: all elements of all patches. Tensor-product patches stay tensor-product (knots at the
 *   midpoints), hierarchical ones stay hierarchical, Bezier patches are subdivided.
 * - CELL_ARRAY: elements whose value in a one-component cell array (SetInputArrayToProcess 0) lies
 *   in [LowerThreshold, UpperThreshold].
 * - IMPLICIT_FUNCTION: elements sampled at the 3^d points of local parameters 0, 1/2, 1 (corners,
 *   middles of edges and faces, centre) of the spline map. CROSSED: the function has a value <= 0
 *   and a value >= 0 there; CROSSED_OR_INSIDE: it has a value <= 0. What lies between the samples
 * is not seen.
 * - SELECTION: cells that a vtkSelection on port 1 selects.
 * - SEGMENTS: no elements: mesh lines of LR B-splines are inserted, exactly those that port 2
 * gives, in any order: a table with the columns Direction, Value, Start, End, Multiplicity,
 * PatchId, or lines in the plane of the parameters (SegmentTable.h). Patches without a segment stay
 * as they are.
 *
 * Marked elements are refined locally. What a tensor-product surface or volume becomes is
 * LocalSpace's choice: a truncated hierarchical (THB) spline or an LR spline; curves become
 * hierarchical. Patches that are hierarchical or LR stay it. Of patches on unstructured meshes all
 * sheets of cells that run through the marked ones are halved along their parallel edges. With
 * GlobalRefinement every patch that has a marked element is refined as by UNIFORM. In repeated
 * refinements the children of marked elements are marked (CELL_ARRAY, SELECTION), or the new
 * elements are sampled again (IMPLICIT_FUNCTION).
 *
 * An LR patch is refined by mesh lines, in UNIFORM mode too. LRStrategy says how long they are:
 * across all functions alive on an element (FULL_SPAN), across the smallest (MINIMUM_SPAN), all
 * knot spans of a function halved (STRUCTURED_MESH), or those of them with marked elements that are
 * longer than half the longest (RESTRICTED_MESH). LRTarget says what is halved: the marked
 * elements, or FUNCTIONS, namely those with at least half of their support marked and for every
 * marked element the one with the largest part marked. LRDirections restricts the lines to one
 * parameter, or to one after the other with every refinement. With KeepIndependent lines are added
 * until the functions of LR patches are linearly independent, after every refinement, and with
 * NumberOfRefinements 0 also of patches that came in dependent. See LRStrategies.h, LRDependence.h.
 *
 * The map, its weights and all fields do not change (up to rounding). Cell arrays other than those
 * of the spline grid pass to the children.
 *
 * Errors: local refinement of Bezier patches and degree elevation of hierarchical patches
 * (DimensionMismatch), segments that are no mesh lines (what LRRefinement::Insert returns) or of
 * patches that are no surfaces (DimensionMismatch), a dependence that 100 more lines do not resolve
 * (NotConverged), degree above 9 (InvalidDegree), no such array, function, selection, column or
 * patch (InvalidParameter), no segment (EmptyInput), more functions than MaximumFunctions
 * (TooLarge), and those of decoding.
 */
#ifndef vtkSplineRefine_h
#define vtkSplineRefine_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class vtkImplicitFunction;

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineRefine : public vtkSplineAlgorithm
{
public:
  static vtkSplineRefine* New();
  vtkTypeMacro(vtkSplineRefine, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Modes
  {
    UNIFORM = 0,
    CELL_ARRAY,
    IMPLICIT_FUNCTION,
    SELECTION,
    SEGMENTS
  };
  enum LocalSpaces
  {
    HIERARCHICAL = 0, ///< "Hierarchical (THB)"
    LOCALLY_REFINED   ///< "Locally Refined (LR)"
  };
  enum LRStrategies
  {
    FULL_SPAN = 0,
    MINIMUM_SPAN,
    STRUCTURED_MESH,
    RESTRICTED_MESH
  };
  enum LRTargets
  {
    ELEMENTS = 0,
    FUNCTIONS
  };
  enum LRDirectionChoices
  {
    BOTH = 0,
    ALTERNATING,
    FIRST,
    SECOND
  };
  enum Regions
  {
    CROSSED = 0,
    CROSSED_OR_INSIDE
  };

  ///@{
  /** Which elements are refined: all, or those that a cell array, an implicit function or a
   * selection marks; or the mesh line segments that are inserted; one of Modes. Default UNIFORM. */
  vtkSetClampMacro(Mode, int, UNIFORM, SEGMENTS);
  vtkGetMacro(Mode, int);
  ///@}
  ///@{
  /** How often elements are halved; children of marked elements are marked again, an implicit
   * function looks at the new elements. Default 1, valid range [0, 10]. For Mode not SEGMENTS. */
  vtkSetClampMacro(NumberOfRefinements, int, 0, 10);
  vtkGetMacro(NumberOfRefinements, int);
  ///@}
  ///@{
  /** Whether a patch with marked elements is refined everywhere, so that it stays what it is,
   * tensor-product or Bezier. Default off. For Mode not UNIFORM, SEGMENTS. Group "Local
   * Refinement". */
  vtkSetMacro(GlobalRefinement, bool);
  vtkGetMacro(GlobalRefinement, bool);
  vtkBooleanMacro(GlobalRefinement, bool);
  ///@}
  ///@{
  /** Degrees added in every direction before elements are halved, continuity stays; not for
   * hierarchical patches. Default 0, valid range [0, 8]. */
  vtkSetClampMacro(DegreeElevation, int, 0, 8);
  vtkGetMacro(DegreeElevation, int);
  ///@}
  ///@{
  /** Lowest value of a marked element of the cell array, inclusive. Default 0. For Mode
   * CELL_ARRAY. Group "Marks". */
  vtkSetMacro(LowerThreshold, double);
  vtkGetMacro(LowerThreshold, double);
  ///@}
  ///@{
  /** Highest value of a marked element of the cell array, inclusive. Default 1e299. For Mode
   * CELL_ARRAY. Group "Marks". */
  vtkSetMacro(UpperThreshold, double);
  vtkGetMacro(UpperThreshold, double);
  ///@}
  ///@{
  /** The function of mode IMPLICIT_FUNCTION. Default none. */
  virtual void SetImplicitFunction(vtkImplicitFunction* function);
  vtkGetObjectMacro(ImplicitFunction, vtkImplicitFunction);
  ///@}
  ///@{
  /** Whether elements are marked that the function's surface crosses, or those inside as well,
   * one of Regions. Corners, middles and the centre of elements are looked at; what lies between
   * is not seen. Default CROSSED_OR_INSIDE. For Mode IMPLICIT_FUNCTION. Group "Marks". */
  vtkSetClampMacro(ImplicitRegion, int, CROSSED, CROSSED_OR_INSIDE);
  vtkGetMacro(ImplicitRegion, int);
  ///@}
  ///@{
  /** Rings of new cells around marked elements that are split too; -1: the smallest number that
   * brings new functions, (degree - 1) / 2 rounded up. Default -1, valid range [-1, 16].
   * Advanced. For Mode not UNIFORM, SEGMENTS. Group "Local Refinement". */
  vtkSetClampMacro(Extension, int, -1, 16);
  vtkGetMacro(Extension, int);
  ///@}
  ///@{
  /** Functions alive on an element belong to at most so many successive levels; 0: no such
   * limit, 1 is not valid. Default 0, valid range [0, 24]. Advanced. For Mode not UNIFORM,
   * SEGMENTS. Group "Local Refinement". */
  vtkSetClampMacro(AdmissibleClass, int, 0, 24);
  vtkGetMacro(AdmissibleClass, int);
  ///@}
  ///@{
  /** Elements of this level are not split locally. Default 24, valid range [1, 24]. Advanced.
   * For Mode not UNIFORM, SEGMENTS. Group "Local Refinement". */
  vtkSetClampMacro(MaxLevel, int, 1, 24);
  vtkGetMacro(MaxLevel, int);
  ///@}
  ///@{
  /** What local refinement makes of tensor-product surfaces and volumes, one of LocalSpaces.
   * Default HIERARCHICAL. For Mode not UNIFORM, SEGMENTS. Group "Local Refinement". */
  vtkSetClampMacro(LocalSpace, int, HIERARCHICAL, LOCALLY_REFINED);
  vtkGetMacro(LocalSpace, int);
  ///@}
  ///@{
  /** How long the new lines of LR patches are: across all functions alive on an element, across
   * the smallest, all knot spans of a function halved, or those of them that hold marked elements
   * and are longer than half the longest; one of LRStrategies. Default FULL_SPAN. Advanced. Group
   * "LR Splines". */
  vtkSetClampMacro(LRStrategy, int, FULL_SPAN, RESTRICTED_MESH);
  vtkGetMacro(LRStrategy, int);
  ///@}
  ///@{
  /** What is halved in LR patches: the marked elements, or the functions that have the most of
   * their support marked; one of LRTargets. Default ELEMENTS. Advanced. Group "LR Splines". */
  vtkSetClampMacro(LRTarget, int, ELEMENTS, FUNCTIONS);
  vtkGetMacro(LRTarget, int);
  ///@}
  ///@{
  /** The parameter that is constant on the new lines of LR patches, one of LRDirectionChoices;
   * ALTERNATING begins with the first one. Default BOTH. Advanced. Group "LR Splines". */
  vtkSetClampMacro(LRDirections, int, BOTH, SECOND);
  vtkGetMacro(LRDirections, int);
  ///@}
  ///@{
  /** Whether lines are added until the functions of LR patches are linearly independent, with no
   * refinements too. Default off. Advanced. Group "LR Splines". */
  vtkSetMacro(KeepIndependent, bool);
  vtkGetMacro(KeepIndependent, bool);
  vtkBooleanMacro(KeepIndependent, bool);
  ///@}
  ///@{
  /** The selection of mode SELECTION (input port 1, optional). */
  void SetSelectionConnection(vtkAlgorithmOutput* output);
  void SetSelectionData(vtkDataObject* selection);
  ///@}
  ///@{
  /** The segments of mode SEGMENTS (input port 2, optional), vtkTable or vtkPolyData. */
  void SetSegmentsConnection(vtkAlgorithmOutput* output);
  void SetSegmentsData(vtkDataObject* segments);
  ///@}

  vtkMTimeType GetMTime() override;

  ///@{
  /** Functions that all patches may have together after the refinement; more is an error before
   * memory is taken. Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineRefine();
  ~vtkSplineRefine() override;
  bool WorksOnPieces() const override { return this->Mode != SEGMENTS; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineRefine(const vtkSplineRefine&) = delete;
  void operator=(const vtkSplineRefine&) = delete;
  class Marker;
  class Stepper;

  int MaximumFunctions = 1000000;
  int Mode = UNIFORM;
  int NumberOfRefinements = 1;
  bool GlobalRefinement = false;
  int DegreeElevation = 0;
  double LowerThreshold = 0.0;
  double UpperThreshold = 1e299;
  vtkImplicitFunction* ImplicitFunction = nullptr;
  int ImplicitRegion = CROSSED_OR_INSIDE;
  int Extension = -1;
  int AdmissibleClass = 0;
  int MaxLevel = 24;
  int LocalSpace = HIERARCHICAL;
  int LRStrategy = FULL_SPAN;
  int LRTarget = ELEMENTS;
  int LRDirections = BOTH;
  bool KeepIndependent = false;
};
#endif
