// SPDX-License-Identifier: BSD-3-Clause
#include "TessellationParts.h"

#include "SpaceFamily.h"

#include <algorithm>
#include <cmath>

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

std::size_t VertexTable::Hash::operator()(const ChartPoint& p) const
{
  std::uint64_t h = static_cast<std::uint64_t>(p.Chart);
  for (const std::int64_t x : p.X)
  {
    h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return static_cast<std::size_t>(h);
}

int VertexTable::At(const ChartPoint& point)
{
  const auto found = this->Map.find(point);
  if (found != this->Map.end())
  {
    return found->second;
  }
  const int vertex = this->Sets.Add();
  this->Map.emplace(point, vertex);
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

void CellSoup::AddCell(TessellationShape shape, const int* corners, int n, int patch, int element)
{
  this->Shapes.push_back(shape);
  this->Corners.insert(this->Corners.end(), corners, corners + n);
  this->Offsets.push_back(static_cast<std::int64_t>(this->Corners.size()));
  this->CellPatch.push_back(patch);
  this->CellElement.push_back(element);
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
template double LargestValue<1>(const std::vector<BezierForm<1>>&);
template double LargestValue<2>(const std::vector<BezierForm<2>>&);
template double LargestValue<3>(const std::vector<BezierForm<3>>&);
template BlockSide ExtractSide<1>(const BezierForm<1>&, int, int, int);
template BlockSide ExtractSide<2>(const BezierForm<2>&, int, int, int);
template BlockSide ExtractSide<3>(const BezierForm<3>&, int, int, int);
}
