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
  PointCloud part, const FitParams& params, const FitProcesses& processes)
{
  FitDivision division(processes, std::move(part));
  try
  {
    const PointCloud& own = division.Part();
    const std::size_t n = division.Sum(static_cast<std::size_t>(own.Parameters.rows()));
    const auto columns = static_cast<Eigen::Index>(
      division.Largest(static_cast<double>(own.Parameters.rows() > 0 ? own.Values.cols() : 0)));
    Status status = own.Parameters.rows() > 0 || n == 0 ? CheckFit(own, params) : Status();
    status = status ? CheckDivided(params) : status;
    if (status && own.Parameters.rows() > 0 && own.Values.cols() != columns)
    {
      status = { ErrorCode::SizeMismatch,
        std::to_string(own.Values.cols()) + " values a point, where another process has " +
          std::to_string(columns) + "; all need the same ones" };
    }
    if (status = division.Agree(status); !status)
    {
      return status;
    }
    PointCloud none;
    none.Parameters.resize(0, 2);
    none.Values.resize(0, columns);
    return RunFit(own.Parameters.rows() > 0 ? own : none, params, division);
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
