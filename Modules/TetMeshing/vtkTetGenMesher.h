// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTetGenMesher
 * @brief   fills a closed surface, or what an image shows, with straight or curved tetrahedra
 *
 * Input 0 is a spline grid of volumes or closed surfaces, or are triangles (quadrilaterals and
 * polygons are divided) that bound solids: every edge in two of them that run it oppositely, or in
 * more where walls meet, none through another. Parts within others are voids, or regions of their
 * own (Inner). Or input 0 is an image of volume (vtkImageData), whose values tell what is solid
 * (Solid); implicit functions become one by vtkSampleFunction. Input 1, optional, is the shape that
 * the surface stands for: triangles, spline surfaces, trimmed faces of a CAD file or a volume,
 * whose boundary is meant; without it a spline stands for itself. Input 2, optional, has lengths of
 * edges (SizeArray): volumes are a field of them, points alone tell them of the regions in which
 * they lie.
 *
 * Tetrahedra are made by TetGen, those of images by CGAL's Mesh_3, in a process of their own with
 * limits of time and memory. Of Order 2
 * and 3 the points of the boundary lie on the shape, those of its sharp edges on these; cells are
 * certified, and where one is not valid its points are moved back until it is.
 *
 * Output 0 (vtkUnstructuredGrid): cells of type VTK_TETRA, VTK_QUADRATIC_TETRA or
 * VTK_LAGRANGE_TETRAHEDRON with the cell arrays Region, Verdict (1: valid) and MinJacobianLower, of
 * images Label; with BoundaryCells also triangles of the same order, outward or towards the higher
 * region, with the values of a tetrahedron beside them, and the cell array BoundaryId: number of
 * the surface's part (its cell array FaceId, or 6 PatchId + FaceId where patches have faces of the
 * same number, as vtkSplineBoundary numbers them, else RegionId, else 0), -1 of tetrahedra and
 * where repair made the triangle. Output 1 (vtkPolyData): the straight boundary with the cell array
 * CellIds of the input (of images -1). Output 2 (vtkTable): one row of numbers.
 *
 * @source Si, ACM TOMS 41 (2015) 11 (TetGen); Boissonnat, Oudot, Graphical Models 67 (2005) 405 and
 * Rineau, Yvinec, IMR 16 (2007) 443 (Mesh_3). The module's page has methods, limits and errors.
 */
#ifndef vtkTetGenMesher_h
#define vtkTetGenMesher_h
#include "vtkKnotworkTetMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

namespace knotwork
{
struct DecodedMesh;
struct ImageTetrahedra;
struct TetrahedraParams;
struct WorkerLimits;
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

  enum ImageSolids
  {
    BELOW = 0,
    ABOVE,
    LABELS
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
  /** Array of input 2, of its points or cells, with lengths of edges at most, above 0; empty: its
   * only one of one component. Default empty. Group "Sizes". */
  vtkSetStringMacro(SizeArray);
  vtkGetStringMacro(SizeArray);
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
  /** What is solid in an image, one of ImageSolids: BELOW, where values are below Level, as of
   * implicit functions; ABOVE, where they are above it; LABELS, where they are above 0, whole
   * numbers, each a region. Default BELOW. For Input vtkImageData. Group "Image". */
  vtkSetClampMacro(Solid, int, BELOW, LABELS);
  vtkGetMacro(Solid, int);
  ///@}
  ///@{
  /** Value on the boundary of the solid. Default 0, valid range [-1e+30, 1e+30]. For Input
   * vtkImageData. For Solid BELOW, ABOVE. Group "Image". */
  vtkSetClampMacro(Level, double, -1e30, 1e30);
  vtkGetMacro(Level, double);
  ///@}
  ///@{
  /** Point array of the image; empty: its active scalars, or its only one of one component. Default
   * empty. For Input vtkImageData. Group "Image". */
  vtkSetStringMacro(ImageArray);
  vtkGetStringMacro(ImageArray);
  ///@}
  ///@{
  /** Order of the cells. Default 1, valid range [1, 3]. */
  vtkSetClampMacro(Order, int, 1, 3);
  vtkGetMacro(Order, int);
  ///@}
  ///@{
  /** Whether triangles of the boundary, and those between regions, are cells, too, behind the
   * tetrahedra: what solvers know loads and supports by. Default off. */
  vtkSetMacro(BoundaryCells, bool);
  vtkGetMacro(BoundaryCells, bool);
  vtkBooleanMacro(BoundaryCells, bool);
  ///@}
  ///@{
  /** Whether a surface that bounds no solid is repaired first, as vtkSurfaceRepair does, with all
   * holes closed. Default off. Group "Surface". */
  vtkSetMacro(Repair, bool);
  vtkGetMacro(Repair, bool);
  vtkBooleanMacro(Repair, bool);
  ///@}
  ///@{
  /** Of an input that is a spline or an image: largest distance of the boundary's triangles from
   * it, share of the diagonal of its box. Default 0.001, valid range [1e-12, 1]. Group "Surface".
   */
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
  /** Seconds that the mesher may take. Default 600, valid range [1, 1000000]. Advanced. */
  vtkSetClampMacro(TimeLimit, int, 1, 1000000);
  vtkGetMacro(TimeLimit, int);
  ///@}
  ///@{
  /** Megabytes that the mesher may take. Default 8192, valid range [1, 1000000]. Advanced. */
  vtkSetClampMacro(MemoryLimit, int, 1, 1000000);
  vtkGetMacro(MemoryLimit, int);
  ///@}
  ///@{
  /** The shape that the surface stands for (input port 1). */
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}
  ///@{
  /** Lengths of edges (input port 2). */
  void SetSizeConnection(vtkAlgorithmOutput* output);
  void SetSizeData(vtkDataObject* sizes);
  ///@}

protected:
  vtkTetGenMesher();
  ~vtkTetGenMesher() override;
  knotwork::Result<knotwork::DecodedMesh> BoundaryOf(
    vtkDataObject* spline, std::vector<int>& parts);
  knotwork::WorkerLimits Limits() const;
  /** Options that are for images alone, or for surfaces. */
  void WarnOfUnused(bool isImage);
  knotwork::Result<knotwork::ImageTetrahedra> MeshImage(
    vtkDataObject* input, const knotwork::TetrahedraParams& params);
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkTetGenMesher(const vtkTetGenMesher&) = delete;
  void operator=(const vtkTetGenMesher&) = delete;

  double RadiusEdgeRatio = 2.0;
  double MinDihedralAngle = 5.0;
  double EdgeLength = 0.0;
  char* SizeArray = nullptr;
  int MaxSteinerPoints = 1000000;
  bool KeepBoundary = true;
  int Inner = VOIDS;
  int Solid = BELOW;
  double Level = 0.0;
  char* ImageArray = nullptr;
  int Order = 1;
  bool BoundaryCells = false;
  bool Repair = false;
  double ChordalTolerance = 1e-3;
  double SharpAngle = 40.0;
  int TimeLimit = 600;
  int MemoryLimit = 8192;
};
#endif
