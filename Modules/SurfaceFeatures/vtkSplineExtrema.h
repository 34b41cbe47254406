// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineExtrema
 * @brief   all minima, maxima and saddles of a function on spline surfaces, proved
 *
 * The function is a component of the geometry (by default z, the height of a height field) or of a
 * field, on every surface patch, as a function of the patch's parameters. Every critical point, on
 * edges of elements, on creases and on the boundary too, lies in a uniqueness box that holds no
 * other one, or, where they are degenerate, in one of the boxes of a cluster.
 *
 * Output 0 (vtkPolyData): a vertex a point, with the point arrays Kind (0 minimum, 1 maximum, 2
 * saddle), Place (0 inside an element, 1 on a smooth edge, 2 on a crease, 3 on the boundary, 4 at a
 * corner), Value, ValueBounds, Parameters, Eigenvalues (of the Hessian), Index, InwardSign,
 * ElementId, PatchId, Block.
 *
 * Output 1 (vtkPolyData): a quadrilateral a box, with the cell arrays Unique (1: holds exactly one
 * point, 0: of a cluster), PointId (of output 0, -1: none), ClusterId (-1: none), ValueBounds,
 * ParametricBounds (u0, u1, v0, v1), ElementId, PatchId, Block. Boxes on the boundary and on
 * creases may be flat.
 *
 * Output 2 (vtkTable): one row with Minima, Maxima, Saddles, OnBoundary, Clusters, ClusterBoxes,
 * IndexSum, EulerCharacteristic, BoxesTested, Proved (1: there are no clusters), whatever kinds are
 * shown.
 *
 * Of several processes each searches the patches that it has; points and boxes are pieces, the
 * table stands in the first process.
 *
 * @source Krawczyk (1969); Farouki and Rajan (1988). The module's page has limits and errors.
 */
#ifndef vtkSplineExtrema_h
#define vtkSplineExtrema_h
#include "vtkKnotworkSurfaceFeaturesModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACEFEATURES_EXPORT vtkSplineExtrema : public vtkSplineAlgorithm
{
public:
  static vtkSplineExtrema* New();
  vtkTypeMacro(vtkSplineExtrema, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Field of the spline grid that is the function; empty or `None`: the geometry. Default
   * empty. */
  vtkSetStringMacro(FieldName);
  vtkGetStringMacro(FieldName);
  ///@}
  ///@{
  /** Component of the geometry (2 is z) or of the field; the only component of a field whatever
   * it says. Default 2, valid range [0, 1000]. Kernel default 0. */
  vtkSetClampMacro(Component, int, 0, 1000);
  vtkGetMacro(Component, int);
  ///@}
  ///@{
  /** Whether minima are in the outputs; the numbers count all kinds. Default on. */
  vtkSetMacro(Minima, bool);
  vtkGetMacro(Minima, bool);
  vtkBooleanMacro(Minima, bool);
  ///@}
  ///@{
  /** Whether maxima are in the outputs. Default on. */
  vtkSetMacro(Maxima, bool);
  vtkGetMacro(Maxima, bool);
  vtkBooleanMacro(Maxima, bool);
  ///@}
  ///@{
  /** Whether saddles are in the outputs. Default on. */
  vtkSetMacro(Saddles, bool);
  vtkGetMacro(Saddles, bool);
  vtkBooleanMacro(Saddles, bool);
  ///@}
  ///@{
  /** Whether critical points along the boundary and at its corners are looked for. Default on. */
  vtkSetMacro(Boundary, bool);
  vtkGetMacro(Boundary, bool);
  vtkBooleanMacro(Boundary, bool);
  ///@}
  ///@{
  /** Whether points and boxes lie on the surface; otherwise in the plane of the parameters.
   * Default on. */
  vtkSetMacro(OnSurface, bool);
  vtkGetMacro(OnSurface, bool);
  vtkBooleanMacro(OnSurface, bool);
  ///@}
  ///@{
  /** Halvings of an element before what is left is a cluster. Default 32, valid range [1, 50].
   * Advanced. */
  vtkSetClampMacro(MaximumDepth, int, 1, 50);
  vtkGetMacro(MaximumDepth, int);
  ///@}
  ///@{
  /** Undecided boxes of an element at a time before they are a cluster: the fewer, the coarser
   * are the boxes along curves of critical points. Default 64, valid range [4, 4096]. Advanced. */
  vtkSetClampMacro(MaximumBoxes, int, 4, 4096);
  vtkGetMacro(MaximumBoxes, int);
  ///@}

protected:
  vtkSplineExtrema();
  ~vtkSplineExtrema() override;
  bool WorksOnPieces() const override { return true; }
  bool SumsUpPieces() const override { return true; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Merge(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineExtrema(const vtkSplineExtrema&) = delete;
  void operator=(const vtkSplineExtrema&) = delete;

  char* FieldName = nullptr;
  int Component = 2;
  bool Minima = true;
  bool Maxima = true;
  bool Saddles = true;
  bool Boundary = true;
  bool OnSurface = true;
  int MaximumDepth = 32;
  int MaximumBoxes = 64;
};
#endif
