// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMeshParameterization
 * @brief   lays a triangle mesh with holes into the plane
 *
 * Input 0 is a triangle mesh (vtkPolyData or vtkUnstructuredGrid): one component of a manifold with
 * a boundary and without handles. Triangles that look the other way than most are turned over. With
 * a MaximumStretch the surface may also be closed and have handles: it is cut into charts where
 * that is needed, each of them a disc with holes whose map is stretched less and does not fold.
 *
 * Output 0 is the mesh with its data, plane coordinates as the point array `UV` (also the texture
 * coordinates; centred, at the scale of the mesh) and the cell arrays `ChartId`, `SingularValues`
 * of the map from each triangle (the second one is negative where it is flipped) and `Flipped`.
 * Charts have points of their own and lie side by side in the plane; copies of a point have the
 * same `CutPointId` (point array). Where a cut crosses a triangle it is divided; point data is
 * linear there. Output 1 are the boundary loops of each chart as closed polylines, the outer one
 * first (counterclockwise in UV, holes clockwise), with `UV`, `PointIds` (-1 where a cut made a
 * point), `CutPointId`, `Chart`, `Loop` and `Length`. Output 2 is a table of one row: the method
 * asked for and those used, why others were used, charts, flipped triangles, stretch, singular
 * values, area distortion, isometry and distance errors.
 *
 * HLLE that folds or fails is replaced by a method that folds less, with a warning. A map that has
 * flipped triangles all the same is an output with a warning.
 *
 * @source Donoho, Grimes (2003); Ruiz, Mejia, Cadavid (2015). The module's page has methods, limits
 * and errors.
 */
#ifndef vtkMeshParameterization_h
#define vtkMeshParameterization_h
#include "vtkKnotworkMeshParameterizationModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

namespace knotwork
{
struct ChartedMesh;
struct FlattenParams;
struct TriangleMesh;
}

class VTKKNOTWORKMESHPARAMETERIZATION_EXPORT vtkMeshParameterization : public vtkSplineAlgorithm
{
public:
  static vtkMeshParameterization* New();
  vtkTypeMacro(vtkMeshParameterization, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    HLLE = 0, ///< "HLLE"
    ISOMAP,
    LAPLACIAN, ///< "Laplacian Eigenmaps"
    LSCM,      ///< "LSCM"
    ARAP,      ///< "ARAP"
    INJECTIVE  ///< as the fallback uses it: steps that flip no triangle
  };
  enum LaplacianWeightings
  {
    COTANGENT = 0,
    GRAPH
  };
  enum GeodesicEstimators
  {
    UNFOLDING = 0,
    EDGE_GRAPH
  };

  ///@{
  /** How the mesh is laid into the plane, one of Methods: HLLE, Hessian eigenmaps; ISOMAP, wrong
   * by nature where the plane domain is not convex, and LAPLACIAN, which distorts everywhere, to
   * compare with; LSCM, conformal; ARAP, as rigid as possible; INJECTIVE, which never flips a
   * triangle. Default HLLE. */
  vtkSetClampMacro(Method, int, HLLE, INJECTIVE);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** Weights of LAPLACIAN, one of LaplacianWeightings. Default COTANGENT. Advanced. For Method
   * LAPLACIAN. */
  vtkSetClampMacro(LaplacianWeights, int, COTANGENT, GRAPH);
  vtkGetMacro(LaplacianWeights, int);
  ///@}
  ///@{
  /** Distances of ISOMAP and of the distance error, one of GeodesicEstimators. Shortest paths of
   * edges are some percent too long however fine the mesh is. Default UNFOLDING. Advanced. */
  vtkSetClampMacro(Geodesics, int, UNFOLDING, EDGE_GRAPH);
  vtkGetMacro(Geodesics, int);
  ///@}
  ///@{
  /** Geodesic neighbours of a vertex for HLLE. More of them smooth more and fold curved surfaces
   * more. Default 10, valid range [6, 50]. Advanced. For Method HLLE. */
  vtkSetClampMacro(Neighbours, int, 6, 50);
  vtkGetMacro(Neighbours, int);
  ///@}
  ///@{
  /** Points whose distances ISOMAP takes, the farthest ones. Default 50, valid range [3, 10000].
   * Advanced. For Method ISOMAP. */
  vtkSetClampMacro(Landmarks, int, 3, 10000);
  vtkGetMacro(Landmarks, int);
  ///@}
  ///@{
  /** Iterations of ARAP and INJECTIVE at most. Default 100, valid range [1, 10000]. Advanced. */
  vtkSetClampMacro(MaximumIterations, int, 1, 10000);
  vtkGetMacro(MaximumIterations, int);
  ///@}
  ///@{
  /** HLLE rejects eigenvectors that live on a smaller part of the area. Default 0.02, valid
   * range [0, 0.99]. Advanced. For Method HLLE. */
  vtkSetClampMacro(MinimumParticipation, double, 0.0, 0.99);
  vtkGetMacro(MinimumParticipation, double);
  ///@}
  ///@{
  /** Stretch max(s1, 1/s2), above 1, that no chart exceeds: the mesh, which may be closed then,
   * is cut into charts. 0: one chart, whatever its stretch. Default 0, valid range [0, 1000]. */
  vtkSetClampMacro(MaximumStretch, double, 0.0, 1000.0);
  vtkGetMacro(MaximumStretch, double);
  ///@}
  ///@{
  /** Charts at most; more stretch than MaximumStretch comes with a warning then. Default 500,
   * valid range [1, 100000]. Advanced. */
  vtkSetClampMacro(MaximumCharts, int, 1, 100000);
  vtkGetMacro(MaximumCharts, int);
  ///@}
  ///@{
  /** Cuts run along edges between triangles that meet at a larger angle, in degrees, where they
   * can. Default 40, valid range [1, 179]. Advanced. */
  vtkSetClampMacro(CreaseAngle, double, 1.0, 179.0);
  vtkGetMacro(CreaseAngle, double);
  ///@}
  ///@{
  /** Whether HLLE is replaced, with a warning, when it folds or fails, and in charts any method
   * that stretches too much. Default on. */
  vtkSetMacro(Fallback, bool);
  vtkGetMacro(Fallback, bool);
  vtkBooleanMacro(Fallback, bool);
  ///@}
  ///@{
  /** Whether the component of the most triangles is taken instead of refusing several ones, and
   * points of no triangle. Default off. */
  vtkSetMacro(LargestComponent, bool);
  vtkGetMacro(LargestComponent, bool);
  vtkBooleanMacro(LargestComponent, bool);
  ///@}
  ///@{
  /** Whether points of the mesh and its loops are (u, v, 0) instead of those of the input.
   * Default off. */
  vtkSetMacro(FlatOutput, bool);
  vtkGetMacro(FlatOutput, bool);
  vtkBooleanMacro(FlatOutput, bool);
  ///@}

  /**
   * Measured seconds of the last run. They are in no output: outputs are the same from run to run.
   */
  vtkGetMacro(Seconds, double);

protected:
  vtkMeshParameterization();
  ~vtkMeshParameterization() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkMeshParameterization(const vtkMeshParameterization&) = delete;
  void operator=(const vtkMeshParameterization&) = delete;

  knotwork::Result<knotwork::ChartedMesh> Flatten(
    const knotwork::TriangleMesh& mesh, const knotwork::FlattenParams& params) const;

  double Seconds = 0.0;
  int Method = HLLE;
  int LaplacianWeights = COTANGENT;
  int Geodesics = UNFOLDING;
  int Neighbours = 10;
  int Landmarks = 50;
  int MaximumIterations = 100;
  double MinimumParticipation = 0.02;
  double MaximumStretch = 0.0;
  int MaximumCharts = 500;
  double CreaseAngle = 40.0;
  bool Fallback = true;
  bool LargestComponent = false;
  bool FlatOutput = false;
};
#endif
