// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadRemesher
 * @brief   quadrilaterals on closed triangles, by QuadriFlow in the program blender
 *
 * Input are triangles (quadrilaterals and polygons are divided) that bound solids: closed, of a
 * manifold, as vtkSurfaceRepair makes them. Every closed part is given to QuadriFlow, which the
 * program blender has (found on PATH, run in a process of its own under limits of time and
 * memory). Nothing that it says is believed: an answer is taken when all faces are quadrilaterals
 * with areas, closed, a manifold of one part and of the triangles' Euler number, turned alike, and
 * within Limit of the triangles both ways. Else other numbers of faces, and sharp edges that need
 * not be kept, are tried. Points then move on the triangles where that makes better shapes. Parts
 * of which no answer holds are made of their triangles: collapsed, then each divided at its middle
 * into three.
 *
 * Output 0 (vtkPolyData): the quadrilaterals with the cell arrays PartId and ScaledJacobian (the
 * smallest sine of the angles).
 *
 * Output 1 (vtkTable): a row a try with Part, Faces (asked for), Sharp (edges were to be kept),
 * OfTriangles (divided; else blender was asked), Taken and Refusal.
 *
 * Output 2 (vtkTable): one row with Quads, Points, Parts, DividedParts (of these, made of
 * triangles), LooseParts (small ones that were left out), EulerNumber, ExtraordinaryPoints, Tries,
 * LeastScaledJacobian, LeastScaledJacobianBefore (before points moved), DistanceFromInput,
 * DistanceToInput, Diagonal, Volume and InputVolume.
 *
 * Errors: blender is missing; the triangles are not closed, or no manifold; no try gave
 * quadrilaterals that hold, with the refusal of each.
 */
#ifndef vtkQuadRemesher_h
#define vtkQuadRemesher_h
#include "vtkKnotworkSurfaceRemeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACEREMESHING_EXPORT vtkQuadRemesher : public vtkSplineAlgorithm
{
public:
  static vtkQuadRemesher* New();
  vtkTypeMacro(vtkQuadRemesher, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Ways
  {
    AUTOMATIC = 0,
    PROGRAM,
    TRIANGLES
  };

  ///@{
  /** Quadrilaterals that are wanted, of all parts together; the result has about as many, or 1.4 or
   * 0.7 times as many where that holds and this does not. Default 2000, valid range [8, 1000000].
   */
  vtkSetClampMacro(Faces, int, 8, 1000000);
  vtkGetMacro(Faces, int);
  ///@}
  ///@{
  /** Whether sharp edges are kept where that gives quadrilaterals that hold. Default on. */
  vtkSetMacro(KeepSharp, bool);
  vtkGetMacro(KeepSharp, bool);
  vtkBooleanMacro(KeepSharp, bool);
  ///@}
  ///@{
  /** Farthest that the result may be from the input, and the input from the result, share of the
   * diagonal of the input's box. Default 0.05, valid range [1e-6, 1]. */
  vtkSetClampMacro(Limit, double, 1e-6, 1.0);
  vtkGetMacro(Limit, double);
  ///@}
  ///@{
  /** Times that points move on the triangles at most, where that makes better shapes; 0: they stay.
   * Default 10, valid range [0, 1000]. */
  vtkSetClampMacro(Smoothing, int, 0, 1000);
  vtkGetMacro(Smoothing, int);
  ///@}
  ///@{
  /** Where quadrilaterals come from, one of Ways: AUTOMATIC, from blender, and parts where that
   * fails from their triangles; PROGRAM, from blender; TRIANGLES, without blender: edges are
   * collapsed until a third of Faces is left, and every triangle is divided at its middle into
   * three. Default AUTOMATIC. */
  vtkSetClampMacro(Way, int, AUTOMATIC, TRIANGLES);
  vtkGetMacro(Way, int);
  ///@}
  ///@{
  /** Seconds of a try at most; two tries that take longer end those of a part. Default 120, valid
   * range [1, 1000000]. Advanced. */
  vtkSetClampMacro(TimeLimit, int, 1, 1000000);
  vtkGetMacro(TimeLimit, int);
  ///@}
  ///@{
  /** Megabytes of blender's data at most. Default 4096, valid range [16, 1048576]. Advanced. */
  vtkSetClampMacro(MemoryLimit, int, 16, 1048576);
  vtkGetMacro(MemoryLimit, int);
  ///@}

protected:
  vtkQuadRemesher();
  ~vtkQuadRemesher() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadRemesher(const vtkQuadRemesher&) = delete;
  void operator=(const vtkQuadRemesher&) = delete;

  int Faces = 2000;
  bool KeepSharp = true;
  double Limit = 0.05;
  int Smoothing = 10;
  int Way = AUTOMATIC;
  int TimeLimit = 120;
  int MemoryLimit = 4096;
};
#endif
