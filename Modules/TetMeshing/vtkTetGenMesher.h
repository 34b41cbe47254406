// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTetGenMesher
 * @brief   fills a closed surface with straight or curved tetrahedra
 *
 * Input 0 is a spline grid of volumes or closed surfaces, or are triangles (quadrilaterals and
 * polygons are divided) that bound solids: every edge in two of them that run it oppositely, or in
 * more where walls meet, none through another. Parts within others are voids, or regions of their
 * own (Inner). Input 1, optional, is the shape that the surface stands for: triangles, spline
 * surfaces, trimmed faces of a CAD file or a volume, whose boundary is meant; without it a spline
 * stands for itself.
 *
 * Tetrahedra are made by TetGen, in a process of its own with limits of time and memory. Of Order 2
 * and 3 the points of the boundary lie on the shape, those of its sharp edges on these; cells are
 * certified, and where one is not valid its points are moved back until it is.
 *
 * Output 0 (vtkUnstructuredGrid): cells of type VTK_TETRA, VTK_QUADRATIC_TETRA or
 * VTK_LAGRANGE_TETRAHEDRON with the cell arrays Region, Verdict (1: valid) and MinJacobianLower.
 * Output 1 (vtkPolyData): the straight boundary with the cell array CellIds of the input. Output 2
 * (vtkTable): one row of numbers.
 *
 * @source Si, ACM TOMS 41 (2015) 11 (TetGen). The module's page has methods, limits and errors.
 */
#ifndef vtkTetGenMesher_h
#define vtkTetGenMesher_h
#include "vtkKnotworkTetMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

namespace knotwork
{
struct DecodedMesh;
}

class VTKKNOTWORKTETMESHING_EXPORT vtkTetGenMesher : public vtkSplineAlgorithm
{
public:
  static vtkTetGenMesher* New();
  vtkTypeMacro(vtkTetGenMesher, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum InnerParts
  {
    VOIDS = 0,
    REGIONS
  };

  ///@{
  /** Largest radius of a circumsphere over the shortest edge; 0: no bound. Default 2, valid range
   * [0, 10]. Group "Sizes". */
  vtkSetClampMacro(RadiusEdgeRatio, double, 0.0, 10.0);
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}
  ///@{
  /** Smallest angle between faces in degrees that is aimed at; 0: none. Default 5, valid range [0,
   * 30]. Group "Sizes". */
  vtkSetClampMacro(MinDihedralAngle, double, 0.0, 30.0);
  vtkGetMacro(MinDihedralAngle, double);
  ///@}
  ///@{
  /** Largest volume, as that of a regular tetrahedron with edges of this length; 0: no bound.
   * Default 0, valid range [0, 1000000000000]. Group "Sizes". */
  vtkSetClampMacro(EdgeLength, double, 0.0, 1e12);
  vtkGetMacro(EdgeLength, double);
  ///@}
  ///@{
  /** Points that are added at most. Default 1000000, valid range >= 0. Advanced. Group "Sizes". */
  vtkSetClampMacro(MaxSteinerPoints, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaxSteinerPoints, int);
  ///@}
  ///@{
  /** Whether the triangles of the surface stay as they are, and cells beside large ones large; else
   * they may be divided. Default on. Group "Surface". */
  vtkSetMacro(KeepBoundary, bool);
  vtkGetMacro(KeepBoundary, bool);
  vtkBooleanMacro(KeepBoundary, bool);
  ///@}
  ///@{
  /** What parts of the surface within others enclose, one of InnerParts: VOIDS, void and solid in
   * turn; REGIONS, solids of their own. Default VOIDS. Group "Surface". */
  vtkSetClampMacro(Inner, int, VOIDS, REGIONS);
  vtkGetMacro(Inner, int);
  ///@}
  ///@{
  /** Order of the cells. Default 1, valid range [1, 3]. */
  vtkSetClampMacro(Order, int, 1, 3);
  vtkGetMacro(Order, int);
  ///@}
  ///@{
  /** Whether a surface that bounds no solid is repaired first, as vtkSurfaceRepair does, with all
   * holes closed. Default off. Group "Surface". */
  vtkSetMacro(Repair, bool);
  vtkGetMacro(Repair, bool);
  vtkBooleanMacro(Repair, bool);
  ///@}
  ///@{
  /** Of an input that is a spline: largest distance of its triangles from it, share of the diagonal
   * of its box. Default 0.001, valid range [1e-12, 1]. Group "Surface". */
  vtkSetClampMacro(ChordalTolerance, double, 1e-12, 1.0);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Edges of a target of triangles between normals that differ by this angle in degrees are
   * sharp. Default 40, valid range [1, 179]. Advanced. For Order not 1. Group "Surface". */
  vtkSetClampMacro(SharpAngle, double, 1.0, 179.0);
  vtkGetMacro(SharpAngle, double);
  ///@}
  ///@{
  /** Seconds that TetGen may take. Default 600, valid range [1, 1000000]. Advanced. */
  vtkSetClampMacro(TimeLimit, int, 1, 1000000);
  vtkGetMacro(TimeLimit, int);
  ///@}
  ///@{
  /** Megabytes that TetGen may take. Default 8192, valid range [1, 1000000]. Advanced. */
  vtkSetClampMacro(MemoryLimit, int, 1, 1000000);
  vtkGetMacro(MemoryLimit, int);
  ///@}
  ///@{
  /** The shape that the surface stands for (input port 1). */
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}

protected:
  vtkTetGenMesher();
  ~vtkTetGenMesher() override = default;
  knotwork::Result<knotwork::DecodedMesh> BoundaryOf(vtkDataObject* spline);
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkTetGenMesher(const vtkTetGenMesher&) = delete;
  void operator=(const vtkTetGenMesher&) = delete;

  double RadiusEdgeRatio = 2.0;
  double MinDihedralAngle = 5.0;
  double EdgeLength = 0.0;
  int MaxSteinerPoints = 1000000;
  bool KeepBoundary = true;
  int Inner = VOIDS;
  int Order = 1;
  bool Repair = false;
  double ChordalTolerance = 1e-3;
  double SharpAngle = 40.0;
  int TimeLimit = 600;
  int MemoryLimit = 8192;
};
#endif
