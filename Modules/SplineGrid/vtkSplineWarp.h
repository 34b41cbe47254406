// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineWarp
 * @brief   sends points, or splines, through a spline map
 *
 * Input 0 is what is sent: any vtkPointSet, a spline grid, or a vtkPartitionedDataSetCollection of
 * spline grids. Input 1 is the map: a spline grid; the coordinates of input 0 are its parameters
 * (x, y of a planar map, x, y, z of a solid).
 *
 * Points keep cells and arrays and get new positions; point normals are dropped, for they are not
 * those of the image. Splines stay splines: the composition is projected onto the patch's own
 * space, which is refined locally (THB) wherever the distance to the composition exceeds Tolerance.
 * Sides that patches share are projected once, so the image is as connected as the input. The
 * result is polynomial; the cell array Distance holds the largest distance found for the patch,
 * measured on a grid of samples in every element at equal parameters; a warning tells when MaxLevel
 * does not allow the tolerance. Fields of the patches are carried to the new space by projection.
 *
 * A point outside the map's domain is an error that names it, or with Clamp is moved to the nearest
 * parameters inside. See Composition.h.
 *
 * Errors: a map without patches (EmptyInput), with several and none chosen or without the one
 * chosen (InvalidParameter), without a parameter domain (DimensionMismatch); a point that is not
 * finite (NonFiniteInput) or outside (OutsideDomain); those of decoding.
 */
#ifndef vtkSplineWarp_h
#define vtkSplineWarp_h
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineWarp : public vtkSplineAlgorithm
{
public:
  static vtkSplineWarp* New();
  vtkTypeMacro(vtkSplineWarp, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** The map, as input 1. */
  void SetMapConnection(vtkAlgorithmOutput* map) { this->SetInputConnection(1, map); }
  void SetMapData(vtkDataObject* map) { this->SetInputData(1, map); }

  ///@{
  /** Patch of the map; -1: its only patch. Default -1. */
  vtkSetMacro(MapPatchId, int);
  vtkGetMacro(MapPatchId, int);
  ///@}
  ///@{
  /** Whether points outside the domain of the map are moved to its border instead of being an
   * error. Default off. */
  vtkSetMacro(Clamp, bool);
  vtkGetMacro(Clamp, bool);
  vtkBooleanMacro(Clamp, bool);
  ///@}
  ///@{
  /** Wanted distance between the composition and its projection, in units of the image; 0: the
   * patches' own spaces, no refinement. Not used for points. Default 0.001, valid range >= 0.
   * Kernel default 0. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Levels that refinement may add to reach the tolerance. Default 5, valid range [0, 20]. */
  vtkSetClampMacro(MaxLevel, int, 0, 20);
  vtkGetMacro(MaxLevel, int);
  ///@}

  ///@{
  /** Functions that a patch may have; a refinement to more is an error before memory is taken.
   * Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineWarp();
  ~vtkSplineWarp() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  int WholeInputPort() const override { return 1; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineWarp(const vtkSplineWarp&) = delete;
  void operator=(const vtkSplineWarp&) = delete;

  int MaximumFunctions = 1000000;
  int MapPatchId = -1;
  bool Clamp = false;
  double Tolerance = 1e-3;
  int MaxLevel = 5;
};
#endif
