// SPDX-License-Identifier: BSD-3-Clause
// The operations of the kernel with splines of the new family. Oracle: the constants themselves.
#include "BezierForm.h"
#include "ConstantSpace.h"
#include "LocallyRefinedForm.h"
#include "Refinement.h"
#include "SpaceFamily.h"
#include "TensorForm.h"

#include <cstdio>
#include <cstdlib>

using namespace knotwork;

namespace
{
void Expect(bool holds, const char* what)
{
  if (!holds)
  {
    std::fprintf(stderr, "%s\n", what);
    std::exit(EXIT_FAILURE);
  }
}

double ValueAt(const Spline<2>& spline, double u, double v)
{
  double local[2];
  const double at[2] = { u, v };
  const int element = spline.Space->Locate(at, local);
  Expect(element >= 0, "a point of the domain is in no element");
  const BezierForm<2> form = MakeBezierForm(spline, 1);
  const double* block = form.Block(element);
  for (int i = 1; i < NumTensorFunctions<2>(spline.Space->Elements[0].Degree); ++i)
  {
    Expect(block[i] == block[0], "an element is not constant");
  }
  return block[0];
}
}

int main()
{
  const KnotVector knots = KnotVector::Uniform(1, 3, 0.0, 1.0);
  Spline<2> spline;
  spline.Space = MakeConstantSpace<2>({ knots, knots }).Value;
  spline.ControlPoints.resize(9, 1);
  for (int f = 0; f < 9; ++f)
  {
    spline.ControlPoints(f, 0) = f * f;
  }
  Expect(spline.Check().Code == ErrorCode::Ok, "the spline is refused");
  Expect(ValueAt(spline, 0.5, 0.9) == 49.0, "wrong value");

  const SpaceFamily<2>& family = FamilyOf(*spline.Space);
  const SpaceDefinition definition = family.Describe(*spline.Space);
  const auto built = FamilyOf<2>(definition.Kind).Build(definition, 1);
  Expect(built && family.Describe(*built.Value) == definition, "it is not what was stored");
  Expect(built.Value->LocalFunctionIds == spline.Space->LocalFunctionIds, "it is another space");

  const auto refined = RefineAllElements(spline);
  Expect(bool(refined), "it is not refined");
  Expect(refined->Value.Space->Kind == SpaceKind::Constant, "refined, it is of another family");
  Expect(refined->Value.Space->NumFunctions == 36, "wrong number of functions");
  Expect(ValueAt(refined->Value, 0.5, 0.9) == 49.0, "refined, it has another value");

  Expect(!RefineMarkedElements(spline, { 1 }), "it is refined locally");
  Expect(!ElevateAllDegrees(spline, 1), "its degree is raised");
  Expect(!ToTensor(spline, 1), "it is made smooth");
  Expect(!MakeLocallyRefined(spline, 1), "it is made smooth by LR B-splines");
  return EXIT_SUCCESS;
}
