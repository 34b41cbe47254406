// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkSplineShift.h>

namespace knotwork
{
namespace
{
class ShiftJob : public FilterJob<vtkSplineShift>
{
public:
  explicit ShiftJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "input", "a spline grid (.vtu)");
    this->AddOutput(0, "--output", Endings::Spline, "the shifted grid");
    this->AddProperties();
  }
};

const JobRegistration Registration{ "shift", "shift a spline",
  "plate.vtu --way along-x --output shifted.vtu", MakeJob<ShiftJob> };
}
}
