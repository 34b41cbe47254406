// SPDX-License-Identifier: BSD-3-Clause
#include "TrimSurface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
/// fitted again with a smaller tolerance.
constexpr double MaxAreaError = 2e-3;
/// Faces that are not proved regular are fitted again, so often at most, with so much more
/// smoothing.
constexpr int MaxAttempts = 4;
constexpr double MoreSmoothing = 30.0;

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
  return {};
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
  for (int pass = 0; pass < MaxFits; ++pass)
  {
    auto map = FitBackMap(chart, fit);
    if (!map)
    {
      return map.Status;
    }
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
    fit.Tolerance *= bound > goal ? 0.9 * goal / bound : 0.6;
  }
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

  Status FitSurface(std::size_t c, double begin, double end)
  {
    BackMapParams backMap = this->Params.BackMap;
    backMap.Tolerance = SurfaceShare * this->State.Tolerance;
    backMap.Smoothing = this->Smoothing[c];
    backMap.Threads = this->Params.Threads;
    backMap.Progress = Within(this->Params.Progress, begin, end);
    DeviationParams deviation;
    deviation.Enough = 0.1 * this->State.Tolerance;
    deviation.Threads = this->Params.Threads;
    auto proved = FitWithProof(this->Charts[c], backMap, deviation);
    if (proved)
    {
      this->State.Model.Faces[c].Surface = std::move(proved->Map.Surface);
      this->State.BackMaps[c] = std::move(proved->Map);
      this->State.Deviations[c] = std::move(proved->Deviation);
    }
    return proved.Status;
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
  // Only the penalized fit has a smoothing that may help.
  const int attempts = params.BackMap.Method == BackMapMethod::Penalized ? MaxAttempts : 1;
  for (int attempt = 0; attempt < attempts && !pending.empty(); ++attempt)
  {
    for (std::size_t i = 0; i < pending.size(); ++i)
    {
      const double share = 0.6 / static_cast<double>(pending.size());
      const double begin = share * static_cast<double>(i);
      if (Status status = trimming.FitSurface(pending[i], begin, begin + share); !status)
      {
        return status;
      }
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
