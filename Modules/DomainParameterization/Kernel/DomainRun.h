// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainParameterization.h"
#include "GluedMap.h"
#include "WorkBudget.h"

namespace knotwork
{
/// What domains of one and of several patches differ in.
template <int Dim>
class DomainSource
{
public:
  virtual ~DomainSource() = default;
  /// @param method  not Automatic.
  /// @param variant  0: the map of that name; others are of its kind and more daring.
  virtual Result<GluedMap<Dim>> FirstMap(InitialMapMethod method, int variant) = 0;
  /// At least 1.
  virtual int NumVariants(InitialMapMethod) const { return 1; }
  /// Whether a larger space is worth its cost.
  virtual bool MayRefine(const GluedMap<Dim>&) const { return true; }
  /// The same map in a larger space. @param certificate  of the elements, patch after patch.
  virtual Result<GluedMap<Dim>> Refine(
    const GluedMap<Dim>& map, const JacobianCertificate& certificate) = 0;
};

template <int Dim>
struct DomainRun
{
  GluedMap<Dim> Map;
  GluedMap<Dim> InitialMap;
};

/// The options that are numbers lie in their ranges.
Status CheckParams(const DomainParams& params, int dim);

/// Elements of the patches, patch after patch.
template <int Dim>
BernsteinCells GluedCells(const GluedMap<Dim>& map, int threads);

/// How the elements of the patches fit together.
template <int Dim>
CellComplex GluedComplex(const GluedMap<Dim>& map);

/// First map, foldover removal, optimization, certificate, weights, refinement; then the metrics
/// and the proof that the map is one-to-one.
///
/// The result is the best certified map: from the first map on, of several candidates, what is
/// proved valid is only replaced by what is proved valid too.
/// @param area  S, of a patch.
/// @param report  Folds and Crossings (no optimization makes the map valid when there are some) and
///                their Messages are looked at, everything else is filled.
template <int Dim>
Status RunDomain(DomainSource<Dim>& source, double area, const DomainParams& params,
  WorkBudget& budget, DomainRun<Dim>& run, DomainReport& report);
}
