// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTemplateMapping
 * @brief   spline map that carries the patches of a template onto target patches
 *
 * Input 0 is the template and input 1 the target: curves in the plane z = 0, or surfaces in space,
 * with the cell array `PatchId`. In the plane: vtkPolyData of polylines; cells of one id are one
 * patch, joined in their order: each must begin where the one before ends. In space: vtkPolyData of
 * triangles, or of flat convex polygons. Either may be a vtkUnstructuredGrid, of linear or of
 * Bezier cells. Target patches go with the template patches of the same id; template patches
 * without a target are free and only follow. Optional point arrays: `Parameter` (plane: of the
 * template increasing along each patch; of the target the parameters of the first iteration;
 * without it point i of n has i / (n - 1)), and `Normals` of the target (without it those of the
 * polyline or mesh). Input 2 is optional: a spline grid of one polynomial patch, the map to start
 * with; its space is taken too.
 *
 * Output 0 is the map as a spline grid of one patch with the cell arrays `MaxError` (unit of the
 * points: the largest distance of the samples in the cell, 0 where there are none),
 * `JacobianMinLower` and `JacobianMaxUpper` (proved bounds of det J in the cell, with respect to
 * the parameters of the map's domain: area or volume over area or volume), and the field data
 * `MinJacobianBound` (the smallest of the first), `Injective` (whether the map takes a value twice:
 * "injective", "injective_up_to_seam", "not_injective", "undecided") and `InjectivityReason`.
 * Output 1 is the mapped template: polylines or triangles with the cell array `PatchId` and the
 * point arrays `PatchId`, `Parameter` (plane) and `Distance` (to the target's patch, -1 on free
 * patches). Output 2 is the convergence table, one row an iteration: `Iteration`, `SquaredL2Error`
 * (sum over all target samples), `MaxError` (two-sided), `NegativeJacobianPercent` (of 10^6 points
 * of the domain: 1000 x 1000 or 100 x 100 x 100), `StepLength` (share of the step that was taken),
 * `HeldElements` (that the guard held back), `Functions`.
 *
 * Without points in both inputs the outputs are empty.
 *
 * @source Sajavicius, Juettler, Speh (2018). The module's page has the method, limits and errors.
 */
#ifndef vtkTemplateMapping_h
#define vtkTemplateMapping_h
#include "vtkKnotworkTemplateMappingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

namespace knotwork
{
template <int Dim>
struct TemplateMapParams;
}

class VTKKNOTWORKTEMPLATEMAPPING_EXPORT vtkTemplateMapping : public vtkSplineAlgorithm
{
public:
  static vtkTemplateMapping* New();
  vtkTypeMacro(vtkTemplateMapping, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** What an iteration minimizes, over the samples p of the target. */
  enum Methods
  {
    FIXED =
      0, ///< "Fixed Parameters" distance to the mapped point of the sample's own, fixed parameter
    PDM = 1, ///< "Point Distance (PDM)" distance to the closest mapped point
    TDM = 2, ///< "Tangent Distance (TDM)" distance of the closest mapped point to the tangent at p
    WEIGHTED =
      3 ///< "Weighted PDM and TDM" PdmWeight times the second plus TdmWeight times the third
  };

  /** How the space grows between iterations. */
  enum Refinements
  {
    NONE = 0,
    LOCAL = 1,  ///< cells with large errors, by truncated hierarchical B-splines
    GLOBAL = 2, ///< every cell
    HELD = 3    ///< cells that the guard holds back, by truncated hierarchical B-splines
  };

  /** The map of the first iteration. */
  enum InitialMaps
  {
    IDENTITY = 0,
    MOVED = 1, ///< the identity, control points moved by the mean displacement around them
    QUADRATIC =
      2 ///< least squares of the samples' distances with the uniformity functional, one solve
  };

  ///@{
  /** The target, as input 1. */
  void SetTargetConnection(vtkAlgorithmOutput* target) { this->SetInputConnection(1, target); }
  void SetTargetData(vtkDataObject* target) { this->SetInputData(1, target); }
  ///@}
  ///@{
  /** The map to start with, as input 2: a spline grid of one polynomial patch over a domain that
   * contains the template. It decides the space too: Degree, InnerKnots and Domain are then not
   * read, nor is InitialMap. */
  void SetInitialMapConnection(vtkAlgorithmOutput* map) { this->SetInputConnection(2, map); }
  void SetInitialMapData(vtkDataObject* map) { this->SetInputData(2, map); }
  ///@}

  ///@{
  /** What an iteration minimizes over the samples p of the target, one of Methods: sum |s - p|^2
   * at fixed parameters (FIXED) or at the closest points s (PDM), or sum ((s - p) . N)^2 with
   * the normal N of the target (TDM), or both with their weights (WEIGHTED). Default TDM. Group
   * "Method". */
  vtkSetClampMacro(Method, int, FIXED, WEIGHTED);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** Polynomial degree of the map in every direction. Default 3, valid range [1, 9]. Group
   * "Method". */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Equally spaced inner knots in each direction: one less than the elements. Default 11, valid
   * range [0, 4096]. Group "Method". */
  vtkSetClampMacro(InnerKnots, int, 0, 4096);
  vtkGetMacro(InnerKnots, int);
  ///@}
  ///@{
  /** Inner knots of single directions; -1: the common number. Default -1 -1 -1, valid range [-1,
   * 4096]. Advanced. Group "Method". Components u, v, w. */
  vtkSetVector3Macro(InnerKnotsPerDirection, int);
  vtkGetVector3Macro(InnerKnotsPerDirection, int);
  ///@}
  ///@{
  /** Dense samples of each template patch among which closest points are searched first; 0: the
   * template's own points. A coarse template needs some thousands; 1 is not valid. Default 0,
   * valid range [0, 10000000]. Group "Method". */
  vtkSetClampMacro(TemplateSamples, int, 0, 10000000);
  vtkGetMacro(TemplateSamples, int);
  ///@}
  ///@{
  /** Newton steps from the nearest dense sample to the closest point. Default 2, valid range [0,
   * 100]. Advanced. Group "Method". */
  vtkSetClampMacro(NewtonSteps, int, 0, 100);
  vtkGetMacro(NewtonSteps, int);
  ///@}
  ///@{
  /** Weight of the squared point distances sum |s - p|^2; not 0 together with TdmWeight. Default
   * 1, valid range >= 0. For Method WEIGHTED. Group "Method". */
  vtkSetClampMacro(PdmWeight, double, 0.0, 1e30);
  vtkGetMacro(PdmWeight, double);
  ///@}
  ///@{
  /** Weight of the squared tangent distances sum ((s - p) . N)^2. Default 1, valid range >= 0.
   * For Method WEIGHTED. Group "Method". */
  vtkSetClampMacro(TdmWeight, double, 0.0, 1e30);
  vtkGetMacro(TdmWeight, double);
  ///@}
  ///@{
  /** Weight of the squared change of the control points in an iteration: larger is smoother and
   * slower; 0 needs samples that determine every control point. Default 0.02, valid range >= 0.
   * Group "Functionals". */
  vtkSetClampMacro(TikhonovWeight, double, 0.0, 1e30);
  vtkGetMacro(TikhonovWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum |s_kl|^2 over the domain: parameter lines bend little and are
   * evenly spaced. Default 0, valid range >= 0. Group "Functionals". */
  vtkSetClampMacro(UniformityWeight, double, 0.0, 1e30);
  vtkGetMacro(UniformityWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum |s_k|^2: parameter lines are short. Default 0, valid range >=
   * 0. Group "Functionals". */
  vtkSetClampMacro(LengthWeight, double, 0.0, 1e30);
  vtkGetMacro(LengthWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum (s_k . s_l)^2: parameter lines meet at right angles. Default
   * 0, valid range >= 0. Advanced. Group "Functionals". */
  vtkSetClampMacro(OrthogonalityWeight, double, 0.0, 1e30);
  vtkGetMacro(OrthogonalityWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum cos^4 of the angles between parameter lines. Default 0, valid
   * range >= 0. Advanced. Group "Functionals". */
  vtkSetClampMacro(SkewnessWeight, double, 0.0, 1e30);
  vtkGetMacro(SkewnessWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum ((s_k . s_kk) / |s_k|^2)^2: speed along parameter lines
   * changes little. Default 0, valid range >= 0. Advanced. Group "Functionals". */
  vtkSetClampMacro(EccentricityWeight, double, 0.0, 1e30);
  vtkGetMacro(EccentricityWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of (det J)^2: cells of equal area or volume. Default 0, valid range
   * >= 0. Advanced. Group "Functionals". */
  vtkSetClampMacro(AreaWeight, double, 0.0, 1e30);
  vtkGetMacro(AreaWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum 1 / (|s_k|^2 + 1e-7)^2: parameter lines nowhere stop. Default
   * 0, valid range >= 0. Advanced. Group "Functionals". */
  vtkSetClampMacro(SelfIntersectionWeight, double, 0.0, 1e30);
  vtkGetMacro(SelfIntersectionWeight, double);
  ///@}
  ///@{
  /** Whether every iterate is kept regular: a step after which det J > 0 is not proved
   * everywhere is held back where it folds, or shortened. Proved bounds decide, not samples.
   * Default on. Group "Regularity". */
  vtkSetMacro(Guard, bool);
  vtkGetMacro(Guard, bool);
  vtkBooleanMacro(Guard, bool);
  ///@}
  ///@{
  /** Iterations end, with the iterate before, when det J < 0 at a larger share of 10^6 points of
   * the domain; 1: never. Default 1, valid range [0, 1]. For Guard off. Group "Regularity". */
  vtkSetClampMacro(MaxIrregularShare, double, 0.0, 1.0);
  vtkGetMacro(MaxIrregularShare, double);
  ///@}
  ///@{
  /** Whether cells become smaller between iterations, one of Refinements: where errors are large
   * (truncated hierarchical B-splines), everywhere, or where the guard holds elements back (needs
   * Guard on). Default NONE. Group "Refinement". */
  vtkSetClampMacro(Refinement, int, NONE, HELD);
  vtkGetMacro(Refinement, int);
  ///@}
  ///@{
  /** Refine after every so many iterations; 0: when the error stagnates. Default 1, valid range
   * [0, 100000]. For Refinement not NONE. Group "Refinement". */
  vtkSetClampMacro(RefineEvery, int, 0, 100000);
  vtkGetMacro(RefineEvery, int);
  ///@}
  ///@{
  /** The squared error stagnates when it falls by less than this part of itself in an iteration.
   * Default 0.05, valid range [1e-6, 0.999999]. For Refinement not NONE. For RefineEvery 0.
   * Group "Refinement". */
  vtkSetClampMacro(StagnationRatio, double, 1e-6, 0.999999);
  vtkGetMacro(StagnationRatio, double);
  ///@}
  ///@{
  /** Cells with a target sample of at least this error are refined, unit of the points. Default
   * 1e-5, valid range >= 0. For Refinement LOCAL. Group "Refinement". */
  vtkSetClampMacro(RefineThreshold, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(RefineThreshold, double);
  ///@}
  ///@{
  /** The error that this share of all samples reaches is the threshold, if it is larger than
   * RefineThreshold; 0: that alone counts. Default 0, valid range [0, 1]. For Refinement LOCAL.
   * Group "Refinement". */
  vtkSetClampMacro(RefineShare, double, 0.0, 1.0);
  vtkGetMacro(RefineShare, double);
  ///@}
  ///@{
  /** Cells of the new level around a marked one that are refined too; the box grows to whole
   * parent cells. Default 1, valid range [0, 100]. For Refinement LOCAL, HELD. Group
   * "Refinement". */
  vtkSetClampMacro(Extension, int, 0, 100);
  vtkGetMacro(Extension, int);
  ///@}
  ///@{
  /** Cells of this level are not refined. Default 10, valid range [0, 24]. Advanced. For
   * Refinement not NONE. Group "Refinement". */
  vtkSetClampMacro(MaxLevel, int, 0, 24);
  vtkGetMacro(MaxLevel, int);
  ///@}
  ///@{
  /** A refinement to more functions is not made; a first space of more is an error. Default
   * 200000, valid range >= 1. Advanced. For Refinement not NONE. Group "Refinement". */
  vtkSetClampMacro(MaxFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaxFunctions, int);
  ///@}
  ///@{
  /** Iterations at most: one least-squares step and one update of the closest points each.
   * Default 20, valid range [1, 100000]. Group "Termination". */
  vtkSetClampMacro(Iterations, int, 1, 100000);
  vtkGetMacro(Iterations, int);
  ///@}
  ///@{
  /** Iterations end when the largest error, both ways between target and mapped template, is not
   * above this, unit of the points; 0: never. Default 0, valid range >= 0. Group "Termination". */
  vtkSetClampMacro(Accuracy, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Accuracy, double);
  ///@}
  ///@{
  /** The map of the first iteration, unless one is given as input 2, one of InitialMaps: the
   * identity, or the identity with each control point moved by the mean displacement of the
   * samples around it (lumped), or the map of least sum |s - p|^2 at the first parameters plus
   * InitialUniformityWeight times the integral of sum |s_kl|^2 (one quadratic solve); the last two
   * for targets far off. Default IDENTITY. Group "Initial Map". */
  vtkSetClampMacro(InitialMap, int, IDENTITY, QUADRATIC);
  vtkGetMacro(InitialMap, int);
  ///@}
  ///@{
  /** Weight of the integral of sum |s_kl|^2 in the initial map: larger is smoother. Default 0.0001,
   * valid range [1e-12, 1e30]. For InitialMap QUADRATIC. Group "Initial Map". */
  vtkSetClampMacro(InitialUniformityWeight, double, 1e-12, 1e30);
  vtkGetMacro(InitialUniformityWeight, double);
  ///@}
  ///@{
  /** Whether the map is made over the box Domain, which must contain the template, not over the
   * template's bounding box. Default off. Advanced. Group "Initial Map". */
  vtkSetMacro(UseDomain, bool);
  vtkGetMacro(UseDomain, bool);
  vtkBooleanMacro(UseDomain, bool);
  ///@}
  ///@{
  /** Box around the template: x, y and (in space) z, each from and to. Default 0 1 0 1 0 1.
   * Advanced. For UseDomain on. Components xmin, xmax, ymin, ymax, zmin, zmax. Group "Initial
   * Map". */
  vtkSetVector6Macro(Domain, double);
  vtkGetVector6Macro(Domain, double);
  ///@}
  ///@{
  /** Whether it is proved that the map as a whole takes no value twice: field data Injective.
   * Default on. Advanced. Group "Regularity". */
  vtkSetMacro(Injectivity, bool);
  vtkGetMacro(Injectivity, bool);
  vtkBooleanMacro(Injectivity, bool);
  ///@}

protected:
  vtkTemplateMapping();
  ~vtkTemplateMapping() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkTemplateMapping(const vtkTemplateMapping&) = delete;
  void operator=(const vtkTemplateMapping&) = delete;

  template <int Dim>
  knotwork::Result<knotwork::TemplateMapParams<Dim>> Parameters(vtkDataObject* initialMap);
  template <int Dim>
  knotwork::Status MapSkeleton(vtkInformationVector** inputs, vtkInformationVector* outputs);

  int Method = TDM;
  int Iterations = 20;
  int Degree = 3;
  int InnerKnots = 11;
  int InnerKnotsPerDirection[3] = { -1, -1, -1 };
  int TemplateSamples = 0;
  int NewtonSteps = 2;
  double PdmWeight = 1.0;
  double TdmWeight = 1.0;
  double TikhonovWeight = 2e-2;
  double UniformityWeight = 0.0;
  double LengthWeight = 0.0;
  double OrthogonalityWeight = 0.0;
  double SkewnessWeight = 0.0;
  double EccentricityWeight = 0.0;
  double AreaWeight = 0.0;
  double SelfIntersectionWeight = 0.0;
  bool Guard = true;
  double Accuracy = 0.0;
  double MaxIrregularShare = 1.0;
  int Refinement = NONE;
  int RefineEvery = 1;
  double StagnationRatio = 0.05;
  double RefineThreshold = 1e-5;
  double RefineShare = 0.0;
  int Extension = 1;
  int MaxLevel = 10;
  int MaxFunctions = 200000;
  int InitialMap = IDENTITY;
  double InitialUniformityWeight = 1e-4;
  bool UseDomain = false;
  double Domain[6] = { 0, 1, 0, 1, 0, 1 };
  bool Injectivity = true;
};
#endif
