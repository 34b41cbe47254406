// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineSource
 * @brief   ready-made spline geometries as Bezier grids
 *
 * Curves, surfaces and solids of one or several patches, all exact: circles, cylinders, spheres and
 * tori are rational. Maps are right-handed (surfaces in space: normal outward) and regular, except
 * that POLAR_SPHERE_SURFACE is degenerate at its poles, and BALL_SECTOR at the centre when
 * InnerRadius is 0 and at the poles when PolarAngle is 180. Patches that touch agree point by
 * point, in parameters, degrees, knots and weights; they have no common points in the grid.
 *
 * Output: a vtkUnstructuredGrid, patches numbered by the cell array PatchId in the order that the
 * shape lists them. Errors: a property outside its range (InvalidParameter), more functions than
 * MaximumFunctions (TooLarge).
 */
#ifndef vtkSplineSource_h
#define vtkSplineSource_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineSource : public vtkSplineAlgorithm
{
public:
  static vtkSplineSource* New();
  vtkTypeMacro(vtkSplineSource, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** The shapes; the words in brackets say what the numbers in Elements count. */
  enum Shapes
  {
    LINE = 0,                ///< along x, Size[0] [along]
    ARC,                     ///< OuterRadius, from +x through Angle [along]
    SQUARE,                  ///< Size[0] x Size[1] [x, y]
    ANNULUS_SECTOR,          ///< InnerRadius to OuterRadius, through Angle [radial, angular]
    DISC,                    ///< 5 patches: square core with corners at InnerRadius, OuterRadius
                             ///< [radial, along the core's sides]
    PLATE_WITH_HOLE,         ///< 4 patches: Size without a disc of InnerRadius [radial, around]
    QUARTER_PLATE_WITH_HOLE, ///< 2 patches: x, y >= 0 of the plate [radial, around]
    CYLINDER_SURFACE,        ///< OuterRadius, Angle, Height [angular, axial]
    SPHERE_SURFACE,          ///< 6 patches of degree 4, OuterRadius [along the sides]
    POLAR_SPHERE_SURFACE,    ///< one patch, OuterRadius, Angle [longitude, latitude]
    TORUS_SURFACE,           ///< tube of InnerRadius around a circle of OuterRadius, Angle
                             ///< [about z, around the tube]
    CUBE,                    ///< Size [x, y, z]
    SOLID_TUBE,              ///< annulus sector times Height [radial, angular, axial]
    SOLID_CYLINDER, ///< 5 patches: disc times Height [radial, along the core's sides, axial]
    BALL_SECTOR,    ///< InnerRadius to OuterRadius, longitudes through Angle, latitudes
                    ///< +-PolarAngle / 2 [radial, longitude, latitude]
    BALL,           ///< 7 patches of degree 4: cube core with corners at InnerRadius,
                    ///< OuterRadius [radial, along the core's sides]
    TWISTED_BAR,    ///< Size, turned about z by Twist from end to end [x, y, z]
    SOLID_TORUS     ///< 5 patches: disc of InnerRadius around a circle of OuterRadius,
                    ///< Angle [radial, along the core's sides, about z]
  };

  ///@{
  /** The curve, surface or solid to make, one of Shapes. Default SQUARE. */
  vtkSetClampMacro(Shape, int, LINE, SOLID_TORUS);
  vtkGetMacro(Shape, int);
  ///@}
  ///@{
  /** The shape by its name: Line, Arc, Square, AnnulusSector, Disc, PlateWithHole,
   * QuarterPlateWithHole, CylinderSurface, SphereSurface, PolarSphereSurface, TorusSurface, Cube,
   * SolidTube, SolidCylinder, BallSector, Ball, TwistedBar, SolidTorus. Another name is an error
   * and changes nothing. */
  void SetShapeName(const char* name);
  const char* GetShapeName();
  ///@}
  ///@{
  /** Degree that every direction is raised to; 0: the lowest one that is exact. Default 0, valid
   * range [0, 9]. */
  vtkSetClampMacro(Degree, int, 0, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Equal elements that every knot span of the shape is cut into, with the highest continuity:
   * along x, y, z, or in radial, angular and axial direction, as far as the shape has them; see
   * Shapes. Default 1 1 1, valid range >= 1. Components first, second, third. */
  vtkSetVector3Macro(Elements, int);
  vtkGetVector3Macro(Elements, int);
  ///@}
  ///@{
  /** Radius of the hole, of a torus' tube, or of the corners of the core of a disc or ball; less
   * than OuterRadius, 0 for ball sectors only, of plates less than half a side. Default 0.5,
   * valid range >= 0. For Shape ANNULUS_SECTOR, DISC, PLATE_WITH_HOLE, QUARTER_PLATE_WITH_HOLE,
   * TORUS_SURFACE, SOLID_TUBE, SOLID_CYLINDER, BALL_SECTOR, BALL, SOLID_TORUS. */
  vtkSetMacro(InnerRadius, double);
  vtkGetMacro(InnerRadius, double);
  ///@}
  ///@{
  /** Radius of the circle, cylinder or sphere, or of the circle that a torus follows; above 0.
   * Default 1, valid range >= 0. For Shape not LINE, SQUARE, PLATE_WITH_HOLE,
   * QUARTER_PLATE_WITH_HOLE, CUBE, TWISTED_BAR. */
  vtkSetMacro(OuterRadius, double);
  vtkGetMacro(OuterRadius, double);
  ///@}
  ///@{
  /** Angle about z from +x in degrees that arcs, sectors and tori span; at 360 a seam remains.
   * Default 90, valid range (0, 360]. For Shape ARC, ANNULUS_SECTOR, CYLINDER_SURFACE,
   * POLAR_SPHERE_SURFACE, TORUS_SURFACE, SOLID_TUBE, BALL_SECTOR, SOLID_TORUS. */
  vtkSetMacro(Angle, double);
  vtkGetMacro(Angle, double);
  ///@}
  ///@{
  /** Patches that share the angle of an annulus sector or a solid tube equally; with 360 degrees
   * they close to a ring. Default 1, valid range [1, 4096]. For Shape ANNULUS_SECTOR, SOLID_TUBE.
   */
  vtkSetClampMacro(Sectors, int, 1, 4096);
  vtkGetMacro(Sectors, int);
  ///@}
  ///@{
  /** Angle in degrees between the lowest and the highest latitude of a ball sector; at 180 it is
   * degenerate at the poles. Default 90, valid range (0, 180]. Advanced. For Shape BALL_SECTOR. */
  vtkSetMacro(PolarAngle, double);
  vtkGetMacro(PolarAngle, double);
  ///@}
  ///@{
  /** Length along z of cylinders and tubes; above 0. Default 1, valid range >= 0. For Shape
   * CYLINDER_SURFACE, SOLID_TUBE, SOLID_CYLINDER. */
  vtkSetMacro(Height, double);
  vtkGetMacro(Height, double);
  ///@}
  ///@{
  /** Angle in degrees between the two ends of a twisted bar. Default 90, valid range [-3600,
   * 3600]. For Shape TWISTED_BAR. */
  vtkSetMacro(Twist, double);
  vtkGetMacro(Twist, double);
  ///@}
  ///@{
  /** Side lengths along x, y and z of lines, squares, plates, cubes and bars; above 0. Default 1
   * 1 1, valid range >= 0. For Shape LINE, SQUARE, PLATE_WITH_HOLE, QUARTER_PLATE_WITH_HOLE, CUBE,
   * TWISTED_BAR. Components x, y, z. */
  vtkSetVector3Macro(Size, double);
  vtkGetVector3Macro(Size, double);
  ///@}
  ///@{
  /** Centre of the box, circle, sphere, ring or axis. Default 0 0 0. Components x, y, z. */
  vtkSetVector3Macro(Center, double);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /** Functions that all patches may have together; more is an error before memory is taken.
   * Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineSource();
  ~vtkSplineSource() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineSource(const vtkSplineSource&) = delete;
  void operator=(const vtkSplineSource&) = delete;

  int MaximumFunctions = 1000000;
  int Shape = SQUARE;
  int Degree = 0;
  int Elements[3] = { 1, 1, 1 };
  double InnerRadius = 0.5;
  double OuterRadius = 1.0;
  double Angle = 90.0;
  int Sectors = 1;
  double PolarAngle = 90.0;
  double Height = 1.0;
  double Twist = 90.0;
  double Size[3] = { 1.0, 1.0, 1.0 };
  double Center[3] = { 0.0, 0.0, 0.0 };
};
#endif
