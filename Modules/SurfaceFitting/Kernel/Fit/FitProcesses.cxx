// SPDX-License-Identifier: BSD-3-Clause
#include "FitProcesses.h"

#include "FitChecks.h"
#include "FitRun.h"

#include <exception>
#include <new>

namespace knotwork
{
namespace
{
/// What only one process can do, as it asks for points beyond those of its elements.
Status CheckDivided(const FitParams& params)
{
  const char* what = nullptr;
  what = params.FindOutliers ? "FindOutliers" : what;
  what = params.CorrectParameters ? "CorrectParameters" : what;
  what = params.Side != FitSide::Both ? "Side" : what;
  what = params.FeatureGridSize > 0 ? "FeatureGridSize" : what;
  return what ? Status(ErrorCode::InvalidParameter,
                  std::string(what) +
                    " needs all points in one process; leave it out, work in one process, or "
                    "divide the cloud into tiles")
              : Status();
}
}

Result<SurfaceFit> FitSurface(
  const PointCloud& part, const FitParams& params, const FitProcesses& processes)
{
  FitDivision division(processes);
  try
  {
    const std::size_t n = division.Sum(static_cast<std::size_t>(part.Parameters.rows()));
    const auto columns = static_cast<Eigen::Index>(
      division.Largest(static_cast<double>(part.Parameters.rows() > 0 ? part.Values.cols() : 0)));
    Status own = part.Parameters.rows() > 0 || n == 0 ? CheckFit(part, params) : Status();
    own = own ? CheckDivided(params) : own;
    if (own && part.Parameters.rows() > 0 && part.Values.cols() != columns)
    {
      own = { ErrorCode::SizeMismatch,
        std::to_string(part.Values.cols()) + " values a point, where another process has " +
          std::to_string(columns) + "; all need the same ones" };
    }
    if (Status status = division.Agree(own); !status)
    {
      return status;
    }
    PointCloud none;
    none.Parameters.resize(0, 2);
    none.Values.resize(0, columns);
    return RunFit(part.Parameters.rows() > 0 ? part : none, params, division);
  }
  catch (const FitStop& stop)
  {
    return stop.Why;
  }
  catch (const std::exception& failure) // the others wait for this process
  {
    const bool isMemory = dynamic_cast<const std::bad_alloc*>(&failure) != nullptr;
    const Status why{ isMemory ? ErrorCode::TooLarge : ErrorCode::LibraryError,
      isMemory ? "out of memory" : failure.what() };
    division.Fail(why);
    return why;
  }
}
}
