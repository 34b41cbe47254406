// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchicalSpace.h"

#include "Hierarchy.h"

namespace knotwork
{
namespace
{
/// Looks up the old space's functions by level and multi-index.
template <int Dim>
class OldFunctions
{
public:
  explicit OldFunctions(const SplineSpace<Dim>& space) : Space(space) {}
  /// Function id, or HierarchyLevel::Partial or Covered.
  int Find(std::size_t level, const LevelIndex<Dim>& index) const
  {
    if (this->Space.Kind == SpaceKind::Tensor)
    {
      return level > 0 ? HierarchyLevel<Dim>::Partial : this->Linear(index);
    }
    const auto& levels = this->Space.Levels->Levels;
    const int number = level < levels.size() ? levels[level].Functions.Find(index) : -1;
    return number < 0 ? HierarchyLevel<Dim>::Partial
                      : levels[level].Ids[static_cast<std::size_t>(number)];
  }

private:
  int Linear(const LevelIndex<Dim>& index) const
  {
    std::int64_t linear = 0;
    for (std::size_t d = Dim; d-- > 0;)
    {
      linear = linear * this->Space.Knots[d].NumFunctions() + index[d];
    }
    return static_cast<int>(linear);
  }
  const SplineSpace<Dim>& Space;
};
}

template <int Dim>
Result<Spline<Dim>> TransferToRefined(const Spline<Dim>& spline, const SplineSpacePtr<Dim>& refined)
{
  if (!refined || !spline.Space)
  {
    return { ErrorCode::EmptyInput, "a spline and a refined space are needed" };
  }
  if (const Status status = spline.Check(); !status)
  {
    return status;
  }
  for (const SplineSpace<Dim>* space : { spline.Space.get(), refined.get() })
  {
    if (space->Kind != SpaceKind::Tensor && space->Kind != SpaceKind::Hierarchical)
    {
      return { ErrorCode::DimensionMismatch,
        "only tensor-product and hierarchical spaces contain each other by levels" };
    }
  }
  if (spline.Space->Knots != refined->Knots)
  {
    return { ErrorCode::DimensionMismatch,
      "the refined space has other level-0 knots than the spline" };
  }
  if (!RefinementTree<Dim>(*refined).Contains(RefinementTree<Dim>(*spline.Space)))
  {
    return { ErrorCode::InvalidTopology,
      "a cell that is refined in the spline's space is not refined in the given one" };
  }
  Spline<Dim> result;
  result.Space = refined;
  if (refined->Kind == SpaceKind::Tensor) // so nothing is refined in either space
  {
    if (refined->NumFunctions != spline.Space->NumFunctions)
    {
      return { ErrorCode::InvalidTopology,
        "the tensor-product space has functions outside the domain that the spline does not have" };
    }
    result.ControlPoints = spline.ControlPoints;
    result.Weights = spline.Weights;
    return result;
  }

  // Coefficients of the spline in every level's tensor-product basis: an active function of the old
  // space keeps its coefficient, one that is not inside the old Omega^level gets it from its
  // parents. Covered functions of the old space have none, and none is asked for: whatever comes
  // from them is covered there as well. The new control points are among the coefficients.
  const PointMatrix old = spline.HomogeneousPoints();
  const OldFunctions<Dim> oldFunctions(*spline.Space);
  const std::vector<DyadicKnots> knots = MakeDyadicKnots<Dim>(refined->Knots);
  PointMatrix points = PointMatrix::Zero(refined->NumFunctions, old.cols());
  PointMatrix coarse, fine;
  for (std::size_t l = 0; l < refined->Levels->Levels.size(); ++l)
  {
    const HierarchyLevel<Dim>& level = refined->Levels->Levels[l];
    ParentStencil<Dim> parents(knots, static_cast<int>(l));
    fine.setZero(static_cast<Eigen::Index>(level.Ids.size()), old.cols());
    for (std::size_t i = 0; i < level.Ids.size(); ++i)
    {
      auto row = fine.row(static_cast<Eigen::Index>(i));
      const int oldId = oldFunctions.Find(l, level.Functions.Index(i));
      if (oldId >= 0)
      {
        row = old.row(oldId);
      }
      else if (oldId == HierarchyLevel<Dim>::Partial)
      {
        parents.Find(refined->Levels->Levels[l - 1].Functions, level.Functions.Index(i));
        for (std::size_t k = 0; k < parents.Numbers.size(); ++k)
        {
          row += parents.Weights[k] * coarse.row(parents.Numbers[k]);
        }
      }
      if (level.Ids[i] >= 0)
      {
        points.row(level.Ids[i]) = row;
      }
    }
    coarse.swap(fine);
  }
  result.SetHomogeneousPoints(points, spline.IsRational());
  return result;
}

template Result<Spline<1>> TransferToRefined<1>(const Spline<1>&, const SplineSpacePtr<1>&);
template Result<Spline<2>> TransferToRefined<2>(const Spline<2>&, const SplineSpacePtr<2>&);
template Result<Spline<3>> TransferToRefined<3>(const Spline<3>&, const SplineSpacePtr<3>&);
}
