// SPDX-License-Identifier: BSD-3-Clause
#include "WorkBudget.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
WorkBudget::WorkBudget(double effort, double seconds, ProgressCallback progress)
  : Limit(1e9 * effort), HasDeadline(seconds > 0.0), Progress(std::move(progress))
{
  if (this->HasDeadline)
  {
    // more than a century is no limit, and would not fit
    this->Deadline = Clock::now() +
      std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(std::min(seconds, 3e9)));
  }
}

bool WorkBudget::Spend(double nanoseconds)
{
  this->Spent += nanoseconds;
  if (this->Spent >= this->Limit && this->Reason == DomainStop::Finished)
  {
    this->Reason = DomainStop::Effort;
  }
  return this->Continue();
}

bool WorkBudget::Continue()
{
  if (this->HasDeadline && this->Reason == DomainStop::Finished && Clock::now() >= this->Deadline)
  {
    this->Reason = DomainStop::Time;
  }
  if (this->Progress && !this->Cancelled)
  {
    // runs end long before their limit, or near it: the share goes on in either case
    const double share = this->Spent / (this->Spent + 0.1 * this->Limit);
    this->Share = std::max(this->Share, share);
    this->Cancelled = !this->Progress(this->Share);
  }
  return this->MayGoOn();
}

double WorkBudget::SecondsLeft() const
{
  if (!this->HasDeadline)
  {
    return 0.0;
  }
  const double left = std::chrono::duration<double>(this->Deadline - Clock::now()).count();
  return std::max(left, std::numeric_limits<double>::min());
}

ProgressCallback WorkBudget::AsProgress()
{
  return [this](double) { return this->Continue(); };
}
}
