// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDomainParameterization
 * @brief   spline map onto the domain that four curves or six faces enclose
 *
 * Input 0 is a spline grid with one patch a side (keyed by `PatchId`), in any order: four curves in
 * a plane z = constant, or six faces in space, each polynomial or rational with its own degrees and
 * knots. Which sides meet, and how they run, is found. The boundary is not moved.
 *
 * Or it is a vtkPolyData of lines that were drawn by hand: one closed polyline or a polyline a
 * side, or points in drawing order, of which the point array `Line` may number the lines. Curves
 * are fitted to them (knotwork::FitOutline). Output 0 then has the field-data arrays
 * `OutlineDistance` (largest distance of the points from the curves), `OutlineCorners`,
 * `OutlineLines`, `OutlineArcs` and `OutlineCurves` (numbers of corners and of straight, circular
 * and fitted pieces).
 *
 * Or it is a collection whose blocks each have the four curves or six faces of a domain: each
 * domain gets a map of its own, a patch of output 0 with the block's number as `PatchId`. Verdicts
 * are then the worst of all, areas and numbers sums, the others extrema, and means by area; the
 * convergence table has the column `Domain`. Of several processes each does its blocks; the table
 * is in the first one.
 *
 * Input 1 (optional) is a layout: a linear mesh of quadrilaterals or hexahedra, one a patch. Input
 * 0 then has one curve (face) for every edge (face) on the mesh's boundary, found by the points
 * that it joins, and may have some for inner ones. All patches are parameterized together; those
 * inside start straight, or as given, and move with the points.
 *
 * Output 0 is the map as a spline grid of one patch (one a cell of the layout, `PatchId` its number
 * among the quadrilaterals or hexahedra) with the field-data arrays `Verdict` ("valid",
 * "invalid", "undecided", "reversed": of det J, proved, not sampled), `Injective` ("injective",
 * "injective_up_to_seam", "not_injective", "undecided": proved too), `JacobianMinLower` and
 * `JacobianMinUpper` (proved bounds of the smallest det J with respect to the parameters of the
 * unit square or cube) and, over 501 x 501 (51^3) samples, `MinDetOverArea`, `MaxDetOverArea`,
 * `MinScaledJacobian`, `MeanScaledJacobian`, `MeanConditionNumber`; `Area`, `Iterations`,
 * `Functions`, `Patches`, `Work` and `Stopped` ("finished", "effort", "time_limit"). Output 1 is
 * the first map, before the optimization. Output 2 is the convergence table with a row an
 * iteration: `Stage`, `Iteration`, `Energy`, `MinDetOverArea`, `GradientNorm`, `Functions`. A map
 * that is not proved regular and one-to-one is an output like any other, with a warning that says
 * where and why.
 *
 * @source Ji, Yu, Wang, Zhu (2021). The module's page has the method, limits and errors.
 */
#ifndef vtkDomainParameterization_h
#define vtkDomainParameterization_h
#include "vtkKnotworkDomainParameterizationModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <memory> // for what the outputs are made of
#include <vector> // for domains

class vtkDataSet;
class vtkPolyData;

namespace knotwork
{
struct DomainParams;
struct DomainSummary;
struct SplineModel;
}

class VTKKNOTWORKDOMAINPARAMETERIZATION_EXPORT vtkDomainParameterization : public vtkSplineAlgorithm
{
public:
  static vtkDomainParameterization* New();
  vtkTypeMacro(vtkDomainParameterization, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Whether each block of a collection has the four curves or six faces of a domain. */
  static bool HoldsDomains(vtkDataObject* boundary);

  enum InitialMaps
  {
    INITIAL_AUTOMATIC = 0, ///< "Automatic" Coons; harmonic when its folds cannot be removed
    COONS,
    SPRING,
    HARMONIC,
    VARIATIONAL_HARMONIC ///< of one patch, degrees of at least 2
  };
  enum Optimizers
  {
    OPTIMIZER_AUTOMATIC = 0, ///< "Automatic"
    LBFGS,                   ///< "L-BFGS"
    NEWTON
  };
  enum Foldovers
  {
    FOLDOVER_AUTOMATIC =
      0, ///< "Automatic" a few rounds of ReLU, the penalty when that is not enough
    PENALTY,
    RELU ///< "ReLU"
  };
  enum Objectives
  {
    WINSLOW = 0,   ///< the Winslow functional and uniformity
    LEAST_JACOBIAN ///< from there on, the largest least det J
  };
  enum FirstWeights
  {
    BLENDED = 0, ///< Boolean sum of the logarithms of the boundary's weights
    ONES
  };
  enum WeightModes
  {
    WEIGHTS_AUTOMATIC =
      0,              ///< "Automatic" optimized only when control points alone give no valid map
    WEIGHTS_FIXED,    ///< "Fixed"
    WEIGHTS_OPTIMIZED ///< "Optimized" control points and weights in turn, from the start
  };

  ///@{
  /** The map the optimization begins with, one of InitialMaps. INITIAL_AUTOMATIC: COONS, and
   * where that folds HARMONIC if it folds less. VARIATIONAL_HARMONIC: the map whose inverse is
   * harmonic. Default INITIAL_AUTOMATIC. Group "First Map". */
  vtkSetClampMacro(InitialMap, int, INITIAL_AUTOMATIC, VARIATIONAL_HARMONIC);
  vtkGetMacro(InitialMap, int);
  ///@}
  ///@{
  /** How the functional is minimized, one of Optimizers. OPTIMIZER_AUTOMATIC takes the faster
   * one. Default OPTIMIZER_AUTOMATIC. Advanced. Group "Optimization". */
  vtkSetClampMacro(Optimizer, int, OPTIMIZER_AUTOMATIC, NEWTON);
  vtkGetMacro(Optimizer, int);
  ///@}
  ///@{
  /** How folds of the first map are removed, one of Foldovers. FOLDOVER_AUTOMATIC: a few rounds
   * of RELU, PENALTY when that is not enough. Default FOLDOVER_AUTOMATIC. Advanced. Group "First
   * Map". */
  vtkSetClampMacro(Foldover, int, FOLDOVER_AUTOMATIC, RELU);
  vtkGetMacro(Foldover, int);
  ///@}
  ///@{
  /** Whether inner weights move too, one of WeightModes. WEIGHTS_AUTOMATIC: only when control
   * points alone give no valid map. WEIGHTS_OPTIMIZED: in turn with the control points, from the
   * unfolded first map on. Default WEIGHTS_AUTOMATIC. Group "Optimization". */
  vtkSetClampMacro(Weights, int, WEIGHTS_AUTOMATIC, WEIGHTS_OPTIMIZED);
  vtkGetMacro(Weights, int);
  ///@}
  ///@{
  /** Inner weights of the first map where the boundary is rational, one of FirstWeights: BLENDED
   * from those of the boundary (Boolean sum of their logarithms), or ONES. Default BLENDED.
   * Advanced. Group "First Map". */
  vtkSetClampMacro(InitialWeights, int, BLENDED, ONES);
  vtkGetMacro(InitialWeights, int);
  ///@}
  ///@{
  /** What the inner control points are to make best, one of Objectives. WINSLOW: shape and
   * uniformity together. LEAST_JACOBIAN: from there on, the largest least det J. Default
   * WINSLOW. Group "Optimization". */
  vtkSetClampMacro(Objective, int, WINSLOW, LEAST_JACOBIAN);
  vtkGetMacro(Objective, int);
  ///@}
  ///@{
  /** Work at most, about as many seconds of one core, but counted: the same run ends at the same
   * place on every machine, with the best map so far. Default 4, valid range [1e-6, 1000000]. Group
   * "Optimization". */
  vtkSetClampMacro(Effort, double, 1e-6, 1e6);
  vtkGetMacro(Effort, double);
  ///@}
  ///@{
  /** Seconds of the wall clock at most, then the best map so far is taken; 0: no limit. The
   * result then depends on the machine's speed. Default 0, valid range [0, 1000000000].
   * Advanced. Group "Optimization". */
  vtkSetClampMacro(TimeLimit, double, 0.0, 1e9);
  vtkGetMacro(TimeLimit, double);
  ///@}
  ///@{
  /** Weight lambda of the uniformity int (det J / S - 1)^2 against the Winslow functional.
   * Default 1, valid range [0, 1000000]. Group "Optimization". */
  vtkSetClampMacro(UniformityWeight, double, 0.0, 1e6);
  vtkGetMacro(UniformityWeight, double);
  ///@}
  ///@{
  /** delta / S of the RELU functional that removes folds; a tenth of it in every further round.
   * Default 0.05, valid range [1e-6, 0.999]. Advanced. For Foldover not PENALTY. Group "First Map".
   */
  vtkSetClampMacro(FoldoverMargin, double, 1e-6, 0.999);
  vtkGetMacro(FoldoverMargin, double);
  ///@}
  ///@{
  /** Added to det J / S in the denominator of the functional. Default 1e-10, valid range [1e-16,
   * 1]. Advanced. Group "Optimization". */
  vtkSetClampMacro(WinslowEpsilon, double, 1e-16, 1.0);
  vtkGetMacro(WinslowEpsilon, double);
  ///@}
  ///@{
  /** Rounds of control points and weights end when they lower the energy by less. Default 0.01,
   * valid range [1e-12, 1000000]. Advanced. For Weights not WEIGHTS_FIXED. Group "Optimization". */
  vtkSetClampMacro(AlternationTolerance, double, 1e-12, 1e6);
  vtkGetMacro(AlternationTolerance, double);
  ///@}
  ///@{
  /** Iterations of one minimization at most. Default 1000, valid range [1, 1000000]. Advanced.
   * Group "Optimization". */
  vtkSetClampMacro(MaximumIterations, int, 1, 1000000);
  vtkGetMacro(MaximumIterations, int);
  ///@}
  ///@{
  /** A minimization ends after three iterations in a row that lower the energy by less than this
   * part of it. Default 1e-7, valid range [1e-15, 0.5]. Advanced. Group "Optimization". */
  vtkSetClampMacro(EnergyTolerance, double, 1e-15, 0.5);
  vtkGetMacro(EnergyTolerance, double);
  ///@}
  ///@{
  /** Rounds of control points and weights at most. Default 5, valid range [1, 100]. Advanced.
   * For Weights not WEIGHTS_FIXED. Group "Optimization". */
  vtkSetClampMacro(MaximumAlternations, int, 1, 100);
  vtkGetMacro(MaximumAlternations, int);
  ///@}
  ///@{
  /** Rounds of local (THB) refinement where the space is too poor for a valid map. Default 3,
   * valid range [0, 10]. Group "Optimization". */
  vtkSetClampMacro(MaximumRefinements, int, 0, 10);
  vtkGetMacro(MaximumRefinements, int);
  ///@}
  ///@{
  /** Of lines drawn by hand: largest distance of the curves from the points, a share of the
   * outline's size. Default 0.002, valid range [1e-9, 0.1]. Group "Outline". For Input vtkPolyData.
   */
  vtkSetClampMacro(OutlineTolerance, double, 1e-9, 0.1);
  vtkGetMacro(OutlineTolerance, double);
  ///@}
  ///@{
  /** Of lines drawn by hand: degrees that a line turns at a corner, at least. Default 40, valid
   * range [5, 170]. Group "Outline". For Input vtkPolyData. */
  vtkSetClampMacro(CornerAngle, double, 5.0, 170.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Of lines drawn by hand: share of a line's length over which its directions before and behind
   * a point are taken; more makes corners robust against noise, less finds near ones. Default 0.02,
   * valid range [0.0001, 0.2]. Advanced. Group "Outline". For Input vtkPolyData. */
  vtkSetClampMacro(CornerWindow, double, 1e-4, 0.2);
  vtkGetMacro(CornerWindow, double);
  ///@}
  ///@{
  /** Ends of sides at most this part of the boundary's size apart are one corner. Default 1e-9,
   * valid range [0, 0.1]. Advanced. */
  vtkSetClampMacro(GapTolerance, double, 0.0, 0.1);
  vtkGetMacro(GapTolerance, double);
  ///@}
  ///@{
  /** Samples a direction of the metrics, ends included; 0: 501 in the plane and 51 in space, 1:
   * 2; in space up to 301. The proved bounds do not depend on it. Default 0, valid range [0,
   * 5001]. Advanced. */
  vtkSetClampMacro(MetricSamples, int, 0, 5001);
  vtkGetMacro(MetricSamples, int);
  ///@}
  ///@{
  /** How close the proved bounds of every element's smallest det J are brought: upper - lower <=
   * CertificateGap * max(|lower|, |upper|). Default 0.1, valid range [1e-12, 1]. Advanced. */
  vtkSetClampMacro(CertificateGap, double, 1e-12, 1.0);
  vtkGetMacro(CertificateGap, double);
  ///@}

  ///@{
  /** A map, or the patches of a layout together, with more functions is refused. Default
   * 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}
  ///@{
  /** With a layout: directions of patches have at least this degree. Default 2, valid range [1,
   * 9]. Group "Layout". */
  vtkSetClampMacro(MinimumDegree, int, 1, 9);
  vtkGetMacro(MinimumDegree, int);
  ///@}
  ///@{
  /** With a layout: directions of patches have at least so many elements. Default 4, valid range
   * [1, 1000]. Group "Layout". */
  vtkSetClampMacro(MinimumElements, int, 1, 1000);
  vtkGetMacro(MinimumElements, int);
  ///@}
  ///@{
  /** With a layout: whether sides between patches move. Default on. Group "Layout". */
  vtkSetMacro(MoveInterfaces, bool);
  vtkGetMacro(MoveInterfaces, bool);
  vtkBooleanMacro(MoveInterfaces, bool);
  ///@}

  ///@{
  /** Of the last update, of det J: 1 valid, 0 undecided, -1 invalid, 2 reversed. */
  vtkGetMacro(Verdict, int);
  ///@}
  ///@{
  /** Of the last update: 1 one-to-one, 2 up to seams, 0 undecided, -1 not. */
  vtkGetMacro(Injectivity, int);
  ///@}
  ///@{
  /** Of the last update: wall time of the optimization and the proofs. */
  vtkGetMacro(SecondsWithCertificate, double);
  ///@}

protected:
  vtkDomainParameterization();
  ~vtkDomainParameterization() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  bool SumsUpPieces() const override { return true; }
  knotwork::Status Gather(vtkInformationVector** inputs) override;
  knotwork::Status Merge(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkDomainParameterization(const vtkDomainParameterization&) = delete;
  void operator=(const vtkDomainParameterization&) = delete;

  struct Made;
  knotwork::Status ParameterizeDrawn(
    vtkPolyData* drawn, vtkDataSet* layout, vtkInformationVector* outputs);
  /** A domain a model. */
  knotwork::Status ParameterizeEach(
    const std::vector<knotwork::SplineModel>& domains, vtkInformationVector* outputs);
  /** Adds one domain to Last. Its patch has the domain's number, unless that is negative. */
  template <int Dim>
  knotwork::Status Parameterize(const knotwork::SplineModel& model, vtkDataSet* layout, int domain,
    const knotwork::ProgressCallback& progress);
  /** Last as outputs. */
  knotwork::Status Encode(vtkInformationVector* outputs);
  /** The field data of output 0. */
  void Tell(const std::vector<knotwork::DomainSummary>& summaries, vtkInformationVector* outputs);
  knotwork::DomainParams KernelParams() const;

  int InitialMap = INITIAL_AUTOMATIC;
  int Optimizer = OPTIMIZER_AUTOMATIC;
  int Foldover = FOLDOVER_AUTOMATIC;
  int Weights = WEIGHTS_AUTOMATIC;
  int InitialWeights = BLENDED;
  int Objective = WINSLOW;
  double Effort = 4.0;
  double TimeLimit = 0.0;
  double FoldoverMargin = 0.05;
  double WinslowEpsilon = 1e-10;
  double AlternationTolerance = 0.01;
  double UniformityWeight = 1.0;
  int MaximumIterations = 1000;
  double EnergyTolerance = 1e-7;
  int MaximumAlternations = 5;
  int MaximumRefinements = 3;
  double OutlineTolerance = 2e-3;
  double CornerAngle = 40.0;
  double CornerWindow = 0.02;
  double GapTolerance = 1e-9;
  int MetricSamples = 0;
  double CertificateGap = 0.1;
  int MaximumFunctions = 1000000;
  int MinimumDegree = 2;
  int MinimumElements = 4;
  bool MoveInterfaces = true;
  int Verdict = 0;
  int Injectivity = 0;
  double SecondsWithCertificate = 0.0;
  std::unique_ptr<Made> Last; ///< of this process, kept until all have told each other
};
#endif
