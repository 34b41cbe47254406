// SPDX-License-Identifier: BSD-3-Clause
// A saddle is within a small tolerance of the surface that is fitted to it.
#include <knotwork/SurfaceFitting/SurfaceFit.h>

int main()
{
  constexpr int n = 30;
  knotwork::PointCloud cloud;
  cloud.Parameters.resize(n * n, 2);
  cloud.Values.resize(n * n, 1);
  for (int i = 0; i < n * n; ++i)
  {
    const double x = i % n;
    const double y = i / n;
    cloud.Parameters.row(i) << x, y;
    cloud.Values(i, 0) = x * x - y * y;
  }
  knotwork::FitParams params;
  params.Tolerance = 1e-3;
  const auto fit = knotwork::FitSurface(cloud, params);
  return fit && fit->Final.NumOutside == 0 ? 0 : 1;
}
