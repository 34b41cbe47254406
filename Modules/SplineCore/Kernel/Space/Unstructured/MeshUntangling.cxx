// SPDX-License-Identifier: BSD-3-Clause
#include "MeshUntangling.h"

#include "MeshSlide.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// With so many rings more, and so many more of the sharp edges given way.
constexpr int MostAttempts = 3;

template <int Dim>
using Edges = Eigen::Matrix<double, 3, Dim>; ///< edge vectors of a cell, or derivatives, as columns

template <int Dim>
Status CheckMesh(const CellMesh<Dim>& mesh, const PointMatrixView& points)
{
  if (points.rows() != mesh.NumPoints || points.cols() < Dim || points.cols() > 3)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(points.rows()) + " points of " + std::to_string(points.cols()) +
        " coordinates for a mesh of " + std::to_string(mesh.NumPoints) };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
  }
  return {};
}

/// Edge vectors at a corner of a cell, each from its lower to its upper end.
template <int Dim>
Edges<Dim> EdgesAt(const CellMesh<Dim>& mesh, const PointMatrix& points, int cell, int corner)
{
  Edges<Dim> edges;
  const int* corners = mesh.Cell(cell);
  for (int d = 0; d < Dim; ++d)
  {
    edges.col(d) = points.row(corners[corner | 1 << d]) - points.row(corners[corner & ~(1 << d)]);
  }
  return edges;
}

/// Derivatives of the multilinear map of a hexahedron.
Edges<3> DerivativesAt(
  const CellMesh<3>& mesh, const PointMatrix& points, int cell, const Eigen::Vector3d& at)
{
  Edges<3> sum = Edges<3>::Zero();
  for (int corner = 0; corner < 8; ++corner)
  {
    const auto factor = [&](int d) { return (corner >> d & 1) != 0 ? at[d] : 1.0 - at[d]; };
    const Edges<3> edges = EdgesAt<3>(mesh, points, cell, corner);
    for (int d = 0; d < 3; ++d)
    {
      // both ends of an edge see it
      sum.col(d) += 0.5 * factor((d + 1) % 3) * factor((d + 2) % 3) * edges.col(d);
    }
  }
  return sum;
}

/// Cells as they are seen: hexahedra from the sign that most have, quadrilaterals of a plane from
/// its upper side, others from that of their diagonals.
template <int Dim>
class Orientation
{
public:
  Orientation(const CellMesh<Dim>& mesh, const PointMatrix& points)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      if constexpr (Dim == 3)
      {
        count += DerivativesAt(mesh, points, c, Eigen::Vector3d::Constant(0.5)).determinant() > 0.0
          ? 1
          : -1;
      }
      else
      {
        sum += Diagonals(mesh, points, c);
        count += sum[2] > 0.0 ? 1 : -1;
      }
    }
    this->Sign = count < 0 ? -1.0 : 1.0;
    this->IsPlane = Dim == 2 && (points.col(2).array() == points(0, 2)).all() && points.rows() > 0;
    this->Sign = this->IsPlane && sum[2] < 0.0 ? -1.0 : Dim == 3 ? this->Sign : 1.0;
  }

  /// Cross product of the diagonals, in units of area.
  static Eigen::Vector3d Diagonals(const CellMesh<Dim>& mesh, const PointMatrix& points, int cell)
  {
    const int* corners = mesh.Cell(cell);
    const Eigen::Vector3d a = points.row(corners[3]) - points.row(corners[0]);
    const Eigen::Vector3d b = points.row(corners[2]) - points.row(corners[1]);
    return 0.5 * a.cross(b);
  }
  Eigen::Vector3d NormalOf(const CellMesh<Dim>& mesh, const PointMatrix& points, int cell) const
  {
    return this->IsPlane ? Eigen::Vector3d(0.0, 0.0, this->Sign)
                         : Eigen::Vector3d(Diagonals(mesh, points, cell).normalized());
  }
  double Sign = 1.0; ///< of hexahedra, and of quadrilaterals of a plane

private:
  bool IsPlane = false;
};

template <int Dim>
double Determinant(const Edges<Dim>& edges, double sign, const Eigen::Vector3d& normal)
{
  if constexpr (Dim == 3)
  {
    return sign * edges.determinant();
  }
  return normal.dot(edges.col(0).cross(edges.col(1)));
}

template <int Dim>
bool IsFolded(const CellMesh<Dim>& mesh, const PointMatrix& points,
  const Orientation<Dim>& orientation, int cell)
{
  if constexpr (Dim == 3)
  {
    for (int k = 0; k < 27; ++k)
    {
      const Eigen::Vector3d at(0.5 * (k % 3), 0.5 * (k / 3 % 3), 0.5 * (k / 9));
      if (!(orientation.Sign * DerivativesAt(mesh, points, cell, at).determinant() > 0.0))
      {
        return true;
      }
    }
    return false;
  }
  else
  {
    const Eigen::Vector3d normal = orientation.NormalOf(mesh, points, cell);
    for (int corner = 0; corner < 4; ++corner)
    {
      if (!(Determinant<2>(EdgesAt<2>(mesh, points, cell, corner), 1.0, normal) > 0.0))
      {
        return true;
      }
    }
    return false;
  }
}

template <int Dim>
std::vector<int> FindFolded(const CellMesh<Dim>& mesh, const PointMatrix& points)
{
  const Orientation<Dim> orientation(mesh, points);
  std::vector<int> folded;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    if (IsFolded<Dim>(mesh, points, orientation, c))
    {
      folded.push_back(c);
    }
  }
  return folded;
}

PointMatrix InSpace(const PointMatrixView& points)
{
  PointMatrix all = PointMatrix::Zero(points.rows(), 3);
  all.leftCols(points.cols()) = points;
  return all;
}

/// The surface.
template <int Dim>
std::vector<SurfaceQuad> SurfaceQuads(
  const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, const std::vector<int>& folded)
{
  std::vector<SurfaceQuad> quads;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Cell(c);
    const bool isFolded = std::binary_search(folded.begin(), folded.end(), c);
    if constexpr (Dim == 2)
    {
      quads.push_back({ { corners[0], corners[1], corners[3], corners[2] }, isFolded });
    }
    else
    {
      for (int side = 0; side < 6; ++side)
      {
        if (topology.IsBoundary(c, side))
        {
          const int d = side / 2;
          const int a = 1 << (d + 1) % 3;
          const int b = 1 << (d + 2) % 3;
          const int at = side % 2 << d;
          // seen from outside, at the upper end
          const bool isUpper = side % 2 == 1;
          quads.push_back({ { corners[at], corners[at | (isUpper ? a : b)], corners[at | a | b],
                              corners[at | (isUpper ? b : a)] },
            isFolded });
        }
      }
    }
  }
  return quads;
}

/// Corners of a quadrilateral at the ends of its side.
std::array<int, 2> EndsOf(int side)
{
  const int across = side / 2;
  const int low = side % 2 << across;
  return { low, low | 1 << (1 - across) };
}

/// Cells within so many rings, by common points.
template <int Dim>
std::vector<char> Grow(const CellMesh<Dim>& mesh, const std::vector<int>& cells, int rings)
{
  std::vector<char> inside(At(mesh.NumCells()), 0);
  for (const int c : cells)
  {
    inside[At(c)] = 1;
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    std::vector<char> touched(At(mesh.NumPoints), 0);
    const auto forCorners = [&](int cell, auto&& visit)
    { std::for_each(mesh.Cell(cell), mesh.Cell(cell) + (1 << Dim), visit); };
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      if (inside[At(c)] != 0)
      {
        forCorners(c, [&](int point) { touched[At(point)] = 1; });
      }
    }
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      forCorners(c, [&](int point) { inside[At(c)] |= touched[At(point)]; });
    }
  }
  return inside;
}

/// The shape of the cells as a function of one point after the other.
template <int Dim>
class ShapeDescent
{
public:
  ShapeDescent(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, PointMatrix& points,
    const PointSlide& slide, const std::vector<char>& moving)
    : Mesh(mesh), Points(points), Slide(slide), View(mesh, points), CornersOf(At(mesh.NumPoints))
  {
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        this->CornersOf[At(mesh.Cell(c)[corner])].push_back({ c, corner });
      }
    }
    std::vector<char> touched(At(mesh.NumCells()), 0);
    for (int i = 0; i < mesh.NumPoints; ++i)
    {
      const auto& corners = this->CornersOf[At(i)];
      const bool isMoving = !slide.IsFixed(i) &&
        std::any_of(corners.begin(), corners.end(),
          [&](const CellCorner& at) { return moving[At(at.Cell)] != 0; });
      if (isMoving)
      {
        this->Movable.push_back(i);
        for (const CellCorner& at : corners)
        {
          touched[At(at.Cell)] = 1;
        }
      }
    }
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      if (touched[At(c)] != 0)
      {
        this->Cells.push_back(c);
      }
    }
    this->FindLengths(topology);
    this->Normals.resize(At(mesh.NumCells()));
  }

  /// Once over all points. @return the largest move, in longest edges at its point.
  double Sweep()
  {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int c : this->Cells)
    {
      if constexpr (Dim == 2)
      {
        this->Normals[At(c)] = this->View.NormalOf(this->Mesh, this->Points, c);
      }
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        lowest = std::min(lowest, this->DeterminantAt(c, corner));
      }
    }
    constexpr double least = 1e-2;
    this->Offset = lowest < least ? std::sqrt(least * (least - lowest)) : 0.0;
    double largest = 0.0;
    for (const int point : this->Movable)
    {
      largest = std::max(largest, this->Improve(point));
    }
    return largest;
  }

private:
  struct CellCorner
  {
    int Cell;
    int Corner;
  };

  /// Medians of the lengths of edges along sheets, among the cells that change: few are astray.
  void FindLengths(const MeshTopology<Dim>& topology)
  {
    const auto sheets = topology.FindSheets();
    std::vector<std::vector<double>> lengths(At(sheets.Count));
    for (const int c : this->Cells)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        const Edges<Dim> edges = EdgesAt<Dim>(this->Mesh, this->Points, c, corner);
        for (int d = 0; d < Dim; ++d)
        {
          lengths[At(sheets.Of[At(c * Dim + d)])].push_back(edges.col(d).norm());
        }
      }
    }
    for (std::vector<double>& of : lengths)
    {
      std::nth_element(
        of.begin(), of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2), of.end());
    }
    this->Scales.assign(At(this->Mesh.NumCells()), {});
    for (const int c : this->Cells)
    {
      for (int d = 0; d < Dim; ++d)
      {
        const std::vector<double>& of = lengths[At(sheets.Of[At(c * Dim + d)])];
        const double median = of[of.size() / 2];
        this->Scales[At(c)][At(d)] = median > 0.0 ? 1.0 / median : 1.0;
      }
    }
  }

  Edges<Dim> ScaledEdges(int cell, int corner) const
  {
    Edges<Dim> edges = EdgesAt<Dim>(this->Mesh, this->Points, cell, corner);
    for (int d = 0; d < Dim; ++d)
    {
      edges.col(d) *= this->Scales[At(cell)][At(d)];
    }
    return edges;
  }
  double DeterminantAt(int cell, int corner) const
  {
    return Determinant<Dim>(
      this->ScaledEdges(cell, corner), this->View.Sign, this->Normals[At(cell)]);
  }

  /// |A|^2 / (Dim h(det A)^(2 / Dim)) at a corner, and its derivatives by the edges.
  double ShapeAt(int cell, int corner, Edges<Dim>& derivatives) const
  {
    const Edges<Dim> edges = this->ScaledEdges(cell, corner);
    Edges<Dim> ofDeterminant;
    const Eigen::Vector3d& normal = this->Normals[At(cell)];
    if constexpr (Dim == 3)
    {
      for (int d = 0; d < 3; ++d)
      {
        ofDeterminant.col(d) =
          this->View.Sign * edges.col((d + 1) % 3).cross(edges.col((d + 2) % 3));
      }
    }
    else
    {
      ofDeterminant.col(0) = edges.col(1).cross(normal);
      ofDeterminant.col(1) = normal.cross(edges.col(0));
    }
    const double determinant = Determinant<Dim>(edges, this->View.Sign, normal);
    const double root = std::sqrt(determinant * determinant + 4.0 * this->Offset * this->Offset);
    const double height = 0.5 * (determinant + root);
    if (!(height > 0.0))
    {
      return std::numeric_limits<double>::infinity();
    }
    const double squares = edges.squaredNorm();
    const double shape = squares / (Dim * std::pow(height, 2.0 / Dim));
    derivatives = shape * (2.0 / squares * edges - 2.0 / (Dim * root) * ofDeterminant);
    for (int d = 0; d < Dim; ++d)
    {
      derivatives.col(d) *= this->Scales[At(cell)][At(d)];
    }
    return shape;
  }

  /// Of the cells around a point, and the derivatives by it.
  double ShapeAround(int point, Eigen::Vector3d& gradient) const
  {
    gradient.setZero();
    double sum = 0.0;
    Edges<Dim> derivatives;
    for (const CellCorner& at : this->CornersOf[At(point)])
    {
      for (int d = -1; d < Dim; ++d) // the corner itself, and those that edges lead to
      {
        sum += this->ShapeAt(at.Cell, d < 0 ? at.Corner : at.Corner ^ 1 << d, derivatives);
        for (int e = 0; e < Dim; ++e)
        {
          if (d < 0 || d == e)
          {
            gradient += ((at.Corner >> e & 1) != 0 ? 1.0 : -1.0) * derivatives.col(e);
          }
        }
      }
    }
    return sum;
  }

  /// A step of Newton's method along what the point may do. @return as Sweep.
  double Improve(int point)
  {
    using Vector = Eigen::VectorXd;
    const Eigen::RowVector3d begin = this->Points.row(point);
    const auto directions = this->Slide.Directions(point, begin);
    const Eigen::Index n = directions.cols();
    Eigen::Vector3d gradient;
    const double before = this->ShapeAround(point, gradient);
    const Vector slope = directions.transpose() * gradient;
    if (!std::isfinite(before) || !(slope.norm() > 0.0))
    {
      return 0.0;
    }
    double size = std::numeric_limits<double>::infinity();
    for (const CellCorner& at : this->CornersOf[At(point)])
    {
      size = std::min(size,
        EdgesAt<Dim>(this->Mesh, this->Points, at.Cell, at.Corner).colwise().norm().maxCoeff());
    }
    Eigen::MatrixXd second(n, n);
    const double step = 1e-4 * size;
    for (Eigen::Index k = 0; k < n; ++k)
    {
      Eigen::Vector3d ahead;
      Eigen::Vector3d behind;
      this->Points.row(point) = begin + step * directions.col(k).transpose();
      this->ShapeAround(point, ahead);
      this->Points.row(point) = begin - step * directions.col(k).transpose();
      this->ShapeAround(point, behind);
      second.col(k) = directions.transpose() * (ahead - behind) / (2.0 * step);
    }
    this->Points.row(point) = begin;
    second = (0.5 * (second + second.transpose())).eval();
    // bent as far up along every axis as it is bent up or down
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(second);
    Vector move = -slope / slope.norm() * size * 0.1;
    if (axes.info() == Eigen::Success && axes.eigenvalues().allFinite())
    {
      const Vector bends =
        axes.eigenvalues().cwiseAbs().cwiseMax(1e-6 * axes.eigenvalues().cwiseAbs().maxCoeff());
      move = -(axes.eigenvectors() *
        ((axes.eigenvectors().transpose() * slope).array() / bends.array()).matrix());
    }
    if (!move.allFinite())
    {
      return 0.0;
    }
    move *= std::min(1.0, 0.5 * size / move.norm());
    for (int halving = 0; halving < 12; ++halving, move *= 0.5)
    {
      this->Points.row(point) = this->Slide.Nearest(point, begin + (directions * move).transpose());
      if (this->ShapeAround(point, gradient) < before)
      {
        return (this->Points.row(point) - begin).norm() / size;
      }
    }
    this->Points.row(point) = begin;
    return 0.0;
  }

  const CellMesh<Dim>& Mesh;
  PointMatrix& Points;
  const PointSlide& Slide;
  const Orientation<Dim> View;
  std::vector<std::vector<CellCorner>> CornersOf; ///< of every point
  std::vector<int> Movable;
  std::vector<int> Cells; ///< that change
  std::vector<std::array<double, Dim>> Scales;
  std::vector<Eigen::Vector3d> Normals;
  double Offset = 0.0; ///< of the determinant, so that folded cells have a finite shape
};
}

template <int Dim>
Result<std::vector<int>> FoldedCells(const CellMesh<Dim>& mesh, const PointMatrixView& points)
{
  const Status status = CheckMesh(mesh, points);
  return status ? Result<std::vector<int>>(FindFolded<Dim>(mesh, InSpace(points)))
                : Result<std::vector<int>>(status);
}

template <int Dim>
Result<UntangledMesh> UntangleMesh(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const PointMatrixView& points, const UntanglingParams& params)
{
  if (const Status status = CheckMesh(mesh, points); !status)
  {
    return status;
  }
  std::vector<std::array<int, 2>> marked;
  if constexpr (Dim == 2)
  {
    for (const CellSide& feature : params.Features)
    {
      const auto [low, high] = EndsOf(feature.Side);
      marked.push_back({ mesh.Cell(feature.Cell)[low], mesh.Cell(feature.Cell)[high] });
    }
  }
  if (params.Rings < 0 || params.MaxSweeps < 1 ||
    !(params.FeatureAngle >= 0.0 && params.FeatureAngle <= 180.0))
  {
    return { ErrorCode::InvalidParameter,
      "rings must be 0 or more, sweeps 1 or more, and the angle in [0, 180] degrees" };
  }
  for (const int cell : params.Poor)
  {
    if (cell < 0 || cell >= mesh.NumCells())
    {
      return { ErrorCode::InvalidParameter,
        "there is no cell " + std::to_string(cell) + " to give a better shape" };
    }
  }
  const PointMatrix before = InSpace(points);
  PointMatrix moved = before;
  UntangledMesh result;
  result.FoldedBefore = FindFolded<Dim>(mesh, before);
  result.Folded = result.FoldedBefore;
  std::vector<int> seeds = result.Folded;
  seeds.insert(seeds.end(), params.Poor.begin(), params.Poor.end());
  for (int attempt = 0; attempt < MostAttempts && !seeds.empty(); ++attempt)
  {
    // where nothing else helps edges give way, the sharpest last
    const double share = static_cast<double>(attempt) / (MostAttempts - 1);
    std::optional<MeshSlide> own;
    if (!params.Slide)
    {
      own.emplace(SurfaceQuads<Dim>(mesh, topology, result.FoldedBefore), before,
        params.FeatureAngle + share * (180.0 - params.FeatureAngle), marked);
    }
    const PointSlide& slide = params.Slide ? *params.Slide : *own;
    ShapeDescent<Dim> descent(
      mesh, topology, moved, slide, Grow<Dim>(mesh, seeds, params.Rings + attempt));
    double move = 1.0;
    for (int sweep = 0; sweep < params.MaxSweeps && move > 1e-3; ++sweep)
    {
      const double done = attempt + static_cast<double>(sweep) / params.MaxSweeps;
      if (params.Progress && !params.Progress(done / MostAttempts))
      {
        return { ErrorCode::Aborted, "untangling stopped in sweep " + std::to_string(sweep) };
      }
      move = descent.Sweep();
    }
    result.Folded = FindFolded<Dim>(mesh, moved);
    seeds = result.Folded;
  }
  const Eigen::VectorXd moves = (moved - before).rowwise().norm();
  result.NumMoved = static_cast<int>((moves.array() > 0.0).count());
  result.LargestMove = moves.size() > 0 ? moves.maxCoeff() : 0.0;
  result.Points = moved.leftCols(points.cols());
  return result;
}

template Result<std::vector<int>> FoldedCells(const CellMesh<2>&, const PointMatrixView&);
template Result<std::vector<int>> FoldedCells(const CellMesh<3>&, const PointMatrixView&);
template Result<UntangledMesh> UntangleMesh(
  const CellMesh<2>&, const MeshTopology<2>&, const PointMatrixView&, const UntanglingParams&);
template Result<UntangledMesh> UntangleMesh(
  const CellMesh<3>&, const MeshTopology<3>&, const PointMatrixView&, const UntanglingParams&);
}
