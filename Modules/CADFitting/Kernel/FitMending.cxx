// SPDX-License-Identifier: BSD-3-Clause
#include "FitMending.h"

#include "ControlPointRoles.h"
#include "ElementPatch.h"
#include "FitMeasures.h"
#include "QueryBlocks.h"

#include <algorithm>
#include <set>

namespace knotwork
{
namespace
{
/// Rounds in which elements without a certificate take the mesh map of their own corners alone.
constexpr int MostRounds = 4;
/// Times that control points inside alone are moved by the barrier functional.
constexpr int InsideSteps = 4;
/// Times that elements of surfaces are unfolded, in a ring more each time; of volumes one fewer.
constexpr int MostUnfoldings = 4;
/// Times that what was moved is fitted once more, and the least share of its way to where that puts
/// it.
constexpr int MostApproaches = 4;
constexpr double LeastApproach = 0.1;

std::vector<Eigen::Index> RowsThatDiffer(const PointMatrix& a, const PointMatrix& b)
{
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
  {
    if (a.row(i) != b.row(i))
    {
      rows.push_back(i);
    }
  }
  return rows;
}

template <int Dim>
class FitMending
{
public:
  FitMending(FittedMesh<Dim>& mesh, FittedSpline<Dim>& spline, const CADFitParams& params)
    : Mesh(mesh), Fitted(spline), Params(params)
  {
  }

  Status Mend()
  {
    Status status;
    if (!this->Candidates().empty())
    {
      status = this->DistanceNow(&this->Allowed).Status;
    }
    status = status ? this->TakeMeshMaps() : status;
    if (status && this->Mesh.IsFitted && this->Params.Untangle && !this->Candidates().empty())
    {
      const std::vector<int> bad = this->Candidates();
      status = this->Try(
        [&]
        {
          Status moved = this->Mesh.MovePoints(bad, this->Params);
          moved = moved ? this->Fitted.Project(this->Mesh, this->Params) : moved;
          return moved ? Result<int>(static_cast<int>(bad.size())) : Result<int>(moved);
        });
    }
    return status ? this->MoveControlPoints() : status;
  }

  /// Elements that are mended.
  std::vector<int> Candidates() const
  {
    return this->Params.Smoothing == FitSmoothing::Net
      ? InvertedNets<Dim>(this->Fitted.Value, this->Fitted.Verdicts.IsReversed)
      : this->Fitted.Verdicts.Bad;
  }

  int Smoothed = 0; ///< as CADFit

private:
  Result<double> DistanceNow(double* allowed = nullptr) const
  {
    return DistanceFromTarget(this->Mesh, this->Fitted.Value, this->Params, allowed);
  }

  /// What a step leaves is kept where it has fewer elements without a certificate, and stays at the
  /// target.
  template <class Step>
  Status Try(Step&& step)
  {
    const PointMatrix points = this->Mesh.Points;
    const std::vector<int> folded = this->Mesh.Folded;
    const Spline<Dim> value = this->Fitted.Value;
    const Spline<Dim> before = this->Fitted.Before;
    ElementVerdicts& last = this->Fitted.Verdicts;
    Result<int> changed = step();
    ElementVerdicts verdicts;
    Status status = changed.Status;
    if (status && changed.Value > 0)
    {
      status = this->Fitted.Certify(this->Params, verdicts);
    }
    bool isBetter = status && changed.Value > 0 && verdicts.Bad.size() < last.Bad.size();
    if (isBetter)
    {
      const auto distance = this->DistanceNow();
      status = distance.Status;
      isBetter = distance.Value <= this->Allowed;
    }
    if (!status)
    {
      return status;
    }
    if (isBetter)
    {
      last = std::move(verdicts);
      this->Smoothed = std::max(this->Smoothed, changed.Value);
    }
    else
    {
      this->Mesh.Points = points;
      this->Mesh.Folded = folded;
      this->Fitted.Value = value;
      this->Fitted.Before = before;
    }
    return {};
  }

  /// Elements that are mended take the mesh map of their corners; later those around too.
  Status TakeMeshMaps()
  {
    Status status;
    for (int round = 0; status && round < MostRounds && !this->Candidates().empty(); ++round)
    {
      // wide windows swing on cells of bad shape
      const std::vector<int> own =
        Rings<Dim>(this->Mesh.Mesh, this->Candidates(), round > 0 ? 1 : 0);
      const std::vector<int> before = this->Fitted.LinearCells;
      std::set<int> all(before.begin(), before.end());
      all.insert(own.begin(), own.end());
      this->Fitted.LinearCells.assign(all.begin(), all.end());
      const std::size_t last = this->Fitted.Verdicts.Bad.size();
      status = this->Try(
        [&]
        {
          Status made = this->Fitted.Project(this->Mesh, this->Params);
          return made ? Result<int>(static_cast<int>(all.size())) : Result<int>(made);
        });
      if (this->Fitted.Verdicts.Bad.size() >= last)
      {
        this->Fitted.LinearCells = before;
        break;
      }
    }
    return status;
  }

  /// Moves of control points of elements that are mended, and of those around.
  Status MoveControlPoints()
  {
    Status status;
    Spline<Dim>& spline = this->Fitted.Value;
    MendingParams params;
    params.Threads = this->Params.Threads;
    params.Progress = PartOf(this->Params.Progress, 0.7, 0.8);
    const std::vector<char> held = this->Candidates().empty()
      ? std::vector<char>()
      : HeldControlPoints(this->Mesh, this->Fitted);
    if (!this->Candidates().empty())
    {
      params.Rings = this->Params.SmoothingRings;
      status = this->Try(
        [&]() -> Result<int>
        {
          const PointMatrix moves = spline.ControlPoints - this->Fitted.Before.ControlPoints;
          return ExtendMoves<Dim>(spline, this->Candidates(), moves, held, params);
        });
    }
    const PointMatrix fitted = spline.ControlPoints;
    // inside, in more and more rings; then the surface too, along the target, then held less and
    // less fast
    for (int step = 0; status && step < 10 && !this->Candidates().empty(); ++step)
    {
      if (step == InsideSteps)
      {
        status = this->UnfoldElements();
        if (!status || this->Candidates().empty())
        {
          break;
        }
      }
      constexpr double attractions[] = { 1000.0, 100.0, 10.0, 1.0, 1.0, 0.1 };
      params.Rings = std::max(0,
        this->Params.SmoothingRings - 2 +
          (step < InsideSteps ? step
              : step < 8      ? 1
                              : 2));
      params.Attraction = step < InsideSteps ? 0.0 : attractions[step - InsideSteps];
      status = this->Try(
        [&]
        {
          const PointMatrix before = spline.ControlPoints;
          Result<int> changed = MinimizeBarrier<Dim>(
            spline, this->Candidates(), this->Fitted.Verdicts.IsReversed, held, params);
          const Status followed =
            changed && changed.Value > 0 ? this->FollowTarget(before) : Status();
          return followed ? changed : Result<int>(followed);
        });
    }
    return status ? this->Approach(fitted) : status;
  }

  /// Control points of a surface that were moved across its normals keep their offsets from the
  /// target.
  Status FollowTarget(const PointMatrix& before)
  {
    if (Dim == 3 || !this->Mesh.IsFitted || !this->Mesh.HasSurfaces)
    {
      return {};
    }
    PointMatrix& now = this->Fitted.Value.ControlPoints;
    const std::vector<Eigen::Index> moved = RowsThatDiffer(now, before);
    return KeepOffsets(
      *this->Mesh.Target, before, moved, std::vector<TargetPart>(moved.size()), now);
  }

  Status UnfoldElements()
  {
    Status status;
    if (!this->Mesh.IsFitted || !this->Mesh.HasSurfaces)
    {
      return status;
    }
    const ControlPointPlaces places = PlacesOnTarget(this->Mesh, this->Fitted);
    for (int step = 0; status && step < (Dim == 2 ? MostUnfoldings : MostUnfoldings - 1) &&
         !this->Candidates().empty();
         ++step)
    {
      UnfoldingParams params;
      params.Rings = std::max(0, this->Params.SmoothingRings - (Dim == 2 ? 0 : 1)) + step;
      params.Threads = this->Params.Threads;
      params.Progress = PartOf(this->Params.Progress, 0.7, 0.8);
      status = this->Try(
        [&]
        {
          return Unfold<Dim>(this->Fitted.Value, this->Candidates(),
            this->Fitted.Verdicts.IsReversed, places, *this->Mesh.Target, params);
        });
    }
    return status;
  }

  /// Control points that were moved, fitted to the target once more from where the surface is now:
  /// as far as that brings it nearer, and leaves the verdicts as good.
  /// @param fitted  control points as they were before they were moved.
  Status Approach(const PointMatrix& fitted)
  {
    PointMatrix& now = this->Fitted.Value.ControlPoints;
    const std::vector<Eigen::Index> moved = RowsThatDiffer(now, fitted);
    Status status;
    bool isNearer = !moved.empty() && this->Mesh.IsFitted && this->Mesh.HasSurfaces;
    auto last = isNearer ? this->DistanceNow() : Result<double>(0.0);
    status = last.Status;
    for (int pass = 0; status && isNearer && pass < MostApproaches; ++pass)
    {
      const auto fit = this->Fitted.ProjectedAgain(this->Mesh, this->Params);
      status = fit.Status;
      isNearer = false;
      for (double share = 1.0; status && !isNearer && share > LeastApproach; share *= 0.5)
      {
        const PointMatrix before = now;
        for (const Eigen::Index i : moved)
        {
          now.row(i) += share * (fit->Value.ControlPoints.row(i) - before.row(i));
        }
        ElementVerdicts verdicts;
        status = this->Fitted.Certify(this->Params, verdicts);
        if (status && verdicts.Bad.size() <= this->Fitted.Verdicts.Bad.size())
        {
          const auto distance = this->DistanceNow(); // takes longer than the certificates
          status = distance.Status;
          isNearer = status && distance.Value < last.Value;
          last = isNearer ? distance : last;
        }
        if (isNearer)
        {
          this->Fitted.Verdicts = std::move(verdicts);
        }
        else
        {
          now = before;
        }
      }
    }
    return status;
  }

  FittedMesh<Dim>& Mesh;
  FittedSpline<Dim>& Fitted;
  const CADFitParams& Params;
  double Allowed = 0.0; ///< distance of the surface from the target
};
}

template <int Dim>
Status MendFit(
  FittedMesh<Dim>& mesh, FittedSpline<Dim>& spline, const CADFitParams& params, CADFit<Dim>& fit)
{
  FitMending<Dim> mending(mesh, spline, params);
  fit.InvalidBefore = static_cast<int>(mending.Candidates().size());
  const Status status = params.Smoothing == FitSmoothing::Off ? Status() : mending.Mend();
  fit.Smoothed = mending.Smoothed;
  return status;
}

template Status MendFit(FittedMesh<2>&, FittedSpline<2>&, const CADFitParams&, CADFit<2>&);
template Status MendFit(FittedMesh<3>&, FittedSpline<3>&, const CADFitParams&, CADFit<3>&);
}
