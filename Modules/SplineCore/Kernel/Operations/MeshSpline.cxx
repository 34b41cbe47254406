// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSpline.h"

#include "BezierForm.h"
#include "BezierProjection.h"
#include "DualFunctionals.h"
#include "VertexWindow.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Status CheckVertices(const SplineSpacePtr<Dim>& space, const PointMatrixView& vertices)
{
  if (!space)
  {
    return { ErrorCode::EmptyInput, "no space" };
  }
  if (space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the space is none on a mesh" };
  }
  if (vertices.rows() != MeshOf(*space).NumPoints || vertices.cols() < 1)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(vertices.rows()) + " vertices of " + std::to_string(vertices.cols()) +
        " coordinates for a mesh of " + std::to_string(MeshOf(*space).NumPoints) };
  }
  for (Eigen::Index i = 0; i < vertices.rows(); ++i)
  {
    if (!vertices.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "vertex " + std::to_string(i) };
    }
  }
  return {};
}

/// A place in a mesh as distances in knot intervals from the lower ends of a cell, whose directions
/// have turned on the way: direction d goes out of side Ahead[d].
template <int Dim>
struct MeshPlace
{
  int Cell = 0;
  IntArray<Dim> Ahead{};
  RealArray<Dim> Distance{};
};

/// Goes to the cell that the place is in, straight along one direction after the other; what is
/// beyond the boundary ends there.
template <int Dim>
void WalkInside(const UnstructuredData<Dim>& data, MeshPlace<Dim>& place)
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const auto length = [&] { return data.Length(place.Cell, place.Ahead[d] / 2); };
    for (;;)
    {
      const bool below = place.Distance[d] < 0.0;
      const int side = below ? place.Ahead[d] ^ 1 : place.Ahead[d];
      if ((!below && place.Distance[d] <= length()) || data.Topology.IsBoundary(place.Cell, side))
      {
        break;
      }
      place.Distance[d] -= below ? 0.0 : length();
      const FacetCrossing<Dim>& crossing = data.Topology.Crossing(place.Cell, side);
      place.Cell = data.Topology.Neighbour(place.Cell, side);
      for (int& ahead : place.Ahead)
      {
        ahead = crossing.Image[At(ahead)];
      }
      place.Distance[d] += below ? length() : 0.0;
    }
    place.Distance[d] = std::clamp(place.Distance[d], 0.0, length());
  }
}

/// The mesh's multilinear map.
template <int Dim>
void ValueAt(const UnstructuredData<Dim>& data, const MeshPlace<Dim>& place,
  const PointMatrixView& vertices, Eigen::Ref<Eigen::RowVectorXd> value)
{
  value.setZero();
  for (int k = 0; k < (1 << Dim); ++k)
  {
    double weight = 1.0;
    int corner = 0;
    for (int d = 0; d < Dim; ++d)
    {
      const int ahead = place.Ahead[At(d)];
      const double t = place.Distance[At(d)] / data.Length(place.Cell, ahead / 2);
      weight *= (k >> d & 1) != 0 ? t : 1.0 - t;
      const int end = (k >> d & 1) != 0 ? ahead : ahead ^ 1;
      corner |= end % 2 << end / 2;
    }
    value += weight * vertices.row(data.Mesh.Cell(place.Cell)[corner]);
  }
}

/// Facets that are C^0 and not left out, each once.
std::vector<CellSide> FindCreases(
  const UnstructuredData<2>& data, const std::vector<CellSide>& leftOut)
{
  std::vector<char> isOut(At(data.Topology.NumCells()) * 4, 0);
  for (const CellSide& side : leftOut)
  {
    isOut[At(side.Cell * 4 + side.Side)] = 1;
    isOut[At(data.Topology.Neighbour(side.Cell, side.Side) * 4 +
      data.Topology.Crossing(side.Cell, side.Side).Side)] = 1;
  }
  std::vector<CellSide> creases;
  for (int c = 0; c < data.Topology.NumCells(); ++c)
  {
    for (int side = 0; side < 4; ++side)
    {
      const bool isOnce = data.ContinuityOf(c, side) == 0 &&
        (c < data.Topology.Neighbour(c, side) ||
          (c == data.Topology.Neighbour(c, side) && side < data.Topology.Crossing(c, side).Side));
      if (isOnce && isOut[At(c * 4 + side)] == 0)
      {
        creases.push_back({ c, side });
      }
    }
  }
  return creases;
}

/// Local parameters of a point on a side.
void OnSide(int side, double t, double* local)
{
  local[side / 2] = side % 2;
  local[1 - side / 2] = t;
}

Eigen::Vector3d NormalOf(const EvaluationBatch& batch, Eigen::Index row, Eigen::Index components)
{
  const Eigen::Vector3d u = batch.First.row(row).head<3>();
  const Eigen::Vector3d v = batch.First.row(row).segment<3>(components);
  return u.cross(v);
}

/// Creases that are evaluated at once.
constexpr std::size_t BatchSize = 4096;
}

template <int Dim>
Result<Spline<Dim>> SplineThroughVertices(const SplineSpacePtr<Dim>& space,
  const PointMatrixView& vertices, int threads, const ProgressCallback& progress)
{
  if (const Status status = CheckVertices<Dim>(space, vertices); !status)
  {
    return status;
  }
  const UnstructuredData<Dim>& data = *space->Unstructured;
  ProjectionParams params;
  params.Threads = threads;
  params.Progress = progress;
  return ProjectOntoSpace<Dim>(
    space, static_cast<int>(vertices.cols()),
    [&](int cell, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
    {
      InterpolateAround(data, cell, local, vertices, values);
      return true;
    },
    params);
}

template <int Dim>
Result<Spline<Dim>> SplineOfCage(const SplineSpacePtr<Dim>& space, const PointMatrixView& vertices)
{
  if (const Status status = CheckVertices<Dim>(space, vertices); !status)
  {
    return status;
  }
  const UnstructuredData<Dim>& data = *space->Unstructured;
  const int p = data.Degree;
  KnotWindows windows(p);
  const std::vector<int> windowOf = FindWindows(data, windows);
  std::vector<std::vector<double>> means; // of p knots, p + 1 a window
  for (int w = 0; w < windows.Count(); ++w)
  {
    const std::vector<double> knots = windows.LocalKnots(w);
    std::vector<double>& of = means.emplace_back();
    for (auto first = knots.begin(); first + p <= knots.end(); ++first)
    {
      of.push_back(std::accumulate(first, first + p, 0.0) / p);
    }
  }
  Spline<Dim> spline;
  spline.Space = space;
  spline.ControlPoints.resize(space->NumFunctions, vertices.cols());
  const DualFunctionals<Dim> duals(*space);
  const std::vector<FunctionalSite> sites = ChooseSites(*space, duals);
  Eigen::RowVectorXd value(vertices.cols());
  for (int f = 0; f < space->NumFunctions; ++f)
  {
    const FunctionalSite& site = sites[At(f)];
    const auto index = TensorIndex<Dim>(space->Elements[At(site.Element)].Degree, site.Local);
    MeshPlace<Dim> place;
    place.Cell = site.Element;
    for (int d = 0; d < Dim; ++d)
    {
      place.Ahead[At(d)] = 2 * d + 1;
      place.Distance[At(d)] = means[At(windowOf[At(site.Element * Dim + d)])][At(index[At(d)])];
    }
    WalkInside(data, place);
    ValueAt(data, place, vertices, value);
    spline.ControlPoints.row(f) = value;
  }
  return spline;
}

template <int Dim>
VertexDistance DistanceFromVertices(
  const Spline<Dim>& spline, const PointMatrixView& vertices, int threads)
{
  const CellMesh<Dim>& mesh = MeshOf(*spline.Space);
  std::vector<int> elements(At(mesh.NumPoints), -1);
  PointMatrix local(mesh.NumPoints, Dim);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      const int point = mesh.Cell(c)[corner];
      elements[At(point)] = c;
      for (int d = 0; d < Dim; ++d)
      {
        local(point, d) = corner >> d & 1;
      }
    }
  }
  EvaluationParams params;
  params.Threads = threads;
  EvaluationBatch batch;
  VertexDistance distance;
  if (EvaluateElements<Dim>(MakeBezierForm(spline, threads), elements, local, params, batch))
  {
    const Eigen::VectorXd squares = (batch.Values - vertices).rowwise().squaredNorm();
    distance.Largest = std::sqrt(squares.maxCoeff());
    distance.RootMeanSquare = std::sqrt(squares.mean());
  }
  return distance;
}

double LargestCreaseAngle(
  const Spline<2>& surface, const std::vector<CellSide>& features, int threads)
{
  const UnstructuredData<2>& data = *surface.Space->Unstructured;
  const std::vector<CellSide> creases = FindCreases(data, features);
  const BezierForm<2> form = MakeBezierForm(surface, threads);
  const int samples = 2 * data.Degree + 3;
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = threads;
  EvaluationBatch batch;
  double largest = 0.0;
  for (std::size_t first = 0; first < creases.size(); first += BatchSize)
  {
    const std::size_t count = std::min(BatchSize, creases.size() - first);
    std::vector<int> elements; // this side and the other, in turn
    PointMatrix local(static_cast<Eigen::Index>(count) * samples * 2, 2);
    std::vector<bool> turned; // the other cell's normal, one a crease
    for (std::size_t i = first; i < first + count; ++i)
    {
      const auto [cell, side] = creases[i];
      const FacetCrossing<2>& crossing = data.Topology.Crossing(cell, side);
      turned.push_back(!crossing.Coherent);
      const bool reversed = crossing.Image[At(2 * (1 - side / 2))] % 2 == 1;
      for (int k = 0; k < samples; ++k)
      {
        const double t = static_cast<double>(k) / (samples - 1);
        OnSide(side, t, local.row(static_cast<Eigen::Index>(elements.size())).data());
        elements.push_back(cell);
        OnSide(crossing.Side, reversed ? 1.0 - t : t,
          local.row(static_cast<Eigen::Index>(elements.size())).data());
        elements.push_back(data.Topology.Neighbour(cell, side));
      }
    }
    if (!EvaluateElements<2>(form, elements, local, params, batch))
    {
      break;
    }
    for (Eigen::Index i = 0; i < local.rows(); i += 2)
    {
      const Eigen::Vector3d a = NormalOf(batch, i, form.NumComponents);
      const bool turn = turned[static_cast<std::size_t>(i / (2 * samples))];
      const Eigen::Vector3d b = (turn ? -1.0 : 1.0) * NormalOf(batch, i + 1, form.NumComponents);
      largest = std::max(largest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return largest * 180.0 / static_cast<double>(EIGEN_PI);
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<Spline<Dim>> SplineThroughVertices(                                              \
    const SplineSpacePtr<Dim>&, const PointMatrixView&, int, const ProgressCallback&);             \
  template Result<Spline<Dim>> SplineOfCage(const SplineSpacePtr<Dim>&, const PointMatrixView&);   \
  template VertexDistance DistanceFromVertices(const Spline<Dim>&, const PointMatrixView&, int);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
