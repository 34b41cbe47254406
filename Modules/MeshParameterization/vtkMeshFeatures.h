// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMeshFeatures
 * @brief   finds the sharp edges of a triangle mesh, its corners and the regions between them
 *
 * Input 0 is a mesh of triangles (quadrilaterals and polygons are divided), closed or open, of one
 * or several parts; equal points are one, as in STL files. An edge is sharp where the normals of
 * its two sides differ; they are fitted to patches of triangles as large as the noise of the points
 * asks for, which is estimated. On a clean mesh they are the normals of the triangles. Rows of
 * triangles that are too narrow to be faces become edges, gaps are closed, small regions join
 * neighbours.
 *
 * Input 1, which is optional, are lines (vtkPolyData) through points of the mesh that are edges,
 * whatever their angle; the cell array RegionArray of input 0 may tell regions. Both extend what is
 * found, or replace it (Mode).
 *
 * Output 0 (vtkPolyData): the triangles with their data and the cell array RegionId.
 *
 * Output 1 (vtkPolyData): a polyline a chain of edges, from corner to corner or closed, with the
 * cell arrays ChainId, Closed, Rim (an edge of the mesh's boundary), Angle (the largest between the
 * two sides, degrees), MeanAngle, Length.
 *
 * Output 2 (vtkPolyData): the corners as vertices.
 *
 * Output 3 (vtkTable): one row with SharpEdges, RimEdges, Chains, ClosedChains, Corners, Regions,
 * JoinedRegions, ClosedGaps, NoiseLevel.
 *
 * @source Canny (1986), hysteresis; Zhang et al. (2015), normals of consistent patches. The
 * module's page has rules, limits and errors.
 */
#ifndef vtkMeshFeatures_h
#define vtkMeshFeatures_h
#include "vtkKnotworkMeshParameterizationModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class vtkAlgorithmOutput;

class VTKKNOTWORKMESHPARAMETERIZATION_EXPORT vtkMeshFeatures : public vtkSplineAlgorithm
{
public:
  static vtkMeshFeatures* New();
  vtkTypeMacro(vtkMeshFeatures, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Modes
  {
    EXTEND = 0,
    REPLACE
  };

  ///@{
  /** Angle between the normals of two sides from which on an edge is sharp, degrees. Default 40,
   * valid range [1, 179]. Group "Sharp Edges". */
  vtkSetClampMacro(SharpAngle, double, 1.0, 179.0);
  vtkGetMacro(SharpAngle, double);
  ///@}
  ///@{
  /** The same of edges that continue sharp ones, at most SharpAngle. Default 20, valid range [1,
   * 179]. Group "Sharp Edges". */
  vtkSetClampMacro(WeakAngle, double, 1.0, 179.0);
  vtkGetMacro(WeakAngle, double);
  ///@}
  ///@{
  /** Turn of a chain of edges from which on it has a corner, degrees. Default 60, valid range [1,
   * 180]. Group "Sharp Edges". */
  vtkSetClampMacro(CornerAngle, double, 1.0, 180.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Standard deviation of the points from the shape, unit of the points; negative: estimated for
   * each part of the mesh. Default -1, valid range >= -1. Group "Sharp Edges". */
  vtkSetClampMacro(NoiseLevel, double, -1.0, VTK_DOUBLE_MAX);
  vtkGetMacro(NoiseLevel, double);
  ///@}
  ///@{
  /** Share of the mesh's area below which a region joins a neighbour. Default 0, valid range [0,
   * 0.99]. Group "Regions". */
  vtkSetClampMacro(SmallestRegion, double, 0.0, 0.99);
  vtkGetMacro(SmallestRegion, double);
  ///@}
  ///@{
  /** Width of rows of triangles between two sides, chamfers and fillets, that are edges instead of
   * regions, share of the diagonal of the box of its part of the mesh; 0: none are. Default 0.005,
   * valid range [0, 1]. Group "Regions". */
  vtkSetClampMacro(NarrowWidth, double, 0.0, 1.0);
  vtkGetMacro(NarrowWidth, double);
  ///@}
  ///@{
  /** Length of gaps in chains of edges that are closed, share of the diagonal of the box of its
   * part of the mesh; 0: none are. Default 0.02, valid range [0, 1]. Group "Sharp Edges". */
  vtkSetClampMacro(LargestGap, double, 0.0, 1.0);
  vtkGetMacro(LargestGap, double);
  ///@}
  ///@{
  /** What edges (input 1) and regions (RegionArray) that are given do, one of Modes: EXTEND, they
   * are features beside those that are found; REPLACE, they are all of them. Default EXTEND. Group
   * "Given Features". */
  vtkSetClampMacro(Mode, int, EXTEND, REPLACE);
  vtkGetMacro(Mode, int);
  ///@}
  ///@{
  /** Cell array of the mesh; edges between triangles of different values are features. Empty or
   * `None`: none is. Default empty. Group "Given Features". */
  vtkSetStringMacro(RegionArray);
  vtkGetStringMacro(RegionArray);
  ///@}
  ///@{
  /** The edges that are given (input port 1). */
  void SetEdgesConnection(vtkAlgorithmOutput* output);
  void SetEdgesData(vtkDataObject* edges);
  ///@}

protected:
  vtkMeshFeatures();
  ~vtkMeshFeatures() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkMeshFeatures(const vtkMeshFeatures&) = delete;
  void operator=(const vtkMeshFeatures&) = delete;

  double SharpAngle = 40.0;
  double WeakAngle = 20.0;
  double CornerAngle = 60.0;
  double NoiseLevel = -1.0;
  double SmallestRegion = 0.0;
  double NarrowWidth = 0.005;
  double LargestGap = 0.02;
  int Mode = EXTEND;
  char* RegionArray = nullptr;
};
#endif
