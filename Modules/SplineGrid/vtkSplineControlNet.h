// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineControlNet
 * @brief   control points of spline grids as vertices, and the lines of their net
 *
 * Output: vtkPolyData (for a collection: a collection of them) with one point a function. Lines
 * join neighbours in the grid of control points; in a hierarchical patch, functions of the same
 * level with neighbouring indices, so every level has a net of its own; in a Bezier patch, the nets
 * of the elements.
 *
 * Point arrays: Weight (1 in polynomial patches), FunctionId (in its patch), Level, PatchId,
 * Greville (three parameters, unused ones 0; 0 in Bezier patches), and the coefficients of every
 * field that the patches carry (0 in patches without it). Cell arrays: PatchId, Level, Direction
 * (of a line; -1 for a vertex). The points are Euclidean: not multiplied by weights.
 */
#ifndef vtkSplineControlNet_h
#define vtkSplineControlNet_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineControlNet : public vtkSplineAlgorithm
{
public:
  static vtkSplineControlNet* New();
  vtkTypeMacro(vtkSplineControlNet, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Whether every control point is a vertex cell. Default on. */
  vtkSetMacro(Vertices, bool);
  vtkGetMacro(Vertices, bool);
  vtkBooleanMacro(Vertices, bool);
  ///@}
  ///@{
  /** Whether the lines of the net are made. Default on. */
  vtkSetMacro(Lines, bool);
  vtkGetMacro(Lines, bool);
  vtkBooleanMacro(Lines, bool);
  ///@}

protected:
  vtkSplineControlNet();
  ~vtkSplineControlNet() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineControlNet(const vtkSplineControlNet&) = delete;
  void operator=(const vtkSplineControlNet&) = delete;

  bool Vertices = true;
  bool Lines = true;
};
#endif
