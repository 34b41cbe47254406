// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeComparison.h"

#include <knotwork/JacobianValidation/CellMaps.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
constexpr int FirstDivision = 4;
constexpr int LastDivision = 32;
constexpr std::size_t MaxTriangles = 20000000;

/// Corners of a cell in a row around a facet; triangles end with -1.
using Facet = std::array<int, 4>;

const std::vector<Facet>& FacetsOf(CellShape shape)
{
  static const std::vector<Facet> tetrahedron{ { 0, 2, 1, -1 }, { 0, 1, 3, -1 }, { 1, 2, 3, -1 },
    { 0, 3, 2, -1 } };
  static const std::vector<Facet> wedge{ { 0, 2, 1, -1 }, { 3, 4, 5, -1 }, { 0, 1, 4, 3 },
    { 1, 2, 5, 4 }, { 2, 0, 3, 5 } };
  static const std::vector<Facet> hexahedron{ { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 },
    { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
  return shape == CellShape::Tetrahedron ? tetrahedron
    : shape == CellShape::Wedge          ? wedge
                                         : hexahedron;
}

struct OpenFacet
{
  int Cell = 0;
  Facet Local;  ///< corners of the cell
  Facet Points; ///< of the mesh
};

Result<std::vector<OpenFacet>> FindOpenFacets(
  const BernsteinCells& cells, const std::vector<int>& corners)
{
  std::map<Facet, std::pair<int, OpenFacet>> facets; // by sorted points: how many, the first
  std::size_t begin = 0;
  for (int cell = 0; cell < cells.NumCells(); ++cell)
  {
    const CellShape shape = cells.Shapes[static_cast<std::size_t>(cell)];
    if (NumParameters(shape) != 3)
    {
      return { ErrorCode::DimensionMismatch,
        "cell " + std::to_string(cell) + " is no volume: give tetrahedra, wedges or hexahedra" };
    }
    const auto count = static_cast<std::size_t>(NumCorners(shape));
    if (begin + count > corners.size())
    {
      return { ErrorCode::SizeMismatch, "cell " + std::to_string(cell) + " has no corners" };
    }
    for (const Facet& local : FacetsOf(shape))
    {
      OpenFacet facet{ cell, local, local };
      for (int& point : facet.Points)
      {
        point = point < 0 ? -1 : corners[begin + static_cast<std::size_t>(point)];
      }
      Facet key = facet.Points;
      std::sort(key.begin(), key.end());
      auto& entry = facets.emplace(key, std::pair(0, facet)).first->second;
      if (++entry.first > 2)
      {
        return { ErrorCode::InvalidTopology,
          "a facet of cell " + std::to_string(cell) +
            " belongs to three cells: remove cells that stand there twice" };
      }
    }
    begin += count;
  }
  std::vector<OpenFacet> open;
  for (const auto& [key, entry] : facets)
  {
    if (entry.first == 1)
    {
      open.push_back(entry.second);
    }
  }
  std::sort(open.begin(), open.end(),
    [](const OpenFacet& a, const OpenFacet& b)
    { return std::tie(a.Cell, a.Local) < std::tie(b.Cell, b.Local); });
  return open;
}

/// Divides facets alike; points of edges and corners are made once.
class FacetGrid
{
public:
  FacetGrid(const BernsteinCells& cells, int division) : Cells(cells), Division(division) {}

  void Add(const OpenFacet& facet)
  {
    const int n = this->Division;
    const bool isTriangle = facet.Local[3] < 0;
    std::vector<int> grid(static_cast<std::size_t>((n + 1) * (n + 1)), -1);
    const auto at = [&](int i, int j) -> int&
    { return grid[static_cast<std::size_t>(j * (n + 1) + i)]; };
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i <= (isTriangle ? n - j : n); ++i)
      {
        at(i, j) = this->Point(facet, i, j);
      }
    }
    const auto add = [&](int a, int b, int c)
    {
      this->Out.Mesh.Triangles.push_back({ a, b, c });
      this->Out.Patches.push_back(facet.Cell);
      this->Out.Faces.push_back(0);
    };
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < (isTriangle ? n - j : n); ++i)
      {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (!isTriangle || i + j + 1 < n)
        {
          add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
    // a quarter of the second difference over two steps is what a step deviates by
    const auto bend = [&](int a, int b, int c)
    {
      const auto& points = this->Points;
      const Eigen::RowVector3d middle = points[static_cast<std::size_t>(b)] -
        0.5 * (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(c)]);
      this->Out.Bound = std::max(this->Out.Bound, 0.25 * middle.norm());
    };
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i + 2 <= (isTriangle ? n - j : n); ++i)
      {
        bend(at(i, j), at(i + 1, j), at(i + 2, j));
        bend(at(j, i), at(j, i + 1), at(j, i + 2));
        if (isTriangle)
        {
          bend(at(i, n - j - i), at(i + 1, n - j - i - 1), at(i + 2, n - j - i - 2));
        }
      }
    }
  }

  BoundaryMesh Take()
  {
    this->Out.Mesh.Points.resize(static_cast<Eigen::Index>(this->Points.size()), 3);
    for (std::size_t i = 0; i < this->Points.size(); ++i)
    {
      this->Out.Mesh.Points.row(static_cast<Eigen::Index>(i)) = this->Points[i];
    }
    return std::move(this->Out);
  }

private:
  int Point(const OpenFacet& facet, int i, int j)
  {
    const int n = this->Division;
    const bool isTriangle = facet.Local[3] < 0;
    // shares of the corners, in parts of n (triangle) or n * n
    const std::array<int, 4> share = isTriangle
      ? std::array<int, 4>{ n - i - j, i, j, 0 }
      : std::array<int, 4>{ (n - i) * (n - j), i * (n - j), i * j, (n - i) * j };
    const double all = isTriangle ? n : n * n;
    std::array<int, 3> key{ -1, -1, -1 }; // of an edge its ends and the share of the second
    int met = 0;
    std::array<double, 3> local{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      if (share[k] == 0)
      {
        continue;
      }
      const auto corner =
        CornerParameters(this->Cells.Shapes[static_cast<std::size_t>(facet.Cell)], facet.Local[k]);
      for (std::size_t d = 0; d < 3; ++d)
      {
        local[d] += share[k] / all * corner[d];
      }
      if (met < 2)
      {
        key[static_cast<std::size_t>(met)] = facet.Points[k];
        key[2] = isTriangle ? share[k] : share[k] / n;
      }
      ++met;
    }
    if (met == 1)
    {
      key[2] = 0;
    }
    else if (met == 2 && key[0] > key[1])
    {
      std::swap(key[0], key[1]);
      key[2] = n - key[2];
    }
    const int next = static_cast<int>(this->Points.size());
    if (met <= 2)
    {
      const auto [entry, isNew] = this->Shared.emplace(key, next);
      if (!isNew)
      {
        return entry->second;
      }
    }
    Eigen::RowVector3d point;
    EvaluateCell(this->Cells, facet.Cell, local, point.data());
    this->Points.push_back(point);
    return next;
  }

  const BernsteinCells& Cells;
  int Division;
  std::vector<Eigen::RowVector3d> Points;
  std::map<std::array<int, 3>, int> Shared;
  BoundaryMesh Out;
};

class Stopwatch
{
public:
  /// Since the last call.
  double Seconds()
  {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - this->Start;
    this->Start = now;
    return passed.count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};
}

Result<BoundaryMesh> TriangulateFacets(
  const BernsteinCells& cells, const std::vector<int>& corners, double tolerance)
{
  const auto open = FindOpenFacets(cells, corners);
  if (!open)
  {
    return open.Status;
  }
  if (open->empty())
  {
    return { ErrorCode::EmptyInput, "the cells have no boundary: give cells of a solid" };
  }
  for (int division = FirstDivision;; division *= 2)
  {
    const auto part = static_cast<std::size_t>(2 * division * division);
    if (open->size() * part > MaxTriangles)
    {
      return { ErrorCode::TooLarge,
        "the boundary's " + std::to_string(open->size()) + " facets divided " +
          std::to_string(division) + " times are more than " + std::to_string(MaxTriangles) +
          " triangles: raise the chordal tolerance" };
    }
    FacetGrid grid(cells, division);
    for (const OpenFacet& facet : open.Value)
    {
      grid.Add(facet);
    }
    BoundaryMesh boundary = grid.Take();
    if (boundary.Bound <= tolerance || division == LastDivision)
    {
      const Status status = FinishBoundary(boundary);
      return status ? Result<BoundaryMesh>(std::move(boundary)) : Result<BoundaryMesh>(status);
    }
  }
}

Result<ComparedVolume> CompareVolume(const BernsteinCells& cells, const BoundaryMesh& boundary,
  const FitTarget& reference, const TriangleMesh& triangles, const VolumeComparisonParams& params)
{
  ComparedVolume compared;
  Stopwatch watch;
  const auto part = [&](double begin, double end) -> ProgressCallback
  {
    return [=, &params](double share)
    { return !params.Progress || params.Progress(begin + share * (end - begin)); };
  };
  CellMaps maps;
  maps.Volumes.resize(static_cast<std::size_t>(cells.NumCells()));
  std::iota(maps.Volumes.begin(), maps.Volumes.end(), 0);
  JacobianParams jacobian;
  jacobian.Threads = params.Threads;
  auto certificate = ValidateMaps(cells, maps, jacobian, part(0.0, 0.2));
  if (!certificate)
  {
    return certificate.Status;
  }
  compared.Certificate = std::move(certificate.Value);
  compared.CertificateSeconds = watch.Seconds();
  CellMeasuresParams measures;
  measures.BoundBoxes = params.BoundBoxes;
  measures.Threads = params.Threads;
  auto measured = MeasureCells(cells, measures);
  if (!measured)
  {
    return measured.Status;
  }
  compared.Measures = std::move(measured.Value);
  compared.MeasureSeconds = watch.Seconds();
  DeviationMapParams deviation;
  deviation.Samples = params.Samples;
  deviation.Threads = params.Threads;
  deviation.Progress = part(0.4, 1.0);
  auto map = MapDeviation(boundary.Mesh, reference, triangles, deviation);
  if (!map)
  {
    return map.Status;
  }
  compared.Deviation = std::move(map.Value);
  compared.ToReference = compared.Deviation.ScanProfile.Percentiles.back();
  compared.FromReference = compared.Deviation.ModelProfile.Percentiles.back();
  compared.DistanceSeconds = watch.Seconds();
  return compared;
}

QualityHistogram MakeHistogram(const CellMeasures& measures, int bins)
{
  QualityHistogram histogram;
  for (int i = 0; i <= bins; ++i)
  {
    histogram.Edges.push_back(-1.0 + 2.0 * i / bins);
  }
  histogram.Guaranteed.assign(static_cast<std::size_t>(bins), 0);
  histogram.Attained = histogram.Guaranteed;
  const auto bin = [bins](double value)
  {
    return static_cast<std::size_t>(
      std::clamp(static_cast<int>(0.5 * (value + 1.0) * bins), 0, bins - 1));
  };
  for (const CellMeasure& cell : measures.Cells)
  {
    ++histogram.Guaranteed[bin(cell.ScaledLower)];
    ++histogram.Attained[bin(cell.ScaledMin)];
  }
  return histogram;
}
}
