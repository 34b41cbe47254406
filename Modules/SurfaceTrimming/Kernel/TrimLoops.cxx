// SPDX-License-Identifier: BSD-3-Clause
#include "TrimLoops.h"

#include "BoundaryChains.h"
#include "ChainFit.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace knotwork
{
namespace
{
/// Halvings of the tolerance where loops cross.
constexpr int maxAttempts = 8;
/// Of the tolerance: how near a curve in space is to the surfaces, beyond what they disagree.
constexpr double curveShare = 0.04;

Status CheckLoopInput(const std::vector<ChartMesh>& charts, const std::vector<Spline<2>>& surfaces,
  const LoopParams& params)
{
  if (charts.empty())
  {
    return { ErrorCode::EmptyInput, "there are no charts" };
  }
  if (charts.size() != surfaces.size())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(surfaces.size()) + " surfaces for " + std::to_string(charts.size()) +
        " charts" };
  }
  const auto bad = [](const char* text) { return Status(ErrorCode::InvalidParameter, text); };
  if (!(params.Tolerance > 0.0 && std::isfinite(params.Tolerance)))
  {
    return bad("Tolerance must be positive");
  }
  if (!(params.CornerAngle > 0.0 && params.CornerAngle <= 180.0))
  {
    return bad("CornerAngle must lie in (0, 180]");
  }
  if (params.Threads < 0)
  {
    return bad("Threads must be 0 or more");
  }
  for (std::size_t c = 0; c < charts.size(); ++c)
  {
    const std::string place = "chart " + std::to_string(c) + ": ";
    if (Status status = charts[c].Check(); !status)
    {
      return { status.Code, place + status.Detail };
    }
    const Spline<2>& surface = surfaces[c];
    if (Status status = surface.Check(); !status)
    {
      return { status.Code, place + "surface: " + status.Detail };
    }
    if (surface.NumComponents() != 3 || surface.Space->Kind != SpaceKind::Tensor ||
      surface.IsRational())
    {
      return { ErrorCode::DimensionMismatch,
        place + "the surface must be a polynomial tensor product in space" };
    }
    const ParametricBox<2> box = surface.Space->Domain();
    const auto& uv = charts[c].UV;
    for (int d = 0; d < 2; ++d)
    {
      const std::size_t at = static_cast<std::size_t>(d);
      if (uv.col(d).minCoeff() < box.Lower[at] || uv.col(d).maxCoeff() > box.Upper[at])
      {
        return { ErrorCode::OutsideDomain, place + "points lie outside the surface's domain" };
      }
    }
  }
  return {};
}

class LoopFitter
{
public:
  LoopFitter(const std::vector<ChartMesh>& charts, const std::vector<Spline<2>>& surfaces,
    const LoopParams& params, BoundaryChains topology)
    : Charts(charts), Params(params), Topology(std::move(topology))
  {
    for (const Spline<2>& surface : surfaces)
    {
      this->Bounds.emplace_back(surface, params.Threads);
    }
    this->Fitted.resize(this->Topology.Chains.size());
    this->Tolerances.assign(this->Topology.Chains.size(), params.Tolerance);
    this->Pending.resize(this->Topology.Chains.size());
    for (std::size_t i = 0; i < this->Pending.size(); ++i)
    {
      this->Pending[i] = i;
    }
    this->Out.Loops.resize(charts.size());
    this->Out.Verdicts.assign(charts.size(), LoopVerdict::Undecided);
    this->Unproved.resize(charts.size());
    for (std::size_t c = 0; c < charts.size(); ++c)
    {
      this->Unproved[c] = c;
    }
  }

  Status Run()
  {
    if (Status status = this->PlaceVertices(); !status)
    {
      return status;
    }
    for (int attempt = 0; attempt < maxAttempts && !this->Pending.empty(); ++attempt)
    {
      if (Status status = this->FitPending(attempt); !status)
      {
        return status;
      }
      if (Status status = this->Prove(); !status)
      {
        return status;
      }
    }
    this->Out.NumEdges = static_cast<int>(this->Topology.Chains.size());
    this->Out.NumVertices = this->Topology.NumVertices;
    this->Out.NumBoundaryLoops = this->Topology.NumBoundaryLoops;
    for (const FittedChain& chain : this->Fitted)
    {
      this->Out.MaxBoundaryDistance =
        std::max(this->Out.MaxBoundaryDistance, chain.BoundaryDistance);
      this->Out.MaxTrimDistance = std::max(this->Out.MaxTrimDistance, chain.TrimDistance);
      this->Out.MaxEdgeGap = std::max(this->Out.MaxEdgeGap, chain.EdgeGap);
    }
    return {};
  }

  TrimLoops Out;

private:
  const ChartMesh& Chart(int c) const { return this->Charts[static_cast<std::size_t>(c)]; }

  /// A vertex is the mean of the surfaces' points there, over all ends of edges.
  Status PlaceVertices()
  {
    const std::size_t n = static_cast<std::size_t>(this->Topology.NumVertices);
    std::vector<Eigen::RowVector3d> sums(n, Eigen::RowVector3d::Zero());
    std::vector<int> counts(n, 0);
    EvaluationParams params;
    params.Threads = 1;
    EvaluationBatch batch;
    for (const BoundaryChain& chain : this->Topology.Chains)
    {
      for (const ChainUse& use : chain.Uses)
      {
        PointMatrix ends(2, 2);
        ends << this->Chart(use.Chart).UV.row(use.Points.front()),
          this->Chart(use.Chart).UV.row(use.Points.back());
        Status status = EvaluateParameters<2>(
          this->Bounds[static_cast<std::size_t>(use.Chart)].Form(), ends, params, batch);
        if (!status)
        {
          return status;
        }
        for (std::size_t e = 0; e < 2; ++e)
        {
          const std::size_t vertex = static_cast<std::size_t>(chain.Vertices[e]);
          sums[vertex] += batch.Values.row(static_cast<Eigen::Index>(e));
          ++counts[vertex];
        }
      }
    }
    for (std::size_t v = 0; v < n; ++v)
    {
      this->Vertices.push_back(sums[v] / counts[v]);
    }
    this->TakeGivenVertices();
    return {};
  }

  void TakeGivenVertices()
  {
    std::unordered_map<std::int64_t, Eigen::RowVector3d> given;
    for (const LoopVertex& vertex : this->Params.Vertices)
    {
      if (vertex.Point)
      {
        given[vertex.PointId] = vertex.Point->transpose();
      }
    }
    for (const BoundaryChain& chain : this->Topology.Chains)
    {
      const ChainUse& use = chain.Uses.front();
      const std::vector<std::int64_t>& ids = this->Chart(use.Chart).PointIds;
      for (std::size_t e = 0; e < 2 && !ids.empty(); ++e)
      {
        const int point = e == 0 ? use.Points.front() : use.Points.back();
        if (const auto at = given.find(ids[static_cast<std::size_t>(point)]); at != given.end())
        {
          this->Vertices[static_cast<std::size_t>(chain.Vertices[e])] = at->second;
        }
      }
    }
  }

  Result<FittedChain> Fit(std::size_t index) const
  {
    const BoundaryChain& chain = this->Topology.Chains[index];
    std::vector<PointMatrix> uv;
    std::vector<const SurfaceBounds*> surfaces;
    PointMatrix points;
    for (const ChainUse& use : chain.Uses)
    {
      const ChartMesh& chart = this->Chart(use.Chart);
      const Eigen::Index n = static_cast<Eigen::Index>(use.Points.size());
      points.resize(n, 3);
      PointMatrix& plane = uv.emplace_back(n, 2);
      for (Eigen::Index i = 0; i < n; ++i)
      {
        const int point = use.Points[static_cast<std::size_t>(i)];
        points.row(i) = chart.Points.row(point);
        plane.row(i) = chart.UV.row(point);
      }
      surfaces.push_back(&this->Bounds[static_cast<std::size_t>(use.Chart)]);
    }
    ChainFitParams params;
    params.Tolerance = this->Tolerances[index];
    params.CurveTolerance = curveShare * this->Params.Tolerance;
    for (std::size_t e = 0; e < 2; ++e)
    {
      params.Ends[e] = this->Vertices[static_cast<std::size_t>(chain.Vertices[e])];
    }
    return FitChain(MakeChainPolyline(points, uv), surfaces, params);
  }

  Status FitPending(int attempt)
  {
    // in parts, so that the caller may stop in between
    constexpr std::size_t part = 64;
    std::vector<Status> states(this->Pending.size());
    for (std::size_t begin = 0; begin < this->Pending.size(); begin += part)
    {
      const double share = static_cast<double>(begin) / static_cast<double>(this->Pending.size());
      const double before = 1.0 - std::ldexp(1.0, -attempt);
      if (this->Params.Progress && !this->Params.Progress(before + std::ldexp(share, -attempt - 1)))
      {
        return { ErrorCode::Aborted, "the fit of trimming curves was stopped" };
      }
      const std::size_t count = std::min(part, this->Pending.size() - begin);
      ParallelFor(count, 1, this->Params.Threads,
        [&](std::size_t from, std::size_t to)
        {
          for (std::size_t i = begin + from; i < begin + to; ++i)
          {
            auto fitted = this->Fit(this->Pending[i]);
            states[i] = fitted.Status;
            this->Fitted[this->Pending[i]] = std::move(fitted.Value);
          }
        });
    }
    for (std::size_t i = 0; i < states.size(); ++i)
    {
      if (!states[i])
      {
        return { states[i].Code,
          "edge " + std::to_string(this->Pending[i]) + ": " + states[i].Detail };
      }
    }
    return {};
  }

  TrimmedLoop MakeLoop(const std::vector<ChainStep>& steps) const
  {
    TrimmedLoop loop;
    for (const ChainStep& step : steps)
    {
      const std::size_t index = static_cast<std::size_t>(step.Chain);
      const BoundaryChain& chain = this->Topology.Chains[index];
      TrimmingCurve curve;
      curve.Curve = this->Fitted[index].Curve;
      curve.UV = this->Fitted[index].UV.middleCols(2 * step.Use, 2);
      curve.Edge = step.Chain;
      curve.Vertices = chain.Vertices;
      curve.Reversed = chain.Uses[static_cast<std::size_t>(step.Use)].Reversed;
      loop.Curves.push_back(std::move(curve));
    }
    return loop;
  }

  /// Assembles charts whose curves are new; where their loops are not simple, half the tolerance.
  Status Prove()
  {
    std::vector<std::size_t> again;
    std::vector<bool> touched(this->Charts.size(), false);
    for (const std::size_t c : this->Unproved)
    {
      TrimmedFace face;
      for (const auto& steps : this->Topology.Loops[c])
      {
        face.Loops.push_back(this->MakeLoop(steps));
      }
      const auto verdict = ProveLoops(face, this->Params.Threads);
      if (!verdict)
      {
        return { verdict.Status.Code, "chart " + std::to_string(c) + ": " + verdict.Status.Detail };
      }
      this->Out.Loops[c] = std::move(face.Loops);
      this->Out.Verdicts[c] = verdict.Value;
      if (verdict.Value != LoopVerdict::SimpleNested)
      {
        touched[c] = true;
      }
    }
    this->Pending.clear();
    for (std::size_t i = 0; i < this->Topology.Chains.size(); ++i)
    {
      const auto& uses = this->Topology.Chains[i].Uses;
      if (std::any_of(uses.begin(), uses.end(),
            [&](const ChainUse& use) { return touched[static_cast<std::size_t>(use.Chart)]; }))
      {
        this->Pending.push_back(i);
        this->Tolerances[i] *= 0.5;
      }
    }
    // their neighbours have new curves too
    for (const std::size_t i : this->Pending)
    {
      for (const ChainUse& use : this->Topology.Chains[i].Uses)
      {
        touched[static_cast<std::size_t>(use.Chart)] = true;
      }
    }
    for (std::size_t c = 0; c < touched.size(); ++c)
    {
      if (touched[c])
      {
        again.push_back(c);
      }
    }
    this->Unproved = std::move(again);
    return {};
  }

  const std::vector<ChartMesh>& Charts;
  const LoopParams& Params;
  BoundaryChains Topology;
  std::vector<SurfaceBounds> Bounds;
  std::vector<Eigen::RowVector3d> Vertices;
  std::vector<double> Tolerances;
  std::vector<FittedChain> Fitted;
  std::vector<std::size_t> Pending;  ///< chains to be fitted
  std::vector<std::size_t> Unproved; ///< charts whose curves are not proved as they are
};
}

Result<TrimLoops> FitLoops(const std::vector<ChartMesh>& charts,
  const std::vector<Spline<2>>& surfaces, const LoopParams& params)
{
  if (Status status = CheckLoopInput(charts, surfaces, params); !status)
  {
    return status;
  }
  auto topology = FindBoundaryChains(charts, params.CornerAngle, params.Vertices);
  if (!topology)
  {
    return topology.Status;
  }
  LoopFitter fitter(charts, surfaces, params, std::move(topology.Value));
  if (Status status = fitter.Run(); !status)
  {
    return status;
  }
  return std::move(fitter.Out);
}
}
