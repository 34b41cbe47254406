// SPDX-License-Identifier: BSD-3-Clause
// Four straight sides enclose a valid map.
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/SplineCore/TensorSpace.h>

namespace
{
knotwork::Spline<1> Segment(double ax, double ay, double bx, double by)
{
  knotwork::Spline<1> side;
  side.Space = knotwork::MakeTensorSpace<1>({ knotwork::KnotVector::Uniform(1, 1) }).Value;
  side.ControlPoints.resize(2, 2);
  side.ControlPoints << ax, ay, bx, by;
  return side;
}
}

int main()
{
  const knotwork::DomainBoundary<2> boundary{ { Segment(0, 0, 0, 1), Segment(2, 0, 1, 1),
    Segment(0, 0, 2, 0), Segment(0, 1, 1, 1) } };
  const auto domain = knotwork::ParameterizeDomain<2>(boundary);
  return domain && domain->Certificate.Verdict == knotwork::Verdict::Valid ? 0 : 1;
}
