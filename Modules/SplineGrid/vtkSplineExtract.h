// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineExtract
 * @brief   parts, iso-curves and other parametrizations of spline surfaces, boundaries of volumes
 *
 * What is switched on is done in this order:
 *
 * - Boundary: volumes on unstructured meshes become their whole boundary, one surface a patch on
 *   the mesh of the boundary's quadrilaterals; surfaces on such meshes become the curves of their
 *   boundary, of which the first keeps the patch's number.
 * - RestrictToBox: the part of the surface over Box becomes the patch.
 * - SwapParameters: S'(u, v) = S(v, u).
 * - ReverseFirst, ReverseSecond: a parameter t becomes begin + end - t of its domain.
 * - MoveDomain: the parameters are scaled and shifted, so that Domain becomes the domain.
 * - ExpandToTensor: a locally refined (LR) surface becomes a tensor product, every mesh line as
 *   long as the domain.
 * - IsoCurve: the curve on which a parameter is IsoValue, over the domain of the other one.
 *
 * Tensor-product and LR surfaces stay what they are otherwise; weights and fields are carried
 * along. Patch numbers stay; cell arrays other than those of the spline grid are dropped.
 *
 * Errors: patches that are no surfaces, other volumes than those of Boundary, hierarchical and
 * Bezier surfaces, parts and curves of surfaces on meshes (DimensionMismatch), a volume without a
 * boundary (EmptyInput) or that touches itself along an edge (InvalidTopology), a box or value
 * outside the domain of a patch (OutsideDomain), a new domain without length (InvalidParameter),
 * ends of a tensor product whose knots have not full multiplicity or different knots that a new
 * domain makes one (InvalidKnots), more than MaximumFunctions of an expansion (TooLarge), and those
 * of decoding. See SurfaceExtraction.h.
 */
#ifndef vtkSplineExtract_h
#define vtkSplineExtract_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineExtract : public vtkSplineAlgorithm
{
public:
  static vtkSplineExtract* New();
  vtkTypeMacro(vtkSplineExtract, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum IsoCurves
  {
    NONE = 0,
    FIRST,
    SECOND
  };

  ///@{
  /** Whether volumes on unstructured meshes become their boundary, one surface, and surfaces on
   * such meshes the curves of theirs. Default off. */
  vtkSetMacro(Boundary, bool);
  vtkGetMacro(Boundary, bool);
  vtkBooleanMacro(Boundary, bool);
  ///@}
  ///@{
  /** Whether only the part of the surfaces over the box is kept. Default off. Group "Part". */
  vtkSetMacro(RestrictToBox, bool);
  vtkGetMacro(RestrictToBox, bool);
  vtkBooleanMacro(RestrictToBox, bool);
  ///@}
  ///@{
  /** The box of parameters, in the domain of every patch: u from Box[0] to Box[1], v from Box[2]
   * to Box[3]. Default 0 1 0 1. For RestrictToBox on. Components u0, u1, v0, v1. Group "Part". */
  vtkSetVector4Macro(Box, double);
  vtkGetVector4Macro(Box, double);
  ///@}
  ///@{
  /** Whether the parameters are exchanged: S'(u, v) = S(v, u). Default off. Group "Parameters". */
  vtkSetMacro(SwapParameters, bool);
  vtkGetMacro(SwapParameters, bool);
  vtkBooleanMacro(SwapParameters, bool);
  ///@}
  ///@{
  /** Whether the first parameter, as it is after the exchange, is reversed: t becomes begin +
   * end - t. Default off. Group "Parameters". */
  vtkSetMacro(ReverseFirst, bool);
  vtkGetMacro(ReverseFirst, bool);
  vtkBooleanMacro(ReverseFirst, bool);
  ///@}
  ///@{
  /** Whether the second parameter, as it is after the exchange, is reversed. Default off. Group
   * "Parameters". */
  vtkSetMacro(ReverseSecond, bool);
  vtkGetMacro(ReverseSecond, bool);
  vtkBooleanMacro(ReverseSecond, bool);
  ///@}
  ///@{
  /** Whether the parameters are scaled and shifted, so that Domain becomes the domain of every
   * patch. Default off. Group "Parameters". */
  vtkSetMacro(MoveDomain, bool);
  vtkGetMacro(MoveDomain, bool);
  vtkBooleanMacro(MoveDomain, bool);
  ///@}
  ///@{
  /** The new domain: u from Domain[0] to Domain[1], v from Domain[2] to Domain[3]. Default 0 1 0 1.
   * For MoveDomain on. Components u0, u1, v0, v1. Group "Parameters". */
  vtkSetVector4Macro(Domain, double);
  vtkGetVector4Macro(Domain, double);
  ///@}
  ///@{
  /** Whether LR surfaces become tensor products: every mesh line becomes as long as the domain.
   * Default off. */
  vtkSetMacro(ExpandToTensor, bool);
  vtkGetMacro(ExpandToTensor, bool);
  vtkBooleanMacro(ExpandToTensor, bool);
  ///@}
  ///@{
  /** The parameter that is constant on a curve that is taken instead of the surface, one of
   * IsoCurves. Default NONE. Group "Curve". */
  vtkSetClampMacro(IsoCurve, int, NONE, SECOND);
  vtkGetMacro(IsoCurve, int);
  ///@}
  ///@{
  /** Value of the parameter that is constant on the curve, in the domain that every patch has then;
   * on a line of full multiplicity the limit from above. Default 0.5. For IsoCurve not NONE. Kernel
   * default 0. Group "Curve". */
  vtkSetMacro(IsoValue, double);
  vtkGetMacro(IsoValue, double);
  ///@}

  ///@{
  /** Functions that a surface may have as a tensor product; more is an error before memory is
   * taken. Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineExtract();
  ~vtkSplineExtract() override = default;
  bool WorksOnPieces() const override { return true; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineExtract(const vtkSplineExtract&) = delete;
  void operator=(const vtkSplineExtract&) = delete;

  int MaximumFunctions = 1000000;
  bool Boundary = false;
  bool RestrictToBox = false;
  double Box[4] = { 0.0, 1.0, 0.0, 1.0 };
  bool SwapParameters = false;
  bool ReverseFirst = false;
  bool ReverseSecond = false;
  bool MoveDomain = false;
  double Domain[4] = { 0.0, 1.0, 0.0, 1.0 };
  bool ExpandToTensor = false;
  int IsoCurve = NONE;
  double IsoValue = 0.5;
};
#endif
