// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/DomainParameterization.h>

#include <chrono>

namespace knotwork
{
/// What a run may still do. Work is counted, not measured: a run stops at the same place on every
/// machine, unless a limit of time is asked for. Calls the progress callback and heeds it.
class WorkBudget
{
public:
  /// @param effort  see DomainParams::Effort.
  /// @param seconds  of the wall clock; 0: no limit.
  WorkBudget(double effort, double seconds, ProgressCallback progress);

  /// Counts work that was done, in nanoseconds of the machine that set the unit.
  /// @return false: stop.
  bool Spend(double nanoseconds);
  /// Asks clock and caller, too. @return false: stop.
  bool Continue();
  /// The same as a callback that counts nothing, for proofs.
  ProgressCallback AsProgress();

  bool MayGoOn() const { return this->Reason == DomainStop::Finished && !this->Cancelled; }
  bool Aborted() const { return this->Cancelled; }
  DomainStop Stop() const { return this->Reason; }
  double Used() const { return 1e-9 * this->Spent; }
  /// Nanoseconds that are left.
  double Left() const { return this->Limit - this->Spent; }
  /// Of the wall clock, above 0; 0: no limit.
  double SecondsLeft() const;

private:
  using Clock = std::chrono::steady_clock;
  double Limit;
  double Spent = 0.0;
  bool HasDeadline;
  Clock::time_point Deadline;
  ProgressCallback Progress;
  double Share = 0.0;
  DomainStop Reason = DomainStop::Finished;
  bool Cancelled = false;
};
}
