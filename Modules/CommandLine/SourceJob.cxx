// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkSplineSource.h>

namespace knotwork
{
namespace
{
class SourceJob : public FilterJob<vtkSplineSource>
{
public:
  explicit SourceJob(CLI::App& app) : FilterJob(app)
  {
    this->AddOutput(0, "--output", Endings::Spline, "the shape as Bezier grid");
    this->AddProperties();
  }
};

const JobRegistration Registration{ "source", "make a spline of a standard shape",
  "--shape annulus-sector --elements 4 4 1 --output plate.vtu", MakeJob<SourceJob> };
}
}
