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
    FIXED = 0,   ///< distance to the mapped point of the sample's own, fixed parameter
    PDM = 1,     ///< distance to the closest mapped point
    TDM = 2,     ///< distance of the closest mapped point to the tangent at p
    WEIGHTED = 3 ///< PdmWeight times the second plus TdmWeight times the third
  };

  /** How the space grows between iterations. */
  enum Refinements
  {
    NONE = 0,
    LOCAL = 1, ///< cells with large errors, by truncated hierarchical B-splines
    GLOBAL = 2 ///< every cell
  };

  /** The map of the first iteration. */
  enum InitialMaps
  {
    IDENTITY = 0,
    MOVED = 1 ///< the identity, control points moved by the mean displacement around them
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
  /** FIXED, PDM, TDM or WEIGHTED. Default TDM. */
  vtkSetClampMacro(Method, int, FIXED, WEIGHTED);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** Iterations at most: one least-squares step and one update of the closest points each. Default
   * 20, valid range [1, 100000]. */
  vtkSetClampMacro(Iterations, int, 1, 100000);
  vtkGetMacro(Iterations, int);
  ///@}
  ///@{
  /** Polynomial degree of the map in every direction. Default 3, valid range [1, 9]. */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Equally spaced inner knots in each direction. Default 11, valid range [0, 4096]. */
  vtkSetClampMacro(InnerKnots, int, 0, 4096);
  vtkGetMacro(InnerKnots, int);
  ///@}
  ///@{
  /** The same of single directions; -1 takes the common number. Default -1, valid range [-1, 4096].
   */
  vtkSetVector3Macro(InnerKnotsPerDirection, int);
  vtkGetVector3Macro(InnerKnotsPerDirection, int);
  ///@}
  ///@{
  /** Dense samples of each template patch among which closest points are searched first: 0 takes
   * the template's own points. Default 0, valid range 0 and [2, 1e7]. */
  vtkSetClampMacro(TemplateSamples, int, 0, 10000000);
  vtkGetMacro(TemplateSamples, int);
  ///@}
  ///@{
  /** Newton steps from the nearest dense sample. Default 2, valid range [0, 100]. */
  vtkSetClampMacro(NewtonSteps, int, 0, 100);
  vtkGetMacro(NewtonSteps, int);
  ///@}
  ///@{
  /** Weight of the squared point distances, WEIGHTED only. Default 1, not negative; not 0 together
   * with TdmWeight. */
  vtkSetClampMacro(PdmWeight, double, 0.0, 1e30);
  vtkGetMacro(PdmWeight, double);
  ///@}
  ///@{
  /** Weight of the squared tangent distances, WEIGHTED only. Default 1, not negative. */
  vtkSetClampMacro(TdmWeight, double, 0.0, 1e30);
  vtkGetMacro(TdmWeight, double);
  ///@}
  ///@{
  /** Weight of the squared change of the control points in an iteration. Default 0.02, not
   * negative; 0 needs samples that determine every control point. */
  vtkSetClampMacro(TikhonovWeight, double, 0.0, 1e30);
  vtkGetMacro(TikhonovWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum |s_kl|^2 over the domain: parameter lines bend little and are
   * evenly spaced. Default 0, not negative. */
  vtkSetClampMacro(UniformityWeight, double, 0.0, 1e30);
  vtkGetMacro(UniformityWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum |s_k|^2: parameter lines are short. Default 0, not negative. */
  vtkSetClampMacro(LengthWeight, double, 0.0, 1e30);
  vtkGetMacro(LengthWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum (s_k . s_l)^2: parameter lines meet at right angles. Default 0,
   * not negative. */
  vtkSetClampMacro(OrthogonalityWeight, double, 0.0, 1e30);
  vtkGetMacro(OrthogonalityWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum cos^4 of the angles between parameter lines. Default 0, not
   * negative. */
  vtkSetClampMacro(SkewnessWeight, double, 0.0, 1e30);
  vtkGetMacro(SkewnessWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum ((s_k . s_kk) / |s_k|^2)^2: speed along parameter lines changes
   * little. Default 0, not negative. */
  vtkSetClampMacro(EccentricityWeight, double, 0.0, 1e30);
  vtkGetMacro(EccentricityWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of (det J)^2: cells of equal area or volume. Default 0, not negative.
   */
  vtkSetClampMacro(AreaWeight, double, 0.0, 1e30);
  vtkGetMacro(AreaWeight, double);
  ///@}
  ///@{
  /** Weight of the integral of sum 1 / (|s_k|^2 + 1e-7)^2: parameter lines nowhere stop. Default 0,
   * not negative. */
  vtkSetClampMacro(SelfIntersectionWeight, double, 0.0, 1e30);
  vtkGetMacro(SelfIntersectionWeight, double);
  ///@}
  ///@{
  /** Keep every iterate regular: a step after which det J > 0 is not proved everywhere is changed.
   * The certificate decides, not samples. Default on. */
  vtkSetMacro(Guard, bool);
  vtkGetMacro(Guard, bool);
  vtkBooleanMacro(Guard, bool);
  ///@}
  ///@{
  /** Iterations end when the largest error is not above this, unit of the points; 0: never. Default
   * 0, not negative. */
  vtkSetClampMacro(Accuracy, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Accuracy, double);
  ///@}
  ///@{
  /** Iterations end, with the iterate before, when det J < 0 at a larger share of 10^6 points of
   * the domain. Nothing to do while the guard is on. Default 1: never; valid range [0, 1]. */
  vtkSetClampMacro(MaxIrregularShare, double, 0.0, 1.0);
  vtkGetMacro(MaxIrregularShare, double);
  ///@}
  ///@{
  /** NONE, LOCAL or GLOBAL. Default NONE. */
  vtkSetClampMacro(Refinement, int, NONE, GLOBAL);
  vtkGetMacro(Refinement, int);
  ///@}
  ///@{
  /** Refine after every so many iterations; 0: when the error stagnates. Default 1, valid range [0,
   * 100000]. */
  vtkSetClampMacro(RefineEvery, int, 0, 100000);
  vtkGetMacro(RefineEvery, int);
  ///@}
  ///@{
  /** The squared error stagnates when it falls by less than this part of itself in an iteration.
   * Default 0.05, valid range [1e-6, 0.999999]. */
  vtkSetClampMacro(StagnationRatio, double, 1e-6, 0.999999);
  vtkGetMacro(StagnationRatio, double);
  ///@}
  ///@{
  /** LOCAL: cells with a target sample of at least this error are refined, unit of the points.
   * Default 1e-5, not negative. */
  vtkSetClampMacro(RefineThreshold, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(RefineThreshold, double);
  ///@}
  ///@{
  /** LOCAL: the error that this share of all samples reaches is the threshold, if it is larger than
   * RefineThreshold; 0: that alone counts. Default 0, valid range [0, 1]. */
  vtkSetClampMacro(RefineShare, double, 0.0, 1.0);
  vtkGetMacro(RefineShare, double);
  ///@}
  ///@{
  /** LOCAL: cells of the new level around a marked one that are refined too. Default 1, valid range
   * [0, 100]. */
  vtkSetClampMacro(Extension, int, 0, 100);
  vtkGetMacro(Extension, int);
  ///@}
  ///@{
  /** Cells of this level are not refined. Default 10, valid range [0, 24]. */
  vtkSetClampMacro(MaxLevel, int, 0, 24);
  vtkGetMacro(MaxLevel, int);
  ///@}
  ///@{
  /** A refinement to more functions is not made. Default 200000, at least 1. */
  vtkSetClampMacro(MaxFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaxFunctions, int);
  ///@}
  ///@{
  /** IDENTITY or MOVED; not read when input 2 has a map. Default IDENTITY. */
  vtkSetClampMacro(InitialMap, int, IDENTITY, MOVED);
  vtkGetMacro(InitialMap, int);
  ///@}
  ///@{
  /** Make the map over Domain, not over the template's bounding box. Default off. */
  vtkSetMacro(UseDomain, bool);
  vtkGetMacro(UseDomain, bool);
  vtkBooleanMacro(UseDomain, bool);
  ///@}
  ///@{
  /** Box around the template as xmin, xmax, ymin, ymax, zmin, zmax (z: in space only). Default the
   * unit box. */
  vtkSetVector6Macro(Domain, double);
  vtkGetVector6Macro(Domain, double);
  ///@}
  ///@{
  /** Prove that the map as a whole takes no value twice. Default on. */
  vtkSetMacro(Injectivity, bool);
  vtkGetMacro(Injectivity, bool);
  vtkBooleanMacro(Injectivity, bool);
  ///@}

protected:
  vtkTemplateMapping();
  ~vtkTemplateMapping() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
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
  bool UseDomain = false;
  double Domain[6] = { 0, 1, 0, 1, 0, 1 };
  bool Injectivity = true;
};
#endif
