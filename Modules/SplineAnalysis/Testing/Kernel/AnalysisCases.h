// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshCases.h"
#include <knotwork/SplineAnalysis/GalerkinProblem.h>
#include <knotwork/SplineCore/KnotVector.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>

/// Spaces of all families on bodies with curved boundaries, and their facets.
namespace knotwork::testing
{
struct AnalysisCase
{
  std::string Name;
  GalerkinSpace Space;
  std::vector<CellSide> Boundary;
};

/// A smooth map near the identity that bends boundaries.
inline void Bend(double* x, int dimension, double size = 0.1)
{
  const double a = x[0];
  const double b = x[1];
  const double c = dimension == 3 ? x[2] : 0.3;
  x[0] += size * std::sin(2.0 * b + c);
  x[1] += size * std::cos(1.5 * a - c);
  if (dimension == 3)
  {
    x[2] += size * std::sin(a + 2.0 * b);
  }
}

template <int Dim>
AnalysisCase CaseOf(const std::string& name, const Spline<Dim>& spline)
{
  AnalysisCase result{ name, MakeGalerkinSpace(spline).Value, {} };
  result.Boundary = BoundaryFacets(result.Space).Value;
  // side by side: a first part of them is whole sides where there are such
  std::stable_sort(result.Boundary.begin(), result.Boundary.end(),
    [](const CellSide& a, const CellSide& b) { return a.Side < b.Side; });
  return result;
}

template <int Dim>
std::vector<Spline<Dim>> ShapePatches(const ShapeParams& params)
{
  std::vector<Spline<Dim>> patches;
  for (const AnySpline& any : MakeShape(params).Value)
  {
    patches.push_back(std::get<Spline<Dim>>(any));
    patches.back().ControlPoints = patches.back().ControlPoints.leftCols(Dim).eval();
  }
  return patches;
}

template <int Dim>
AnalysisCase MultiPatchCase(const std::string& name, const ShapeParams& params)
{
  MultiPatch<Dim> patches;
  patches.Patches = ShapePatches<Dim>(params);
  patches.Topology.Interfaces = FindInterfaces(patches.Patches);
  AnalysisCase result{ name, MakeGalerkinSpace(patches).Value, {} };
  result.Boundary = BoundaryFacets(result.Space).Value;
  return result;
}

/// The bent unit square or cube, uniform.
template <int Dim>
Spline<Dim> BentBox(int degree, int elements, double size = 0.1)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, elements));
  Spline<Dim> spline;
  spline.Space = MakeTensorSpace<Dim>(knots).Value;
  spline.ControlPoints = GrevillePoints(*spline.Space);
  for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
  {
    Bend(spline.ControlPoints.row(i).data(), Dim, size);
  }
  return spline;
}

/// Sectors of radius 1 around a point, in space swept along z from 0 to 1.
/// @param map  moves the vertices.
template <int Dim>
Spline<Dim> MappedStar(
  int valence, int n, int layers, int degree, const std::function<void(double*)>& map)
{
  const CellMesh<2> base = meshes::Star(valence, n);
  CellMesh<Dim> mesh;
  if constexpr (Dim == 2)
  {
    mesh = base;
  }
  else
  {
    mesh = meshes::Sweep(base, layers);
  }
  PointMatrix vertices(mesh.NumPoints, Dim);
  for (int cell = 0; cell < mesh.NumCells(); ++cell)
  {
    const int flat = cell % base.NumCells();
    const int s = flat / (n * n);
    const int c = flat % (n * n);
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      const double i = static_cast<double>(c % n + (corner & 1)) / n;
      const double j = static_cast<double>(c / n + (corner >> 1 & 1)) / n;
      const double step = 8.0 * std::atan(1.0) / valence;
      double* x = vertices.row(mesh.Cell(cell)[corner]).data();
      x[0] = i * std::cos(s * step) + j * std::cos((s + 1) * step);
      x[1] = i * std::sin(s * step) + j * std::sin((s + 1) * step);
      if constexpr (Dim == 3)
      {
        x[2] = static_cast<double>(cell / base.NumCells() + (corner >> 2)) / layers;
      }
    }
  }
  for (Eigen::Index i = 0; i < vertices.rows(); ++i)
  {
    map(vertices.row(i).data());
  }
  UnstructuredParams params;
  params.Degree = degree;
  const auto space = MakeUnstructuredSpace<Dim>(mesh, params);
  return SplineThroughVertices<Dim>(space->Space, vertices).Value;
}

template <int Dim>
Spline<Dim> BentStar(int valence, int n, int degree, int layers = 2)
{
  return MappedStar<Dim>(valence, n, layers, degree, [](double* x) { Bend(x, Dim, 0.05); });
}

/// A map of the unit square or cube by Lagrange elements, n a direction; boxes are cut into
/// simplices along their diagonals. @param straight  elements are those of their corners.
inline AnalysisCase MappedLagrangeCase(
  CellShape shape, int order, int n, const std::function<void(double*)>& map, bool straight = false)
{
  const int dimension = NumParameters(shape);
  const bool simplex = shape == CellShape::Triangle || shape == CellShape::Tetrahedron;
  const int m = order * n + 1;
  LagrangeMesh mesh;
  mesh.Nodes.resize(dimension == 2 ? m * m : m * m * m, dimension);
  const auto number = [&](const std::array<int, 3>& i)
  { return i[0] + m * (i[1] + (dimension == 3 ? m * i[2] : 0)); };
  for (int node = 0; node < mesh.Nodes.rows(); ++node)
  {
    double* x = mesh.Nodes.row(node).data();
    x[0] = static_cast<double>(node % m) / (m - 1);
    x[1] = static_cast<double>(node / m % m) / (m - 1);
    if (dimension == 3)
    {
      x[2] = static_cast<double>(node / m / m) / (m - 1);
    }
    map(x);
  }
  // corners of an element as offsets in a box: origin, then the ends of the directions
  std::vector<std::vector<std::array<int, 3>>> pieces;
  if (!simplex)
  {
    pieces = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  }
  else if (dimension == 2)
  {
    pieces = { { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 } },
      { { 0, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } } };
  }
  else
  {
    std::array<int, 3> order3{ 0, 1, 2 };
    do
    {
      std::vector<std::array<int, 3>> corners(4);
      for (std::size_t k = 0; k < 3; ++k)
      {
        corners[k + 1] = corners[k];
        corners[k + 1][static_cast<std::size_t>(order3[k])] = 1;
      }
      const bool odd = (order3[1] - order3[0] + 3) % 3 == 2;
      if (odd)
      {
        std::swap(corners[1], corners[2]);
      }
      pieces.push_back(corners);
    } while (std::next_permutation(order3.begin(), order3.end()));
  }
  const CellDegree degree{ order, order, dimension == 3 ? order : 0 };
  for (int box = 0; box < (dimension == 2 ? n * n : n * n * n); ++box)
  {
    const std::array<int, 3> at{ box % n, box / n % n, box / n / n };
    for (const auto& corners : pieces)
    {
      mesh.Shapes.push_back(shape);
      mesh.Orders.push_back(order);
      std::vector<int> nodes(static_cast<std::size_t>(NumCellCoefficients(shape, degree)));
      for (int k = 0; k <= degree[2]; ++k)
      {
        for (int j = 0; j <= order; ++j)
        {
          for (int i = 0; i <= order; ++i)
          {
            if (simplex && i + j + k > order)
            {
              continue;
            }
            std::array<int, 3> place{};
            for (std::size_t d = 0; d < 3; ++d)
            {
              const int o = corners[0][d];
              place[d] = at[d] * order + o * order + i * (corners[1][d] - o) +
                j * (corners[2][d] - o) + (dimension == 3 ? k * (corners[3][d] - o) : 0);
            }
            const int node = number(place);
            nodes[static_cast<std::size_t>(CellCoefficient(shape, degree, i, j, k))] = node;
            const std::array<int, 3> steps{ i, j, k };
            Eigen::RowVectorXd middle = Eigen::RowVectorXd::Zero(dimension);
            for (std::size_t c = 0; straight && c < static_cast<std::size_t>(dimension) + 1; ++c)
            {
              std::array<int, 3> end{};
              for (std::size_t d = 0; d < 3; ++d)
              {
                end[d] = (at[d] + corners[c][d]) * order;
              }
              const int share = c == 0 ? order - i - j - k : steps[c - 1];
              middle += static_cast<double>(share) / order * mesh.Nodes.row(number(end));
            }
            if (straight)
            {
              mesh.Nodes.row(node) = middle;
            }
          }
        }
      }
      mesh.NodeIds.insert(mesh.NodeIds.end(), nodes.begin(), nodes.end());
    }
  }
  AnalysisCase result{ "Lagrange shape " + std::to_string(static_cast<int>(shape)) + " order " +
      std::to_string(order),
    MakeGalerkinSpace(mesh).Value, {} };
  result.Boundary = BoundaryFacets(result.Space).Value;
  return result;
}

/// The bent unit square or cube. @param size  of the bends.
inline AnalysisCase LagrangeCase(CellShape shape, int order, int n, double size = 0.1)
{
  const int dimension = NumParameters(shape);
  return MappedLagrangeCase(
    shape, order, n, [dimension, size](double* x) { Bend(x, dimension, size); });
}
}
