// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSpline.h"

#include "BezierForm.h"
#include "BezierProjection.h"
#include "DualFunctionals.h"
#include "VertexWindow.h"

#include <knotwork/SplineCore/AngleBetween.h>

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

/// det J times a direction that tells its sign: of surfaces in space the normal.
template <int Dim>
Eigen::Vector3d Turn(const EvaluationBatch& batch, Eigen::Index row, Eigen::Index components)
{
  const auto derivative = [&](int d) -> Eigen::Vector3d
  {
    Eigen::Vector3d column = Eigen::Vector3d::Zero();
    const Eigen::Index n = std::min<Eigen::Index>(components, 3);
    column.head(n) = batch.First.row(row).segment(d * components, n);
    return column;
  };
  const Eigen::Vector3d normal = derivative(0).cross(derivative(1));
  return Dim == 2 ? normal : Eigen::Vector3d(0.0, 0.0, normal.dot(derivative(Dim - 1)));
}

template <int Dim>
bool IsPlane(const Spline<Dim>& spline)
{
  const auto& points = spline.ControlPoints;
  return points.cols() < 3 || (points.col(2).array() == points(0, 2)).all();
}

/// Local parameters of n points a direction, ends among them.
template <int Dim>
PointMatrix LocalGrid(int n)
{
  PointMatrix grid(static_cast<Eigen::Index>(std::pow(n, Dim)), Dim);
  for (Eigen::Index i = 0; i < grid.rows(); ++i)
  {
    Eigen::Index rest = i;
    for (int d = 0; d < Dim; ++d, rest /= n)
    {
      grid(i, d) = static_cast<double>(rest % n) / (n - 1);
    }
  }
  return grid;
}
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
ElementFunction InterpolateVertices(
  const SplineSpacePtr<Dim>& space, const PointMatrix& vertices, const std::vector<int>& linear)
{
  const int degree = space->Unstructured->Degree;
  std::vector<char> widths(At(space->NumElements()), static_cast<char>(degree + 1 + degree % 2));
  for (const int cell : linear)
  {
    widths[At(cell)] = 1;
  }
  return [space, &vertices, widths](
           int cell, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
  {
    VertexWindow<Dim>(*space->Unstructured, cell, widths[At(cell)])
      .Interpolate(local, vertices, values);
    return true;
  };
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

template <int Dim>
std::vector<int> FoldedElements(const Spline<Dim>& spline, int threads)
{
  const BezierForm<Dim> form = MakeBezierForm(spline, threads);
  const PointMatrix grid = LocalGrid<Dim>(spline.Space->Unstructured->Degree + 2);
  const Eigen::Index samples = grid.rows();
  const int count = spline.Space->NumElements();
  const int atOnce = static_cast<int>(std::max<Eigen::Index>(1, 65536 / samples));
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = threads;
  EvaluationBatch batch;
  std::vector<Eigen::Vector3d> means(At(count), Eigen::Vector3d::Zero());
  const auto forSamples = [&](auto&& visit)
  {
    for (int first = 0; first < count; first += atOnce)
    {
      const int last = std::min(count, first + atOnce);
      std::vector<int> elements;
      for (int e = first; e < last; ++e)
      {
        elements.insert(elements.end(), At(static_cast<int>(samples)), e);
      }
      if (EvaluateElements<Dim>(form, elements, grid.replicate(last - first, 1), params, batch))
      {
        for (std::size_t i = 0; i < elements.size(); ++i)
        {
          visit(elements[i], Turn<Dim>(batch, static_cast<Eigen::Index>(i), form.NumComponents));
        }
      }
    }
  };
  forSamples([&](int e, const Eigen::Vector3d& turn) { means[At(e)] += turn; });
  if (Dim == 3 || IsPlane(spline))
  {
    const auto isUp = [](const Eigen::Vector3d& mean) { return mean[2] > 0.0; };
    const bool most = 2 * std::count_if(means.begin(), means.end(), isUp) >= count;
    std::fill(means.begin(), means.end(), Eigen::Vector3d(0.0, 0.0, most ? 1.0 : -1.0));
  }
  std::vector<int> folded;
  forSamples(
    [&](int e, const Eigen::Vector3d& turn)
    {
      if (!(turn.dot(means[At(e)]) > 0.0) && (folded.empty() || folded.back() != e))
      {
        folded.push_back(e);
      }
    });
  return folded;
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
      largest = std::max(largest, AngleBetween(a, b));
    }
  }
  return largest * 180.0 / static_cast<double>(EIGEN_PI);
}

template Result<Spline<2>> SplineThroughVertices(
  const SplineSpacePtr<2>&, const PointMatrixView&, int, const ProgressCallback&);
template Result<Spline<3>> SplineThroughVertices(
  const SplineSpacePtr<3>&, const PointMatrixView&, int, const ProgressCallback&);
template ElementFunction InterpolateVertices(
  const SplineSpacePtr<2>&, const PointMatrix&, const std::vector<int>&);
template ElementFunction InterpolateVertices(
  const SplineSpacePtr<3>&, const PointMatrix&, const std::vector<int>&);
template Result<Spline<2>> SplineOfCage(const SplineSpacePtr<2>&, const PointMatrixView&);
template Result<Spline<3>> SplineOfCage(const SplineSpacePtr<3>&, const PointMatrixView&);
template VertexDistance DistanceFromVertices(const Spline<2>&, const PointMatrixView&, int);
template VertexDistance DistanceFromVertices(const Spline<3>&, const PointMatrixView&, int);
template std::vector<int> FoldedElements(const Spline<2>&, int);
template std::vector<int> FoldedElements(const Spline<3>&, int);
}
