// SPDX-License-Identifier: BSD-3-Clause
#include "ElementMending.h"

#include "ElementPatch.h"

#include <knotwork/DomainParameterization/DomainEnergy.h>
#include <knotwork/DomainParameterization/Minimize.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <optional>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
bool IsPlane(const Spline<Dim>& spline)
{
  return Dim == 2 && (spline.ControlPoints.col(2).array() == spline.ControlPoints(0, 2)).all();
}

/// Gives every element a box of its own size, so that det J is about one in each: elements of one
/// patch may differ in size a thousand times.
/// @param planes  NumFunctions x Dim.
template <int Dim>
void SetBoxes(SplineSpace<Dim>& space, const Eigen::MatrixXd& planes)
{
  Spline<Dim> geometry;
  geometry.Space = std::make_shared<SplineSpace<Dim>>(space);
  geometry.ControlPoints = planes;
  const BezierForm<Dim> form = MakeBezierForm(geometry, 1);
  const int count = space.Elements.front().Degree[0] + 1;
  IntArray<Dim> counts;
  counts.fill(count);
  const PointMatrix local = MakeElementQuadrature<Dim>(counts).Local;
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = 1;
  EvaluationBatch batch;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    EvaluateElements<Dim>(
      form, std::vector<int>(At(static_cast<int>(local.rows())), e), local, params, batch);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < local.rows(); ++i)
    {
      sum += std::abs(
        Eigen::Map<const Eigen::Matrix<double, Dim, Dim>>(batch.First.row(i).data()).determinant());
    }
    const double size =
      std::pow(std::max(sum / static_cast<double>(local.rows()), 1e-6), 1.0 / Dim);
    space.Elements[At(e)].Box.Upper.fill(size);
    space.Elements[At(e)].Box.Lower.fill(0.0);
  }
}

/// Differences of neighbouring control points of an element's net at one of its points, towards
/// inside.
Eigen::Matrix3d NetEdges(
  const double* block, const IntArray<3>& degree, const IntArray<3>& index, int count)
{
  Eigen::Matrix3d edges;
  const int strides[] = { 1, degree[0] + 1, (degree[0] + 1) * (degree[1] + 1) };
  const int at = index[0] + index[1] * strides[1] + index[2] * strides[2];
  for (std::size_t d = 0; d < 3; ++d)
  {
    const bool isLast = index[d] == degree[d];
    const int low = isLast ? at - strides[d] : at;
    for (int c = 0; c < 3; ++c)
    {
      edges(c, static_cast<Eigen::Index>(d)) =
        block[c * count + low + strides[d]] - block[c * count + low];
    }
  }
  return edges;
}
/// The function that a local coefficient is, or has the largest share in it.
template <int Dim>
int MainFunction(const SplineSpace<Dim>& space, int row)
{
  if (space.IsIdentityMap())
  {
    return row;
  }
  std::size_t best = space.RowStart[At(row)];
  for (std::size_t k = best; k < space.RowStart[At(row) + 1]; ++k)
  {
    best = space.RowCoefficient[k] > space.RowCoefficient[best] ? k : best;
  }
  return space.RowFunction[best];
}

/// Pairs of functions that are neighbours in the net of an element, both ways, as often as in
/// elements.
template <int Dim>
std::vector<std::pair<int, int>> NetNeighbours(
  const SplineSpace<Dim>& space, const std::vector<int>& elements)
{
  std::vector<std::pair<int, int>> pairs;
  for (const int e : elements)
  {
    const auto& degree = space.Elements[At(e)].Degree;
    const int* locals = space.LocalFunctions(e);
    int stride = 1;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      for (int i = 0; i < NumTensorFunctions<Dim>(degree); ++i)
      {
        if (i / stride % (degree[d] + 1) < degree[d])
        {
          const int a = MainFunction(space, locals[i]);
          const int b = MainFunction(space, locals[i + stride]);
          if (a != b)
          {
            pairs.emplace_back(a, b);
            pairs.emplace_back(b, a);
          }
        }
      }
      stride *= degree[d] + 1;
    }
  }
  return pairs;
}
}

template <int Dim>
Result<ElementVerdicts> CertifyElements(
  const Spline<Dim>& spline, int threads, const ProgressCallback& progress)
{
  Spline<Dim> geometry = spline;
  if (IsPlane(spline))
  {
    geometry.ControlPoints = spline.ControlPoints.leftCols(2).eval();
  }
  JacobianParams params;
  params.Threads = threads;
  if (Dim < geometry.ControlPoints.cols())
  {
    // the normal of a folded element that is plane vanishes along a line: no number of boxes
    // decides
    params.MaxBoxes = 20000;
  }
  auto certificate =
    ValidateJacobian(MakeBernsteinCells(MakeBezierForm(geometry, threads)), params, progress);
  if (!certificate)
  {
    return certificate.Status;
  }
  Result<ElementVerdicts> result;
  result->Certificate = std::move(certificate.Value);
  result->IsReversed = result->Certificate.NumReversed > result->Certificate.NumValid;
  const Verdict good = result->IsReversed ? Verdict::Reversed : Verdict::Valid;
  for (std::size_t e = 0; e < result->Certificate.Cells.size(); ++e)
  {
    if (result->Certificate.Cells[e].Verdict != good)
    {
      result->Bad.push_back(static_cast<int>(e));
    }
  }
  return result;
}

template <int Dim>
std::vector<int> InvertedNets(const Spline<Dim>& spline, bool isReversed)
{
  const BezierForm<Dim> form = MakeBezierForm(spline, 1);
  std::vector<int> inverted;
  const double sign = isReversed ? -1.0 : 1.0;
  for (int e = 0; e < spline.Space->NumElements(); ++e)
  {
    IntArray<3> degree{ 0, 0, 0 };
    const auto& own = spline.Space->Elements[At(e)].Degree;
    std::copy(own.begin(), own.end(), degree.begin());
    const int count = NumTensorFunctions<Dim>(own);
    bool isInverted = false;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int pass : { 0, 1 })
    {
      for (int i = 0; i < count; ++i)
      {
        IntArray<3> index{ i % (degree[0] + 1), i / (degree[0] + 1) % (degree[1] + 1),
          i / ((degree[0] + 1) * (degree[1] + 1)) };
        Eigen::Matrix3d edges;
        if constexpr (Dim == 3)
        {
          edges = NetEdges(form.Block(e), degree, index, count);
          isInverted = isInverted || !(sign * edges.determinant() > 0.0);
        }
        else
        {
          const int at = index[0] + index[1] * (degree[0] + 1);
          const int u = index[0] == degree[0] ? at - 1 : at;
          const int v = index[1] == degree[1] ? at - degree[0] - 1 : at;
          for (int c = 0; c < 3; ++c)
          {
            edges(c, 0) = form.Block(e)[c * count + u + 1] - form.Block(e)[c * count + u];
            edges(c, 1) =
              form.Block(e)[c * count + v + degree[0] + 1] - form.Block(e)[c * count + v];
          }
          const Eigen::Vector3d a = edges.col(0);
          const Eigen::Vector3d normal = a.cross(Eigen::Vector3d(edges.col(1)));
          if (pass == 0)
          {
            mean += normal;
          }
          else
          {
            const double turn = IsPlane(spline) ? sign * normal[2] : mean.dot(normal);
            isInverted = isInverted || !(turn > 0.0);
          }
        }
      }
    }
    if (isInverted)
    {
      inverted.push_back(e);
    }
  }
  return inverted;
}

template <int Dim>
int ExtendMoves(Spline<Dim>& spline, const std::vector<int>& elements, const PointMatrix& moves,
  const std::vector<char>& isHeld, const MendingParams& params)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const std::vector<int> patch = Rings<Dim>(MeshOf(space), elements, params.Rings);
  const PatchFunctions functions = FunctionsOf<Dim>(space, patch, isHeld);
  Eigen::VectorXi unknown = Eigen::VectorXi::Constant(space.NumFunctions, -1);
  int count = 0;
  for (std::size_t i = 0; i < functions.Functions.size(); ++i)
  {
    if (functions.IsFree[i] != 0)
    {
      unknown[functions.Functions[i]] = count++;
    }
  }
  if (count == 0)
  {
    return 0;
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3);
  for (const auto& [own, other] : NetNeighbours(space, patch))
  {
    const int row = unknown[own];
    const int column = unknown[other];
    if (row < 0)
    {
      continue;
    }
    entries.emplace_back(row, row, 1.0);
    if (column >= 0)
    {
      entries.emplace_back(row, column, -1.0);
    }
    else if (isHeld[At(other)] != 0)
    {
      right.row(row) += moves.row(other);
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(1e-10);
  const Eigen::MatrixXd solution = solver.solve(right);
  if (!solution.allFinite())
  {
    return 0;
  }
  for (const int function : functions.Functions)
  {
    if (unknown[function] >= 0)
    {
      spline.ControlPoints.row(function) += solution.row(unknown[function]);
    }
  }
  return static_cast<int>(patch.size());
}

namespace
{
/// Of a control point on the surface, in sizes of elements: farther it leaves the target for good.
constexpr double MostMove = 0.5;

/// Elements without a certificate. @param planes  NumFunctions x Dim, not mirrored any more.
template <int Dim>
std::size_t CountBad(const SplineSpace<Dim>& space, const Eigen::MatrixXd& planes)
{
  Spline<Dim> geometry;
  geometry.Space = std::make_shared<SplineSpace<Dim>>(space);
  geometry.ControlPoints = planes;
  JacobianParams params;
  params.Threads = 1;
  const auto certificate =
    ValidateJacobian(MakeBernsteinCells(MakeBezierForm(geometry, 1)), params);
  return certificate ? certificate->Cells.size() - static_cast<std::size_t>(certificate->NumValid)
                     : space.Elements.size();
}

template <int Dim>
double MeanSize(const SplineSpace<Dim>& space)
{
  double sum = 0.0;
  for (const auto& element : space.Elements)
  {
    sum += element.Box.Upper[0];
  }
  return sum / space.NumElements();
}

double LargestHeldMove(
  const PatchFunctions& functions, const std::vector<char>& isHeld, const Eigen::MatrixXd& moves)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < functions.Functions.size(); ++i)
  {
    if (isHeld[At(functions.Functions[i])] != 0)
    {
      largest = std::max(largest, moves.row(static_cast<Eigen::Index>(i)).norm());
    }
  }
  return largest;
}

/// The directions that a part of a surface in space is seen in, a row each: two in its mean plane,
/// then its mean normal, by the diagonals of elements.
/// @return none where the sum of the normals is less than half as long as all of them.
std::optional<Eigen::Matrix3d> FrameOf(const Spline<2>& part)
{
  constexpr double LeastSum = 0.5;
  const BezierForm<2> form = MakeBezierForm(part, 1);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double length = 0.0;
  for (int e = 0; e < part.Space->NumElements(); ++e)
  {
    const auto& degree = part.Space->Elements[At(e)].Degree;
    const int count = NumTensorFunctions<2>(degree);
    const auto corner = [&](int u, int v)
    {
      const double* point = form.Block(e) + u * degree[0] + v * degree[1] * (degree[0] + 1);
      return Eigen::Vector3d(point[0], point[count], point[2 * count]);
    };
    const Eigen::Vector3d normal = (corner(1, 1) - corner(0, 0)).cross(corner(0, 1) - corner(1, 0));
    sum += normal;
    length += normal.norm();
  }
  if (!(sum.norm() > LeastSum * length))
  {
    return std::nullopt;
  }
  Eigen::Matrix3d frame;
  frame.row(2) = sum.normalized();
  frame.row(0) = frame.row(2).transpose().unitOrthogonal();
  frame.row(1) = frame.row(2).cross(frame.row(0));
  return frame;
}

/// Minimizes in one patch; nothing changes unless it has fewer elements without a certificate then.
template <int Dim>
Result<int> MendPatch(Spline<Dim>& spline, const std::vector<int>& patch, bool isReversed,
  bool isInSpace, const std::vector<char>& isHeld, const MendingParams& params)
{
  const SplineSpace<Dim>& space = *spline.Space;
  std::vector<char> stays = isHeld;
  if (params.Attraction > 0.0)
  {
    std::transform(stays.begin(), stays.end(), stays.begin(),
      [](char held) { return static_cast<char>(held == HeldFast ? 1 : 0); });
  }
  const PatchFunctions functions = FunctionsOf<Dim>(space, patch, stays);
  SplineSpace<Dim> part = Restrict(space, patch, functions);
  const auto count = static_cast<Eigen::Index>(functions.Functions.size());
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < count; ++i)
  {
    if (functions.IsFree[static_cast<std::size_t>(i)] != 0)
    {
      free.push_back(i);
    }
  }
  if (free.empty())
  {
    return 0;
  }
  Spline<Dim> seen; // the part in the directions that it is seen in
  seen.ControlPoints = spline.ControlPoints(functions.Functions, Eigen::all);
  std::optional<Eigen::Matrix3d> frame = Eigen::Matrix3d::Identity();
  if constexpr (Dim == 2)
  {
    if (isInSpace)
    {
      seen.Space = std::make_shared<SplineSpace<Dim>>(part);
      frame = FrameOf(seen);
    }
  }
  if (!frame)
  {
    return 0;
  }
  seen.ControlPoints *= frame->transpose();
  // planes of coordinates, mirrored where most elements are reversed, in units of an element
  Eigen::MatrixXd planes = seen.ControlPoints.template leftCols<Dim>();
  const Eigen::RowVectorXd origin = planes.colwise().mean();
  planes.rowwise() -= origin;
  const double extent = (planes.colwise().maxCoeff() - planes.colwise().minCoeff()).norm();
  const double scale = std::pow(static_cast<double>(patch.size()), 1.0 / Dim) / extent;
  planes *= scale;
  planes.col(0) *= isReversed ? -1.0 : 1.0;
  SetBoxes(part, planes);
  const std::size_t before = CountBad(part, planes);
  const Eigen::MatrixXd begin = planes;
  const int degree = part.Elements.front().Degree[0];
  DomainEnergy<Dim> energy(
    MakeElementField<Dim>(part, std::vector<int>(part.Elements.size(), degree + 2)),
    static_cast<int>(count));
  Density density;
  density.Lambda = 0.0;
  density.Kind = DensityKind::Penalty;
  bool isStopped = false;
  for (const double delta : { 0.1, 0.02, 0.004 })
  {
    density.Delta = delta;
    Eigen::MatrixXd gradient(count, Dim);
    const auto objective = [&](const Eigen::VectorXd& x, Eigen::VectorXd& slope)
    {
      for (std::size_t k = 0; k < free.size(); ++k)
      {
        for (Eigen::Index d = 0; d < Dim; ++d)
        {
          planes(free[k], d) = x[static_cast<Eigen::Index>(k) * Dim + d];
        }
      }
      const EnergyValue value =
        energy.Evaluate(density, planes.data(), nullptr, gradient.data(), nullptr);
      slope.resize(x.size());
      double sum = value.Energy;
      for (std::size_t k = 0; k < free.size(); ++k)
      {
        const auto held = isHeld[At(functions.Functions[static_cast<std::size_t>(free[k])])];
        const double attraction = held != 0 ? params.Attraction : 0.0;
        for (Eigen::Index d = 0; d < Dim; ++d)
        {
          const double move = planes(free[k], d) - begin(free[k], d);
          sum += attraction * move * move;
          slope[static_cast<Eigen::Index>(k) * Dim + d] =
            gradient(free[k], d) + 2.0 * attraction * move;
        }
      }
      return sum;
    };
    Eigen::VectorXd x(static_cast<Eigen::Index>(free.size()) * Dim);
    for (std::size_t k = 0; k < free.size(); ++k)
    {
      for (Eigen::Index d = 0; d < Dim; ++d)
      {
        x[static_cast<Eigen::Index>(k) * Dim + d] = planes(free[k], d);
      }
    }
    MinimizeParams minimize;
    minimize.MaxIterations = 200;
    minimize.EnergyTolerance = 1e-5;
    MinimizeLbfgs(x, objective, minimize, {},
      [&](const MinimizeState&)
      {
        isStopped = isStopped || (params.Progress && !params.Progress(0.0));
        return !isStopped;
      });
    if (isStopped)
    {
      return { ErrorCode::Aborted, "mending elements stopped" };
    }
    Eigen::VectorXd unused;
    objective(x, unused);
  }
  if (LargestHeldMove(functions, isHeld, planes - begin) > MostMove * MeanSize(part) ||
    CountBad(part, planes) >= before)
  {
    return 0;
  }
  planes.col(0) *= isReversed ? -1.0 : 1.0;
  planes /= scale;
  planes.rowwise() += origin;
  for (const Eigen::Index i : free)
  {
    Eigen::RowVector3d moved = seen.ControlPoints.row(i);
    moved.template head<Dim>() = planes.row(i);
    spline.ControlPoints.row(functions.Functions[static_cast<std::size_t>(i)]) = moved * *frame;
  }
  return static_cast<int>(patch.size());
}

}

template <int Dim>
Result<int> MinimizeBarrier(Spline<Dim>& spline, const std::vector<int>& elements, bool isReversed,
  const std::vector<char>& isHeld, const MendingParams& params)
{
  const bool isInSpace = Dim == 2 && !IsPlane(spline);
  const CellMesh<Dim>& mesh = MeshOf(*spline.Space);
  Result<int> changed(0);
  for (const std::vector<int>& patch :
    ConnectedParts<Dim>(mesh, Rings<Dim>(mesh, elements, params.Rings)))
  {
    const auto mended =
      MendPatch<Dim>(spline, patch, isReversed && !isInSpace, isInSpace, isHeld, params);
    if (!mended)
    {
      return mended;
    }
    changed.Value += mended.Value;
  }
  return changed;
}

template Result<ElementVerdicts> CertifyElements(const Spline<2>&, int, const ProgressCallback&);
template Result<ElementVerdicts> CertifyElements(const Spline<3>&, int, const ProgressCallback&);
template std::vector<int> InvertedNets(const Spline<2>&, bool);
template std::vector<int> InvertedNets(const Spline<3>&, bool);
template int ExtendMoves(Spline<2>&, const std::vector<int>&, const PointMatrix&,
  const std::vector<char>&, const MendingParams&);
template int ExtendMoves(Spline<3>&, const std::vector<int>&, const PointMatrix&,
  const std::vector<char>&, const MendingParams&);
template Result<int> MinimizeBarrier(
  Spline<2>&, const std::vector<int>&, bool, const std::vector<char>&, const MendingParams&);
template Result<int> MinimizeBarrier(
  Spline<3>&, const std::vector<int>&, bool, const std::vector<char>&, const MendingParams&);
}
