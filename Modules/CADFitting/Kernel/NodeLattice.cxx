// SPDX-License-Identifier: BSD-3-Clause
#include "NodeLattice.h"

#include <knotwork/SplineCore/LatticeInterpolation.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <typename Item>
void MakeUnique(std::vector<Item>& items)
{
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

template <typename Item>
int PlaceIn(const std::vector<Item>& items, const Item& item)
{
  const auto found = std::lower_bound(items.begin(), items.end(), item);
  return found != items.end() && *found == item ? static_cast<int>(found - items.begin()) : -1;
}

/// From the lowest corner on, the lower one of its neighbours second.
FaceCorners Ordered(const FaceCorners& corners)
{
  const int count = corners[3] < 0 ? 3 : 4;
  const auto lowest =
    static_cast<int>(std::min_element(corners.begin(), corners.begin() + count) - corners.begin());
  const int next = corners[At((lowest + 1) % count)];
  const int last = corners[At((lowest + count - 1) % count)];
  FaceCorners ordered{ -1, -1, -1, -1 };
  for (int i = 0; i < count; ++i)
  {
    ordered[At(i)] = corners[At((lowest + (next < last ? i : count - i)) % count)];
  }
  return ordered;
}

/// Integer parameters, in steps of 1 / order.
using Place = std::array<int, 3>;

int NodeAt(CellShape shape, int order, const Place& at)
{
  return CellCoefficient(shape, DegreeOf(shape, order), at[0], at[1], at[2]);
}

Place CornerPlace(CellShape shape, int corner, int order)
{
  const auto parameters = CornerParameters(shape, corner);
  Place place{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    place[d] = static_cast<int>(parameters[d]) * order;
  }
  return place;
}

/// Place s and t steps from corner a towards b and c.
Place Between(CellShape shape, int order, const std::array<int, 3>& corners, int s, int t)
{
  const Place a = CornerPlace(shape, corners[0], 1);
  const Place b = CornerPlace(shape, corners[1], 1);
  const Place c = CornerPlace(shape, corners[2], 1);
  Place place{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    place[d] = order * a[d] + s * (b[d] - a[d]) + t * (c[d] - a[d]);
  }
  return place;
}

/// Weights of the points of one shape and order in a place that they make.
class Blending
{
public:
  Blending(CellShape shape, int order)
    : Shape(shape), Order(order), Size(NumCellCoefficients(shape, DegreeOf(shape, order)))
  {
  }

  /// @param at  of a point within.
  Eigen::RowVectorXd Row(const Place& at) const
  {
    switch (this->Shape)
    {
      case CellShape::Triangle:
        return this->TriangleRow({ 0, 1, 2 }, this->Barycentric(at), 0);
      case CellShape::Tetrahedron:
        return this->TetrahedronRow(at);
      case CellShape::Wedge:
      {
        // Boolean sum of what lies between the triangles and what lies between the quadrilaterals
        const double w = static_cast<double>(at[2]) / this->Order;
        const auto weights = this->Barycentric(at);
        const Eigen::RowVectorXd lines = (1.0 - w) * this->Unit({ at[0], at[1], 0 }) +
          w * this->Unit({ at[0], at[1], this->Order });
        const Eigen::RowVectorXd corners = (1.0 - w) * this->TriangleRow({ 0, 1, 2 }, weights, 0) +
          w * this->TriangleRow({ 0, 1, 2 }, weights, this->Order);
        return lines + this->TriangleRow({ 0, 1, 2 }, weights, at[2]) - corners;
      }
      default:
        return this->TensorRow(at);
    }
  }

private:
  Eigen::RowVectorXd Unit(const Place& at) const
  {
    return Eigen::RowVectorXd::Unit(this->Size, NodeAt(this->Shape, this->Order, at));
  }

  /// Of the origin, then of the parameters that are there.
  std::array<double, 4> Barycentric(const Place& at) const
  {
    const double order = this->Order;
    const double w = this->Shape == CellShape::Tetrahedron ? at[2] / order : 0.0;
    return { 1.0 - (at[0] + at[1]) / order - w, at[0] / order, at[1] / order, w };
  }

  /// 1 - (1 - P) (1 - Q) (1 - R) of the linear interpolations in the directions.
  Eigen::RowVectorXd TensorRow(const Place& at) const
  {
    const int directions = NumParameters(this->Shape);
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(this->Size);
    for (unsigned subset = 1; subset < (1U << directions); ++subset)
    {
      for (unsigned ends = 0; ends < (1U << directions); ++ends)
      {
        if ((ends & ~subset) != 0U)
        {
          continue;
        }
        Place place = at;
        double weight = -1.0;
        for (int d = 0; d < directions; ++d)
        {
          if ((subset >> d & 1U) != 0U)
          {
            const bool end = (ends >> d & 1U) != 0U;
            const double u = static_cast<double>(at[At(d)]) / this->Order;
            weight *= end ? -u : u - 1.0;
            place[At(d)] = end ? this->Order : 0;
          }
        }
        sum += weight * this->Unit(place);
      }
    }
    return sum;
  }

  /// Interpolation along an edge, at a share of it.
  /// @param level  added to the third parameter (wedges).
  Eigen::RowVectorXd EdgeRow(int a, int b, double share, int level) const
  {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(this->Size);
    for (int k = 0; k <= this->Order; ++k)
    {
      double weight = 1.0;
      for (int l = 0; l <= this->Order; ++l)
      {
        weight *= l == k ? 1.0 : (this->Order * share - l) / (k - l);
      }
      Place place = Between(this->Shape, this->Order, { a, b, a }, k, 0);
      place[2] += level;
      row[NodeAt(this->Shape, this->Order, place)] += weight;
    }
    return row;
  }

  /// Straight, and of every edge what it is off by.
  /// @param weights  of the corners, which sum to 1.
  template <std::size_t N>
  Eigen::RowVectorXd EdgesRow(
    const std::array<int, N>& corners, const std::array<double, 4>& weights, int level) const
  {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(this->Size);
    for (std::size_t i = 0; i < N; ++i)
    {
      row += weights[i] * this->EdgeRow(corners[i], corners[i], 0.0, level);
      for (std::size_t j = i + 1; j < N; ++j)
      {
        const double share = 0.5 * (1.0 + weights[j] - weights[i]);
        const double part = weights[i] * weights[j] / (share * (1.0 - share));
        row += part *
          (this->EdgeRow(corners[i], corners[j], share, level) -
            (1.0 - share) * this->EdgeRow(corners[i], corners[j], 0.0, level) -
            share * this->EdgeRow(corners[i], corners[j], 1.0, level));
      }
    }
    return row;
  }

  Eigen::RowVectorXd TriangleRow(
    const std::array<int, 3>& corners, const std::array<double, 4>& weights, int level) const
  {
    return this->EdgesRow(corners, weights, level);
  }

  /// Interpolation on a triangle of a tetrahedron.
  Eigen::RowVectorXd FaceRow(
    const std::array<int, 3>& corners, const std::array<double, 3>& at) const
  {
    const CellDegree degree = DegreeOf(CellShape::Triangle, this->Order);
    const auto count = static_cast<Eigen::Index>(NumCellCoefficients(CellShape::Triangle, degree));
    const LatticeInterpolation interpolation(CellShape::Triangle, degree);
    const Eigen::MatrixXd coefficients =
      interpolation.Coefficients(LongMatrix::Identity(count, count)).cast<double>();
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(this->Size);
    for (int t = 0; t <= this->Order; ++t)
    {
      for (int s = 0; s + t <= this->Order; ++s)
      {
        BernsteinCells cell;
        cell.NumComponents = 2;
        cell.Add(CellShape::Triangle, degree);
        const int number = CellCoefficient(CellShape::Triangle, degree, s, t, 0);
        for (Eigen::Index i = 0; i < count; ++i)
        {
          cell.Block(0)[i] = coefficients(i, number);
        }
        double value[2];
        EvaluateCell(cell, 0, { at[1], at[2], 0.0 }, value);
        row[NodeAt(this->Shape, this->Order, Between(this->Shape, this->Order, corners, s, t))] +=
          value[0];
      }
    }
    return row;
  }

  /// What edges make, and of every face what it is off by that, which fades with the product of its
  /// three weights.
  Eigen::RowVectorXd TetrahedronRow(const Place& at) const
  {
    const auto weights = this->Barycentric(at);
    Eigen::RowVectorXd row = this->EdgesRow(std::array<int, 4>{ 0, 1, 2, 3 }, weights, 0);
    for (std::size_t without = 0; without < 4; ++without)
    {
      std::array<int, 3> corners{};
      std::array<double, 4> own{};
      double part = 1.0;
      std::size_t n = 0;
      for (std::size_t i = 0; i < 4; ++i)
      {
        if (i != without)
        {
          corners[n] = static_cast<int>(i);
          own[n] = weights[i] + weights[without] / 3.0;
          part *= weights[i] / own[n++];
        }
      }
      row += part *
        (this->FaceRow(corners, { own[0], own[1], own[2] }) - this->TriangleRow(corners, own, 0));
    }
    return row;
  }

  CellShape Shape;
  int Order;
  int Size;
};

bool IsWithin(CellShape shape, int order, const Place& at)
{
  const auto isInner = [order](int i) { return i > 0 && i < order; };
  switch (shape)
  {
    case CellShape::Triangle:
      return at[0] > 0 && at[1] > 0 && at[0] + at[1] < order;
    case CellShape::Tetrahedron:
      return at[0] > 0 && at[1] > 0 && at[2] > 0 && at[0] + at[1] + at[2] < order;
    case CellShape::Wedge:
      return IsWithin(CellShape::Triangle, order, at) && isInner(at[2]);
    case CellShape::Quadrilateral:
      return isInner(at[0]) && isInner(at[1]);
    case CellShape::Hexahedron:
      return isInner(at[0]) && isInner(at[1]) && isInner(at[2]);
    default:
      return isInner(at[0]);
  }
}
}

const std::vector<std::array<int, 2>>& EdgesOf(CellShape shape)
{
  using Pairs = std::vector<std::array<int, 2>>;
  static const Pairs none;
  static const Pairs triangle{ { 0, 1 }, { 0, 2 }, { 1, 2 } };
  static const Pairs square{ { 0, 1 }, { 2, 3 }, { 0, 2 }, { 1, 3 } };
  static const Pairs tetrahedron{ { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };
  static const Pairs wedge{ { 0, 1 }, { 0, 2 }, { 1, 2 }, { 3, 4 }, { 3, 5 }, { 4, 5 }, { 0, 3 },
    { 1, 4 }, { 2, 5 } };
  static const Pairs cube{ { 0, 1 }, { 2, 3 }, { 4, 5 }, { 6, 7 }, { 0, 2 }, { 1, 3 }, { 4, 6 },
    { 5, 7 }, { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };
  switch (shape)
  {
    case CellShape::Triangle:
      return triangle;
    case CellShape::Quadrilateral:
      return square;
    case CellShape::Tetrahedron:
      return tetrahedron;
    case CellShape::Wedge:
      return wedge;
    case CellShape::Hexahedron:
      return cube;
    case CellShape::Curve:
      break;
  }
  return none;
}

const std::vector<FaceCorners>& FacesOf(CellShape shape)
{
  using Faces = std::vector<FaceCorners>;
  static const Faces none;
  static const Faces triangle{ { 0, 1, 2, -1 } };
  static const Faces square{ { 0, 1, 3, 2 } };
  static const Faces tetrahedron{ { 0, 2, 1, -1 }, { 0, 1, 3, -1 }, { 1, 2, 3, -1 },
    { 0, 3, 2, -1 } };
  static const Faces wedge{ { 0, 2, 1, -1 }, { 3, 4, 5, -1 }, { 0, 1, 4, 3 }, { 1, 2, 5, 4 },
    { 0, 3, 5, 2 } };
  static const Faces cube{ { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
    { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  switch (shape)
  {
    case CellShape::Triangle:
      return triangle;
    case CellShape::Quadrilateral:
      return square;
    case CellShape::Tetrahedron:
      return tetrahedron;
    case CellShape::Wedge:
      return wedge;
    case CellShape::Hexahedron:
      return cube;
    case CellShape::Curve:
      break;
  }
  return none;
}

CellDegree DegreeOf(CellShape shape, int order)
{
  CellDegree degree{};
  std::fill_n(degree.begin(), NumParameters(shape), order);
  return degree;
}

NodeTable MakeNodeTable(CellShape shape, int order)
{
  NodeTable table;
  const CellDegree degree = DegreeOf(shape, order);
  const auto size = static_cast<Eigen::Index>(NumCellCoefficients(shape, degree));
  const Blending blending(shape, order);
  std::vector<Eigen::RowVectorXd> rows;
  int number = 0;
  for (const auto& parameters : LatticeParameters(shape, degree))
  {
    Place at{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      at[d] = static_cast<int>(std::lround(parameters[d] * order));
    }
    if (IsWithin(shape, order, at))
    {
      table.Inside.push_back(number);
      rows.push_back(blending.Row(at));
    }
    ++number;
  }
  table.Blend.resize(static_cast<Eigen::Index>(rows.size()), size);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    table.Blend.row(static_cast<Eigen::Index>(i)) = rows[i];
  }
  const LatticeInterpolation interpolation(shape, degree);
  const LongMatrix identity = LongMatrix::Identity(size, size);
  // what should be zero is some 1e-19 here; the bound knows what is dropped
  table.ToBezier = interpolation.Coefficients(identity)
                     .unaryExpr([](long double m) { return std::fabs(m) < 1e-15L ? 0.0L : m; })
                     .cast<double>();
  table.ErrorBound = interpolation.Bound(identity, table.ToBezier.cast<long double>());
  return table;
}

NodeLattice::NodeLattice(const StraightElements& elements, int order)
  : Order(order), NumCorners(static_cast<int>(elements.Points.rows())), Shapes(elements.Shapes)
{
  this->Volume = !this->Shapes.empty() && NumParameters(this->Shapes.front()) == 3;
  for (const CellShape shape : { CellShape::Quadrilateral, CellShape::Hexahedron,
         CellShape::Triangle, CellShape::Tetrahedron, CellShape::Wedge })
  {
    this->Tables[static_cast<std::size_t>(shape)] = MakeNodeTable(shape, order);
  }
  this->CollectSides(elements);
  this->Count = this->NumCorners + static_cast<int>(this->Edges.size()) * (order - 1);
  this->NumberFaces();
  this->NumberElements(elements);
}

void NodeLattice::CollectSides(const StraightElements& elements)
{
  for (int e = 0; e < elements.NumElements(); ++e)
  {
    const int* corners = elements.Corners.data() + elements.Begin[At(e)];
    for (const auto& [a, b] : EdgesOf(elements.Shapes[At(e)]))
    {
      const auto ends = std::minmax(corners[a], corners[b]);
      this->Edges.push_back({ ends.first, ends.second });
    }
    for (FaceCorners face : FacesOf(elements.Shapes[At(e)]))
    {
      std::for_each(face.begin(), face.end(), [&](int& c) { c = c < 0 ? -1 : corners[c]; });
      this->Faces.push_back(Ordered(face));
    }
  }
  MakeUnique(this->Edges);
  MakeUnique(this->Faces);
}

int NodeLattice::FindEdge(int a, int b) const
{
  return PlaceIn(this->Edges, { std::min(a, b), std::max(a, b) });
}

int NodeLattice::FindFace(const FaceCorners& corners) const
{
  return PlaceIn(this->Faces, Ordered(corners));
}

int NodeLattice::NodeBetween(int a, int b, int k) const
{
  if (k == 0 || k == this->Order)
  {
    return k == 0 ? a : b;
  }
  return this->EdgeNode(this->FindEdge(a, b), a < b ? k : this->Order - k);
}

void NodeLattice::NumberFaces()
{
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const FaceCorners& face = this->Faces[f];
    const bool isTriangle = face[3] < 0;
    const int last = isTriangle ? face[2] : face[3];
    const int p = this->Order;
    // the order of the coefficients: s from the first towards the second corner is the fastest
    for (int t = 0; t <= p; ++t)
    {
      for (int s = 0; s <= (isTriangle ? p - t : p); ++s)
      {
        int node = -1;
        if (t == 0)
        {
          node = this->NodeBetween(face[0], face[1], s);
        }
        else if (s == 0)
        {
          node = this->NodeBetween(face[0], last, t);
        }
        else if (isTriangle ? s + t == p : s == p)
        {
          node = this->NodeBetween(face[1], face[2], t);
        }
        else if (!isTriangle && t == p)
        {
          node = this->NodeBetween(last, face[2], s);
        }
        else
        {
          node = this->Count++;
        }
        this->FaceNodes.push_back(node);
      }
    }
    this->FaceBegin.push_back(this->FaceNodes.size());
  }
}

void NodeLattice::NumberElements(const StraightElements& elements)
{
  const int p = this->Order;
  for (int e = 0; e < elements.NumElements(); ++e)
  {
    const CellShape shape = elements.Shapes[At(e)];
    const int* corners = elements.Corners.data() + elements.Begin[At(e)];
    const auto first = this->Nodes.size();
    this->Nodes.resize(first + At(NumCellCoefficients(shape, DegreeOf(shape, p))), -1);
    int* nodes = this->Nodes.data() + first;
    this->FacesAt.emplace_back();
    for (const FaceCorners& local : FacesOf(shape))
    {
      FaceCorners face = local;
      std::for_each(face.begin(), face.end(), [&](int& c) { c = c < 0 ? -1 : corners[c]; });
      const int number = this->FindFace(face);
      this->FacesAt.back().push_back(number);
      // the element's corners in the order of the face's
      const FaceCorners& ordered = this->Faces[At(number)];
      const auto cornerOf = [&](int point) {
        return local[At(
          static_cast<int>(std::find(face.begin(), face.end(), point) - face.begin()))];
      };
      const bool isTriangle = face[3] < 0;
      const std::array<int, 3> frame{ cornerOf(ordered[0]), cornerOf(ordered[1]),
        cornerOf(isTriangle ? ordered[2] : ordered[3]) };
      const int* from = this->FaceNodes.data() + this->FaceBegin[At(number)];
      for (int t = 0; t <= p; ++t)
      {
        for (int s = 0; s <= (isTriangle ? p - t : p); ++s)
        {
          nodes[NodeAt(shape, p, Between(shape, p, frame, s, t))] = *from++;
        }
      }
    }
    for (const int inside : this->Tables[static_cast<std::size_t>(shape)].Inside)
    {
      if (nodes[inside] < 0) // those of surfaces are their face's
      {
        nodes[inside] = this->Count++;
      }
    }
    this->Begin.push_back(this->Nodes.size());
  }
}
}
