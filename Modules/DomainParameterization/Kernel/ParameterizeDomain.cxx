// SPDX-License-Identifier: BSD-3-Clause
#include "BezierForm.h"
#include "DomainMeasure.h"
#include "DomainSolver.h"
#include "InitialMaps.h"
#include "ParameterMetrics.h"
#include "Refinement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Status CheckParams(const DomainParams& params)
{
  const auto fail = [](const char* what) { return Status(ErrorCode::InvalidParameter, what); };
  if (!(params.UniformityWeight >= 0.0 && std::isfinite(params.UniformityWeight)))
  {
    return fail("the uniformity weight must be >= 0");
  }
  if (!(params.FoldoverMargin > 0.0 && params.FoldoverMargin < 1.0))
  {
    return fail("the foldover margin must lie in (0, 1)");
  }
  if (!(params.WinslowEpsilon > 0.0 && params.WinslowEpsilon <= 1.0))
  {
    return fail("the Winslow epsilon must lie in (0, 1]");
  }
  if (!(params.AlternationTolerance > 0.0 && std::isfinite(params.AlternationTolerance)))
  {
    return fail("the alternation tolerance must be > 0");
  }
  if (params.MaxAlternations < 1 || params.MaxAlternations > 100)
  {
    return fail("the number of alternations must lie in [1, 100]");
  }
  if (params.MaxIterations < 1 || params.MaxIterations > 1000000)
  {
    return fail("the number of iterations must lie in [1, 1000000]");
  }
  if (!(params.EnergyTolerance > 0.0 && params.EnergyTolerance < 1.0))
  {
    return fail("the energy tolerance must lie in (0, 1)");
  }
  if (params.MaxRefinements < 0 || params.MaxRefinements > 10)
  {
    return fail("the number of refinements must lie in [0, 10]");
  }
  if (params.MetricSamples != 0 && (params.MetricSamples < 2 || params.MetricSamples > 5001))
  {
    return fail("the metric samples must be 0 or lie in [2, 5001]");
  }
  if (!(params.CertificateGap > 0.0 && params.CertificateGap <= 1.0))
  {
    return fail("the certificate's gap must lie in (0, 1]");
  }
  if (params.MaxBoxes < 1)
  {
    return fail("the certificate needs at least one box");
  }
  if (params.Threads < 0)
  {
    return fail("the number of threads must be >= 0");
  }
  return {};
}

/// One run: the stages on one space after the other.
template <int Dim>
class Run
{
public:
  Run(const DomainParams& params, const ProgressCallback& progress)
    : Params(params), Progress(progress)
  {
  }

  Status Start(const DomainBoundary<Dim>& boundary)
  {
    BoundaryParams boundaryParams;
    boundaryParams.GapTolerance = this->Params.GapTolerance;
    auto compatible = MakeCompatible<Dim>(boundary, boundaryParams);
    if (!compatible)
    {
      return compatible.Status;
    }
    this->Out.Boundary = std::move(compatible.Value);
    this->Area = SignedMeasure<Dim>(this->Out.Boundary.Sides);
    this->Out.Folds = FindBoundaryFolds<Dim>(this->Out.Boundary);
    for (const BoundaryFold& fold : this->Out.Folds)
    {
      this->Out.Messages.push_back(fold.Message);
    }
    return this->FirstMap(this->Params.InitialMap);
  }

  Status FirstMap(InitialMapMethod method)
  {
    Spline<Dim> map = MapOfBoundary<Dim>(this->Out.Boundary);
    Status status;
    switch (method)
    {
      case InitialMapMethod::Harmonic:
        status = FillHarmonic<Dim>(map);
        break;
      case InitialMapMethod::Spring:
        status = FillSpring<Dim>(map);
        break;
      default:
        method = InitialMapMethod::Coons;
        FillCoons<Dim>(map);
    }
    this->Out.UsedInitialMap = method;
    this->Out.InitialMap = map;
    this->Out.Map = map;
    return status;
  }

  /// All stages; the map, its certificate and messages are in Out afterwards.
  Status Optimize()
  {
    this->MakeSolver();
    this->Record();
    bool unfolded = this->Solver->RemoveFolds();
    if (!unfolded && this->Params.InitialMap == InitialMapMethod::Automatic &&
      !this->Solver->Aborted)
    {
      const double reached = this->Solver->MinDet();
      const Spline<Dim> first = this->Out.InitialMap;
      const Spline<Dim> best = this->Solver->Map();
      if (this->FirstMap(InitialMapMethod::Harmonic))
      {
        this->Solver->SetMap(this->Out.Map);
        this->Record();
        unfolded = this->Solver->RemoveFolds();
      }
      if (!unfolded && !(this->Solver->MinDet() > reached))
      {
        this->Out.InitialMap = first;
        this->Out.UsedInitialMap = InitialMapMethod::Coons;
        this->Solver->SetMap(best);
      }
    }
    if (unfolded)
    {
      this->Solver->ImprovePoints();
    }
    if (const Status status = this->Certify(); !status)
    {
      return status;
    }
    this->Accept();
    if (const Status status = this->Densify(unfolded); !status)
    {
      return status;
    }
    const bool wanted = this->Params.Weights == WeightMode::Optimized ||
      (this->Params.Weights == WeightMode::Automatic && !this->IsValid() && !this->IsImpossible());
    if (wanted)
    {
      if (const Status status = this->Alternate(); !status)
      {
        return status;
      }
    }
    for (int round = 0; round < this->Params.MaxRefinements && !this->IsValid() &&
         !this->IsImpossible() && !this->Solver->Aborted;
         ++round)
    {
      if (const Status status = this->Refine(); !status)
      {
        return status;
      }
    }
    if (this->IsValid())
    {
      this->Out.Messages.clear(); // what failed on the way does not matter any more
    }
    else if (!this->IsImpossible())
    {
      this->Out.Messages.push_back("no valid map was found in a space of " +
        std::to_string(this->Out.Map.Space->NumFunctions) + " functions; " +
        std::to_string(this->Out.Certificate.NumInvalid) + " elements are invalid, " +
        std::to_string(this->Out.Certificate.NumUndecided) + " undecided");
    }
    return this->Solver->Aborted ? Status(ErrorCode::Aborted, "by the caller") : Status();
  }

  void Measure()
  {
    const Clock::time_point start = Clock::now();
    const int samples =
      this->Params.MetricSamples > 0 ? this->Params.MetricSamples : (Dim == 2 ? 501 : 51);
    this->Out.Metrics = MeasureMap<Dim>(this->Out.Map, this->Area, samples);
    if (this->Params.MeasureInitialMap)
    {
      this->Out.InitialMetrics = MeasureMap<Dim>(this->Out.InitialMap, this->Area, samples);
    }
    this->Out.SecondsMetrics = SecondsSince(start);
  }

  DomainParameterization<Dim> Finish(double seconds)
  {
    this->Absorb();
    this->Out.SecondsOptimization = seconds - this->Out.SecondsCertificate;
    return std::move(this->Out);
  }

private:
  bool IsValid() const { return this->Out.Certificate.Verdict == Verdict::Valid; }
  bool IsImpossible() const { return !this->Out.Folds.empty(); }

  void MakeSolver()
  {
    this->Absorb();
    this->Solver = std::make_unique<DomainSolver<Dim>>(this->Out.Map, this->Area, this->Params);
    if (this->Progress)
    {
      // iterations are not known beforehand: the share creeps towards 1
      this->Solver->Continue = [this]
      {
        ++this->Steps;
        return this->Progress(1.0 - 1.0 / (1.0 + this->Steps / 100.0));
      };
    }
    this->Extra.assign(this->Out.Map.Space->Elements.size(), 0);
  }

  /// Takes over what a solver has counted before another one comes.
  void Absorb()
  {
    if (this->Solver)
    {
      this->Out.History.insert(
        this->Out.History.end(), this->Solver->History.begin(), this->Solver->History.end());
      this->Out.Iterations += this->Solver->Iterations;
      this->Out.Evaluations += this->Solver->Evaluations;
      this->Solver->History.clear();
      this->Solver->Iterations = this->Solver->Evaluations = 0;
    }
  }

  void Record()
  {
    DomainIteration row;
    row.Stage = DomainStage::Initial;
    row.MinDet = this->Solver->MinDet();
    row.Energy = this->Solver->Energy();
    row.Functions = this->Out.Map.Space->NumFunctions;
    this->Solver->History.push_back(row);
  }

  /// Certificate of the solver's map, into Candidate.
  Status Certify()
  {
    const Clock::time_point start = Clock::now();
    JacobianParams params;
    params.RelativeGap = this->Params.CertificateGap;
    params.ComputeMax = true;
    params.MaxBoxes = this->Params.MaxBoxes;
    params.Threads = this->Params.Threads;
    auto certificate = ValidateJacobian(
      MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(this->Solver->Map(), this->Params.Threads)),
      params);
    this->Out.SecondsCertificate += SecondsSince(start);
    if (!certificate)
    {
      return certificate.Status;
    }
    this->Candidate = std::move(certificate.Value);
    return {};
  }

  /// The solver's map and its certificate become the result.
  void Accept()
  {
    this->Out.Map = this->Solver->Map();
    this->Out.Certificate = this->Candidate;
    const SplineSpace<Dim>& space = *this->Out.Map.Space;
    double bounds[4] = { 0.0, 0.0, 0.0, 0.0 };
    for (std::size_t e = 0; e < space.Elements.size(); ++e)
    {
      double volume = 1.0;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        volume *= space.Elements[e].Box.Upper[d] - space.Elements[e].Box.Lower[d];
      }
      const CellCertificate& cell = this->Candidate.Cells[e];
      // a division rounds: one part in 2^50 outward
      const double own[4] = { cell.MinLower / volume, cell.MinUpper / volume,
        cell.MaxLower / volume, cell.MaxUpper / volume };
      for (int k = 0; k < 4; ++k)
      {
        const double out = (k % 2 ? 1.0 : -1.0) * 0x1p-50 * std::abs(own[k]);
        const double value = own[k] + out;
        bounds[k] = e == 0 ? value
          : k < 2          ? std::min(bounds[k], value)
                           : std::max(bounds[k], value);
      }
    }
    this->Out.MinDetLower = bounds[0];
    this->Out.MinDetUpper = bounds[1];
    this->Out.MaxDetLower = bounds[2];
    this->Out.MaxDetUpper = bounds[3];
  }

  std::vector<int> OpenElements(const JacobianCertificate& certificate) const
  {
    std::vector<int> open;
    for (std::size_t e = 0; e < certificate.Cells.size(); ++e)
    {
      if (certificate.Cells[e].Verdict != Verdict::Valid)
      {
        open.push_back(static_cast<int>(e));
      }
    }
    return open;
  }

  /// Whether an element lies at a corner of the domain, where the boundary decides alone.
  bool AtCorner(std::size_t e) const
  {
    const ParametricBox<Dim>& box = this->Out.Map.Space->Elements[e].Box;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      if (box.Lower[d] != 0.0 && box.Upper[d] != 1.0)
      {
        return false;
      }
    }
    return true;
  }

  /// Where quadrature points did not see a fold, more of them, until the certificate is won.
  Status Densify(bool& unfolded)
  {
    for (int round = 0; round < (Dim == 2 ? 4 : 3) && unfolded && !this->IsValid() &&
         !this->IsImpossible() && !this->Solver->Aborted;
         ++round)
    {
      for (int e : this->OpenElements(this->Candidate))
      {
        // points grow with the power of the dimension
        this->Extra[static_cast<std::size_t>(e)] += Dim == 2 ? 2 << round : 1 + round;
      }
      this->Solver->SetQuadrature(this->Extra);
      unfolded = this->Solver->RemoveFolds();
      if (unfolded)
      {
        this->Solver->ImprovePoints();
      }
      if (const Status status = this->Certify(); !status)
      {
        return status;
      }
      if (this->Candidate.NumValid >= this->Out.Certificate.NumValid)
      {
        this->Accept();
      }
    }
    if (!unfolded && !this->IsImpossible())
    {
      this->Out.Messages.push_back("foldover removal in a space of " +
        std::to_string(this->Out.Map.Space->NumFunctions) +
        " functions ended with det J <= 0 at quadrature points");
    }
    return {};
  }

  /// Control points and weights in turn. A certificate once won is never lost.
  Status Alternate()
  {
    this->Solver->SetMap(this->Out.Map);
    if (!this->Solver->RemoveFoldsWithWeights())
    {
      return {};
    }
    double energy = this->Solver->Energy();
    for (int round = 0; round < this->Params.MaxAlternations && !this->Solver->Aborted; ++round)
    {
      this->Solver->ImproveWeights();
      this->Solver->ImprovePoints();
      if (const Status status = this->Certify(); !status)
      {
        return status;
      }
      if (this->Candidate.Verdict != Verdict::Valid)
      {
        if (this->IsValid())
        {
          this->Solver->SetMap(this->Out.Map);
          break;
        }
        for (int e : this->OpenElements(this->Candidate))
        {
          this->Extra[static_cast<std::size_t>(e)] += 2;
        }
        this->Solver->SetQuadrature(this->Extra);
        if (!this->Solver->RemoveFolds())
        {
          break;
        }
      }
      if (this->Candidate.NumValid >= this->Out.Certificate.NumValid)
      {
        this->Accept();
        this->Out.WeightsOptimized = true;
      }
      const double lowered = this->Solver->Energy();
      const bool done = energy - lowered < this->Params.AlternationTolerance;
      energy = lowered;
      if (done && this->IsValid())
      {
        break;
      }
    }
    return {};
  }

  /// Elements without a certificate are split, and everything goes on in the larger space.
  Status Refine()
  {
    RefinementParams refinement;
    refinement.Extension = 0;
    for (const KnotVector& knots : this->Out.Map.Space->Knots)
    {
      refinement.Extension = std::max(refinement.Extension, (knots.Degree() + 1) / 2);
    }
    std::vector<int> marked = this->OpenElements(this->Out.Certificate);
    for (std::size_t e = 0; e < this->Out.Certificate.Cells.size(); ++e)
    {
      const CellCertificate& cell = this->Out.Certificate.Cells[e];
      if (cell.Verdict == Verdict::Valid && cell.Degenerate != 0 && !this->AtCorner(e))
      {
        marked.push_back(static_cast<int>(e)); // only just regular, and not by the boundary alone
      }
    }
    auto refined = RefineMarkedElements<Dim>(this->Out.Map, marked, refinement);
    if (!refined)
    {
      return refined.Status;
    }
    ++this->Out.Refinements;
    this->Out.Map = refined->Value;
    this->MakeSolver();
    bool unfolded = this->Solver->RemoveFolds();
    if (unfolded)
    {
      this->Solver->ImprovePoints();
    }
    if (const Status status = this->Certify(); !status)
    {
      return status;
    }
    this->Accept();
    return this->Densify(unfolded);
  }

  const DomainParams& Params;
  const ProgressCallback& Progress;
  DomainParameterization<Dim> Out;
  double Area = 0.0;
  std::unique_ptr<DomainSolver<Dim>> Solver;
  std::vector<int> Extra; ///< quadrature points a direction and element beyond degree + 1
  JacobianCertificate Candidate;
  int Steps = 0;
};
}

template <int Dim>
Result<DomainParameterization<Dim>> ParameterizeDomain(
  const DomainBoundary<Dim>& boundary, const DomainParams& params, const ProgressCallback& progress)
{
  const Clock::time_point start = Clock::now();
  if (Status status = CheckParams(params); !status)
  {
    return status;
  }
  Run<Dim> run(params, progress);
  if (Status status = run.Start(boundary); !status)
  {
    return status;
  }
  if (Status status = run.Optimize(); !status)
  {
    return status;
  }
  const double seconds = SecondsSince(start);
  run.Measure();
  return run.Finish(seconds);
}

template Result<DomainParameterization<2>> ParameterizeDomain<2>(
  const DomainBoundary<2>&, const DomainParams&, const ProgressCallback&);
template Result<DomainParameterization<3>> ParameterizeDomain<3>(
  const DomainBoundary<3>&, const DomainParams&, const ProgressCallback&);
}
