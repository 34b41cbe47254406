// SPDX-License-Identifier: BSD-3-Clause
#include "UnstructuredRefinement.h"

#include "Bernstein.h"
#include "UnstructuredData.h"
#include "UnstructuredSpace.h"

#include <Eigen/LU>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A cell of the halved mesh: bit d of Child is the half along direction d, where that is halved.
struct ChildCell
{
  int Parent;
  int Child;
};

/// The cells of the mesh with cells halved in some directions, those of a cell together.
/// @param halved  of every cell, bit d for direction d.
std::vector<ChildCell> ChildrenOf(const std::vector<int>& halved)
{
  std::vector<ChildCell> children;
  for (std::size_t c = 0; c < halved.size(); ++c)
  {
    for (int child = 0; child <= halved[c]; ++child)
    {
      if ((child & ~halved[c]) == 0)
      {
        children.push_back({ static_cast<int>(c), child });
      }
    }
  }
  return children;
}

/// The mesh with cells halved; new points are the middles of edges, faces and cells.
template <int Dim>
CellMesh<Dim> HalvedMesh(const CellMesh<Dim>& mesh, const std::vector<int>& halved)
{
  constexpr int numCorners = 1 << Dim;
  CellMesh<Dim> fine;
  fine.NumPoints = mesh.NumPoints;
  fine.Corners.reserve(mesh.Corners.size() << Dim);
  // middles of edges and faces by their lowest points: an edge's other end, or the lower neighbour
  // in a face and the point opposite
  std::map<std::array<int, 3>, int> middles;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    int points[Dim == 2 ? 9 : 27]; // 0, 1 (the middle), 2 a direction
    IntArray<Dim> x{};
    for (int& point : points)
    {
      int low = 0;
      int free = 0;
      for (int d = 0; d < Dim; ++d)
      {
        low |= x[At(d)] == 2 ? 1 << d : 0;
        free |= x[At(d)] == 1 ? 1 << d : 0;
      }
      if ((free & ~halved[At(c)]) != 0)
      {
        point = -1;
      }
      else if (free == 0)
      {
        point = mesh.Cell(c)[low];
      }
      else if (free == numCorners - 1)
      {
        point = fine.NumPoints++;
      }
      else
      {
        std::vector<int> corners;
        for (int corner = 0; corner < numCorners; ++corner)
        {
          if ((corner & ~free) == low)
          {
            corners.push_back(mesh.Cell(c)[corner]);
          }
        }
        std::sort(corners.begin(), corners.end());
        corners.resize(3, -1); // three points of a face say which it is
        const auto [place, isNew] =
          middles.try_emplace({ corners[0], corners[1], corners[2] }, fine.NumPoints);
        fine.NumPoints += isNew ? 1 : 0;
        point = place->second;
      }
      for (std::size_t d = 0; d < Dim && ++x[d] > 2; ++d)
      {
        x[d] = 0;
      }
    }
    for (int child = 0; child <= halved[At(c)]; ++child)
    {
      for (int corner = 0; (child & ~halved[At(c)]) == 0 && corner < numCorners; ++corner)
      {
        int at = 0;
        for (int d = Dim; d-- > 0;)
        {
          const bool isHalved = (halved[At(c)] >> d & 1) != 0;
          at = 3 * at + (isHalved ? (child >> d & 1) + (corner >> d & 1) : 2 * (corner >> d & 1));
        }
        fine.Corners.push_back(points[at]);
      }
    }
  }
  return fine;
}

/// Control points of a larger space from the coefficients in its local functions. Every function
/// is a local function of its own on the cells that it meets: it is read on the first.
/// @param coefficients  of a cell: from the element's local coefficients, one column a component.
template <int Dim, class Coefficients>
Spline<Dim> ReadFunctions(
  const Spline<Dim>& spline, const SplineSpacePtr<Dim>& space, Coefficients&& coefficients)
{
  std::vector<int> functionOf(At(space->NumLocalFunctions), -1);
  for (int j = 0; j < space->NumLocalFunctions; ++j)
  {
    if (space->IsIdentityMap())
    {
      functionOf[At(j)] = j;
    }
    else if (space->RowStart[At(j) + 1] - space->RowStart[At(j)] == 1)
    {
      functionOf[At(j)] = space->RowFunction[space->RowStart[At(j)]];
    }
  }
  const PointMatrix local = spline.Space->LocalCoefficients(spline.HomogeneousPoints(), 1);
  PointMatrix points = PointMatrix::Zero(space->NumFunctions, local.cols());
  std::vector<char> isSet(At(space->NumFunctions), 0);
  std::vector<double> values;
  for (int e = 0; e < space->NumElements(); ++e)
  {
    const int* ids = space->LocalFunctions(e);
    const int count = NumTensorFunctions<Dim>(space->Elements[At(e)].Degree);
    const auto isOpen = [&](int id)
    { return functionOf[At(id)] >= 0 && isSet[At(functionOf[At(id)])] == 0; };
    if (std::none_of(ids, ids + count, isOpen))
    {
      continue;
    }
    for (Eigen::Index column = 0; column < local.cols(); ++column)
    {
      coefficients(e, local, column, values);
      for (int a = 0; a < count; ++a)
      {
        if (isOpen(ids[a]))
        {
          points(functionOf[At(ids[a])], column) = values[At(a)];
        }
      }
    }
    for (int a = 0; a < count; ++a)
    {
      if (functionOf[At(ids[a])] >= 0)
      {
        isSet[At(functionOf[At(ids[a])])] = 1;
      }
    }
  }
  Spline<Dim> result;
  result.Space = space;
  result.SetHomogeneousPoints(points, spline.IsRational());
  return result;
}

/// One column of the local coefficients of an element.
template <int Dim>
std::vector<double> LocalColumn(
  const SplineSpace<Dim>& space, int element, const PointMatrix& local, Eigen::Index column)
{
  std::vector<double> values(At(NumTensorFunctions<Dim>(space.Elements[At(element)].Degree)));
  const int* ids = space.LocalFunctions(element);
  for (std::size_t a = 0; a < values.size(); ++a)
  {
    values[a] = local(ids[a], column);
  }
  return values;
}

std::vector<double> Transposed(const std::vector<double>& matrix, std::size_t n)
{
  std::vector<double> result(n * n);
  for (std::size_t i = 0; i < n * n; ++i)
  {
    result[i % n * n + i / n] = matrix[i];
  }
  return result;
}

/// @param halved  of every cell, bit d for direction d; the same for a sheet.
template <int Dim>
Result<RefinedSpline<Dim>> HalveUnstructured(
  const Spline<Dim>& spline, const std::vector<int>& halved)
{
  const UnstructuredData<Dim>& old = *spline.Space->Unstructured;
  const CellMesh<Dim> mesh = HalvedMesh(old.Mesh, halved);
  const std::vector<ChildCell> cells = ChildrenOf(halved);
  const auto isHalved = [&halved](int cell, int d) { return (halved[At(cell)] >> d & 1) != 0; };
  std::vector<int> continuity;
  continuity.reserve(cells.size() * 2 * Dim);
  for (const auto [parent, child] : cells)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      const bool isOld = !isHalved(parent, side / 2) || (child >> (side / 2) & 1) == side % 2;
      continuity.push_back(isOld ? old.ContinuityOf(parent, side) : old.Degree - 1);
    }
  }
  std::vector<double> lengths;
  const auto isWhole = [](int directions) { return directions == (1 << Dim) - 1; };
  // where all are halved, equal intervals stay equal
  if (!old.Lengths.empty() || !std::all_of(halved.begin(), halved.end(), isWhole))
  {
    const auto topology = MeshTopology<Dim>::Make(mesh);
    if (!topology)
    {
      return topology.Status;
    }
    const auto sheets = topology.Value.FindSheets();
    lengths.resize(At(sheets.Count));
    for (std::size_t i = 0; i < sheets.Of.size(); ++i)
    {
      const int parent = cells[i / Dim].Parent;
      const int d = static_cast<int>(i % Dim);
      lengths[At(sheets.Of[i])] = (isHalved(parent, d) ? 0.5 : 1.0) * old.Length(parent, d);
    }
  }
  auto space = MakeUnstructuredSpace<Dim>(mesh, old.Degree, continuity, lengths);
  if (!space)
  {
    return space.Status;
  }
  // knots of a cell and its halves are knots before and middles: Oslo matrices
  KnotWindows windows(old.Degree);
  const std::vector<int> windowOf = FindWindows(old, windows);
  KnotWindows fineWindows(old.Degree);
  const std::vector<int> fineWindowOf = FindWindows(*space.Value->Unstructured, fineWindows);
  enum Part
  {
    Lower,
    Upper,
    Whole
  };
  std::map<std::array<int, 3>, std::vector<double>> parts;
  const auto matrixOf = [&](int window, int fine, Part part) -> const double*
  {
    std::vector<double>& matrix = parts[{ window, fine, part }];
    if (matrix.empty())
    {
      const std::vector<double> knots = windows.LocalKnots(window);
      std::vector<double> target = fineWindows.LocalKnots(fine);
      const auto p = At(old.Degree);
      const double length = part == Whole ? knots[p] : 0.5 * knots[p];
      const double scale = length / target[p];
      for (double& knot : target)
      {
        knot = scale * knot + (part == Upper ? length : 0.0);
      }
      matrix = Transposed(ConvertLocalKnots(old.Degree, target, knots), p + 1);
    }
    return matrix.data();
  };
  RefinedSpline<Dim> result;
  result.Value = ReadFunctions<Dim>(spline, space.Value,
    [&](int e, const PointMatrix& local, Eigen::Index column, std::vector<double>& values)
    {
      const auto [parent, child] = cells[At(e)];
      values = LocalColumn(*spline.Space, parent, local, column);
      std::array<const double*, Dim> factors;
      for (int d = 0; d < Dim; ++d)
      {
        const Part half = (child >> d & 1) != 0 ? Upper : Lower;
        factors[At(d)] = matrixOf(windowOf[At(parent * Dim + d)], fineWindowOf[At(e * Dim + d)],
          isHalved(parent, d) ? half : Whole);
      }
      ApplyFactors<Dim>(
        spline.Space->Elements[At(parent)].Degree, factors, values.data(), values.data());
    });
  for (const ChildCell& cell : cells)
  {
    result.Parents.push_back(cell.Parent);
  }
  return result;
}
}

template <int Dim>
Result<RefinedSpline<Dim>> HalveAllSheets(const Spline<Dim>& spline)
{
  return HalveUnstructured(spline, std::vector<int>(spline.Space->Elements.size(), (1 << Dim) - 1));
}

template <int Dim>
Result<RefinedSpline<Dim>> HalveSheets(const Spline<Dim>& spline, const std::vector<int>& sheets)
{
  if (!spline.Space || spline.Space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "only splines on unstructured meshes have sheets" };
  }
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  if (sheets.empty())
  {
    RefinedSpline<Dim> same;
    same.Value = spline;
    same.Parents.resize(spline.Space->Elements.size());
    std::iota(same.Parents.begin(), same.Parents.end(), 0);
    return same;
  }
  const auto all = spline.Space->Unstructured->Topology.FindSheets();
  std::vector<char> isMarked(At(all.Count), 0);
  for (const int sheet : sheets)
  {
    if (sheet < 0 || sheet >= all.Count)
    {
      return { ErrorCode::InvalidParameter,
        "there is no sheet " + std::to_string(sheet) + ": there are " + std::to_string(all.Count) };
    }
    isMarked[At(sheet)] = 1;
  }
  std::vector<int> halved(spline.Space->Elements.size(), 0);
  for (std::size_t i = 0; i < all.Of.size(); ++i)
  {
    halved[i / Dim] |= isMarked[At(all.Of[i])] != 0 ? 1 << i % Dim : 0;
  }
  return HalveUnstructured(spline, halved);
}

template <int Dim>
Result<RefinedSpline<Dim>> HalveSheetsOfCells(
  const Spline<Dim>& spline, const std::vector<int>& cells)
{
  const auto all = spline.Space->Unstructured->Topology.FindSheets();
  std::vector<int> sheets;
  for (const int cell : cells)
  {
    if (cell < 0 || cell >= spline.Space->NumElements())
    {
      return { ErrorCode::InvalidParameter, "there is no element " + std::to_string(cell) };
    }
    for (int d = 0; d < Dim; ++d)
    {
      sheets.push_back(all.Of[At(cell * Dim + d)]);
    }
  }
  return HalveSheets(spline, sheets);
}

template <int Dim>
Result<Spline<Dim>> ElevateUnstructured(const Spline<Dim>& spline, int times)
{
  const UnstructuredData<Dim>& old = *spline.Space->Unstructured;
  const int degree = old.Degree + times;
  auto space = MakeUnstructuredSpace<Dim>(
    old.Mesh, degree, { old.Continuity.begin(), old.Continuity.end() }, old.Lengths);
  if (!space)
  {
    return space.Status;
  }
  // from Bernstein coefficients to those of the local functions, by factor
  const Eigen::Index n = degree + 1;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::map<int, Matrix> inverses;
  const auto inverseOf = [&](int factor) -> const double*
  {
    if (factor < 0)
    {
      return nullptr;
    }
    Matrix& inverse = inverses[factor];
    if (inverse.size() == 0)
    {
      inverse = Eigen::Map<const Matrix>(space.Value->FactorData.data() + factor, n, n)
                  .fullPivLu()
                  .inverse();
    }
    return inverse.data();
  };
  return ReadFunctions<Dim>(spline, space.Value,
    [&](int e, const PointMatrix& local, Eigen::Index column, std::vector<double>& values)
    {
      const auto& element = spline.Space->Elements[At(e)];
      values = LocalColumn(*spline.Space, e, local, column);
      ApplyFactors<Dim>(element.Degree, spline.Space->Factors(e), values.data(), values.data());
      const auto& raised = space.Value->Elements[At(e)];
      values = BernsteinElevate<Dim>(element.Degree, values, raised.Degree);
      std::array<const double*, Dim> factors;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        factors[d] = inverseOf(raised.Factor[d]);
      }
      ApplyFactors<Dim>(raised.Degree, factors, values.data(), values.data());
    });
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<RefinedSpline<Dim>> HalveAllSheets(const Spline<Dim>&);                          \
  template Result<RefinedSpline<Dim>> HalveSheets(const Spline<Dim>&, const std::vector<int>&);    \
  template Result<RefinedSpline<Dim>> HalveSheetsOfCells(                                          \
    const Spline<Dim>&, const std::vector<int>&);                                                  \
  template Result<Spline<Dim>> ElevateUnstructured<Dim>(const Spline<Dim>&, int);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
