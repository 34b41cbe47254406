// SPDX-License-Identifier: BSD-3-Clause
// Orders of convergence of splines in space, on curved bodies.
#include "Rates.h"

namespace knotwork::testing
{
namespace
{
/// A star of five sectors swept along z, n layers, bent.
AnalysisCase SweptStar(int n, int degree)
{
  const int valence = 5;
  const CellMesh<2> base = meshes::Star(valence, n);
  const CellMesh<3> mesh = meshes::Sweep(base, n);
  PointMatrix vertices(mesh.NumPoints, 3);
  for (int cell = 0; cell < mesh.NumCells(); ++cell)
  {
    const int flat = cell % base.NumCells();
    const int s = flat / (n * n);
    const int c = flat % (n * n);
    for (int corner = 0; corner < 8; ++corner)
    {
      const double i = static_cast<double>(c % n + (corner & 1)) / n;
      const double j = static_cast<double>(c / n + (corner >> 1 & 1)) / n;
      const double step = 8.0 * std::atan(1.0) / valence;
      double* x = vertices.row(mesh.Cell(cell)[corner]).data();
      x[0] = i * std::cos(s * step) + j * std::cos((s + 1) * step);
      x[1] = i * std::sin(s * step) + j * std::sin((s + 1) * step);
      x[2] = static_cast<double>(cell / base.NumCells() + (corner >> 2)) / n;
    }
  }
  for (Eigen::Index i = 0; i < vertices.rows(); ++i)
  {
    Bend(vertices.row(i).data(), 3, 0.05);
  }
  UnstructuredParams params;
  params.Degree = degree;
  const auto space = MakeUnstructuredSpace<3>(mesh, params);
  return CaseOf<3>("", SplineThroughVertices<3>(space->Space, vertices).Value);
}

AnalysisCase Cylinder(int n, int degree)
{
  ShapeParams cylinder;
  cylinder.Kind = ShapeKind::SolidCylinder;
  cylinder.Degree = degree;
  cylinder.Elements = { n, n, n };
  return MultiPatchCase<3>("", cylinder);
}

/// The bent cube with an eighth of its elements split.
AnalysisCase RefinedBox(int n, int degree)
{
  const Spline<3> box = BentBox<3>(degree, n);
  std::vector<int> marked;
  for (int e = 0; e < box.Space->NumElements(); ++e)
  {
    if (e % n < n / 2 && e / n % n < n / 2 && e / n / n < n / 2)
    {
      marked.push_back(e);
    }
  }
  return CaseOf<3>("", RefineMarkedElements(box, marked)->Value);
}
}

TEST(RatesInSpace, PoissonOnSplines_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    ExpectRates("tensor", p, 6, [p](int n) { return CaseOf<3>("", BentBox<3>(p, n)); });
    ExpectRates("THB", p, 6, [p](int n) { return RefinedBox(n, p); });
    ExpectRates("multi-patch, rational", p, p == 2 ? 5 : 4, [p](int n) { return Cylinder(n, p); });
    ExpectRates("unstructured", p, 4, [p](int n) { return SweptStar(n, p); });
  }
}
}
