// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineDefinition
 * @brief   spline grids from knot vectors, control points and weights, and back
 *
 * For programs that have splines as numbers and not as files: AddTensorPatch() patch by patch, then
 * MakeGrid(); or Decode() a spline grid, whose patches are then asked for degrees, knots, control
 * points and weights. In Python knotwork.spline() and the attributes of spline grids call it.
 *
 * It is no part of a pipeline. A call that fails says why in GetErrorText() and leaves the patches
 * as they were.
 */
#ifndef vtkSplineDefinition_h
#define vtkSplineDefinition_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include "vtkObject.h"

#include <knotwork/SplineCore/Spline.h> // for knotwork::AnySpline
#include <knotwork/SplineCore/Status.h> // for knotwork::Status
#include <memory>                       // for the patches
#include <string>                       // for ErrorText

class vtkDataArray;
class vtkDataObject;
class vtkDoubleArray;
class vtkUnstructuredGrid;

namespace knotwork
{
struct SplineModel;
}

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineDefinition : public vtkObject
{
public:
  static vtkSplineDefinition* New();
  vtkTypeMacro(vtkSplineDefinition, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Adds a tensor-product patch, whose PatchId is the number of patches before it.
   * @param dimension  parameters, 1 to 3; knots of further directions are not read and may be null.
   * @param knots0,knots1,knots2  of each direction: functions + degree + 1 values that do not
   *                   decrease.
   * @param degrees    one a direction, 1 to 9: array of `dimension` values.
   * @param points     control points, not multiplied by weights: rows of 2 or 3 components, the
   *                   first direction fastest.
   * @param weights    one a control point, positive; null: a polynomial patch.
   * @return false: GetErrorText says what does not fit.
   */
  bool AddTensorPatch(int dimension, vtkDataArray* degrees, vtkDataArray* knots0,
    vtkDataArray* knots1, vtkDataArray* knots2, vtkDataArray* points, vtkDataArray* weights);

  /** A spline grid of the patches. False: GetErrorText says why. */
  bool MakeGrid(vtkUnstructuredGrid* grid);

  /** Takes the patches of a vtkUnstructuredGrid of Bezier cells or of a
   * vtkPartitionedDataSetCollection of such grids. False: GetErrorText says why. */
  bool Decode(vtkDataObject* splines);

  int GetNumberOfPatches();
  /** Of the patch with an index in [0, GetNumberOfPatches()), as all that follow; others have the
   * id -1 and nothing. */
  int GetPatchId(int patch);
  /** Number of parameters, 1 to 3. */
  int GetDimension(int patch);
  /** Family of the space: "tensor-product", "hierarchical", "locally-refined", ... */
  std::string GetFamily(int patch);
  /** Degree in a direction in [0, dimension); 0 where elements have different degrees. */
  int GetDegree(int patch, int direction);
  /** Fills `knots` with the knot vector of a direction; none for families that have no
   * global one. Of hierarchical splines that of level 0, of LR splines the distinct knots. */
  void GetKnots(int patch, int direction, vtkDoubleArray* knots);
  /** Fills `points` with the control points, three components, not multiplied by weights. */
  void GetControlPoints(int patch, vtkDoubleArray* points);
  /** Fills `weights` with one a control point; with none where the patch is polynomial. */
  void GetWeights(int patch, vtkDoubleArray* weights);

  ///@{
  /** Of the last call that could fail: vtkErrorCode::UserError + code of the error, and its
   * sentence; 0 and empty without any. */
  vtkGetMacro(ErrorCode, unsigned long);
  vtkGetMacro(ErrorText, std::string);
  ///@}

protected:
  vtkSplineDefinition();
  ~vtkSplineDefinition() override;

private:
  vtkSplineDefinition(const vtkSplineDefinition&) = delete;
  void operator=(const vtkSplineDefinition&) = delete;
  bool End(const knotwork::Status& status);
  /** Null for a number that no patch has. */
  const knotwork::AnySpline* Geometry(int patch);

  std::unique_ptr<knotwork::SplineModel> Model;
  unsigned long ErrorCode = 0;
  std::string ErrorText;
};
#endif
