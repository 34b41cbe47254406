// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Skeleton.h"
#include "Spline.h"

#include <optional>

namespace knotwork
{
/// How a spline map is asked to carry the template onto the target.
enum class TemplateMapMethod
{
  Fixed, ///< samples keep their parameters: sum |s(ghat(t_i)) - p_i|^2
  Pdm,   ///< point distance, parameters follow the closest points
  Tdm    ///< tangent distance, sum ((s(ghat(t_i)) - p_i) . N_i)^2, N_i normal of the target
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
  double TikhonovWeight = 2e-2; ///< of sum |c - c_previous|^2, >= 0
  int Threads = 0;              ///< 0: all cores
  ProgressCallback Progress;
  /// Domain of the map; the template's bounding box when empty. It must contain the template.
  std::optional<ParametricBox<Dim>> Domain;
  /// The map to start with; the identity when empty. Polynomial, Dim components, over a domain that
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
  /// dense sample of the mapped patch to the target's polyline.
  double MaxError = 0.0;
  double NegativeShare = 0.0; ///< of the 1000 x 1000 grid points of the domain, det J < 0
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
  std::vector<std::array<int, 3>> Triangles; ///< Dim 3: of the samples
};

template <int Dim>
struct TemplateMapResult
{
  Spline<Dim> Map;
  std::vector<TemplateMapIteration> History; ///< one entry an iteration
  std::vector<MappedSkeletonPatch> Skeleton; ///< in the template's order
  std::vector<Eigen::VectorXd> Parameters;   ///< t_i of the samples, in the target's order
  std::vector<Eigen::VectorXd> SampleErrors; ///< |s(ghat(t_i)) - p_i|, likewise
  std::vector<double> ElementErrors;         ///< per element of the map: largest distance, of both
                                             ///< kinds, of what lies in it; 0 where nothing does
};

/// A spline map of the plane that carries the patches of a template onto the target patches of the
/// same id. Template patches without a target are free: they follow. Each iteration solves one
/// linear least-squares problem for the control points at the present parameters of the target
/// samples, then moves each parameter to the closest point of its mapped patch (not for Fixed). The
/// first iteration uses the samples' given parameters (SkeletonPatch::Parameters, or uniform).
/// Equal inputs give bit-identical results for any number of threads (Seconds apart).
/// @return what CheckSkeletons finds; InvalidParameter, InvalidDegree or DimensionMismatch for
/// options outside their range or an unfit domain or initial map; SingularSystem (possible with a
/// Tikhonov weight of 0); Aborted.
/// @complexity an iteration: O(dense samples) + O(samples log(dense samples)) + one sparse
/// factorization.
/// @source  Sajavicius, Juettler, Speh, Template mapping using adaptive splines and optimization of
/// the parameterization (2018), sections 3 and 4.
template <int Dim>
Result<TemplateMapResult<Dim>> MapTemplate(const Skeleton<Dim>& templateSkeleton,
  const Skeleton<Dim>& target, const TemplateMapParams<Dim>& params = {});
}
