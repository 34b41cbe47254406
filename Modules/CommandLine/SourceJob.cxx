// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"
#include <knotwork/SplineCore/Shapes.h>

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
    Options& options = this->FilterOptions;
    vtkSplineSource* filter = this->Filter;
    std::vector<std::string> names;
    for (int shape = 0; shape < NumShapeKinds; ++shape)
    {
      names.push_back(Options::KebabCase(ToString(static_cast<ShapeKind>(shape))));
    }
    options.AddChoice(
      "Shape", names, filter->GetShape(), [filter](int shape) { filter->SetShape(shape); },
      "the shape");
    KNOTWORK_OPTION(options, filter, Degree, "degree in every direction; 0: the lowest exact one");
    KNOTWORK_VECTOR_OPTION(options, filter, Elements, int, "elements a direction");
    KNOTWORK_FREE_OPTION(options, filter, InnerRadius, "inner radius");
    KNOTWORK_FREE_OPTION(options, filter, OuterRadius, "outer radius");
    KNOTWORK_FREE_OPTION(options, filter, Angle, "angle about z, degrees");
    KNOTWORK_OPTION(options, filter, Sectors, "patches that share the angle of a sector or tube");
    KNOTWORK_FREE_OPTION(
      options, filter, PolarAngle, "range of latitudes of a ball sector, degrees");
    KNOTWORK_FREE_OPTION(options, filter, Height, "length along z");
    KNOTWORK_FREE_OPTION(options, filter, Twist, "turn of a twisted bar, degrees");
    KNOTWORK_VECTOR_OPTION(options, filter, Size, double, "side lengths");
    KNOTWORK_VECTOR_OPTION(options, filter, Center, double, "centre");
    KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  }
};

const JobRegistration Registration{ "source", "make a spline of a standard shape",
  "--shape annulus-sector --elements 4 4 1 --output plate.vtu", MakeJob<SourceJob> };
}
}
