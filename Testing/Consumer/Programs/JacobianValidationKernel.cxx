// SPDX-License-Identifier: BSD-3-Clause
// A disc of five rational patches is proved valid.
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/Shapes.h>

#include <iostream>

int main()
{
  knotwork::ShapeParams disc;
  disc.Kind = knotwork::ShapeKind::Disc;
  const auto patches = knotwork::MakeShape(disc);
  int valid = 0;
  for (const knotwork::AnySpline& patch : patches.Value)
  {
    const auto form = knotwork::MakeBezierForm(std::get<knotwork::Spline<2>>(patch), 1);
    const auto certificate = knotwork::ValidateJacobian(knotwork::MakeBernsteinCells(form));
    valid += certificate && certificate->Verdict == knotwork::Verdict::Valid ? 1 : 0;
  }
  std::cout << valid << " of " << patches->size() << " patches are valid\n";
  return valid == 5 ? 0 : 1;
}
