// SPDX-License-Identifier: BSD-3-Clause
// The surface of a cube goes onto a sphere.
#include <knotwork/CADFitting/CADFit.h>
#include <knotwork/CADFitting/ImplicitTarget.h>

int main()
{
  // the surface of a cube
  knotwork::CellMesh<2> mesh;
  mesh.NumPoints = 8;
  mesh.Corners = { 0, 2, 1, 3, 4, 5, 6, 7, 0, 1, 4, 5, 2, 6, 3, 7, 0, 4, 2, 6, 1, 3, 5, 7 };
  knotwork::PointMatrix points(8, 3);
  for (int i = 0; i < 8; ++i)
  {
    points.row(i) << (i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5;
  }
  const auto sphere = knotwork::MakeImplicitTarget(
    [](const double* x, double* gradient)
    {
      double value = -1.0;
      for (int d = 0; d < 3; ++d)
      {
        gradient[d] = 2.0 * x[d];
        value += x[d] * x[d];
      }
      return value;
    });
  const auto fit = knotwork::FitToTarget<2>(mesh, points, sphere.Value);
  return fit && fit->Distances.ToTarget.Largest < 0.2 ? 0 : 1;
}
