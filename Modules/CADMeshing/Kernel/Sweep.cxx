// SPDX-License-Identifier: BSD-3-Clause
#include "Sweep.h"

#include "RimMap.h"

#include <knotwork/SplineCore/SizeLimit.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <array>
#include <cmath>
#include <map>
#include <string>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;
constexpr double Pi = 3.14159265358979323846;

Status CheckSource(const CellMesh<2>& mesh, const PointMatrixView& points, int layers)
{
  if (mesh.NumCells() == 0 || points.rows() == 0)
  {
    return { ErrorCode::EmptyInput, "the source has no quadrilaterals" };
  }
  if (points.rows() != mesh.NumPoints || points.cols() != 3)
  {
    return { ErrorCode::SizeMismatch,
      "the source has " + std::to_string(mesh.NumPoints) + " points, and coordinates of " +
        std::to_string(points.rows()) };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) + " is not finite" };
    }
  }
  for (std::size_t i = 0; i < mesh.Corners.size(); ++i)
  {
    if (mesh.Corners[i] < 0 || mesh.Corners[i] >= mesh.NumPoints)
    {
      return { ErrorCode::InvalidTopology,
        "quadrilateral " + std::to_string(i / 4) + " has point " + std::to_string(mesh.Corners[i]) +
          " of " + std::to_string(mesh.NumPoints) };
    }
  }
  constexpr double most = 2147483647.0; // ids are int
  return CheckSize((layers + 1.0) * static_cast<double>(points.rows()), most, "points", "Layers");
}

/// Sum of the Jacobians in the middles of cells, 64 times: its sign is that of most volume.
double SignedVolume(const CellMesh<3>& mesh, const PointMatrix& points)
{
  double volume = 0.0;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Cell(c);
    const auto at = [&](int corner) -> Vector3d { return points.row(corners[corner]); };
    const Vector3d u = at(1) + at(3) + at(5) + at(7) - at(0) - at(2) - at(4) - at(6);
    const Vector3d v = at(2) + at(3) + at(6) + at(7) - at(0) - at(1) - at(4) - at(5);
    const Vector3d w = at(4) + at(5) + at(6) + at(7) - at(0) - at(1) - at(2) - at(3);
    volume += u.cross(v).dot(w);
  }
  return volume;
}

/// The cells between the layers, right-handed on the whole.
void AddCells(const CellMesh<2>& source, SweptMesh& swept)
{
  const int n = source.NumPoints;
  const int last = swept.IsRing ? swept.Layers : swept.Layers + 1; // layers of points
  swept.Mesh.NumPoints = last * n;
  for (int k = 0; k < swept.Layers; ++k)
  {
    for (int q = 0; q < source.NumCells(); ++q)
    {
      for (const int layer : { k, (k + 1) % last })
      {
        for (int corner = 0; corner < 4; ++corner)
        {
          swept.Mesh.Corners.push_back(layer * n + source.Cell(q)[corner]);
        }
      }
    }
  }
  if (SignedVolume(swept.Mesh, swept.Points) < 0.0)
  {
    for (std::size_t i = 0; i < swept.Mesh.Corners.size(); i += 4)
    {
      std::swap(swept.Mesh.Corners[i + 1], swept.Mesh.Corners[i + 2]);
    }
  }
}

// --- along a path ---

/// A point of the path and axes there; the third one is its direction.
struct Frame
{
  Vector3d Origin;
  Eigen::Matrix3d Axes;
};

/// Points at equal lengths of a path, and directions there: means of its pieces where they meet.
Status SamplePath(const PathSweepParams& params, bool ring, std::vector<Vector3d>& points,
  std::vector<Vector3d>& tangents)
{
  std::vector<Vector3d> path{ params.Path.row(0) };
  for (Eigen::Index i = 1; i < params.Path.rows(); ++i)
  {
    const Vector3d next = params.Path.row(i);
    if (next != path.back())
    {
      path.push_back(next);
    }
  }
  std::vector<double> lengths{ 0.0 };
  std::vector<Vector3d> directions;
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    const double length = (path[i] - path[i - 1]).norm();
    lengths.push_back(lengths.back() + length);
    directions.emplace_back((path[i] - path[i - 1]) / length);
  }
  if (directions.empty() || !(lengths.back() > 0.0))
  {
    return { ErrorCode::InvalidTopology, "the path has no length; give two points apart" };
  }
  // directions at the vertices of the path, between which they change linearly
  std::vector<Vector3d> turning(path.size());
  for (std::size_t i = 0; i < path.size(); ++i)
  {
    const bool isEnd = i == 0 || i + 1 == path.size();
    const Vector3d& before = i > 0 ? directions[i - 1] : ring ? directions.back() : directions[0];
    const Vector3d& after = i < directions.size() ? directions[i]
      : ring                                      ? directions[0]
                                                  : directions.back();
    if ((!isEnd || ring) && before.dot(after) < -0.99)
    {
      return { ErrorCode::InvalidTopology,
        "the path turns back on itself at its point " + std::to_string(i) };
    }
    // lengths weigh: the shorter piece says more about the direction at its end
    const double a =
      i > 0 ? lengths[i] - lengths[i - 1] : lengths.back() - lengths[path.size() - 2];
    const double b = i + 1 < path.size() ? lengths[i + 1] - lengths[i] : lengths[1];
    turning[i] = isEnd && !ring ? before : Vector3d((b * before + a * after).normalized());
  }
  if (!ring && path.size() > 2)
  {
    // one-sided at the ends: what the first turn goes on as, before it
    const auto atEnd = [](const Vector3d& end, const Vector3d& next)
    { return Vector3d(2.0 * end.dot(next) * end - next).normalized(); };
    turning.front() = atEnd(directions.front(), turning[1]);
    turning.back() = atEnd(directions.back(), turning[path.size() - 2]);
  }
  std::size_t piece = 0;
  for (int k = 0; k <= params.Layers; ++k)
  {
    const double at = lengths.back() * k / params.Layers;
    while (piece + 2 < path.size() && lengths[piece + 1] < at)
    {
      ++piece;
    }
    const double t = std::min(1.0, (at - lengths[piece]) / (lengths[piece + 1] - lengths[piece]));
    points.emplace_back(
      t < 1.0 ? Vector3d((1.0 - t) * path[piece] + t * path[piece + 1]) : path[piece + 1]);
    tangents.emplace_back(((1.0 - t) * turning[piece] + t * turning[piece + 1]).normalized());
  }
  if (ring)
  {
    points.back() = points.front();
    tangents.back() = tangents.front();
  }
  return {};
}

/// The next frame by two reflections.
Vector3d Transported(const Vector3d& axis, const Vector3d& from, const Vector3d& to,
  const Vector3d& tangent, const Vector3d& next)
{
  const auto reflect = [](const Vector3d& v, const Vector3d& normal)
  {
    const double square = normal.squaredNorm();
    return square > 0.0 ? Vector3d(v - 2.0 / square * normal.dot(v) * normal) : v;
  };
  const Vector3d step = to - from;
  const Vector3d turned = reflect(axis, step);
  const Vector3d result = reflect(turned, next - reflect(tangent, step));
  return (result - result.dot(next) * next).normalized();
}

Status MakeFrames(const PathSweepParams& params, bool ring, std::vector<Frame>& frames)
{
  std::vector<Vector3d> points;
  std::vector<Vector3d> tangents;
  if (Status status = SamplePath(params, ring, points, tangents); !status)
  {
    return status;
  }
  std::vector<Vector3d> axes{ tangents[0].unitOrthogonal() };
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    axes.push_back(
      Transported(axes.back(), points[k - 1], points[k], tangents[k - 1], tangents[k]));
  }
  const double back = ring
    ? std::atan2(axes.back().cross(axes.front()).dot(tangents[0]), axes.back().dot(axes.front()))
    : 0.0;
  const double twist = params.Twist * Pi / 180.0 + back;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const double share = static_cast<double>(k) / params.Layers;
    const double scale = 1.0 + share * (params.Scale - 1.0);
    const Vector3d first = Eigen::AngleAxisd(share * twist, tangents[k]) * axes[k];
    Frame frame;
    frame.Origin = points[k];
    frame.Axes.col(0) = scale * first;
    frame.Axes.col(1) = scale * tangents[k].cross(first);
    frame.Axes.col(2) = scale * tangents[k];
    frames.push_back(frame);
  }
  return {};
}

Status CheckPath(const PathSweepParams& params, bool ring)
{
  if (params.Path.rows() < 2 || params.Path.cols() != 3)
  {
    return { ErrorCode::EmptyInput, "the path has less than two points" };
  }
  if (!params.Path.allFinite() || !std::isfinite(params.Twist) || !std::isfinite(params.Scale))
  {
    return { ErrorCode::NonFiniteInput, "the path, Twist or Scale is not finite" };
  }
  if (params.Layers < (ring ? 3 : 1))
  {
    return { ErrorCode::InvalidParameter,
      "Layers is " + std::to_string(params.Layers) +
        "; it must be 1 or more, along a closed path 3" };
  }
  if (!(params.Scale > 0.0))
  {
    return { ErrorCode::InvalidParameter, "Scale must be above 0" };
  }
  if (ring && (std::remainder(params.Twist, 360.0) != 0.0 || params.Scale != 1.0))
  {
    return { ErrorCode::InvalidParameter,
      "along a closed path Twist must be a multiple of 360 degrees, and Scale 1" };
  }
  return {};
}

// --- between columns ---

/// Edges by their ends, and how many cells have them.
std::map<std::pair<int, int>, int> EdgesOf(const CellMesh<2>& mesh)
{
  std::map<std::pair<int, int>, int> edges;
  for (int q = 0; q < mesh.NumCells(); ++q)
  {
    const int* c = mesh.Cell(q);
    for (const auto& [a, b] : { std::pair(c[0], c[1]), std::pair(c[1], c[3]), std::pair(c[3], c[2]),
           std::pair(c[2], c[0]) })
    {
      ++edges[{ std::min(a, b), std::max(a, b) }];
    }
  }
  return edges;
}

/// Harmonic functions of the graph of a mesh's edges by their values at some points.
class HarmonicExtension
{
public:
  Status Make(const CellMesh<2>& mesh, const std::vector<int>& fixed)
  {
    const int n = mesh.NumPoints;
    this->Number.assign(static_cast<std::size_t>(n), -2);
    for (std::size_t i = 0; i < mesh.Corners.size(); ++i)
    {
      this->Number[static_cast<std::size_t>(mesh.Corners[i])] = 0;
    }
    for (std::size_t i = 0; i < fixed.size(); ++i)
    {
      this->Number[static_cast<std::size_t>(fixed[i])] = -1;
    }
    for (int v = 0; v < n; ++v)
    {
      if (this->Number[static_cast<std::size_t>(v)] == 0)
      {
        this->Number[static_cast<std::size_t>(v)] = static_cast<int>(this->Free.size());
        this->Free.push_back(v);
      }
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& [edge, cells] : EdgesOf(mesh))
    {
      this->Add(edge.first, edge.second, entries);
      this->Add(edge.second, edge.first, entries);
    }
    const auto size = static_cast<Eigen::Index>(this->Free.size());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (size > 0)
    {
      this->Solver.compute(matrix);
      if (this->Solver.info() != Eigen::Success)
      {
        return { ErrorCode::NotConverged,
          "the equations of inner points cannot be solved: a part of the source has no rim" };
      }
    }
    return {};
  }

  /// @param values  n x 3, of which those of free points are found.
  void Extend(PointMatrix& values) const
  {
    PointMatrix right = PointMatrix::Zero(static_cast<Eigen::Index>(this->Free.size()), 3);
    for (const auto& [row, point] : this->Rim)
    {
      right.row(row) += values.row(point);
    }
    if (right.rows() > 0)
    {
      const Eigen::MatrixXd solved = this->Solver.solve(Eigen::MatrixXd(right));
      for (std::size_t i = 0; i < this->Free.size(); ++i)
      {
        values.row(this->Free[i]) = solved.row(static_cast<Eigen::Index>(i));
      }
    }
  }

private:
  void Add(int from, int to, std::vector<Eigen::Triplet<double>>& entries)
  {
    const int row = this->Number[static_cast<std::size_t>(from)];
    const int column = this->Number[static_cast<std::size_t>(to)];
    if (row < 0)
    {
      return;
    }
    entries.emplace_back(row, row, 1.0);
    if (column >= 0)
    {
      entries.emplace_back(row, column, -1.0);
    }
    else
    {
      this->Rim.emplace_back(row, to);
    }
  }

  std::vector<int> Number; ///< of unknowns; -1: given, -2: of no cell
  std::vector<int> Free;
  std::vector<std::pair<int, int>> Rim; ///< rows and given points beside them
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> Solver;
};

/// Every point on an edge of one cell alone is in the rim.
Status CheckRim(const CellMesh<2>& mesh, const std::vector<int>& rim)
{
  std::vector<bool> given(static_cast<std::size_t>(mesh.NumPoints), false);
  for (const int v : rim)
  {
    if (v < 0 || v >= mesh.NumPoints)
    {
      return { ErrorCode::InvalidTopology,
        "the rim has point " + std::to_string(v) + " of " + std::to_string(mesh.NumPoints) };
    }
    given[static_cast<std::size_t>(v)] = true;
  }
  for (const auto& [edge, cells] : EdgesOf(mesh))
  {
    for (const int v : { edge.first, edge.second })
    {
      if (cells == 1 && !given[static_cast<std::size_t>(v)])
      {
        return { ErrorCode::InvalidTopology,
          "point " + std::to_string(v) + " of the source's rim has no column" };
      }
    }
  }
  return {};
}

PointMatrix LayerOf(const std::vector<PointMatrix>& columns, int layer)
{
  PointMatrix points(static_cast<Eigen::Index>(columns.size()), 3);
  for (std::size_t i = 0; i < columns.size(); ++i)
  {
    points.row(static_cast<Eigen::Index>(i)) = columns[i].row(layer);
  }
  return points;
}
}

Result<SweptMesh> SweepAlongPath(
  const CellMesh<2>& mesh, const PointMatrixView& points, const PathSweepParams& params)
{
  const bool ring = params.Path.rows() > 2 && params.Path.cols() == 3 &&
    params.Path.row(0) == params.Path.row(params.Path.rows() - 1);
  if (Status status = CheckPath(params, ring); !status)
  {
    return status;
  }
  if (Status status = CheckSource(mesh, points, params.Layers); !status)
  {
    return status;
  }
  std::vector<Frame> frames;
  if (Status status = MakeFrames(params, ring, frames); !status)
  {
    return status;
  }
  SweptMesh swept;
  swept.Layers = params.Layers;
  swept.IsRing = ring;
  const Eigen::Index n = points.rows();
  const Eigen::Index last = params.Layers + (ring ? 0 : 1);
  swept.Points.resize(last * n, 3);
  swept.Points.topRows(n) = points;
  const PointMatrix local = (points.rowwise() - frames[0].Origin.transpose()) * frames[0].Axes;
  for (Eigen::Index k = 1; k < last; ++k)
  {
    if (params.Progress && !params.Progress(static_cast<double>(k) / static_cast<double>(last)))
    {
      return { ErrorCode::Aborted, "" };
    }
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    swept.Points.middleRows(k * n, n) =
      (local * frame.Axes.transpose()).rowwise() + frame.Origin.transpose();
  }
  AddCells(mesh, swept);
  return swept;
}

Result<SweptMesh> SweepBetween(
  const CellMesh<2>& mesh, const PointMatrixView& points, const LinkedSweepParams& params)
{
  const int layers =
    params.Columns.empty() ? 0 : static_cast<int>(params.Columns.front().rows()) - 1;
  if (Status status = CheckSource(mesh, points, layers); !status)
  {
    return status;
  }
  if (layers < 1 || params.Columns.size() != params.Rim.size())
  {
    return { ErrorCode::SizeMismatch,
      "the rim of " + std::to_string(params.Rim.size()) + " points has " +
        std::to_string(params.Columns.size()) + " columns of " + std::to_string(layers) +
        " layers" };
  }
  for (const PointMatrix& column : params.Columns)
  {
    if (column.rows() != layers + 1 || column.cols() != 3)
    {
      return { ErrorCode::SizeMismatch,
        "columns of the rim have " + std::to_string(layers) + " and " +
          std::to_string(column.rows() - 1) + " layers" };
    }
    if (!column.allFinite())
    {
      return { ErrorCode::NonFiniteInput, "a column of the rim is not finite" };
    }
  }
  if (params.Target.rows() > 0 &&
    (params.Target.rows() != points.rows() || params.Target.cols() != 3))
  {
    return { ErrorCode::SizeMismatch,
      "the target has " + std::to_string(params.Target.rows()) + " points for " +
        std::to_string(points.rows()) };
  }
  if (Status status = CheckRim(mesh, params.Rim); !status)
  {
    return status;
  }
  HarmonicExtension harmonic;
  if (Status status = harmonic.Make(mesh, params.Rim); !status)
  {
    return status;
  }
  SweptMesh swept;
  swept.Layers = layers;
  const Eigen::Index n = points.rows();
  swept.Points.resize((layers + 1) * n, 3);
  swept.Points.topRows(n) = points;
  const PointMatrix first = LayerOf(params.Columns, 0);

  // what follows the rim of one end to a layer
  const auto follow = [&](
                        const PointMatrixView& end, const PointMatrix& from, const PointMatrix& to)
  {
    const RimMap map(from, to);
    PointMatrix correction = PointMatrix::Zero(n, 3);
    for (std::size_t i = 0; i < params.Rim.size(); ++i)
    {
      const auto row = static_cast<Eigen::Index>(i);
      correction.row(params.Rim[i]) = to.row(row) - map(from.row(row));
    }
    harmonic.Extend(correction);
    PointMatrix moved(n, 3);
    for (Eigen::Index v = 0; v < n; ++v)
    {
      moved.row(v) = map(end.row(v)) + correction.row(v);
    }
    return moved;
  };
  if (RimMap(first, first).IsFlat())
  {
    return { ErrorCode::InvalidTopology, "the rim of the source lies in one line" };
  }
  const PointMatrix lastRim = LayerOf(params.Columns, layers);
  const PointMatrix target =
    params.Target.rows() > 0 ? params.Target : follow(points, first, lastRim);
  for (int k = 1; k <= layers; ++k)
  {
    if (params.Progress && !params.Progress(static_cast<double>(k) / layers))
    {
      return { ErrorCode::Aborted, "" };
    }
    const PointMatrix rim = LayerOf(params.Columns, k);
    const double share = static_cast<double>(k) / layers;
    auto layer = swept.Points.middleRows(k * n, n);
    layer = k == layers ? target
                        : PointMatrix((1.0 - share) * follow(points, first, rim) +
                            share * follow(target, lastRim, rim));
    for (std::size_t i = 0; i < params.Rim.size(); ++i) // to the last bit
    {
      layer.row(params.Rim[i]) = rim.row(static_cast<Eigen::Index>(i));
    }
  }
  AddCells(mesh, swept);
  return swept;
}
}
