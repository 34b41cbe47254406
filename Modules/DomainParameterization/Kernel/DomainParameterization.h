// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/DomainBoundary.h>
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>

#include <string>
#include <vector>

namespace knotwork
{
/// Control points of the first map, from the boundary alone.
enum class InitialMapMethod
{
  Automatic, ///< Coons; harmonic when the folds of that cannot be removed
  Coons,     ///< Boolean sum at the Greville abscissae
  Spring,    ///< every inner control point is the mean of its neighbours
  Harmonic,  ///< least squares of the Laplacian
  /// The map whose inverse is harmonic, by least squares of its equations. Of one patch, degrees of
  /// at least 2.
  VariationalHarmonic
};

/// Weights of inner control points of the first map, where the boundary is rational.
enum class InitialWeights
{
  Blended, ///< Boolean sum of the logarithms of the boundary's weights
  Ones
};

enum class DomainOptimizer
{
  Automatic, ///< what is the faster one: Lbfgs
  Lbfgs,     ///< limited-memory BFGS, preconditioned
  Newton     ///< projected Newton, sparse Cholesky factorization
};

/// How folds of the first map are removed.
enum class FoldoverRemoval
{
  Automatic, ///< Relu for a few rounds, Penalty when that is not enough
  Penalty,   ///< det J in the denominator of the quality functional becomes positive by
             ///< (det J + sqrt(eps^2 + det J^2)) / 2, eps falling
  Relu       ///< int max(0, delta - det J), delta falling
};

enum class WeightMode
{
  Automatic, ///< optimized only when control points alone give no valid map
  Fixed,     ///< those of the first map
  Optimized  ///< control points and weights in turn, from the unfolded first map on
};

/// What the inner control points are to make best, once the map has no folds.
enum class DomainObjective
{
  Winslow,      ///< the functional of ParameterizeDomain
  LeastJacobian ///< from there on, the largest least det J
};

struct DomainParams
{
  InitialMapMethod InitialMap = InitialMapMethod::Automatic;
  DomainOptimizer Optimizer = DomainOptimizer::Automatic;
  FoldoverRemoval Foldover = FoldoverRemoval::Automatic;
  WeightMode Weights = WeightMode::Automatic;
  InitialWeights FirstWeights = InitialWeights::Blended;
  DomainObjective Objective = DomainObjective::Winslow;
  double UniformityWeight = 1.0;      ///< lambda, >= 0
  double FoldoverMargin = 0.05;       ///< delta / S of the ReLU functional, (0, 1)
  double WinslowEpsilon = 1e-10;      ///< added to det J / S where that is cut off at 0, > 0
  double AlternationTolerance = 0.01; ///< eps0: stop when a round lowers the energy by less, > 0
  int MaxAlternations = 5;            ///< rounds of control points and weights, [1, 100]
  int MaxIterations = 1000;           ///< of one minimization, [1, 1000000]
  double EnergyTolerance = 1e-7;      ///< stop when an iteration lowers the energy by a smaller
  int MaxRefinements = 3;             ///< rounds of local refinement when the space is too poor,
                                      ///< [0, 10]; 0: never
  int MetricSamples = 0;              ///< a direction, [2, 5001]; 0: 501 in 2D, 51 in 3D
  bool MeasureInitialMap = false;     ///< also the metrics of the first map
  double GapTolerance = 1e-9;         ///< see BoundaryParams
  int MaxFunctions = DefaultMaxFunctions; ///< see BoundaryParams; LayoutParams has its own, >= 1
  double CertificateGap = 0.1;     ///< of the bounds of each element's min det J, (0, 1], see
                                   ///< JacobianParams::RelativeGap
  std::int64_t MaxBoxes = 1000000; ///< of the certificate, see JacobianParams
  /// Work at most, (0, 1e6]: about as many seconds of one core, but counted, so that the same run
  /// ends at the same place on every machine. The best map so far is then the result.
  double Effort = 4.0;
  double TimeLimit = 0.0; ///< seconds of the wall clock, >= 0; 0: none. The same
  int Threads = 0;        ///< 0: all cores; the result does not depend on it
};

/// What a row of the convergence table belongs to.
enum class DomainStage
{
  Initial,  ///< the first map
  Foldover, ///< foldover removal
  Quality,  ///< the quality functional in the control points
  Weights   ///< the quality functional in the logarithms of the inner weights
};

struct DomainIteration
{
  DomainStage Stage = DomainStage::Initial;
  int Iteration = 0;         ///< within the stage's run, from 0 (its start)
  double Energy = 0.0;       ///< of the stage's functional
  double MinDet = 0.0;       ///< over S, at the quadrature points
  double GradientNorm = 0.0; ///< of the free unknowns, largest component
  int Functions = 0;         ///< of the map's space
};

/// Why a run ended.
enum class DomainStop
{
  Finished, ///< by itself
  Effort,   ///< DomainParams::Effort was used up
  Time      ///< DomainParams::TimeLimit was reached
};

/// Measures at Samples^Dim equally spaced parameters, ends included. Det: of the map from the unit
/// square (cube). Scaled: det J over the product of the lengths of J's columns. Condition:
/// |J|_F |J^-1|_F, Dim at best; points with a scaled Jacobian
/// below 1e-10 (degenerate corners) do not count for its mean.
struct DomainMetrics
{
  int Samples = 0;
  double Area = 0.0; ///< S, signed, from the boundary alone (theorem of Green; of Gauss in 3D)
  double MinDet = 0.0;
  double MaxDet = 0.0;
  double MinDetOverArea = 0.0;
  double MaxDetOverArea = 0.0;
  double MinScaledJacobian = 0.0;
  double MeanScaledJacobian = 0.0;
  double MeanConditionNumber = 0.0;
  int NonPositive = 0; ///< samples with det J <= 0
};

/// A place where the boundary alone makes det J <= 0, whatever the interior: a corner whose
/// tangents span no positive area, or a point of an edge between two faces.
struct BoundaryFold
{
  std::array<double, 3> Parameters{};
  std::array<double, 3> Position{};
  double Det = 0.0;                       ///< of the sides' derivatives there
  std::array<int, 3> Sides{ -1, -1, -1 }; ///< of the map that meet there; -1: none
  std::string Message; ///< one sentence with the place and the given sides' numbers
};

/// A place where two sides of the boundary, or one with itself, meet beside their common corners
/// and edges: no map is one-to-one.
struct BoundaryCrossing
{
  std::array<int, 2> Sides{ -1, -1 }; ///< as given
  std::array<double, 3> Position{};
  std::string Message; ///< one sentence
};

/// What a parameterization says of its result.
struct DomainReport
{
  JacobianCertificate Certificate; ///< of the map: verdict, bounds, witnesses
  /// Whether the map (of all patches together) takes no value twice: proved, like the certificate.
  InjectivityCertificate Injectivity;
  /// Proved bounds of the smallest and largest det J of the map from the unit square (cube); the
  /// certificate's own numbers are per element with respect to local parameters.
  double MinDetLower = 0.0;
  double MinDetUpper = 0.0;
  double MaxDetLower = 0.0;
  double MaxDetUpper = 0.0;
  DomainMetrics Metrics;        ///< of the map
  DomainMetrics InitialMetrics; ///< of the first map; Samples = 0: not asked for
  std::vector<DomainIteration> History;
  int Iterations = 0;  ///< over all stages
  int Evaluations = 0; ///< of functionals, over all stages
  bool WeightsOptimized = false;
  int Refinements = 0; ///< rounds of refinement that were made
  InitialMapMethod UsedInitialMap = InitialMapMethod::Coons;
  std::vector<BoundaryFold> Folds; ///< empty unless the boundary makes a valid map impossible
  std::vector<BoundaryCrossing> Crossings; ///< empty unless the boundary crosses itself, proved
  DomainStop Stop = DomainStop::Finished;
  double Work = 0.0; ///< in the unit of DomainParams::Effort
  /// What a stage failed at, one sentence each, those of Folds and Crossings first; empty when the
  /// map is regular and one-to-one and the run ended by itself.
  std::vector<std::string> Messages;
  double SecondsOptimization = 0.0; ///< of the wall clock: everything before the metrics and
                                    ///< without the certificate
  double SecondsCertificate = 0.0;
  double SecondsMetrics = 0.0;
  /// No map of this boundary is regular and one-to-one.
  bool IsImpossible() const { return !this->Folds.empty() || !this->Crossings.empty(); }
  /// Proved regular and one-to-one (up to seams, which are the boundary's own).
  bool IsValid() const
  {
    return this->Certificate.Verdict == Verdict::Valid &&
      (this->Injectivity.Verdict == InjectivityVerdict::Injective ||
        this->Injectivity.Verdict == InjectivityVerdict::InjectiveUpToSeam);
  }
};

template <int Dim>
struct DomainParameterization : DomainReport
{
  Spline<Dim> Map; ///< Dim components, on [0, 1]^Dim
  Spline<Dim> InitialMap;
  CompatibleBoundary<Dim> Boundary;
};

/// Spline map of the unit square (cube) onto the domain that four curves (six faces) enclose. The
/// control points and weights of the (compatible) boundary are those of the map, bit for bit, and
/// are never moved. Inner control points minimize
///     int |J|^2 / (det J)^(2/Dim) + lambda int (det J / S - 1)^2,   S the area (volume),
/// the Winslow functional in the plane, after folds of the first map are removed. The map comes
/// with a certificate: Valid is proved, not sampled. A map that is not Valid is returned too, with
/// the reasons in Folds and Messages.
/// @return failures of MakeCompatible; InvalidParameter naming an option; Aborted.
/// @complexity an evaluation: O(quadrature points * degree), (p+1)^Dim points an element.
/// @source  Ji, Yu, Wang, Zhu, CAGD 2021 (functionals, control points and weights in turn);
/// Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov, ACM TOG 40 (2021) (penalty).
template <int Dim>
Result<DomainParameterization<Dim>> ParameterizeDomain(const DomainBoundary<Dim>& boundary,
  const DomainParams& params = {}, const ProgressCallback& progress = {});
}
