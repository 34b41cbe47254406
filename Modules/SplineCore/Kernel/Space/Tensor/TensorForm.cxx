// SPDX-License-Identifier: BSD-3-Clause
#include "TensorForm.h"

#include "SpaceFamily.h"

namespace knotwork
{
template <int Dim>
Result<Spline<Dim>> ToTensor(const Spline<Dim>& spline, int threads, int maxFunctions)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  return FamilyOf(*spline.Space).TensorForm(spline, threads, maxFunctions);
}

template Result<Spline<1>> ToTensor<1>(const Spline<1>&, int, int);
template Result<Spline<2>> ToTensor<2>(const Spline<2>&, int, int);
template Result<Spline<3>> ToTensor<3>(const Spline<3>&, int, int);
}
