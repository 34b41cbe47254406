// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDatumAlignment
 * @brief   moves a mesh to the coordinate system of some of its surfaces
 *
 * The input is a mesh of triangles (polygons are divided). Its planes, cylinders, spheres, cones
 * and tori are recognised as vtkSurfaceRecognition does; regions are named by the numbers that it
 * gives them with the same tolerance.
 *
 * z is the outward normal of the datum plane, or without one the datum axis. x is across z: the
 * outward normal of the datum axis where that is a plane, else its axis; where that runs along z,
 * from the origin to it. The origin lies on what the datum point tells (centre of a sphere or
 * torus, axis of a cylinder or cone, planes), then, as far as it is free, on the datum plane, then
 * on the datum axis, then it is the nearest to the mesh's middle.
 *
 * Output 0 is the mesh at its new place, with the field array Motion: 16 numbers, the matrix by
 * rows. Output 1 is a table of one row: Regions, FreeMotions (that the datums say nothing about),
 * Motion.
 */
#ifndef vtkDatumAlignment_h
#define vtkDatumAlignment_h
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADFITTING_EXPORT vtkDatumAlignment : public vtkSplineAlgorithm
{
public:
  static vtkDatumAlignment* New();
  vtkTypeMacro(vtkDatumAlignment, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Region of a plane: z is its normal, and it lies at z = 0; -1: none. Default -1, valid range
   * [-1, 100000000]. */
  vtkSetClampMacro(DatumPlane, int, -1, 100000000);
  vtkGetMacro(DatumPlane, int);
  ///@}
  ///@{
  /** Region of a second plane, a cylinder, cone or torus: what x is made of, or z without
   * DatumPlane; -1: none. Default -1, valid range [-1, 100000000]. */
  vtkSetClampMacro(DatumAxis, int, -1, 100000000);
  vtkGetMacro(DatumAxis, int);
  ///@}
  ///@{
  /** Up to three regions that fix the origin, joined by commas: a sphere or torus, a cylinder or
   * cone, planes. Default empty. */
  vtkSetStringMacro(DatumPoint);
  vtkGetStringMacro(DatumPoint);
  ///@}
  ///@{
  /** Whether normals of planes count as they point into the part: it lies above its datum plane
   * then. Default off. */
  vtkSetMacro(Inward, bool);
  vtkGetMacro(Inward, bool);
  vtkBooleanMacro(Inward, bool);
  ///@}
  ///@{
  /** Distance of points from the surface of their region at most, unit of the points; 0: a
   * thousandth of the diagonal of the mesh's box. Default 0, valid range >= 0. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Distance of edges and triangles from the surface that their corners lie on at most, in
   * tolerances: more for coarse tessellations. Default 5, valid range [0, 1000]. */
  vtkSetClampMacro(MaximumSag, double, 0.0, 1000.0);
  vtkGetMacro(MaximumSag, double);
  ///@}

protected:
  vtkDatumAlignment();
  ~vtkDatumAlignment() override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkDatumAlignment(const vtkDatumAlignment&) = delete;
  void operator=(const vtkDatumAlignment&) = delete;

  int DatumPlane = -1;
  int DatumAxis = -1;
  char* DatumPoint = nullptr;
  bool Inward = false;
  double Tolerance = 0.0;
  double MaximumSag = 5.0;
};
#endif
