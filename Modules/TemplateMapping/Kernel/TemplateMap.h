// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/TemplateMapping/Skeleton.h>

#include <optional>

namespace knotwork
{
/// How a spline map is asked to carry the template onto the target.
enum class TemplateMapMethod
{
  Fixed,   ///< samples keep their parameters: sum |s(ghat(t_i)) - p_i|^2
  Pdm,     ///< point distance, parameters follow the closest points
  Tdm,     ///< tangent distance, sum ((s(ghat(t_i)) - p_i) . N_i)^2, N_i normal of the target
  Weighted ///< PdmWeight times the second plus TdmWeight times the third
};

/// The map of the first iteration, unless one is given.
enum class TemplateInitialMap
{
  Identity,
  /// The identity, each control point moved by the mean of the displacements p_i - ghat(t_i) of the
  /// samples in the support of its function, weighted by the function's values there: one
  /// control-point iteration whose system is replaced by its row sums. Control points without
  /// samples around them move by the mean of all ("lumped"). For maps that begin far off.
  Moved,
  /// The map of least sum |s(ghat(t_i)) - p_i|^2 + InitialUniformityWeight int sum |s_kl|^2: one
  /// quadratic solve. Reproduces affine maps.
  Quadratic
};

/// How the space grows between iterations.
enum class TemplateRefinement
{
  None,
  Local,  ///< cells with large errors, by truncated hierarchical B-splines
  Global, ///< every cell
  Held    ///< cells that the guard holds back, by truncated hierarchical B-splines
};

template <int Dim>
struct TemplateMapParams
{
  TemplateMapMethod Method = TemplateMapMethod::Tdm;
  int Iterations = 20;          ///< [1, 100000]
  int Degree = 3;               ///< [1, 9], in every direction
  IntArray<Dim> InnerKnots;     ///< [0, 4096] a direction, equally spaced; 11 each
  int TemplateSamples = 0;      ///< dense samples a patch, [2, 10^7]; 0: the template's own points
  int NewtonSteps = 2;          ///< a closest-point update, [0, 100]
  double PdmWeight = 1.0;       ///< of the point distances, Weighted only, >= 0
  double TdmWeight = 1.0;       ///< of the tangent distances, Weighted only, >= 0; not both 0
  double TikhonovWeight = 2e-2; ///< of sum |c - c_previous|^2, >= 0
  /// Weights of the quality functionals (QualityFunctionals.h), >= 0. The last five are not
  /// quadratic: a Gauss-Newton step, halved until the sum of all terms falls.
  double UniformityWeight = 0.0;
  double LengthWeight = 0.0;
  double OrthogonalityWeight = 0.0;
  double SkewnessWeight = 0.0;
  double EccentricityWeight = 0.0;
  double AreaWeight = 0.0;
  double SelfIntersectionWeight = 0.0;
  /// Keep every iterate regular: a step that would make the Jacobian of the map anywhere less than
  /// positive is shortened, and one that has to be shortened much is replaced by a descent with a
  /// barrier in front of det J = 0. The certificate decides, not samples. A given initial map with
  /// folds has them removed first.
  bool Guard = true;

  /// Iterations end early when the largest error (MaxError) is not above this; 0: never. >= 0
  double Accuracy = 0.0;
  /// Iterations end, and the iterate before (of the first: itself) is the result, when a larger
  /// share of the grid points of the domain has det J < 0. In [0, 1]; 1: never. Nothing to do with
  /// the guard on.
  double MaxIrregularShare = 1.0;

  TemplateRefinement Refinement = TemplateRefinement::None;
  int RefineEvery = 1; ///< refine after every so many iterations, [0, 100000]; 0: when the squared
                       ///< error falls by less than StagnationRatio of itself in an iteration
  double StagnationRatio = 0.05; ///< (0, 1)
  /// Local: cells with a target sample of an error of at least this are refined, >= 0.
  double RefineThreshold = 1e-5;
  /// Local: the threshold is the error that this share of the samples reaches, [0, 1]; 0: the
  /// absolute threshold counts. Of two given ones the larger threshold counts.
  double RefineShare = 0.0;
  int Extension = 1;         ///< Local, Held: cells of the new level around a marked one, [0, 100]
  int MaxLevel = 10;         ///< cells of this level are not refined, [0, 24]
  int MaxFunctions = 200000; ///< a refinement that would have more is not made, >= 1

  /// Whether the result is to be proved injective as a whole.
  bool Injectivity = true;
  int Threads = 0; ///< 0: all cores
  ProgressCallback Progress;
  /// Domain of the map; the template's bounding box when empty. It must contain the template.
  std::optional<ParametricBox<Dim>> Domain;
  TemplateInitialMap Start = TemplateInitialMap::Identity;
  double InitialUniformityWeight = 1e-4; ///< of Quadratic, [1e-12, 1e30]
  /// The map to start with, in place of Start. Polynomial, Dim components, over a domain that
  /// contains the template; it decides the space: Degree, InnerKnots and Domain are then not read.
  std::optional<Spline<Dim>> InitialMap;

  TemplateMapParams() { this->InnerKnots.fill(11); }
};

/// State after an iteration.
struct TemplateMapIteration
{
  int Iteration = 0; ///< from 1
  /// Sum of |s(ghat(t_i)) - p_i|^2 over all samples of all target patches after the closest-point
  /// update (Fixed: at the fixed parameters).
  double SquaredError = 0.0;
  /// Two-sided: the largest distance of a target sample to the mapped skeleton's patch, or of a
  /// dense sample of the mapped patch to the target patch.
  double MaxError = 0.0;
  double NegativeShare = 0.0; ///< of 10^6 grid points of the domain (1000 x 1000, 100 x 100 x 100,
                              ///< end points included), det J < 0
  double StepLength = 1.0;    ///< share of the step that was taken
  int HeldElements = 0;       ///< that the guard held back
  int Functions = 0;          ///< of the map's space
  double Seconds = 0.0;       ///< since the call
};

/// A template patch under the map: its dense samples.
struct MappedSkeletonPatch
{
  int Id = 0;
  bool Free = false;                         ///< the target has no patch of this id
  PointMatrix Places;                        ///< n x PlaceSize<Dim>
  PointMatrix Points;                        ///< n x Dim
  Eigen::VectorXd Distances;                 ///< n, to the target patch; -1 for free patches
  std::vector<std::array<int, 3>> Triangles; ///< Dim = 3: of the samples
};

template <int Dim>
struct TemplateMapResult
{
  Spline<Dim> Map;
  std::vector<TemplateMapIteration> History; ///< one entry an iteration
  std::vector<MappedSkeletonPatch> Skeleton; ///< in the template's order
  std::vector<PointMatrix> Places;           ///< t_i of the samples, in the target's order
  std::vector<Eigen::VectorXd> SampleErrors; ///< |s(ghat(t_i)) - p_i|, likewise
  std::vector<double> ElementErrors;         ///< per element of the map: largest distance, of both
                                             ///< kinds, of what lies in it; 0 where nothing does
  JacobianCertificate Certificate;           ///< of the map, with respect to local parameters
  std::vector<double> ElementMinJacobian;    ///< proved lower bounds of det J, with respect to the
                                             ///< domain's parameters, an entry an element
  std::vector<double> ElementMaxJacobian;    ///< proved upper bounds, likewise
  double MinJacobianBound = 0.0;             ///< the smallest of the lower bounds
  /// That the map takes no value twice; undecided when it was not asked for.
  InjectivityCertificate Injectivity;
};

/// A spline map of the plane (space) that carries the patches of a template onto the target patches
/// of the same id. Template patches without a target are free: they follow. Each iteration solves
/// one linear least-squares problem for the control points at the present places of the target
/// samples, then moves each sample to the closest point of its mapped patch (not for Fixed), and
/// refines the space when that is asked for and due. The first iteration uses the samples' given
/// parameters (SkeletonPatch::Parameters; in the plane uniform ones without), else closest points
/// of the first map.
///
/// With the guard on every iterate is regular, proved by certificates: elements that a step would
/// fold are held back, see RegularityGuard. When a step is in danger that still stems from given
/// parameters, the map begins anew at the closest points of the first map (not for Fixed): given
/// parameters may ask for turns that no regular map makes. From then on the proximal weight falls
/// by half with every step that was in no danger, down to a thousandth.
///
/// Equal inputs give bit-identical results for any number of threads (Seconds apart).
/// @return what CheckSkeletons finds; InvalidParameter, InvalidDegree or DimensionMismatch for
/// options outside their range or an unfit domain or initial map; SingularSystem (possible with a
/// Tikhonov weight of 0); Aborted.
/// @complexity an iteration: O(dense samples) + O(samples log(dense samples)) + one sparse
/// factorization (plane) or some hundred matrix-free conjugate gradients (space) a trial step + a
/// certificate a trial step.
/// @source  Sajavicius, Juettler, Speh, Template mapping using adaptive splines and optimization of
/// the parameterization (2018), sections 3 and 4.
template <int Dim>
Result<TemplateMapResult<Dim>> MapTemplate(const Skeleton<Dim>& templateSkeleton,
  const Skeleton<Dim>& target, const TemplateMapParams<Dim>& params = {});
}
