// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineVolumeFit
 * @brief   fits a spline of three parameters to values at scattered points in space
 *
 * Input are points with a point array of numbers (ValueArray, input array 0; else the active
 * scalars): temperatures, densities, velocities. They become a field, of the array's name, on a
 * spline volume over the box of the points: a trivariate LR B-spline or truncated hierarchical
 * (THB) one whose geometry is that box, so that x, y, z are its parameters. Elements are halved
 * where points are outside of the tolerance until none is, or a limit is reached (a warning says
 * how many are left).
 *
 * Output 0 is the volume as a spline grid with the field. Output 1 are the points with the array
 * Distance: the largest absolute difference of a component. Output 2 is a table of the iterations:
 * Method, Functions, Elements, MaxError, RmsError, PointsOutside.
 */
#ifndef vtkSplineVolumeFit_h
#define vtkSplineVolumeFit_h
#include "vtkKnotworkSurfaceFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACEFITTING_EXPORT vtkSplineVolumeFit : public vtkSplineAlgorithm
{
public:
  static vtkSplineVolumeFit* New();
  vtkTypeMacro(vtkSplineVolumeFit, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Spaces
  {
    LR = 0, ///< "LR" LR B-splines
    THB     ///< "THB" truncated hierarchical B-splines
  };
  enum Methods
  {
    LEAST_SQUARES = 0,
    MBA,     ///< "MBA"
    COMBINED ///< least squares until SwitchIteration, then MBA
  };
  enum Strategies
  {
    FULL_SPAN = 0,
    MINIMUM_SPAN,
    STRUCTURED_MESH,
    RESTRICTED_MESH
  };

  ///@{
  /** Largest absolute difference of a value from the spline. 0: a thousandth of the range of the
   * values. Default 0, valid range >= 0. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Kind of the spline space, one of Spaces: locally refined or truncated hierarchical
   * B-splines. Default LR. */
  vtkSetClampMacro(Space, int, LR, THB);
  vtkGetMacro(Space, int);
  ///@}
  ///@{
  /** Degree in all three directions. Default 2, valid range [1, 9]. */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Elements of the first space in every direction; 0: chosen by the number of points. Default 0,
   * valid range [0, 512]. Advanced. */
  vtkSetClampMacro(InitialElements, int, 0, 512);
  vtkGetMacro(InitialElements, int);
  ///@}
  ///@{
  /** How coefficients are found, one of Methods. Default LEAST_SQUARES. */
  vtkSetClampMacro(Method, int, LEAST_SQUARES, COMBINED);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** The first iteration of MBA. Default 6, valid range [0, 100]. Advanced. For Method COMBINED. */
  vtkSetClampMacro(SwitchIteration, int, 0, 100);
  vtkGetMacro(SwitchIteration, int);
  ///@}
  ///@{
  /** Weight of the energy of second derivatives of an element in its own parameters, relative to
   * the mean number of points of an element. Default 1e-9, valid range [1e-15, 1000]. Advanced. For
   * Method not MBA. */
  vtkSetClampMacro(Smoothing, double, 1e-15, 1000.0);
  vtkGetMacro(Smoothing, double);
  ///@}
  ///@{
  /** Which mesh rectangles halve an element of an LR volume, one of Strategies. Default FULL_SPAN.
   * Advanced. For Space LR. */
  vtkSetClampMacro(Strategy, int, FULL_SPAN, RESTRICTED_MESH);
  vtkGetMacro(Strategy, int);
  ///@}
  ///@{
  /** Iterations after the first. Default 20, valid range [0, 100]. */
  vtkSetClampMacro(MaximumIterations, int, 0, 100);
  vtkGetMacro(MaximumIterations, int);
  ///@}
  ///@{
  /** Functions of the result; 0: the number of points, at least 1000. Default 0, valid range >= 0.
   * Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineVolumeFit();
  ~vtkSplineVolumeFit() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineVolumeFit(const vtkSplineVolumeFit&) = delete;
  void operator=(const vtkSplineVolumeFit&) = delete;

  double Tolerance = 0.0;
  int Space = LR;
  int Degree = 2;
  int InitialElements = 0;
  int Method = LEAST_SQUARES;
  int SwitchIteration = 6;
  double Smoothing = 1e-9;
  int Strategy = FULL_SPAN;
  int MaximumIterations = 20;
  int MaximumFunctions = 0;
};
#endif
