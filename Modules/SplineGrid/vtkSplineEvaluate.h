// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineEvaluate
 * @brief   values and derivatives of splines at points given by parameters or by position
 *
 * Input 0: a spline grid (vtkUnstructuredGrid or vtkPartitionedDataSetCollection). Input 1: a
 * vtkPointSet; every point of it is evaluated.
 *
 * In mode PARAMETERS the parameters are those in ParameterArray (as many components as the patch
 * has parameters, or more), or the point's coordinates when the name is empty. The patch is the
 * point's value in PatchIdArray when input 1 has that array, else PatchId; -1 takes the only patch.
 * A parameter outside the domain is an error that names the point. On the border of elements, where
 * derivatives may jump, FromBelow says a direction whose element is taken.
 *
 * In mode PROBE the point on the spline nearest to the point is found (over all patches): the
 * inverse of planar maps and of solids, the closest point of curves and surfaces. See
 * ClosestPoint.h.
 *
 * Output: input 1 with the points moved to the spline, its arrays, and the point arrays PatchId,
 * ElementId, LocalParameters (3 components, in [0, 1]), every field of the splines, in mode PROBE
 * Distance (unit of the points), and for Derivatives >= 1 of the map and of each field
 * Derivative_u, Derivative_v,
 * ... (a field's are NAME_u, ...), for 2 also Derivative_uu, Derivative_uv, ...: with respect to
 * the parameters of the domain (of the element's unit square where a patch has no domain). Patches
 * of different parametric dimension leave the derivatives that they do not have zero.
 *
 * Errors: no spline, or no array of the given name (EmptyInput); several patches and none chosen
 * (InvalidParameter); a PatchId that the splines do not have (InvalidTopology); too few parameters
 * or a patch without a domain in mode PARAMETERS (DimensionMismatch); a parameter outside the
 * domain (OutsideDomain); a position that is not finite (NonFiniteInput); those of decoding.
 */
#ifndef vtkSplineEvaluate_h
#define vtkSplineEvaluate_h
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <string> // for array names

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineEvaluate : public vtkSplineAlgorithm
{
public:
  static vtkSplineEvaluate* New();
  vtkTypeMacro(vtkSplineEvaluate, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Modes
  {
    PARAMETERS = 0,
    PROBE
  };

  ///@{
  /** Whether points are parameters of the spline (PARAMETERS), or positions whose nearest point
   * on it is wanted (PROBE); one of Modes. Default PARAMETERS. */
  vtkSetClampMacro(Mode, int, PARAMETERS, PROBE);
  vtkGetMacro(Mode, int);
  ///@}
  ///@{
  /** Highest order of the derivatives that become point arrays. Default 0, valid range [0, 2]. */
  vtkSetClampMacro(Derivatives, int, 0, 2);
  vtkGetMacro(Derivatives, int);
  ///@}
  ///@{
  /** Which limit is taken at knots, where derivatives jump: 0 that from larger parameters, not 0
   * that from smaller ones. Default 0 0 0. Advanced. For Mode PARAMETERS. Components u, v, w. */
  vtkSetVector3Macro(FromBelow, int);
  vtkGetVector3Macro(FromBelow, int);
  ///@}
  ///@{
  /** Point array of the second input with the parameters; empty or `None`: its coordinates. Default
   * empty. For Mode PARAMETERS. */
  vtkSetMacro(ParameterArray, std::string);
  vtkGetMacro(ParameterArray, std::string);
  ///@}
  ///@{
  /** Point array of the second input with the patch of each point, where it has such an array.
   * Default PatchId. For Mode PARAMETERS. */
  vtkSetMacro(PatchIdArray, std::string);
  vtkGetMacro(PatchIdArray, std::string);
  ///@}
  ///@{
  /** Patch of all points where there is no PatchIdArray; -1: the only patch. Default -1. For Mode
   * PARAMETERS. */
  vtkSetMacro(PatchId, int);
  vtkGetMacro(PatchId, int);
  ///@}

  /** The points, as input 1. */
  void SetPointsConnection(vtkAlgorithmOutput* points) { this->SetInputConnection(1, points); }
  void SetPointsData(vtkDataObject* points) { this->SetInputData(1, points); }

protected:
  vtkSplineEvaluate();
  ~vtkSplineEvaluate() override = default;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  /** Pieces of the points. */
  bool WorksOnPieces() const override { return true; }
  int WholeInputPort() const override { return 0; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineEvaluate(const vtkSplineEvaluate&) = delete;
  void operator=(const vtkSplineEvaluate&) = delete;

  int Mode = PARAMETERS;
  int Derivatives = 0;
  int FromBelow[3] = { 0, 0, 0 };
  std::string ParameterArray;
  std::string PatchIdArray = "PatchId";
  int PatchId = -1;
};
#endif
