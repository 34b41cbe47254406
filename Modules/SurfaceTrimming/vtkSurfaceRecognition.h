// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceRecognition
 * @brief   divides a triangle mesh into planes, cylinders, spheres, cones, tori, extrusions,
 * revolutions and free form
 *
 * The input is a mesh of triangles (quadrilaterals and polygons are divided), closed or open, of
 * one or several parts; equal points are one, as in STL files. What lies on one surface is one
 * region, also where its facets meet at an angle: the strips of a tessellated cylinder are one
 * cylinder. Of surfaces on which the points lie within the noise that is found, Tolerance at most,
 * the simplest is taken. Pieces of one extrusion or revolution with a profile of any form are one.
 *
 * Output 0 (vtkPolyData): the triangles with the cell arrays RegionId and SurfaceType (0 plane, 1
 * cylinder, 2 sphere, 3 cone, 4 torus, 5 free form, 6 extrusion, 7 revolution).
 *
 * Output 1 (vtkPolyData): the edges between regions as lines, with the cell array Regions (two).
 *
 * Output 2 (vtkTable): a row a region with Region, Type, Triangles, Area, Point, Axis, Radius (of a
 * cone beside Point, of a torus of its circle of centres), MinorRadius, Angle (of a cone between
 * axis and surface, degrees), Reversed (the triangles' normals are opposite to the surface's),
 * MaxDistance (of points), MaxSag (of the middles of edges and triangles), Direction, Position and
 * Size (numbers of the values that SnapDistance made common, -1: the region's own; positions are of
 * planes along their normal and of axes; sizes are radii, of tori the minor one, and angles of
 * cones), Turn (of the axis, to be common, degrees).
 *
 * Output 3 (vtkTable): one row with Regions, Planes, Cylinders, Spheres, Cones, Tori, Extrusions,
 * Revolutions, FreeForms, MaxDistance, MaxSag, Noise, Tolerance, SnappedSurfaces, CommonDirections,
 * CommonPositions, CommonSizes, MaxTurn.
 *
 * @source Guess and score: Schnabel, Wahl, Klein (2007). The module's page has limits and errors.
 */
#ifndef vtkSurfaceRecognition_h
#define vtkSurfaceRecognition_h
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACETRIMMING_EXPORT vtkSurfaceRecognition : public vtkSplineAlgorithm
{
public:
  static vtkSurfaceRecognition* New();
  vtkTypeMacro(vtkSurfaceRecognition, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

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
  ///@{
  /** Directions, positions and sizes of surfaces that are nearly equal become equal where surfaces
   * then move by this distance at most at the points of their regions, unit of the points, up to
   * the tolerance; 0: all keep their own. Default 0, valid range >= 0. */
  vtkSetClampMacro(SnapDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SnapDistance, double);
  ///@}

protected:
  vtkSurfaceRecognition();
  ~vtkSurfaceRecognition() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSurfaceRecognition(const vtkSurfaceRecognition&) = delete;
  void operator=(const vtkSurfaceRecognition&) = delete;

  double Tolerance = 0.0;
  double MaximumSag = 5.0;
  double SnapDistance = 0.0;
};
#endif
