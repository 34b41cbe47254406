// SPDX-License-Identifier: BSD-3-Clause
#include "CellMaps.h"

#include "ExactForm.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace knotwork
{
namespace
{
constexpr double EdgeTolerance = 1e-6;      // of an edge's length
constexpr double HeightTolerance = 0x1p-48; // of z

double Height(const BernsteinCells& cells, int cell, int i, int n)
{
  const double* z = cells.Block(cell) + 2 * n;
  return cells.Rational ? z[i] / z[n + i] : z[i];
}

bool IsSame(double z, double other)
{
  return std::fabs(z - other) <= HeightTolerance * std::max(std::fabs(z), std::fabs(other));
}

/// The straight line between the ends of an edge of a cell.
struct Chord
{
  std::array<double, 3> Middle{};
  std::array<double, 3> Half{};
  double Length = 0.0;
  double Place = 0.0; ///< of the middle along a direction in which lattices do not line up
  int Surface = 0;
};

void AddEdges(const BernsteinCells& cells, int cell, int surface, std::vector<SurfaceEdge>& edges)
{
  const std::size_t at = static_cast<std::size_t>(cell);
  const CellShape shape = cells.Shapes[at];
  const CellDegree& degree = cells.Degrees[at];
  const int n = NumCellCoefficients(shape, degree);
  const double* block = cells.Block(cell);
  const auto corner = [&](int c)
  {
    const auto u = CornerParameters(shape, c);
    const int i = CellCoefficient(
      shape, degree, static_cast<int>(u[0]) * degree[0], static_cast<int>(u[1]) * degree[1], 0);
    std::array<double, 3> x{};
    for (int d = 0; d < 3; ++d)
    {
      x[static_cast<std::size_t>(d)] =
        cells.Rational ? block[d * n + i] / block[3 * n + i] : block[d * n + i];
    }
    return x;
  };
  constexpr std::array<std::array<int, 2>, 4> ends{ { { 0, 1 }, { 0, 2 }, { 1, 3 }, { 2, 3 } } };
  constexpr std::array<std::array<int, 2>, 3> triangle{ { { 0, 1 }, { 0, 2 }, { 1, 2 } } };
  const std::size_t count = shape == CellShape::Triangle ? 3 : 4;
  for (std::size_t e = 0; e < count; ++e)
  {
    const auto& [first, last] = count == 3 ? triangle[e] : ends[e];
    edges.push_back({ surface, { corner(first), corner(last) } });
  }
}

std::vector<Chord> ChordsOf(const std::vector<SurfaceEdge>& edges)
{
  std::vector<Chord> chords;
  for (const SurfaceEdge& edge : edges)
  {
    const auto& [a, b] = edge.Ends;
    Chord chord;
    chord.Surface = edge.Surface;
    for (std::size_t d = 0; d < 3; ++d)
    {
      chord.Middle[d] = 0.5 * (a[d] + b[d]);
      chord.Half[d] = 0.5 * (b[d] - a[d]);
    }
    chord.Length = 2.0 * std::hypot(chord.Half[0], chord.Half[1], chord.Half[2]);
    chord.Place = 0.6711 * chord.Middle[0] + 0.5493 * chord.Middle[1] + 0.4983 * chord.Middle[2];
    if (chord.Length > 0.0)
    {
      chords.push_back(chord);
    }
  }
  return chords;
}

bool Coincide(const Chord& a, const Chord& b)
{
  const double tolerance = 0.5 * EdgeTolerance * std::min(a.Length, b.Length);
  bool same = true;
  bool turned = true;
  for (std::size_t d = 0; d < 3; ++d)
  {
    same = same && std::fabs(a.Middle[d] - b.Middle[d]) <= tolerance &&
      std::fabs(a.Half[d] - b.Half[d]) <= tolerance;
    turned = turned && std::fabs(a.Middle[d] - b.Middle[d]) <= tolerance &&
      std::fabs(a.Half[d] + b.Half[d]) <= tolerance;
  }
  return same || turned;
}

void JoinAtEdges(std::vector<Chord>& chords, DisjointSets& surfaces)
{
  std::sort(
    chords.begin(), chords.end(), [](const Chord& a, const Chord& b) { return a.Place < b.Place; });
  for (std::size_t i = 0; i < chords.size(); ++i)
  {
    const double reach = chords[i].Place + EdgeTolerance * chords[i].Length;
    for (std::size_t k = i + 1; k < chords.size() && chords[k].Place <= reach; ++k)
    {
      if (Coincide(chords[i], chords[k]))
      {
        surfaces.Unite(chords[i].Surface, chords[k].Surface);
      }
    }
  }
}

/// One coordinate after the other of a cell whose weights are all the same.
/// @return false when they differ, or when a coordinate is not known exactly.
bool Coordinates(const BernsteinCells& cells, int cell, std::vector<double>& values)
{
  const std::size_t at = static_cast<std::size_t>(cell);
  const int n = NumCellCoefficients(cells.Shapes[at], cells.Degrees[at]);
  const double* block = cells.Block(cell);
  const double* w = block + cells.NumComponents * n;
  values.assign(block, w);
  if (!cells.Rational || std::any_of(w, w + n, [w](double x) { return x != w[0]; }))
  {
    return !cells.Rational;
  }
  const double* rest =
    cells.Remainders.empty() ? nullptr : cells.Remainders.data() + cells.Offsets[at];
  for (std::size_t i = 0; w[0] != 1.0 && i < values.size(); ++i)
  {
    if (values[i] != 0.0 && !Quotient(values[i], rest ? rest[i] : 0.0, w[0], values[i]))
    {
      return false;
    }
  }
  return w[0] == 1.0 || cells.Uncertainty(cell) == 0.0;
}

/// The least double e so that e - b is not below a.
double Above(double a, double b)
{
  double sum = a + b;
  while (sum - b < a)
  {
    sum = std::nextafter(sum, std::numeric_limits<double>::infinity());
  }
  return sum;
}

/// Cells of one kind with their numbers in the dataset.
struct Kind
{
  BernsteinCells Cells;
  std::vector<int> Origin;
};

std::vector<Kind> KindsOf(const BernsteinCells& cells, const CellMaps& maps)
{
  std::array<std::vector<int>, 4> lists; // plane or space, polynomial or rational
  std::vector<double> values;
  const auto add = [&](const std::vector<int>& list, std::size_t space)
  {
    for (const int cell : list)
    {
      lists[2 * space + (Coordinates(cells, cell, values) ? 0 : 1)].push_back(cell);
    }
  };
  for (const auto& plane : maps.Planes)
  {
    add(plane, 0);
  }
  add(maps.Volumes, 1);
  add(maps.Others, 1);
  std::vector<Kind> kinds;
  for (std::size_t k = 0; k < lists.size(); ++k)
  {
    if (!lists[k].empty())
    {
      std::sort(lists[k].begin(), lists[k].end());
      kinds.push_back({ SelectCells(cells, lists[k], k < 2 ? 2 : 3), std::move(lists[k]) });
    }
  }
  return kinds;
}

int Rank(InjectivityVerdict verdict)
{
  switch (verdict)
  {
    case InjectivityVerdict::NotInjective:
      return 0;
    case InjectivityVerdict::Undecided:
      return 1;
    case InjectivityVerdict::InjectiveUpToSeam:
      return 2;
    case InjectivityVerdict::Injective:
      break;
  }
  return 3;
}

/// What a complex says of some of its cells.
CellComplex Part(
  const CellComplex& complex, const BernsteinCells& cells, const std::vector<int>& which)
{
  CellComplex part;
  for (const int cell : which)
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    if (!complex.Patches.empty())
    {
      part.Patches.push_back(complex.Patches[at]);
    }
    if (!complex.Boxes.empty())
    {
      part.Boxes.push_back(complex.Boxes[at]);
    }
    if (!complex.PointIds.empty())
    {
      const auto planes = static_cast<std::size_t>(cells.NumPlanes());
      const auto first = complex.PointIds.begin();
      part.PointIds.insert(part.PointIds.end(),
        first + static_cast<std::ptrdiff_t>(cells.Offsets[at] / planes),
        first + static_cast<std::ptrdiff_t>(cells.Offsets[at + 1] / planes));
    }
  }
  return part;
}

/// Adds what is proved of some of the cells to what is proved of others.
void Merge(const InjectivityCertificate& part, const std::vector<int>& origin, bool isFirst,
  InjectivityCertificate& all)
{
  const auto name = [&](int& cell)
  { cell = cell < 0 ? cell : origin[static_cast<std::size_t>(cell)]; };
  if (isFirst || Rank(part.Verdict) < Rank(all.Verdict))
  {
    all.Verdict = part.Verdict;
    all.Reason = part.Reason;
    all.HasWitness = part.HasWitness;
    all.Witness = part.Witness;
    for (auto& place : all.Witness.Places)
    {
      name(place.Cell);
    }
  }
  for (InterfaceGap gap : part.Gaps)
  {
    name(gap.Cells[0]);
    name(gap.Cells[1]);
    all.Gaps.push_back(gap);
  }
  all.NumBoundarySides += part.NumBoundarySides;
  all.NumBoundaryComponents += part.NumBoundaryComponents;
  all.NumInterfaces += part.NumInterfaces;
  all.NumSeams += part.NumSeams;
  all.NumCollapsedSides += part.NumCollapsedSides;
  all.NumTouching += part.NumTouching;
  all.InnerRounding = std::max(all.InnerRounding, part.InnerRounding);
  all.Boxes += part.Boxes;
}
}

std::vector<SurfaceCell> SurfaceCellsOf(
  const BernsteinCells& cells, const std::vector<std::int64_t>& patches)
{
  std::vector<SurfaceCell> surfaces;
  for (int cell = 0; cell < cells.NumCells(); ++cell)
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    if (NumParameters(cells.Shapes[at]) != 2)
    {
      continue;
    }
    const int n = NumCellCoefficients(cells.Shapes[at], cells.Degrees[at]);
    SurfaceCell surface{ patches.empty() ? -1 : patches[at], true, Height(cells, cell, 0, n) };
    for (int i = 1; i < n && surface.IsFlat; ++i)
    {
      surface.IsFlat = IsSame(Height(cells, cell, i, n), surface.Height);
    }
    surfaces.push_back(surface);
  }
  return surfaces;
}

std::vector<SurfaceEdge> SurfaceEdgesOf(const BernsteinCells& cells)
{
  std::vector<SurfaceEdge> edges;
  int surface = 0;
  for (int cell = 0; cell < cells.NumCells(); ++cell)
  {
    if (NumParameters(cells.Shapes[static_cast<std::size_t>(cell)]) == 2)
    {
      AddEdges(cells, cell, surface++, edges);
    }
  }
  return edges;
}

bool NeedsEdges(const std::vector<SurfaceCell>& cells)
{
  const bool someFlat =
    std::any_of(cells.begin(), cells.end(), [](const SurfaceCell& cell) { return cell.IsFlat; });
  const bool onePlane = std::all_of(cells.begin(), cells.end(),
    [&](const SurfaceCell& cell) { return cell.IsFlat && IsSame(cell.Height, cells[0].Height); });
  return someFlat && !onePlane;
}

std::vector<bool> FindPlanes(
  const std::vector<SurfaceCell>& cells, const std::vector<SurfaceEdge>& edges)
{
  std::vector<bool> isOfPlane;
  for (const SurfaceCell& cell : cells)
  {
    isOfPlane.push_back(cell.IsFlat);
  }
  if (!NeedsEdges(cells))
  {
    return isOfPlane;
  }
  DisjointSets surfaces(static_cast<int>(cells.size()));
  std::map<std::int64_t, int> firstOfPatch;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    const int number = static_cast<int>(i);
    if (cells[i].Patch >= 0)
    {
      surfaces.Unite(number, firstOfPatch.emplace(cells[i].Patch, number).first->second);
    }
  }
  std::vector<Chord> chords = ChordsOf(edges);
  JoinAtEdges(chords, surfaces);
  std::vector<bool> isPlane(cells.size(), true); // by root
  const auto rootOf = [&surfaces](std::size_t i)
  { return static_cast<std::size_t>(surfaces.Find(static_cast<int>(i))); };
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    const std::size_t root = rootOf(i);
    isPlane[root] = isPlane[root] && cells[i].IsFlat && IsSame(cells[i].Height, cells[root].Height);
  }
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    isOfPlane[i] = isPlane[rootOf(i)];
  }
  return isOfPlane;
}

CellMaps FindCellMaps(const BernsteinCells& cells, const std::vector<int>& patches)
{
  const auto surfaces = SurfaceCellsOf(cells, { patches.begin(), patches.end() });
  return MakeCellMaps(cells,
    FindPlanes(
      surfaces, NeedsEdges(surfaces) ? SurfaceEdgesOf(cells) : std::vector<SurfaceEdge>()));
}

CellMaps MakeCellMaps(const BernsteinCells& cells, const std::vector<bool>& isOfPlane)
{
  CellMaps maps;
  std::vector<std::pair<double, int>> flat; // heights and cells
  std::size_t next = 0;
  for (int cell = 0; cell < cells.NumCells(); ++cell)
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    const int parameters = NumParameters(cells.Shapes[at]);
    if (parameters == 2 && isOfPlane[next++])
    {
      flat.emplace_back(
        Height(cells, cell, 0, NumCellCoefficients(cells.Shapes[at], cells.Degrees[at])), cell);
    }
    else
    {
      (parameters == 3 ? maps.Volumes : maps.Others).push_back(cell);
    }
  }
  std::stable_sort(
    flat.begin(), flat.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double last = 0.0;
  for (const auto& [height, cell] : flat)
  {
    if (maps.Planes.empty() || !IsSame(last, height))
    {
      maps.Planes.emplace_back();
    }
    maps.Planes.back().push_back(cell);
    last = height;
  }
  for (auto& plane : maps.Planes)
  {
    std::sort(plane.begin(), plane.end());
  }
  return maps;
}

BernsteinCells SelectCells(
  const BernsteinCells& cells, const std::vector<int>& which, int numComponents)
{
  BernsteinCells result;
  result.NumComponents = numComponents;
  std::vector<double> values;
  result.Rational = std::any_of(
    which.begin(), which.end(), [&](int cell) { return !Coordinates(cells, cell, values); });
  std::size_t size = 0;
  for (const int cell : which)
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    size += static_cast<std::size_t>(
      NumCellCoefficients(cells.Shapes[at], cells.Degrees[at]) * result.NumPlanes());
  }
  result.Data.reserve(size);
  for (const int cell : which)
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    const std::size_t n =
      static_cast<std::size_t>(NumCellCoefficients(cells.Shapes[at], cells.Degrees[at]));
    const std::size_t coordinates = static_cast<std::size_t>(numComponents) * n;
    double* to = result.Block(result.Add(cells.Shapes[at], cells.Degrees[at]));
    const double* block = cells.Block(cell);
    const double* weights = block + static_cast<std::size_t>(cells.NumComponents) * n;
    double error = cells.Errors.empty() ? 0.0 : cells.Errors[at];
    const bool divided = cells.Rational && !result.Rational && weights[0] != 1.0;
    if (divided)
    {
      Coordinates(cells, cell, values);
      std::copy_n(values.begin(), coordinates, to);
      error = 0.0;
    }
    else
    {
      std::copy_n(block, coordinates, to);
      if (result.Rational)
      {
        std::copy_n(weights, n, to + coordinates);
      }
    }
    if (!cells.Remainders.empty())
    {
      const std::size_t first = result.Remainders.size();
      result.Remainders.resize(result.Data.size());
      double largest = 0.0; // of the components that are left
      for (std::size_t i = 0; !divided && i < coordinates; ++i)
      {
        const double rest = cells.Remainders[cells.Offsets[at] + i];
        result.Remainders[first + i] = rest;
        largest = std::max(largest, std::fabs(rest));
      }
      error = divided ? 0.0 : Above(cells.Uncertainty(cell), largest);
    }
    result.Errors.push_back(error);
  }
  if (std::all_of(
        result.Errors.begin(), result.Errors.end(), [](double error) { return error == 0.0; }))
  {
    result.Errors.clear();
    result.Remainders.clear();
  }
  return result;
}

Result<JacobianCertificate> ValidateMaps(const BernsteinCells& cells, const CellMaps& maps,
  const JacobianParams& params, const ProgressCallback& progress)
{
  if (const Status status = cells.Check(); !status)
  {
    return status;
  }
  const std::vector<Kind> kinds = KindsOf(cells, maps);
  if (kinds.empty())
  {
    return ValidateJacobian(cells, params, progress);
  }
  JacobianCertificate result;
  result.Cells.resize(cells.Shapes.size());
  std::size_t done = 0;
  for (const Kind& kind : kinds)
  {
    const auto report = [&](double part)
    {
      return progress((static_cast<double>(done) + part * static_cast<double>(kind.Origin.size())) /
        static_cast<double>(cells.Shapes.size()));
    };
    const auto proved =
      ValidateJacobian(kind.Cells, params, progress ? ProgressCallback(report) : progress);
    if (!proved)
    {
      return proved.Status;
    }
    for (std::size_t i = 0; i < kind.Origin.size(); ++i)
    {
      result.Cells[static_cast<std::size_t>(kind.Origin[i])] = proved->Cells[i];
    }
    for (JacobianWitness witness : proved->Witnesses)
    {
      witness.Cell = kind.Origin[static_cast<std::size_t>(witness.Cell)];
      result.Witnesses.push_back(witness);
    }
    done += kind.Origin.size();
  }
  std::sort(result.Witnesses.begin(), result.Witnesses.end(),
    [](const JacobianWitness& a, const JacobianWitness& b) { return a.Cell < b.Cell; });
  for (std::size_t w = 0; w < result.Witnesses.size(); ++w)
  {
    result.Cells[static_cast<std::size_t>(result.Witnesses[w].Cell)].Witness =
      static_cast<std::int32_t>(w);
  }
  Summarize(result);
  return result;
}

Result<InjectivityCertificate> ProveMapsInjective(const BernsteinCells& cells, const CellMaps& maps,
  const CellComplex& complex, const JacobianCertificate& certificate,
  const InjectivityParams& params, const ProgressCallback& progress)
{
  std::vector<const std::vector<int>*> lists;
  for (const auto& plane : maps.Planes)
  {
    lists.push_back(&plane);
  }
  if (!maps.Volumes.empty())
  {
    lists.push_back(&maps.Volumes);
  }
  InjectivityCertificate all;
  for (std::size_t k = 0; k < lists.size(); ++k)
  {
    const std::vector<int>& which = *lists[k];
    const bool space = lists[k] == &maps.Volumes;
    JacobianCertificate local; // what the proof asks for: cells, and their witnesses
    local.Witnesses = certificate.Witnesses;
    for (const int cell : which)
    {
      local.Cells.push_back(certificate.Cells[static_cast<std::size_t>(cell)]);
    }
    const auto report = [&](double part)
    { return progress((static_cast<double>(k) + part) / static_cast<double>(lists.size())); };
    const auto proved = ProveInjectivity(SelectCells(cells, which, space ? 3 : 2),
      Part(complex, cells, which), local, params, progress ? ProgressCallback(report) : progress);
    if (!proved)
    {
      return proved.Status;
    }
    Merge(proved.Value, which, k == 0, all);
  }
  return all;
}
}
