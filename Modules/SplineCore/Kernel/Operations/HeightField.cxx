// SPDX-License-Identifier: BSD-3-Clause
#include "HeightField.h"

#include <cmath>

namespace knotwork
{
namespace
{
constexpr double SameParameter = 1e-7;
}

bool IsHeightField(const BezierForm<2>& form)
{
  if (!form.Space || !form.Space->HasDomain() || form.Rational || form.NumComponents < 3)
  {
    return false;
  }
  const ParametricBox<2> domain = form.Space->Domain();
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const auto& element = form.Space->Elements[static_cast<std::size_t>(e)];
    const int n = NumTensorFunctions<2>(element.Degree);
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double* plane = form.Block(e) + static_cast<std::ptrdiff_t>(d) * n;
      const double low = element.Box.Lower[d];
      const double step = (element.Box.Upper[d] - low) / element.Degree[d];
      const double tolerance = SameParameter * (domain.Upper[d] - domain.Lower[d]);
      for (int i = 0; i < n; ++i)
      {
        const int k = d == 0 ? i % (element.Degree[0] + 1) : i / (element.Degree[0] + 1);
        if (!(std::fabs(plane[i] - (low + k * step)) <= tolerance))
        {
          return false;
        }
      }
    }
  }
  return true;
}
}
