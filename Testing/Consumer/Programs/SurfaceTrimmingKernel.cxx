// SPDX-License-Identifier: BSD-3-Clause
// A flat square of triangles becomes one face with one loop.
#include <knotwork/SurfaceTrimming/TrimSurface.h>

int main()
{
  constexpr int n = 6;
  knotwork::ChartMesh chart;
  chart.Points.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      chart.Points.row(i + (n + 1) * j) << i, j, 0.0;
      chart.PointIds.push_back(i + (n + 1) * j);
      if (i < n && j < n)
      {
        const int a = i + (n + 1) * j;
        chart.Triangles.push_back({ a, a + 1, a + n + 2 });
        chart.Triangles.push_back({ a, a + n + 2, a + n + 1 });
      }
    }
  }
  chart.UV = chart.Points.leftCols(2);
  const auto trimmed = knotwork::TrimSurface({ chart }, {});
  return trimmed && trimmed->Model.Faces.size() == 1 && trimmed->Model.Faces[0].Loops.size() == 1
    ? 0
    : 1;
}
