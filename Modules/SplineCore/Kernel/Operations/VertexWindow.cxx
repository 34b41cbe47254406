// SPDX-License-Identifier: BSD-3-Clause
#include "VertexWindow.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Values at t of the polynomials that are 1 at one node and 0 at the others.
void LagrangeValues(const std::vector<double>& nodes, double t, double* values)
{
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    values[i] = 1.0;
    for (std::size_t j = 0; j < nodes.size(); ++j)
    {
      values[i] *= j == i ? 1.0 : (t - nodes[j]) / (nodes[i] - nodes[j]);
    }
  }
}
}

template <int Dim>
VertexWindow<Dim>::VertexWindow(const UnstructuredData<Dim>& data, int cell, int most) : Data(data)
{
  this->Size.fill(1);
  Place place{ cell, {} };
  for (int d = 0; d < Dim; ++d)
  {
    place.Ahead[At(d)] = 2 * d + 1;
  }
  this->Places.push_back(place);
  this->Widen(most);
  this->TakeNodes();
  this->TakePoints();
}

/// As far to both sides as half of the width first, so that the cell is in the middle; then where
/// there is room.
template <int Dim>
void VertexWindow<Dim>::Widen(int most)
{
  for (int step = 0; step < most / 2; ++step)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      for (const bool upper : { false, true })
      {
        this->AddLayer(d, upper);
      }
    }
  }
  for (std::size_t d = 0; d < Dim; ++d)
  {
    while (this->Size[d] < most && (this->AddLayer(d, false) || this->AddLayer(d, true)))
    {
    }
  }
}

template <int Dim>
int VertexWindow<Dim>::Stride(std::size_t direction) const
{
  int stride = 1;
  for (std::size_t d = 0; d < direction; ++d)
  {
    stride *= this->Size[d];
  }
  return stride;
}

template <int Dim>
bool VertexWindow<Dim>::Cross(const Place& from, std::size_t direction, bool upper, Place& to) const
{
  const int side = upper ? from.Ahead[direction] : from.Ahead[direction] ^ 1;
  if (this->Data.ContinuityOf(from.Cell, side) <= 0)
  {
    return false;
  }
  to.Cell = this->Data.Topology.Neighbour(from.Cell, side);
  const FacetCrossing<Dim>& crossing = this->Data.Topology.Crossing(from.Cell, side);
  for (std::size_t k = 0; k < Dim; ++k)
  {
    to.Ahead[k] = crossing.Image[At(from.Ahead[k])];
  }
  return true;
}

/// One more layer of cells at an end, if there is one that is a grid itself.
template <int Dim>
bool VertexWindow<Dim>::AddLayer(std::size_t direction, bool upper)
{
  const int stride = this->Stride(direction);
  const int width = this->Size[direction];
  std::vector<Place> layer; // in the order of the places beside it
  for (std::size_t i = 0; i < this->Places.size(); ++i)
  {
    if (static_cast<int>(i) / stride % width != (upper ? width - 1 : 0))
    {
      continue;
    }
    Place next;
    if (!this->Cross(this->Places[i], direction, upper, next))
    {
      return false;
    }
    layer.push_back(next);
  }
  int inLayer = 1;
  for (std::size_t k = 0; k < Dim; ++k)
  {
    for (std::size_t i = 0; k != direction && i < layer.size(); ++i)
    {
      Place beside;
      if (static_cast<int>(i) / inLayer % this->Size[k] + 1 < this->Size[k] &&
        (!this->Cross(layer[i], k, true, beside) || beside.Cell != layer[i + At(inLayer)].Cell))
      {
        return false;
      }
    }
    inLayer *= k == direction ? 1 : this->Size[k];
  }
  std::vector<Place> wider;
  wider.reserve(this->Places.size() + layer.size());
  const int block = stride * width; // places with one index in the directions after this one
  for (std::size_t i = 0; i < this->Places.size() / At(block); ++i)
  {
    const auto old = this->Places.begin() + static_cast<std::ptrdiff_t>(i) * block;
    const auto added = layer.begin() + static_cast<std::ptrdiff_t>(i) * stride;
    wider.insert(wider.end(), upper ? old : added, upper ? old + block : added + stride);
    wider.insert(wider.end(), upper ? added : old, upper ? added + stride : old + block);
  }
  this->Places = std::move(wider);
  ++this->Size[direction];
  this->Root[direction] += upper ? 0 : 1;
  return true;
}

/// All places of a layer have one interval: it is that of the sheet.
template <int Dim>
void VertexWindow<Dim>::TakeNodes()
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    std::vector<double>& nodes = this->Nodes[d];
    nodes.assign(1, 0.0);
    for (int i = 0; i < this->Size[d]; ++i)
    {
      const Place& place = this->Places[At(i * this->Stride(d))];
      nodes.push_back(nodes.back() + this->Data.Length(place.Cell, place.Ahead[d] / 2));
    }
    const double begin = nodes[At(this->Root[d])];
    const double length = nodes[At(this->Root[d]) + 1] - begin;
    for (double& node : nodes)
    {
      node = (node - begin) / length;
    }
  }
}

template <int Dim>
void VertexWindow<Dim>::TakePoints()
{
  int count = 1;
  for (const int n : this->Size)
  {
    count *= n + 1;
  }
  IntArray<Dim> index{};
  for (int i = 0; i < count; ++i)
  {
    std::size_t at = 0;
    for (std::size_t d = Dim; d-- > 0;)
    {
      at = at * At(this->Size[d]) + At(std::min(index[d], this->Size[d] - 1));
    }
    const Place& place = this->Places[at];
    int corner = 0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const int end = place.Ahead[d] ^ (index[d] == this->Size[d] ? 0 : 1);
      corner |= end % 2 << end / 2;
    }
    this->Points.push_back(this->Data.Mesh.Cell(place.Cell)[corner]);
    for (std::size_t d = 0; d < Dim && ++index[d] > this->Size[d]; ++d)
    {
      index[d] = 0;
    }
  }
}

/// Direction by direction, the last one first; what the point before had in common is kept, which
/// is most of it on grids of points.
template <int Dim>
void VertexWindow<Dim>::Interpolate(
  const PointMatrixView& local, const PointMatrixView& vertices, PointMatrix& values) const
{
  std::array<PointMatrix, Dim + 1> partial; // values after the directions from d on
  partial[Dim].resize(static_cast<Eigen::Index>(this->Points.size()), vertices.cols());
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    partial[Dim].row(static_cast<Eigen::Index>(i)) = vertices.row(this->Points[i]);
  }
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    bool kept = i > 0;
    for (std::size_t d = Dim; d-- > 0;)
    {
      const auto column = static_cast<Eigen::Index>(d);
      kept = kept && local(i, column) == local(i - 1, column);
      if (kept)
      {
        continue;
      }
      double factors[MaxDegree + 5];
      LagrangeValues(this->Nodes[d], local(i, column), factors);
      const Eigen::Index block =
        partial[d + 1].rows() / static_cast<Eigen::Index>(this->Nodes[d].size());
      partial[d].setZero(block, vertices.cols());
      for (std::size_t k = 0; k < this->Nodes[d].size(); ++k)
      {
        partial[d] +=
          factors[k] * partial[d + 1].middleRows(static_cast<Eigen::Index>(k) * block, block);
      }
    }
    values.row(i) = partial[0].row(0);
  }
}

template <int Dim>
void InterpolateAround(const UnstructuredData<Dim>& data, int cell, const PointMatrix& local,
  const PointMatrixView& vertices, PointMatrix& values)
{
  const int least = data.Degree + (data.Degree + 1) % 2;                    // odd
  const Eigen::Index deciding = std::min<Eigen::Index>(3, vertices.cols()); // coordinates
  VertexWindow<Dim>(data, cell, 1).Interpolate(local, vertices, values);
  PointMatrix wider(values.rows(), values.cols());
  double last = 0.0;
  for (int width = 3; width <= least + 4; width += 2)
  {
    VertexWindow<Dim>(data, cell, width).Interpolate(local, vertices, wider);
    const double change = (wider - values).leftCols(deciding).rowwise().squaredNorm().maxCoeff();
    if (width > least && !(change <= last))
    {
      break;
    }
    last = change;
    values.swap(wider);
  }
}

template class VertexWindow<2>;
template class VertexWindow<3>;
template void InterpolateAround(
  const UnstructuredData<2>&, int, const PointMatrix&, const PointMatrixView&, PointMatrix&);
template void InterpolateAround(
  const UnstructuredData<3>&, int, const PointMatrix&, const PointMatrixView&, PointMatrix&);
}
