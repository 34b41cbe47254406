// SPDX-License-Identifier: BSD-3-Clause
#include "DomainRun.h"

#include "DomainSolver.h"
#include "ParameterMetrics.h"
#include <knotwork/JacobianValidation/CellPieces.h>
#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/LU>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
using Clock = std::chrono::steady_clock;

/// Of the certificates on the way, which need the sign only.
constexpr std::int64_t SignBoxes = 100000;
/// Nanoseconds that a certificate takes a cell and a box, for WorkBudget.
template <int Dim>
constexpr double CellCost = Dim == 2 ? 5e2 : 3e3;
template <int Dim>
constexpr double BoxCost = Dim == 2 ? 2e3 : 1e4;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The stages on one space after the other.
template <int Dim>
class StageSequence
{
public:
  StageSequence(DomainSource<Dim>& source, double area, const DomainParams& params,
    WorkBudget& budget, DomainRun<Dim>& out, DomainReport& report)
    : Source(source), Area(area), Params(params), Budget(budget), Out(out), Report(report)
  {
  }

  /// All stages; the map, its certificate and messages are in Out and Report afterwards.
  Status Optimize()
  {
    Status status = this->FindFirstMap();
    const bool fromStart =
      this->Params.Weights == WeightMode::Optimized && !this->Report.IsImpossible();
    if (status && fromStart && this->Budget.MayGoOn())
    {
      status = this->AlternateFromStart();
    }
    // control points alone, unless that led to a regular map
    if (status && this->IsRegular() && !this->Report.WeightsOptimized)
    {
      status = this->Improve();
    }
    // without hope of a valid map only the first, for what it shows
    for (std::size_t k = 0; status && k < this->Starts.size() && !this->IsRegular() &&
         this->Budget.MayGoOn() && (k == 0 || !this->Report.IsImpossible());
         ++k)
    {
      status = this->Unfold(this->Starts[k], k == 0);
    }
    const bool wanted =
      (this->Params.Weights == WeightMode::Optimized && !this->Report.WeightsOptimized) ||
      (this->Params.Weights == WeightMode::Automatic && this->MayTry());
    if (status && wanted && this->Budget.MayGoOn())
    {
      status = this->Alternate(this->Out.Map, false);
    }
    for (std::size_t k = 0; status && wanted && k < this->Starts.size() && this->MayTry(); ++k)
    {
      this->Extra.assign(this->Extra.size(), 0);
      this->Solver->SetMap(this->Starts[k].Map);
      this->Solver->SetQuadrature(this->Extra);
      status = this->RemoveFolds(false);
      if (status && this->MayTry())
      {
        status = this->Alternate(GluedMap<Dim>(this->Solver->Map()), false);
      }
    }
    for (int round = 0; status && round < this->Params.MaxRefinements && this->MayTry() &&
         this->Source.MayRefine(this->Out.Map);
         ++round)
    {
      status = this->Refine();
    }
    if (status && this->Params.Objective == DomainObjective::LeastJacobian)
    {
      status = this->RaiseLeastJacobian();
    }
    if (this->Budget.Aborted())
    {
      return { ErrorCode::Aborted, "by the caller" };
    }
    return status;
  }

  /// Bounds of the certificate as tight as they were asked for, and whether the map is one-to-one.
  Status Prove()
  {
    const Clock::time_point start = Clock::now();
    const BernsteinCells cells = GluedCells<Dim>(this->Out.Map, this->Params.Threads);
    JacobianParams params;
    params.RelativeGap = this->Params.CertificateGap;
    params.ComputeMax = true;
    params.MaxBoxes = this->Params.MaxBoxes;
    params.Threads = this->Params.Threads;
    auto sharp = ValidateJacobian(cells, params, this->Budget.AsProgress());
    // a limit of boxes or time must not take away the sign that was proved before
    if (sharp && Rank(sharp.Value) >= Rank(this->Report.Certificate))
    {
      this->Candidate = std::move(sharp.Value);
      this->SetCertificate();
    }
    else if (!sharp && sharp.Status.Code != ErrorCode::Aborted)
    {
      return sharp.Status;
    }
    InjectivityParams injectivity;
    injectivity.MaxBoxes = this->Params.MaxBoxes;
    injectivity.Threads = this->Params.Threads;
    // after a limit of time this is still proved: it takes milliseconds
    auto proved = ProveInjectivity(cells, GluedComplex<Dim>(this->Out.Map),
      this->Report.Certificate, injectivity, [this](double) { return !this->Aborts(); });
    this->Report.SecondsCertificate += SecondsSince(start);
    if (!proved)
    {
      return proved.Status;
    }
    this->Report.Injectivity = std::move(proved.Value);
    return {};
  }

  /// What is to be said of the result.
  void Conclude()
  {
    std::vector<std::string>& messages = this->Report.Messages;
    this->Report.Stop = this->Budget.Stop();
    this->Report.Work = this->Budget.Used();
    const char* stopped = this->Report.Stop == DomainStop::Effort ? "the effort was used up"
      : this->Report.Stop == DomainStop::Time                     ? "the time limit was reached"
                                                                  : nullptr;
    const char* remedy = this->Report.Stop == DomainStop::Effort
      ? "raise Effort to let it go on"
      : "raise TimeLimit to let it go on";
    if (!this->IsRegular())
    {
      if (!this->Report.IsImpossible())
      {
        messages.push_back("no valid map was found in a space of " +
          std::to_string(this->Out.Map.NumFunctions()) + " functions; " +
          std::to_string(this->Report.Certificate.NumInvalid) + " elements are invalid, " +
          std::to_string(this->Report.Certificate.NumUndecided) + " undecided" +
          (stopped ? std::string("; ") + stopped + ": " + remedy : std::string()));
      }
      return;
    }
    // what failed on the way to a regular map does not matter any more
    messages.clear();
    if (Rank(this->Report.Certificate) == 1)
    {
      messages.push_back(this->RoundingMessage());
    }
    else if (!this->Report.Crossings.empty())
    {
      messages.push_back(
        "the map is regular, but not one-to-one: " + this->Report.Crossings.front().Message);
    }
    else if (!this->Report.IsValid())
    {
      messages.push_back(this->OverlapMessage());
    }
    if (stopped)
    {
      messages.push_back(
        std::string(this->Report.IsValid() ? "the map is valid" : "the map is regular") +
        ", but its optimization was not finished: " + stopped + "; " + remedy);
    }
  }

  void Measure()
  {
    const Clock::time_point start = Clock::now();
    const int samples =
      this->Params.MetricSamples > 0 ? this->Params.MetricSamples : (Dim == 2 ? 501 : 51);
    const auto goOn = [this] { return !this->Aborts(); };
    this->Report.Metrics = MeasureMaps<Dim>(this->Out.Map.Patches, this->Area, samples, goOn);
    if (this->Params.MeasureInitialMap)
    {
      this->Report.InitialMetrics =
        MeasureMaps<Dim>(this->Out.InitialMap.Patches, this->Area, samples, goOn);
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
  struct Start
  {
    InitialMapMethod Method = InitialMapMethod::Coons;
    GluedMap<Dim> Map;
  };

  /// 2: proved regular. 1: but for elements that are degenerate within the rounding of their
  /// coordinates, which is the boundary's. 0: not so.
  static int Rank(const JacobianCertificate& certificate)
  {
    if (certificate.Verdict == Verdict::Valid)
    {
      return 2;
    }
    return std::none_of(certificate.Cells.begin(), certificate.Cells.end(), IsOpen) ? 1 : 0;
  }
  static bool Holds(const JacobianCertificate& certificate) { return Rank(certificate) > 0; }
  /// Neither valid nor as near to it as rounding lets it be.
  static bool IsOpen(const CellCertificate& cell)
  {
    return cell.Verdict != Verdict::Valid &&
      !(cell.Verdict == Verdict::Undecided && cell.Limit == JacobianLimit::Rounding);
  }
  bool IsRegular() const { return Holds(this->Report.Certificate); }
  /// More may lead to a regular map.
  bool MayTry() const
  {
    return !this->IsRegular() && !this->Report.IsImpossible() && this->Budget.MayGoOn();
  }
  bool Aborts()
  {
    this->Budget.Continue();
    return this->Budget.Aborted();
  }

  /// Candidates for the first map, until one is proved valid; otherwise all of them are starts.
  Status FindFirstMap()
  {
    std::vector<InitialMapMethod> methods{ this->Params.InitialMap };
    const bool automatic = this->Params.InitialMap == InitialMapMethod::Automatic;
    if (automatic)
    {
      methods = { InitialMapMethod::Coons, InitialMapMethod::Harmonic };
    }
    for (const InitialMapMethod method : methods)
    {
      for (int variant = 0; variant < (automatic ? this->Source.NumVariants(method) : 1); ++variant)
      {
        auto map = this->Source.FirstMap(method, variant);
        if (!map && (this->Starts.empty() || map.Status.Code != ErrorCode::SingularSystem))
        {
          return map.Status;
        }
        if (!map)
        {
          continue;
        }
        this->Use({ method, std::move(map.Value) });
        if (const Status status = this->Certify(); !status)
        {
          return status;
        }
        if (Holds(this->Candidate))
        {
          this->Accept();
          this->Starts.clear();
          return {};
        }
        this->Starts.push_back({ method, this->Out.Map });
        if (!this->Budget.MayGoOn())
        {
          break;
        }
      }
    }
    // the first of them is the result when nothing better comes
    this->Use(this->Starts.front());
    if (const Status status = this->Certify(); !status)
    {
      return status;
    }
    this->Accept();
    return {};
  }

  /// A first map becomes the result's and the solver's.
  void Use(const Start& start)
  {
    this->Report.UsedInitialMap = start.Method;
    this->Out.InitialMap = start.Map;
    this->Out.Map = start.Map;
    if (this->Solver)
    {
      this->Solver->SetMap(start.Map);
    }
    else
    {
      this->MakeSolver();
    }
    this->Record();
  }

  void MakeSolver()
  {
    this->Absorb();
    this->Solver =
      std::make_unique<DomainSolver<Dim>>(this->Out.Map, this->Area, this->Params, this->Budget);
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

  /// Certificate of the solver's map, into Candidate: the sign, bounds as they come.
  Status Certify()
  {
    const Clock::time_point start = Clock::now();
    JacobianParams params;
    params.MaxBoxes = std::min(this->Params.MaxBoxes, SignBoxes);
    params.Threads = this->Params.Threads;
    const BernsteinCells cells = GluedCells<Dim>(this->Solver->Map(), this->Params.Threads);
    auto certificate = ValidateJacobian(cells, params, [this](double) { return !this->Aborts(); });
    this->Report.SecondsCertificate += SecondsSince(start);
    if (!certificate)
    {
      return certificate.Status;
    }
    this->Candidate = std::move(certificate.Value);
    this->Budget.Spend(
      CellCost<Dim> * cells.NumCells() + BoxCost<Dim> * static_cast<double>(this->Candidate.Boxes));
    return {};
  }

  /// The only way into the result: a certificate is replaced by one.
  /// @pre Candidate is the certificate of the solver's map.
  bool Offer()
  {
    const int rank = Rank(this->Candidate);
    const int known = Rank(this->Report.Certificate);
    const bool better = rank > known ||
      (rank == known &&
        (rank > 0 || this->Candidate.NumValid >= this->Report.Certificate.NumValid));
    if (better)
    {
      this->Accept();
    }
    return better;
  }

  void Accept()
  {
    this->Out.Map = this->Solver->Map();
    this->SetCertificate();
  }

  /// Candidate, and its bounds with respect to the parameters of the square or cube.
  void SetCertificate()
  {
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

  /// More quadrature points in the elements that Candidate leaves open.
  void LookCloser(int points)
  {
    for (std::size_t e = 0; e < this->Candidate.Cells.size(); ++e)
    {
      if (IsOpen(this->Candidate.Cells[e]))
      {
        this->Extra[e] += points;
      }
    }
    this->Solver->SetQuadrature(this->Extra);
  }
  /// Points grow with the power of the dimension.
  static int Closer(int round) { return Dim == 2 ? 2 << round : 1 + round; }
  static constexpr int Rounds = Dim == 2 ? 4 : 3;

  /// Minimizes from the result, which is regular. Where the functional leads out of the regular
  /// maps between the quadrature points, as far towards that as the way is regular, and on from
  /// there with more points.
  Status Improve()
  {
    for (int round = 0; round <= Rounds && this->Budget.MayGoOn(); ++round)
    {
      this->Solver->SetMap(this->Out.Map);
      this->Solver->ImprovePoints();
      if (const Status status = this->Certify(); !status)
      {
        return status;
      }
      if (this->Offer())
      {
        return {};
      }
      const JacobianCertificate open = this->Candidate;
      const GluedMap<Dim> goal = this->Solver->Map();
      for (double share = 0.5; share > 0.05; share *= 0.5)
      {
        this->Solver->SetMap(Between(this->Out.Map, goal, share));
        if (const Status status = this->Certify(); !status)
        {
          return status;
        }
        if (this->Offer())
        {
          break;
        }
      }
      this->Candidate = open;
      this->LookCloser(Closer(round));
    }
    return {};
  }

  /// Control points a + share (b - a), for those that may move. @pre of one space and weights.
  static GluedMap<Dim> Between(const GluedMap<Dim>& a, const GluedMap<Dim>& b, double share)
  {
    GluedMap<Dim> between = b;
    for (std::size_t p = 0; p < a.Patches.size(); ++p)
    {
      PointMatrix& points = between.Patches[p].ControlPoints;
      for (Eigen::Index i = 0; i < points.rows(); ++i)
      {
        const int number = a.Functions[p][static_cast<std::size_t>(i)];
        if (!a.Fixed[static_cast<std::size_t>(number)])
        {
          points.row(i) = (1.0 - share) * a.Patches[p].ControlPoints.row(i) + share * points.row(i);
        }
      }
    }
    return between;
  }

  /// A first map with folds: they are removed, and the map is improved.
  /// @param first  nothing was tried before.
  Status Unfold(const Start& start, bool first)
  {
    const GluedMap<Dim> before = this->Out.Map;
    const GluedMap<Dim> beforeFirst = this->Out.InitialMap;
    const InitialMapMethod beforeMethod = this->Report.UsedInitialMap;
    const JacobianCertificate certificate = this->Report.Certificate;
    this->Solver->SetMap(start.Map);
    if (!first)
    {
      this->Extra.assign(this->Extra.size(), 0);
      this->Solver->SetQuadrature(this->Extra);
      this->Record();
    }
    this->Out.InitialMap = start.Map;
    this->Report.UsedInitialMap = start.Method;
    // what this start leads to, on its own
    if (const Status status = this->RemoveFolds(true); !status)
    {
      return status;
    }
    if (!this->IsRegular() && !first && this->Report.Certificate.NumValid <= certificate.NumValid)
    {
      this->Out.Map = before;
      this->Out.InitialMap = beforeFirst;
      this->Report.UsedInitialMap = beforeMethod;
      this->Candidate = certificate;
      this->SetCertificate();
      this->Solver->SetMap(before);
    }
    return {};
  }

  /// Folds are removed from the solver's map, which is then improved until the certificate is won:
  /// where quadrature points did not see a fold, more of them.
  /// @param fresh  the result so far is not to be compared with.
  Status RemoveFolds(bool fresh)
  {
    bool unfolded = false;
    for (int round = 0; round <= Rounds; ++round)
    {
      unfolded = this->Solver->RemoveFolds();
      if (unfolded)
      {
        // on the way to the best map there may be a regular one that the best map is not
        if (const Status status = this->Certify(); !status)
        {
          return status;
        }
        if (Holds(this->Candidate))
        {
          this->Accept();
          return this->Improve();
        }
        this->Solver->ImprovePoints();
      }
      if (const Status status = this->Certify(); !status)
      {
        return status;
      }
      if (fresh && round == 0)
      {
        this->Accept();
      }
      else
      {
        this->Offer();
      }
      if (!unfolded || this->IsRegular() || !this->Report.Folds.empty() || !this->Budget.MayGoOn())
      {
        break;
      }
      this->LookCloser(Closer(round));
    }
    const std::string text = "foldover removal in a space of " +
      std::to_string(this->Out.Map.NumFunctions()) +
      " functions ended with det J <= 0 at quadrature points";
    std::vector<std::string>& messages = this->Report.Messages;
    if (!unfolded && !this->Report.IsImpossible() && this->Budget.MayGoOn() &&
      std::find(messages.begin(), messages.end(), text) == messages.end())
    {
      messages.push_back(text);
    }
    return {};
  }

  /// As the published method does it; without a regular map at the end nothing has happened.
  Status AlternateFromStart()
  {
    const GluedMap<Dim> before = this->Out.Map;
    const JacobianCertificate certificate = this->Report.Certificate;
    const Status status = this->Alternate(before, true);
    if (status && !(this->IsRegular() && this->Report.WeightsOptimized))
    {
      this->Report.WeightsOptimized = false;
      this->Extra.assign(this->Extra.size(), 0);
      this->Solver->SetMap(before);
      this->Solver->SetQuadrature(this->Extra);
      this->Candidate = certificate;
      this->Accept();
    }
    return status;
  }

  /// Control points and weights in turn; the result is replaced by what is better.
  /// @param fromStart  `from` is a first map: its folds are removed as Foldover says, by weights
  ///                   too where that does not suffice, and control points are the first to move.
  Status Alternate(const GluedMap<Dim>& from, bool fromStart)
  {
    this->Solver->SetMap(from);
    if (!(fromStart && this->Solver->RemoveFolds()) && !this->Solver->RemoveFoldsWithWeights())
    {
      return {};
    }
    if (fromStart)
    {
      this->Solver->ImprovePoints();
    }
    double energy = this->Solver->Energy();
    for (int round = 0; round < this->Params.MaxAlternations && this->Budget.MayGoOn(); ++round)
    {
      this->Solver->ImproveWeights();
      this->Solver->ImprovePoints();
      if (const Status status = this->Certify(); !status)
      {
        return status;
      }
      if (!Holds(this->Candidate))
      {
        if (this->IsRegular())
        {
          this->Solver->SetMap(this->Out.Map);
          break;
        }
        this->LookCloser(2);
        if (!this->Solver->RemoveFolds() && !this->Solver->RemoveFoldsWithWeights())
        {
          break;
        }
        if (const Status status = this->Certify(); !status)
        {
          return status;
        }
      }
      if (this->Offer())
      {
        this->Report.WeightsOptimized = true;
      }
      const double lowered = this->Solver->Energy();
      const bool done = energy - lowered < this->Params.AlternationTolerance;
      energy = lowered;
      if (done && this->IsRegular())
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
    return this->RemoveFolds(true);
  }

  /// Larger and larger powers of 1 / det J, as long as the least det J grows.
  Status RaiseLeastJacobian()
  {
    constexpr int samples = Dim == 2 ? 201 : 31;
    const auto least = [&](const GluedMap<Dim>& map)
    { return MeasureMaps<Dim>(map.Patches, this->Area, samples).MinDetOverArea; };
    double best = least(this->Out.Map);
    this->Solver->SetMap(this->Out.Map);
    for (int& extra : this->Extra)
    {
      extra += 2;
    }
    this->Solver->SetQuadrature(this->Extra);
    for (double power = 4.0; power <= 256.0 && this->IsRegular() && this->Budget.MayGoOn();
         power *= 2.0)
    {
      this->Solver->RaiseLeastJacobian(power);
      if (const Status status = this->Certify(); !status)
      {
        return status;
      }
      const double reached = least(this->Solver->Map());
      if (reached > best && this->Offer())
      {
        best = reached;
      }
      else if (!Holds(this->Candidate))
      {
        this->LookCloser(2);
        this->Solver->SetMap(this->Out.Map);
      }
    }
    return {};
  }

  static std::string Near(const std::array<double, 3>& position)
  {
    return "near " + PointText(position.data(), Dim);
  }

  /// A map that is regular as far as the rounding of its boundary lets one say: where it is not
  /// known, and how exact the coordinates must be. Named is the corner with the smallest det J of
  /// the first such element.
  std::string RoundingMessage() const
  {
    const JacobianCertificate& certificate = this->Report.Certificate;
    const BernsteinCells cells = GluedCells<Dim>(this->Out.Map, this->Params.Threads);
    std::array<double, 3> place{};
    double least = std::numeric_limits<double>::infinity();
    double rounding = 0.0;
    int first = -1;
    for (std::size_t c = 0; c < certificate.Cells.size(); ++c)
    {
      if (certificate.Cells[c].Verdict != Verdict::Undecided)
      {
        continue;
      }
      first = first < 0 ? static_cast<int>(c) : first;
      rounding = std::max(rounding, certificate.Cells[c].Rounding);
    }
    for (int corner = 0; first >= 0 && corner < NumCorners(cells.Shapes[0]); ++corner)
    {
      const auto u = CornerParameters(cells.Shapes[0], corner);
      const CellPoint point = EvaluateCell(cells, first, u.data());
      Eigen::Matrix<double, Dim, Dim> derivative;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        for (std::size_t k = 0; k < Dim; ++k)
        {
          derivative(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(d)) =
            point.Derivative[d][k];
        }
      }
      const double det = std::abs(derivative.determinant());
      if (det < least)
      {
        least = det;
        place = point.Position;
      }
    }
    return "the map is regular, but where its boundary is degenerate within the rounding of its "
           "coordinates (" +
      std::to_string(certificate.NumUndecided) + " elements, undecided, the first " + Near(place) +
      "): open the angle there, or give coordinates that are exact to less than " +
      Digits(rounding);
  }

  /// A regular map that is not proved one-to-one.
  std::string OverlapMessage() const
  {
    const InjectivityCertificate& injectivity = this->Report.Injectivity;
    std::string text = injectivity.Verdict == InjectivityVerdict::NotInjective
      ? "the map is regular, but not one-to-one: "
      : "the map is regular, but not proved one-to-one: ";
    text += ToString(injectivity.Reason);
    if (injectivity.HasWitness)
    {
      text += ", " + Near(injectivity.Witness.Places[0].Position);
    }
    return text;
  }

  DomainSource<Dim>& Source;
  double Area;
  const DomainParams& Params;
  WorkBudget& Budget;
  DomainRun<Dim>& Out;
  DomainReport& Report;
  std::vector<Start> Starts; ///< first maps without a certificate
  std::unique_ptr<DomainSolver<Dim>> Solver;
  std::vector<int> Extra; ///< quadrature points a direction and element beyond degree + 1
  JacobianCertificate Candidate;
};
}

Status CheckParams(const DomainParams& params, int dim)
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
  if (dim == 3 && params.MetricSamples > 301) // 2.7e7, as 5001 are in the plane
  {
    return fail("the metric samples a direction must lie in [2, 301] in space");
  }
  if (params.MaxFunctions < 1)
  {
    return fail("the largest number of functions must be >= 1");
  }
  if (!(params.CertificateGap > 0.0 && params.CertificateGap <= 1.0))
  {
    return fail("the certificate's gap must lie in (0, 1]");
  }
  if (params.MaxBoxes < 1)
  {
    return fail("the certificate needs at least one box");
  }
  if (!(params.Effort > 0.0 && params.Effort <= 1e6))
  {
    return fail("the effort must lie in (0, 1000000]");
  }
  if (!(params.TimeLimit >= 0.0 && std::isfinite(params.TimeLimit)))
  {
    return fail("the time limit must be >= 0 seconds; 0: none");
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
CellComplex GluedComplex(const GluedMap<Dim>& map)
{
  CellComplex complex;
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    for (const auto& element : map.Patches[p].Space->Elements)
    {
      ParametricBox<3> box{};
      for (std::size_t d = 0; d < Dim; ++d)
      {
        box.Lower[d] = element.Box.Lower[d];
        box.Upper[d] = element.Box.Upper[d];
      }
      complex.Patches.push_back(static_cast<int>(p));
      complex.Boxes.push_back(box);
    }
  }
  return complex;
}

template <int Dim>
Status RunDomain(DomainSource<Dim>& source, double area, const DomainParams& params,
  WorkBudget& budget, DomainRun<Dim>& run, DomainReport& report)
{
  const Clock::time_point start = Clock::now();
  StageSequence<Dim> stages(source, area, params, budget, run, report);
  if (Status status = stages.Optimize(); !status)
  {
    return status;
  }
  stages.Absorb();
  report.SecondsOptimization += SecondsSince(start) - report.SecondsCertificate;
  if (Status status = stages.Prove(); !status)
  {
    return status;
  }
  stages.Conclude();
  stages.Measure();
  return budget.Aborted() ? Status(ErrorCode::Aborted, "by the caller") : Status();
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template BernsteinCells GluedCells<Dim>(const GluedMap<Dim>&, int);                              \
  template CellComplex GluedComplex<Dim>(const GluedMap<Dim>&);                                    \
  template Status RunDomain<Dim>(                                                                  \
    DomainSource<Dim>&, double, const DomainParams&, WorkBudget&, DomainRun<Dim>&, DomainReport&);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
