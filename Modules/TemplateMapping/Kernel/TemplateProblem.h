// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ClosestPoints.h"
#include "FitSystem.h"
#include "TemplateMap.h"

namespace knotwork
{
/// A target patch and the template patch that is carried onto it.
template <int Dim>
struct TargetConstraint
{
  std::size_t Template = 0; ///< index of the template patch
  PointMatrix Points;       ///< p_i
  PointMatrix Normals;      ///< N_i; empty unless tangent distances are read
  TargetIndex<Dim> Surface;
  PatchFeet Closest; ///< present places, feet and distances
};

/// What the iterations of a template map share: the patches, where the target's samples belong on
/// them, and how far off they are.
template <int Dim>
class TemplateProblem
{
public:
  /// @pre CheckSkeletons accepts both.
  TemplateProblem(const Skeleton<Dim>& skeleton, const Skeleton<Dim>& target,
    const SplineSpace<Dim>& space, const TemplateMapParams<Dim>& params);

  /// Another space over the same domain, and a map in it.
  void SetSpace(const SplineSpace<Dim>& space);
  /// Some samples have places of their own before closest points are searched.
  bool HasGivenPlaces() const;
  /// Samples go back to the places they were given.
  void ForgetPlaces();
  /// Dense samples and distances under a map; places stay, but for those that are not known yet:
  /// these are searched.
  void Update(const BezierForm<Dim>& form);
  /// All target samples at their present places.
  FitSamples<Dim> Samples() const;
  /// Closest points of all samples, and the errors after that.
  /// @param keep  samples keep their places: errors alone are wanted.
  void Project(const BezierForm<Dim>& form, bool keep, TemplateMapIteration& record);
  /// Domain points of the samples with an error of at least the threshold, or with an error that
  /// the given share of all samples reaches if that is larger.
  PointMatrix FarSamples(double threshold, double share) const;
  /// Skeleton, places and errors of the finished map.
  void Report(TemplateMapResult<Dim>& result) const;

private:
  int Threads;
  int NewtonSteps;
  std::vector<int> Ids;                  // of the template
  std::vector<MappedPatch<Dim>> Patches; // of the template
  std::vector<TargetConstraint<Dim>> Constraints;
  std::vector<PointMatrix> FirstPlaces; // of the constraints; empty: not known
};
}
