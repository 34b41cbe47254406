// SPDX-License-Identifier: BSD-3-Clause
#include "DomainRun.h"

#include "DomainSolver.h"
#include "ParameterMetrics.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace knotwork
{
namespace
{
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The stages on one space after the other.
template <int Dim>
class Runner
{
public:
  Runner(DomainSource<Dim>& source, double area, const DomainParams& params,
    const ProgressCallback& progress, DomainRun<Dim>& out, DomainReport& report)
    : Source(source), Area(area), Params(params), Progress(progress), Out(out), Report(report)
  {
  }

  Status FirstMap(InitialMapMethod method)
  {
    method = method == InitialMapMethod::Automatic ? InitialMapMethod::Coons : method;
    auto map = this->Source.FirstMap(method);
    if (map)
    {
      this->Report.UsedInitialMap = method;
      this->Out.InitialMap = map.Value;
      this->Out.Map = std::move(map.Value);
    }
    return map.Status;
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
      const GluedMap<Dim> first = this->Out.InitialMap;
      const GluedMap<Dim> best = this->Solver->Map();
      if (this->FirstMap(InitialMapMethod::Harmonic))
      {
        this->Solver->SetMap(this->Out.Map);
        this->Record();
        unfolded = this->Solver->RemoveFolds();
      }
      if (!unfolded && !(this->Solver->MinDet() > reached))
      {
        this->Out.InitialMap = first;
        this->Report.UsedInitialMap = InitialMapMethod::Coons;
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
         !this->IsImpossible() && !this->Solver->Aborted && this->Source.MayRefine(this->Out.Map);
         ++round)
    {
      if (const Status status = this->Refine(); !status)
      {
        return status;
      }
    }
    if (this->IsValid())
    {
      this->Report.Messages.clear(); // what failed on the way does not matter any more
    }
    else if (!this->IsImpossible())
    {
      this->Report.Messages.push_back("no valid map was found in a space of " +
        std::to_string(this->Out.Map.NumFunctions()) + " functions; " +
        std::to_string(this->Report.Certificate.NumInvalid) + " elements are invalid, " +
        std::to_string(this->Report.Certificate.NumUndecided) + " undecided");
    }
    return this->Solver->Aborted ? Status(ErrorCode::Aborted, "by the caller") : Status();
  }

  void Measure()
  {
    const Clock::time_point start = Clock::now();
    const int samples =
      this->Params.MetricSamples > 0 ? this->Params.MetricSamples : (Dim == 2 ? 501 : 51);
    this->Report.Metrics = MeasureMaps<Dim>(this->Out.Map.Patches, this->Area, samples);
    if (this->Params.MeasureInitialMap)
    {
      this->Report.InitialMetrics =
        MeasureMaps<Dim>(this->Out.InitialMap.Patches, this->Area, samples);
    }
    this->Report.SecondsMetrics = SecondsSince(start);
  }

  /// Takes over what a solver has counted before another one comes.
  void Absorb()
  {
    if (this->Solver)
    {
      this->Report.History.insert(
        this->Report.History.end(), this->Solver->History.begin(), this->Solver->History.end());
      this->Report.Iterations += this->Solver->Iterations;
      this->Report.Evaluations += this->Solver->Evaluations;
      this->Solver->History.clear();
      this->Solver->Iterations = this->Solver->Evaluations = 0;
    }
  }

private:
  bool IsValid() const { return this->Report.Certificate.Verdict == Verdict::Valid; }
  bool IsImpossible() const { return !this->Report.Folds.empty(); }

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
    this->Extra.assign(static_cast<std::size_t>(this->Out.Map.NumElements()), 0);
  }

  void Record()
  {
    DomainIteration row;
    row.Stage = DomainStage::Initial;
    row.MinDet = this->Solver->MinDet();
    row.Energy = this->Solver->Energy();
    row.Functions = this->Out.Map.NumFunctions();
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
    auto certificate =
      ValidateJacobian(GluedCells<Dim>(this->Solver->Map(), this->Params.Threads), params);
    this->Report.SecondsCertificate += SecondsSince(start);
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
    this->Report.Certificate = this->Candidate;
    double bounds[4] = { 0.0, 0.0, 0.0, 0.0 };
    const CellCertificate* cell = this->Candidate.Cells.data();
    for (const Spline<Dim>& patch : this->Out.Map.Patches)
    {
      for (const auto& element : patch.Space->Elements)
      {
        double volume = 1.0;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          volume *= element.Box.Upper[d] - element.Box.Lower[d];
        }
        // a division rounds: one part in 2^50 outward
        const double own[4] = { cell->MinLower / volume, cell->MinUpper / volume,
          cell->MaxLower / volume, cell->MaxUpper / volume };
        for (int k = 0; k < 4; ++k)
        {
          const double out = (k % 2 ? 1.0 : -1.0) * 0x1p-50 * std::abs(own[k]);
          const double value = own[k] + out;
          bounds[k] = cell == this->Candidate.Cells.data() ? value
            : k < 2                                        ? std::min(bounds[k], value)
                                                           : std::max(bounds[k], value);
        }
        ++cell;
      }
    }
    this->Report.MinDetLower = bounds[0];
    this->Report.MinDetUpper = bounds[1];
    this->Report.MaxDetLower = bounds[2];
    this->Report.MaxDetUpper = bounds[3];
  }

  /// Elements without a certificate.
  static std::vector<std::size_t> OpenElements(const JacobianCertificate& certificate)
  {
    std::vector<std::size_t> open;
    for (std::size_t e = 0; e < certificate.Cells.size(); ++e)
    {
      if (certificate.Cells[e].Verdict != Verdict::Valid)
      {
        open.push_back(e);
      }
    }
    return open;
  }

  /// Where quadrature points did not see a fold, more of them, until the certificate is won.
  Status Densify(bool& unfolded)
  {
    for (int round = 0; round < (Dim == 2 ? 4 : 3) && unfolded && !this->IsValid() &&
         !this->IsImpossible() && !this->Solver->Aborted;
         ++round)
    {
      for (std::size_t e : OpenElements(this->Candidate))
      {
        // points grow with the power of the dimension
        this->Extra[e] += Dim == 2 ? 2 << round : 1 + round;
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
      if (this->Candidate.NumValid >= this->Report.Certificate.NumValid)
      {
        this->Accept();
      }
    }
    if (!unfolded && !this->IsImpossible())
    {
      this->Report.Messages.push_back("foldover removal in a space of " +
        std::to_string(this->Out.Map.NumFunctions()) +
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
        for (std::size_t e : OpenElements(this->Candidate))
        {
          this->Extra[e] += 2;
        }
        this->Solver->SetQuadrature(this->Extra);
        if (!this->Solver->RemoveFolds())
        {
          break;
        }
      }
      if (this->Candidate.NumValid >= this->Report.Certificate.NumValid)
      {
        this->Accept();
        this->Report.WeightsOptimized = true;
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

  /// Everything goes on in a larger space.
  Status Refine()
  {
    auto refined = this->Source.Refine(this->Out.Map, this->Report.Certificate);
    if (!refined)
    {
      return refined.Status;
    }
    ++this->Report.Refinements;
    this->Out.Map = std::move(refined.Value);
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

  DomainSource<Dim>& Source;
  double Area;
  const DomainParams& Params;
  const ProgressCallback& Progress;
  DomainRun<Dim>& Out;
  DomainReport& Report;
  std::unique_ptr<DomainSolver<Dim>> Solver;
  std::vector<int> Extra; ///< quadrature points a direction and element beyond degree + 1
  JacobianCertificate Candidate;
  int Steps = 0;
};
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

template <int Dim>
BernsteinCells GluedCells(const GluedMap<Dim>& map, int threads)
{
  BernsteinCells cells;
  for (const Spline<Dim>& patch : map.Patches)
  {
    BernsteinCells own = MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(patch, threads));
    if (cells.NumCells() == 0)
    {
      cells = std::move(own);
      continue;
    }
    const std::size_t offset = cells.Data.size();
    cells.Shapes.insert(cells.Shapes.end(), own.Shapes.begin(), own.Shapes.end());
    cells.Degrees.insert(cells.Degrees.end(), own.Degrees.begin(), own.Degrees.end());
    cells.Data.insert(cells.Data.end(), own.Data.begin(), own.Data.end());
    for (std::size_t e = 1; e < own.Offsets.size(); ++e)
    {
      cells.Offsets.push_back(offset + own.Offsets[e]);
    }
  }
  return cells;
}

template <int Dim>
Status RunDomain(DomainSource<Dim>& source, double area, const DomainParams& params,
  const ProgressCallback& progress, DomainRun<Dim>& run, DomainReport& report)
{
  const Clock::time_point start = Clock::now();
  Runner<Dim> runner(source, area, params, progress, run, report);
  if (Status status = runner.FirstMap(params.InitialMap); !status)
  {
    return status;
  }
  if (Status status = runner.Optimize(); !status)
  {
    return status;
  }
  runner.Absorb();
  report.SecondsOptimization += SecondsSince(start) - report.SecondsCertificate;
  runner.Measure();
  return {};
}

template BernsteinCells GluedCells<2>(const GluedMap<2>&, int);
template BernsteinCells GluedCells<3>(const GluedMap<3>&, int);
template Status RunDomain<2>(DomainSource<2>&, double, const DomainParams&, const ProgressCallback&,
  DomainRun<2>&, DomainReport&);
template Status RunDomain<3>(DomainSource<3>&, double, const DomainParams&, const ProgressCallback&,
  DomainRun<3>&, DomainReport&);
}
