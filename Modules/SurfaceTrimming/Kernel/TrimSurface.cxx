// SPDX-License-Identifier: BSD-3-Clause
#include "TrimSurface.h"
#include "BoundaryChains.h"
#include "ClosestDeviation.h"
#include <knotwork/DomainParameterization/WorkBudget.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace knotwork
{
namespace
{
/// Shares of the tolerance: surface against mesh, and trimming curves against the boundary.
constexpr double SurfaceShare = 0.7;
constexpr double BoundaryShare = 0.25;
/// The bound inside triangles is larger than what the fit found: fits are repeated with what is
/// missing taken off their tolerance.
constexpr int MaxFits = 3;
/// Surfaces that round sharp edges and wrinkles lose area: those that lose a larger share are
/// fitted again with a smaller tolerance. Half of it takes about four times the control points.
constexpr double MaxAreaError = 4e-3;
/// Measured: the lost area falls with this root of the tolerance, at least. It gets so much less
/// than what should do, within these.
constexpr double AreaOrder = 1.5;
constexpr double AreaReserve = 0.95;
constexpr double LeastAreaStep = 0.4;
constexpr double MostAreaStep = 0.9;
/// Faces that are not proved regular are fitted again, so often at most, with so much more
/// smoothing.
constexpr int MaxAttempts = 4;
constexpr double MoreSmoothing = 30.0;
/// They may cost as much together as the first fits did, or so much.
constexpr double LeastEffortOfAttempts = 2.0;
/// Of a chart when nothing is left: that of its first net, which is made in any case.
constexpr double LeastEffort = 1e-6;
/// Of the unit of work, measured, a control point: the bound of a surface's deviation (and of each
/// triangle), loops with all certificates, a STEP file that is written, read again and checked.
constexpr double BoundNanoseconds = 14000.0;
constexpr double TriangleNanoseconds = 3000.0;
constexpr double TrimNanoseconds = 18000.0;
constexpr double FileNanoseconds = 42000.0;

double NumPoints(const Spline<2>& surface)
{
  return static_cast<double>(surface.ControlPoints.rows());
}

double Diagonal(const std::vector<ChartMesh>& charts)
{
  Eigen::RowVector3d lower = charts.front().Points.row(0);
  Eigen::RowVector3d upper = lower;
  for (const ChartMesh& chart : charts)
  {
    lower = lower.cwiseMin(chart.Points.colwise().minCoeff());
    upper = upper.cwiseMax(chart.Points.colwise().maxCoeff());
  }
  return (upper - lower).norm();
}

Status CheckInput(const std::vector<ChartMesh>& charts, const TrimParams& params)
{
  if (charts.empty())
  {
    return { ErrorCode::EmptyInput, "no charts" };
  }
  for (std::size_t c = 0; c < charts.size(); ++c)
  {
    if (Status status = charts[c].Check(); !status)
    {
      return { status.Code,
        charts.size() == 1 ? status.Detail : "chart " + std::to_string(c) + ": " + status.Detail };
    }
  }
  const auto bad = [](const char* text) { return Status(ErrorCode::InvalidParameter, text); };
  if (!(params.Tolerance >= 0.0 && std::isfinite(params.Tolerance)))
  {
    return bad("Tolerance must be 0 or more");
  }
  if (!(params.ChordalTolerance >= 0.0 && std::isfinite(params.ChordalTolerance)))
  {
    return bad("ChordalTolerance must be 0 or more");
  }
  if (!(params.Effort > 0.0 && params.Effort <= 1e6))
  {
    return bad("Effort must lie in (0, 1e6]");
  }
  if (!(params.TimeLimit >= 0.0))
  {
    return bad("TimeLimit must be 0 or more");
  }
  // what does not fit together is refused before surfaces are made
  return FindBoundaryChains(charts, params.CornerAngle, params.Vertices).Status;
}

/// Share `part` of `count` of the progress between begin and end.
ProgressCallback Within(const ProgressCallback& progress, double begin, double end)
{
  if (!progress)
  {
    return {};
  }
  return [=](double share) { return progress(begin + (end - begin) * share); };
}

/// A surface of a chart with the proof of its deviation.
struct ProvedBackMap
{
  BackMap Map;
  ChartDeviation Deviation;
};

Result<ProvedBackMap> FitWithProof(
  const ChartMesh& chart, const BackMapParams& params, const DeviationParams& deviation)
{
  const double goal = params.Tolerance;
  BackMapParams fit = params;
  Result<ProvedBackMap> best;
  double work = 0.0;
  for (int pass = 0; pass < MaxFits; ++pass)
  {
    auto map = FitBackMap(chart, fit);
    if (!map)
    {
      return map.Status;
    }
    const double spent = map->Work + 1e-9 * BoundNanoseconds * NumPoints(map->Surface) +
      1e-9 * TriangleNanoseconds * static_cast<double>(chart.Triangles.size());
    work += spent;
    auto measured = BoundDeviation(chart, map->Surface, deviation);
    if (!measured)
    {
      return measured.Status;
    }
    const double bound = measured->MaxBound;
    const double areaError = std::abs(measured->Area / measured->MeshArea - 1.0);
    if (pass == 0 || bound < best->Deviation.MaxBound)
    {
      best.Value = { std::move(map.Value), std::move(measured.Value) };
    }
    // A net that was given is not changed; one that ended above its own tolerance is at its limit.
    if ((bound <= goal && areaError <= MaxAreaError) || params.Elements > 0 ||
      !best->Map.WithinTolerance)
    {
      break;
    }
    fit.Tolerance *= bound > goal
      ? 0.9 * goal / bound
      : std::clamp(
          std::pow(AreaReserve * MaxAreaError / areaError, AreaOrder), LeastAreaStep, MostAreaStep);
    if (best->Map.Surface.Space) // what was fine enough is where the next one begins
    {
      const auto& knots = best->Map.Surface.Space->Knots;
      fit.FirstNet.assign(knots.begin(), knots.end());
    }
    fit.Effort = params.Effort - work;
    if (fit.Effort <= spent) // a smaller tolerance costs more
    {
      if (bound > goal)
      {
        best->Map.Stop = BackMapStop::Effort;
      }
      break;
    }
  }
  best->Map.Work = work;
  return best;
}

/// What the attempts to make all faces regular work on.
class Trimming
{
public:
  Trimming(const std::vector<ChartMesh>& charts, const TrimParams& params)
    : Charts(charts), Params(params), Smoothing(charts.size(), params.BackMap.Smoothing)
  {
    this->State.Tolerance = params.Tolerance > 0.0 ? params.Tolerance : 1e-3 * Diagonal(charts);
    this->State.Model.Faces.resize(charts.size());
    this->State.BackMaps.resize(charts.size());
    this->State.Deviations.resize(charts.size());
    this->State.Certificates.resize(charts.size());
  }

  /// @param effort  for this chart. @param seconds  for it; 0: no limit. @param firstNet  see
  /// BackMapParams.
  Status FitSurface(std::size_t c, double effort, double seconds, double begin, double end,
    std::vector<KnotVector> firstNet = {})
  {
    BackMapParams backMap = this->Params.BackMap;
    backMap.Effort = effort;
    backMap.LaterWork = 1e-9 * (BoundNanoseconds + TrimNanoseconds + FileNanoseconds);
    backMap.TimeLimit = seconds;
    backMap.Tolerance = SurfaceShare * this->State.Tolerance;
    backMap.Smoothing = this->Smoothing[c];
    backMap.FirstNet = std::move(firstNet);
    backMap.Threads = this->Params.Threads;
    backMap.Progress = Within(this->Params.Progress, begin, end);
    DeviationParams deviation;
    deviation.Enough = 0.1 * this->State.Tolerance;
    deviation.Threads = this->Params.Threads;
    auto proved = FitWithProof(this->Charts[c], backMap, deviation);
    if (!proved)
    {
      return proved.Status;
    }
    this->State.Work += proved->Map.Work;
    // what was stopped takes the place of nothing better
    const BackMapStop stop = proved->Map.Stop;
    const bool worse = this->State.Model.Faces[c].Surface.Space &&
      (stop == BackMapStop::Effort || stop == BackMapStop::Time) &&
      proved->Deviation.MaxBound > this->State.Deviations[c].MaxBound;
    if (!worse)
    {
      this->State.Model.Faces[c].Surface = std::move(proved->Map.Surface);
      this->State.BackMaps[c] = std::move(proved->Map);
      this->State.Deviations[c] = std::move(proved->Deviation);
    }
    return {};
  }

  /// What loops and certificates of all faces take once.
  double TrimWork() const { return 1e-9 * TrimNanoseconds * this->NumPointsOfAll(); }

  /// The same and a file of them.
  double LaterWork() const
  {
    return this->TrimWork() + 1e-9 * FileNanoseconds * this->NumPointsOfAll();
  }

  /// What is left for charts whose surfaces are to be made or replaced.
  double Left(double effort, const std::size_t* begin, const std::size_t* end) const
  {
    double left = effort - this->State.Work - this->LaterWork();
    for (const std::size_t* c = begin; c != end; ++c)
    {
      left += 1e-9 * (TrimNanoseconds + FileNanoseconds) * PointsOf(this->State.Model.Faces[*c]);
    }
    return left;
  }

  /// Gives charts that were stopped what the others left, the cheapest ones first: each goes on
  /// with the net that it was stopped at.
  Status Resume(double effort, WorkBudget& clock)
  {
    std::vector<BackMap>& maps = this->State.BackMaps;
    for (std::vector<std::size_t> waiting = this->Waiting(effort);
         !waiting.empty() && clock.Continue(); waiting = this->Waiting(effort))
    {
      const std::size_t c = *std::min_element(waiting.begin(), waiting.end(),
        [&](std::size_t a, std::size_t b) { return maps[a].NextWork < maps[b].NextWork; });
      const double all = this->Left(effort, waiting.data(), waiting.data() + waiting.size());
      const double share = std::max(all / static_cast<double>(waiting.size()), maps[c].NextWork);
      if (Status status = this->FitSurface(
            c, share, clock.SecondsLeft(), 0.6, 0.6, std::exchange(maps[c].NextNet, {}));
          !status)
      {
        return status;
      }
    }
    return {};
  }

  /// Loops of all charts, and what is proved of their faces.
  Status Trim()
  {
    std::vector<Spline<2>> surfaces;
    for (const TrimmedFace& face : this->State.Model.Faces)
    {
      surfaces.push_back(face.Surface);
    }
    LoopParams params;
    params.Tolerance = BoundaryShare * this->State.Tolerance;
    params.CornerAngle = this->Params.CornerAngle;
    params.Vertices = this->Params.Vertices;
    params.Threads = this->Params.Threads;
    params.Progress = Within(this->Params.Progress, 0.6, 0.7);
    auto loops = FitLoops(this->Charts, surfaces, params);
    if (!loops)
    {
      return loops.Status;
    }
    this->State.Model.NumEdges = loops->NumEdges;
    this->State.Model.NumVertices = loops->NumVertices;
    FaceCertificateParams certificate;
    certificate.Threads = this->Params.Threads;
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      TrimmedFace& face = this->State.Model.Faces[c];
      face.Loops = std::move(loops->Loops[c]);
      auto proved = CertifyFace(face, certificate);
      if (!proved)
      {
        return proved.Status;
      }
      this->State.Certificates[c] = std::move(proved.Value);
    }
    loops->Loops.clear();
    this->State.Loops = std::move(loops.Value);
    return {};
  }

  /// Charts whose faces are not proved regular, after their smoothing has been raised.
  std::vector<std::size_t> SmoothIrregular()
  {
    std::vector<std::size_t> irregular;
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      if (this->State.Certificates[c].Verdict != Verdict::Valid)
      {
        this->Smoothing[c] *= MoreSmoothing;
        irregular.push_back(c);
      }
    }
    return irregular;
  }

  TrimmedSurface State;

private:
  static double PointsOf(const TrimmedFace& face)
  {
    return face.Surface.Space ? NumPoints(face.Surface) : 0.0;
  }

  double NumPointsOfAll() const
  {
    double points = 0.0;
    for (const TrimmedFace& face : this->State.Model.Faces)
    {
      points += PointsOf(face);
    }
    return points;
  }

  /// Charts that were stopped and whose next net is within what is left.
  std::vector<std::size_t> Waiting(double effort) const
  {
    std::vector<std::size_t> waiting;
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      const BackMap& map = this->State.BackMaps[c];
      if (!map.NextNet.empty() && map.NextWork <= this->Left(effort, &c, &c + 1))
      {
        waiting.push_back(c);
      }
    }
    return waiting;
  }

  const std::vector<ChartMesh>& Charts;
  const TrimParams& Params;
  std::vector<double> Smoothing;
};

/// Sums over the faces.
void Summarize(TrimmedSurface& trimmed)
{
  double squares = 0.0;
  double area = 0.0;
  trimmed.MinNormal = trimmed.Certificates.front().MinNormal;
  for (std::size_t c = 0; c < trimmed.Deviations.size(); ++c)
  {
    const ChartDeviation& deviation = trimmed.Deviations[c];
    trimmed.MaxDeviation = std::max(trimmed.MaxDeviation, deviation.MaxBound);
    squares += deviation.Rms * deviation.Rms * deviation.MeshArea;
    area += deviation.MeshArea;
    trimmed.MinNormal = std::min(trimmed.MinNormal, trimmed.Certificates[c].MinNormal);
  }
  // Points between a trimming curve and the boundary: as far as both are from each other.
  trimmed.MaxDeviation += trimmed.Loops.MaxTrimDistance;
  trimmed.RmsDeviation = area > 0.0 ? std::sqrt(squares / area) : 0.0;
  trimmed.WithinTolerance = trimmed.MaxDeviation <= trimmed.Tolerance;
  for (std::size_t c = trimmed.BackMaps.size(); c-- > 0;)
  {
    if (trimmed.BackMaps[c].Stop != BackMapStop::Finished)
    {
      trimmed.Stop = trimmed.BackMaps[c].Stop;
      trimmed.StopReason = trimmed.BackMaps[c].StopReason;
      trimmed.StoppedChart = static_cast<int>(c);
    }
  }
}
}

Result<TrimmedSurface> TrimSurface(const std::vector<ChartMesh>& charts, const TrimParams& params)
{
  if (Status status = CheckInput(charts, params); !status)
  {
    return status;
  }
  Trimming trimming(charts, params);
  std::vector<std::size_t> pending(charts.size());
  std::iota(pending.begin(), pending.end(), std::size_t{ 0 });
  TrimmedSurface best;
  std::size_t fewest = charts.size() + 1;
  WorkBudget clock(params.Effort, params.TimeLimit, {}); // for what is left of TimeLimit
  double effort = params.Effort;
  // Only the penalized fit has a smoothing that may help.
  const int attempts = params.BackMap.Method == BackMapMethod::Penalized ? MaxAttempts : 1;
  for (int attempt = 0; attempt < attempts && !pending.empty(); ++attempt)
  {
    if (attempt == 1)
    {
      const double first = trimming.State.Work;
      effort =
        std::min(effort, first + std::max(first, LeastEffortOfAttempts) + trimming.LaterWork());
    }
    for (std::size_t i = 0; i < pending.size(); ++i)
    {
      const double part = 0.6 / static_cast<double>(pending.size());
      const double begin = part * static_cast<double>(i);
      const double left =
        trimming.Left(effort, pending.data() + i, pending.data() + pending.size()) /
        static_cast<double>(pending.size() - i);
      if (Status status = trimming.FitSurface(
            pending[i], std::max(left, LeastEffort), clock.SecondsLeft(), begin, begin + part);
          !status)
      {
        return status;
      }
    }
    if (Status status = attempt == 0 ? trimming.Resume(effort, clock) : Status(); !status)
    {
      return status;
    }
    if (Status status = trimming.Trim(); !status)
    {
      return status;
    }
    pending = trimming.SmoothIrregular();
    if (pending.size() < fewest)
    {
      fewest = pending.size();
      best = trimming.State;
    }
    // an attempt needs loops and certificates of its own, and something to be better by
    const double trim = trimming.TrimWork();
    best.Work = trimming.State.Work + trimming.LaterWork();
    if (best.Work + trim >= effort || !clock.Continue())
    {
      break;
    }
    trimming.State.Work += trim;
  }
  ClosestDeviationParams closest;
  closest.Enough = std::max(
    (1.0 - 1e-9) * (best.Tolerance - best.Loops.MaxTrimDistance), SurfaceShare * best.Tolerance);
  closest.Threads = params.Threads;
  if (Status status = RefineDeviations(charts, best.Model.Faces, closest, best.Deviations); !status)
  {
    return status;
  }
  Summarize(best);
  if (params.Triangulation)
  {
    TrimmedMeshParams mesh;
    mesh.Tolerance =
      params.ChordalTolerance > 0.0 ? params.ChordalTolerance : 0.25 * best.Tolerance;
    mesh.Threads = params.Threads;
    mesh.Progress = Within(params.Progress, 0.7, 1.0);
    auto triangles = TriangulateFaces(best.Model, mesh);
    if (!triangles)
    {
      return triangles.Status;
    }
    best.Mesh = std::move(triangles.Value);
  }
  return best;
}
}
