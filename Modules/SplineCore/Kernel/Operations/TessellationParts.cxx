// SPDX-License-Identifier: BSD-3-Clause
#include "TessellationParts.h"

#include "Parallel.h"
#include "SpaceFamily.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}
}

template <int Dim>
std::vector<std::vector<ChartCell<Dim>>> MakeCharts(
  const std::vector<BezierForm<Dim>>& patches, int& numCharts)
{
  std::vector<std::vector<ChartCell<Dim>>> cells;
  numCharts = 0;
  for (const BezierForm<Dim>& form : patches)
  {
    cells.push_back(FamilyOf(*form.Space).Charts(*form.Space, numCharts));
  }
  return cells;
}

std::size_t VertexTable::Place(const ChartPoint& point) const
{
  std::uint64_t h = static_cast<std::uint64_t>(point.Chart);
  for (const std::int64_t x : point.X)
  {
    h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  h ^= h >> 32;
  const std::size_t last = this->Slots.size() - 1;
  std::size_t slot = static_cast<std::size_t>(h) & last;
  while (this->Slots[slot] >= 0 && !(this->Points[At(this->Slots[slot])] == point))
  {
    slot = (slot + 1) & last;
  }
  return slot;
}

void VertexTable::Grow()
{
  this->Slots.assign(std::max<std::size_t>(64, 2 * this->Slots.size()), -1);
  for (std::size_t v = 0; v < this->Points.size(); ++v)
  {
    this->Slots[this->Place(this->Points[v])] = static_cast<int>(v);
  }
}

int VertexTable::NumberOf(const ChartPoint& point)
{
  if (!this->Lattices.empty())
  {
    const ChartLattice& lattice = this->Lattices[At(point.Chart)];
    std::int64_t number = 0;
    for (std::size_t d = 3; d-- > 0;)
    {
      number = number * lattice.Count[d] + ((point.X[d] - lattice.Lower[d]) >> lattice.Shift[d]);
    }
    return lattice.First + static_cast<int>(number);
  }
  if (2 * this->Points.size() >= this->Slots.size())
  {
    this->Grow();
  }
  int& vertex = this->Slots[this->Place(point)];
  if (vertex < 0)
  {
    vertex = this->Sets.Add();
    this->Points.push_back(point);
  }
  return vertex;
}

void SideMatcher::Add(const PatchSide& side, const std::array<std::int64_t, 2>& count,
  const std::vector<double>& points)
{
  std::vector<int> numbers;
  for (std::size_t i = 0; i < points.size(); i += At(this->Planes))
  {
    numbers.push_back(this->Clusters.Number(points.data() + i));
  }
  this->Sides.Add(side, count, numbers);
}

template <int K>
Result<std::vector<SecondDerivativeBound<K>>> FindBounds(std::size_t count,
  const TessellationParams& params,
  const std::function<SecondDerivativeBound<K>(std::size_t)>& boundOf)
{
  constexpr std::size_t size = std::tuple_size_v<SecondDerivativeBound<K>>;
  std::vector<SecondDerivativeBound<K>> bounds(count);
  const auto part = static_cast<std::size_t>(params.Part);
  const auto parts = static_cast<std::size_t>(params.Parts);
  const std::size_t first = params.Exchange ? count * part / parts : 0;
  const std::size_t last = params.Exchange ? count * (part + 1) / parts : count;
  ParallelFor(last - first, 16, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = first + begin; i < first + end; ++i)
      {
        bounds[i] = boundOf(i);
      }
    });
  if (params.Exchange)
  {
    double* values = bounds.empty() ? nullptr : bounds.front().data();
    const std::vector<double> all =
      params.Exchange(std::vector<double>(values + first * size, values + last * size));
    if (all.size() != count * size)
    {
      return { ErrorCode::Aborted, "" };
    }
    std::copy(all.begin(), all.end(), values);
  }
  return bounds;
}

template <int Dim>
double LargestValue(const std::vector<BezierForm<Dim>>& patches)
{
  double largest = 1.0; // the weights of polynomial patches
  for (const BezierForm<Dim>& form : patches)
  {
    for (const double x : form.Data)
    {
      largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

void Cut::Clear()
{
  this->Local.clear();
  this->Shapes.clear();
  this->Corners.clear();
}

void Cut::AddCell(TessellationShape shape, std::initializer_list<int> corners)
{
  this->Shapes.push_back(shape);
  this->Corners.insert(this->Corners.end(), corners);
}

template <int Dim>
BlockSide ExtractSide(const BezierForm<Dim>& form, int element, int direction, int end)
{
  const IntArray<Dim>& degree = form.Space->Elements[At(element)].Degree;
  const int n = NumTensorFunctions<Dim>(degree);
  const int number = 2 * direction + end;
  BlockSide side;
  const auto directions = SideDirections<Dim>(number);
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    side.Axes[k] = static_cast<int>(directions[k]);
    side.Count[k] = degree[directions[k]] + 1;
  }
  IntArray<Dim> count = degree;
  for (int& points : count)
  {
    ++points;
  }
  const double* block = form.Block(element);
  const std::vector<int> places = EntityIndices<Dim>(count, EntityOfSide<Dim>(number));
  side.Points.reserve(places.size() * At(form.NumComponents + 1));
  for (const int at : places)
  {
    for (int c = 0; c < form.NumComponents; ++c)
    {
      side.Points.push_back(block[c * n + at]);
    }
    side.Points.push_back(form.Rational ? block[form.NumComponents * n + at] : 1.0);
  }
  return side;
}

template std::vector<std::vector<ChartCell<1>>> MakeCharts<1>(
  const std::vector<BezierForm<1>>&, int&);
template std::vector<std::vector<ChartCell<2>>> MakeCharts<2>(
  const std::vector<BezierForm<2>>&, int&);
template std::vector<std::vector<ChartCell<3>>> MakeCharts<3>(
  const std::vector<BezierForm<3>>&, int&);
template Result<std::vector<SecondDerivativeBound<2>>> FindBounds<2>(std::size_t,
  const TessellationParams&, const std::function<SecondDerivativeBound<2>(std::size_t)>&);
template Result<std::vector<SecondDerivativeBound<3>>> FindBounds<3>(std::size_t,
  const TessellationParams&, const std::function<SecondDerivativeBound<3>(std::size_t)>&);
template double LargestValue<1>(const std::vector<BezierForm<1>>&);
template double LargestValue<2>(const std::vector<BezierForm<2>>&);
template double LargestValue<3>(const std::vector<BezierForm<3>>&);
template BlockSide ExtractSide<1>(const BezierForm<1>&, int, int, int);
template BlockSide ExtractSide<2>(const BezierForm<2>&, int, int, int);
template BlockSide ExtractSide<3>(const BezierForm<3>&, int, int, int);
}
