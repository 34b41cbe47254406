// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADModifier
 * @brief   a CAD part healed, imprinted, cut, split and composed
 *
 * Reads a STEP file, runs operations on it in their order and gives the new model as vtkCADReader
 * does, with triangles of its default tolerance; the new file can be kept. Names, colours, unit
 * and the tree of assemblies stay.
 *
 * Input 0 (optional): curves for operations split-curve, the lines of a vtkPolyData or the curves
 * of a spline grid.
 *
 * Outputs: 0 to 2 those of vtkCADReader (surfaces, trimming curves, triangles); 3 (vtkTable): a row
 * an operation with Operation, SolidsBefore, FacesBefore, VolumeBefore, Solids, Faces, Edges,
 * Vertices, FaceIds, Volume, VolumeChange, Overlap, NewFaces (for each face before it the ids of
 * what it became, with commas, and blanks between faces; - for none), Composite, TurnedFaces,
 * TurnedSolids, SewnEdges, NewSolids, RemovedEdges, RemovedFaces, ClosedGaps and Unmended.
 *
 * Errors: those of knotwork::ParseCADOperation, ModifyCAD and vtkCADReader.
 */
#ifndef vtkCADModifier_h
#define vtkCADModifier_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkCADModifier : public vtkSplineAlgorithm
{
public:
  static vtkCADModifier* New();
  vtkTypeMacro(vtkCADModifier, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Units
  {
    Micrometre = 0,
    Millimetre,
    Centimetre,
    Metre,
    Inch,
    Foot
  };

  ///@{
  /** The part: .step or .stp. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Where the new part is kept: .step, .stp or .brep; empty: nowhere. */
  vtkSetFilePathMacro(OutputFileName);
  vtkGetFilePathMacro(OutputFileName);
  ///@}
  ///@{
  /** What is done, with semicolons or ends of lines between operations: imprint; cut-plane X Y Z NX
   * NY NZ; cut-cylinder X Y Z DX DY DZ R; cut-face FACE; split-plane FACES X Y Z NX NY NZ;
   * split-iso FACES u|v SHARE; split-curve FACES; composite FACES; heal TOLERANCE. FACES are ids
   * such as 3 or 3,5,8. */
  vtkSetStringMacro(Operations);
  vtkGetStringMacro(Operations);
  ///@}
  ///@{
  /** Unit of lengths in operations and outputs, one of Units. Default Millimetre. */
  vtkSetClampMacro(Unit, int, Micrometre, Foot);
  vtkGetMacro(Unit, int);
  ///@}
  ///@{
  /** Largest change of the volume by an operation, as a share of it. Default 1e-9, valid range [0,
   * 1]. Advanced. */
  vtkSetClampMacro(VolumeTolerance, double, 0.0, 1.0);
  vtkGetMacro(VolumeTolerance, double);
  ///@}

protected:
  vtkCADModifier();
  ~vtkCADModifier() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkCADModifier(const vtkCADModifier&) = delete;
  void operator=(const vtkCADModifier&) = delete;

  char* FileName = nullptr;
  char* OutputFileName = nullptr;
  char* Operations = nullptr;
  int Unit = Millimetre;
  double VolumeTolerance = 1e-9;
};
#endif
