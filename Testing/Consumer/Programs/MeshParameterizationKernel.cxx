// SPDX-License-Identifier: BSD-3-Clause
// A roof of two planes is laid into the plane without a flipped triangle.
#include <knotwork/MeshParameterization/MeshParameterization.h>

#include <cmath>

int main()
{
  constexpr int n = 8;
  knotwork::TriangleMesh mesh;
  mesh.Points.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      mesh.Points.row(i + (n + 1) * j) << i, j, 0.5 * std::abs(i - n / 2);
      if (i < n && j < n)
      {
        const int a = i + (n + 1) * j;
        mesh.Triangles.push_back({ a, a + 1, a + n + 2 });
        mesh.Triangles.push_back({ a, a + n + 2, a + n + 1 });
      }
    }
  }
  const auto flat = knotwork::FlattenMesh(mesh);
  return flat && flat->UV.rows() == mesh.Points.rows() && flat->Measures.FlippedTriangles == 0 ? 0
                                                                                               : 1;
}
