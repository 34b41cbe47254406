// SPDX-License-Identifier: BSD-3-Clause
#include "CoonsMap.h"

#include "PatchSides.h"
#include "PatchSpaces.h"

#include <string>

namespace knotwork
{
namespace
{
/// Index of a control point in its box, and the stride of every direction.
template <int Dim>
struct BoxIndex
{
  explicit BoxIndex(const BoxAbscissae<Dim>& abscissae)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      this->Size[d] = static_cast<int>(abscissae[d].size());
      this->Stride[d] = this->Count;
      this->Count *= this->Size[d];
    }
  }
  IntArray<Dim> Of(Eigen::Index row) const
  {
    IntArray<Dim> index;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      index[d] = static_cast<int>(row / this->Stride[d] % this->Size[d]);
    }
    return index;
  }
  bool IsInside(const IntArray<Dim>& index) const
  {
    bool inside = true;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      inside = inside && index[d] > 0 && index[d] < this->Size[d] - 1;
    }
    return inside;
  }

  IntArray<Dim> Size{};
  std::array<Eigen::Index, Dim> Stride{};
  Eigen::Index Count = 1;
};

template <int Dim>
Status CheckBox(const BoxAbscissae<Dim>& abscissae, const PointMatrixView& points)
{
  for (const Eigen::VectorXd& list : abscissae)
  {
    if (list.size() < 2)
    {
      return { ErrorCode::SizeMismatch, "a box has at least 2 control points a direction" };
    }
  }
  const BoxIndex<Dim> box(abscissae);
  if (points.rows() != box.Count || points.cols() < 1)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(points.rows()) + " control points of a box of " + std::to_string(box.Count) };
  }
  return {};
}

/// Values of the two linear functions of a direction: 1 - t, t.
double Hat(double t, bool upper)
{
  return upper ? t : 1.0 - t;
}

/// Control points of the affine map whose directions are the means of the corners' edges.
template <int Dim>
PointMatrix AffineCorners(const PointMatrix& corners)
{
  const Eigen::RowVectorXd middle = corners.colwise().mean();
  PointMatrix result = middle.replicate(corners.rows(), 1);
  for (int d = 0; d < Dim; ++d)
  {
    Eigen::RowVectorXd half = Eigen::RowVectorXd::Zero(corners.cols());
    for (Eigen::Index c = 0; c < corners.rows(); ++c)
    {
      half += ((c >> d & 1) != 0 ? 1.0 : -1.0) / (1 << Dim) * corners.row(c);
    }
    for (Eigen::Index c = 0; c < corners.rows(); ++c)
    {
      result.row(c) += ((c >> d & 1) != 0 ? 1.0 : -1.0) * half;
    }
  }
  return result;
}

template <int Dim>
double BoundaryDistance(const BoxIndex<Dim>& box, const PointMatrixView& a, const PointMatrix& b)
{
  double squared = 0.0;
  for (Eigen::Index row = 0; row < a.rows(); ++row)
  {
    if (!box.IsInside(box.Of(row)))
    {
      squared = std::max(squared, (a.row(row) - b.row(row)).squaredNorm());
    }
  }
  return std::sqrt(squared);
}

/// The faces of a box from their edges.
void FillFaces(const BoxAbscissae<3>& abscissae, PointMatrix& points)
{
  const BoxIndex<3> box(abscissae);
  for (int side = 0; side < 6; ++side)
  {
    const auto along = SideDirections<3>(side);
    const BoxAbscissae<2> own{ abscissae[along[0]], abscissae[along[1]] };
    const BoxIndex<2> face(own);
    const std::size_t across = AcrossSide(side);
    const Eigen::Index first = side % 2 == 0 ? 0 : (box.Size[across] - 1) * box.Stride[across];
    const auto rowOf = [&](Eigen::Index k)
    {
      const auto index = face.Of(k);
      return first + index[0] * box.Stride[along[0]] + index[1] * box.Stride[along[1]];
    };
    PointMatrix grid(face.Count, points.cols());
    for (Eigen::Index k = 0; k < face.Count; ++k)
    {
      grid.row(k) = points.row(rowOf(k));
    }
    FillInside<2>(own, grid);
    for (Eigen::Index k = 0; k < face.Count; ++k)
    {
      points.row(rowOf(k)) = grid.row(k);
    }
  }
}

/// A patch with the functions that its control points belong to.
template <int Dim>
struct PatchNet
{
  BoxAbscissae<Dim> Abscissae;
  std::vector<int> Functions;

  PointMatrix Take(const PointMatrix& all) const
  {
    PointMatrix points(static_cast<Eigen::Index>(this->Functions.size()), all.cols());
    for (Eigen::Index k = 0; k < points.rows(); ++k)
    {
      points.row(k) = all.row(this->Functions[static_cast<std::size_t>(k)]);
    }
    return points;
  }
  void Give(const PointMatrix& points, PointMatrix& all) const
  {
    for (Eigen::Index k = 0; k < points.rows(); ++k)
    {
      all.row(this->Functions[static_cast<std::size_t>(k)]) = points.row(k);
    }
  }
};

template <int Dim>
Result<std::vector<PatchNet<Dim>>> FindNets(const SplineSpace<Dim>& space)
{
  const MeshPatches<Dim> layout = FindSpacePatches(space);
  Result<std::vector<PatchNet<Dim>>> nets;
  for (std::size_t k = 0; k < layout.Patches.size(); ++k)
  {
    auto own = MakePatchSpace(*space.Unstructured, layout, layout.Patches[k]);
    if (!own)
    {
      return own.Status;
    }
    auto functions = FunctionsOfPatch(space, layout, static_cast<int>(k), *own.Value);
    if (!functions)
    {
      return functions.Status;
    }
    nets->push_back({ GrevilleAbscissae(*own.Value), std::move(functions.Value) });
  }
  return nets;
}
}

template <int Dim>
BoxAbscissae<Dim> GrevilleAbscissae(const SplineSpace<Dim>& space)
{
  BoxAbscissae<Dim> result;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    result[d].resize(knots.NumFunctions());
    for (int i = 0; i < knots.NumFunctions(); ++i)
    {
      result[d][i] = (knots.Greville(i) - knots.Begin()) / (knots.End() - knots.Begin());
    }
    result[d][0] = 0.0; // the means of the end knots are rounded
    result[d][knots.NumFunctions() - 1] = 1.0;
  }
  return result;
}

template <int Dim>
Status FillInside(const BoxAbscissae<Dim>& abscissae, PointMatrix& points)
{
  if (Status status = CheckBox<Dim>(abscissae, points); !status)
  {
    return status;
  }
  const BoxIndex<Dim> box(abscissae);
  for (Eigen::Index row = 0; row < box.Count; ++row)
  {
    const IntArray<Dim> index = box.Of(row);
    if (!box.IsInside(index))
    {
      continue;
    }
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(points.cols());
    for (int subset = 1; subset < 1 << Dim; ++subset) // directions that are interpolated
    {
      for (int ends = 0; ends < 1 << Dim; ++ends)
      {
        if ((ends & ~subset) != 0)
        {
          continue;
        }
        double weight = -1.0;
        Eigen::Index from = row;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          if ((subset >> d & 1) != 0)
          {
            const bool upper = (ends >> d & 1) != 0;
            weight *= -Hat(abscissae[d][index[d]], upper);
            from += ((upper ? box.Size[d] - 1 : 0) - index[d]) * box.Stride[d];
          }
        }
        sum += weight * points.row(from);
      }
    }
    points.row(row) = sum;
  }
  return {};
}

template <int Dim>
PointMatrix MultilinearPoints(const BoxAbscissae<Dim>& abscissae, const PointMatrixView& corners)
{
  const BoxIndex<Dim> box(abscissae);
  PointMatrix points = PointMatrix::Zero(box.Count, corners.cols());
  for (Eigen::Index row = 0; row < box.Count; ++row)
  {
    const IntArray<Dim> index = box.Of(row);
    for (Eigen::Index c = 0; c < corners.rows(); ++c)
    {
      double weight = 1.0;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        weight *= Hat(abscissae[d][index[d]], (c >> d & 1) != 0);
      }
      points.row(row) += weight * corners.row(c);
    }
  }
  return points;
}

template <int Dim>
Result<BoundaryShapeResult<Dim>> ShapeOfBoundary(
  const BoxAbscissae<Dim>& abscissae, const PointMatrixView& points, double tolerance)
{
  if (Status status = CheckBox<Dim>(abscissae, points); !status)
  {
    return status;
  }
  if (!(tolerance >= 0.0))
  {
    return { ErrorCode::InvalidParameter,
      "a tolerance is not negative, this is " + std::to_string(tolerance) };
  }
  const BoxIndex<Dim> box(abscissae);
  PointMatrix corners(1 << Dim, points.cols());
  for (Eigen::Index c = 0; c < corners.rows(); ++c)
  {
    Eigen::Index row = 0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      row += (c >> d & 1) != 0 ? (box.Size[d] - 1) * box.Stride[d] : 0;
    }
    corners.row(c) = points.row(row);
  }
  Result<BoundaryShapeResult<Dim>> result;
  for (const BoundaryShape shape : { BoundaryShape::Affine, BoundaryShape::Multilinear })
  {
    PointMatrix made = MultilinearPoints<Dim>(
      abscissae, shape == BoundaryShape::Affine ? AffineCorners<Dim>(corners) : corners);
    result->Distance = BoundaryDistance<Dim>(box, points, made);
    if (result->Distance <= tolerance)
    {
      result->Shape = shape;
      result->Points = std::move(made);
      break;
    }
  }
  return result;
}

template <int Dim>
Result<Spline<Dim>> CoonsMap(const Spline<Dim>& spline, const CoonsParams& params)
{
  if (!spline.Space)
  {
    return { ErrorCode::EmptyInput, "no space" };
  }
  if (spline.Space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the spline is none on an unstructured mesh" };
  }
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  const auto nets = FindNets(*spline.Space);
  if (!nets)
  {
    return nets.Status;
  }
  PointMatrix all = spline.HomogeneousPoints();
  if constexpr (Dim == 3)
  {
    for (std::size_t k = 0; params.FacesFromEdges && k < nets->size(); ++k)
    {
      PointMatrix points = nets.Value[k].Take(all);
      FillFaces(nets.Value[k].Abscissae, points);
      nets.Value[k].Give(points, all);
    }
  }
  for (const PatchNet<Dim>& net : nets.Value)
  {
    PointMatrix points = net.Take(all);
    if (Status status = FillInside<Dim>(net.Abscissae, points); !status)
    {
      return status;
    }
    net.Give(points, all);
  }
  if (spline.IsRational() && !(all.rightCols(1).minCoeff() > 0.0))
  {
    return { ErrorCode::InvalidWeight, "the weights of the boundary give none inside" };
  }
  Result<Spline<Dim>> result;
  result->Space = spline.Space;
  result->SetHomogeneousPoints(all, spline.IsRational());
  return result;
}

template BoxAbscissae<2> GrevilleAbscissae<2>(const SplineSpace<2>&);
template Status FillInside<2>(const BoxAbscissae<2>&, PointMatrix&);
template PointMatrix MultilinearPoints<2>(const BoxAbscissae<2>&, const PointMatrixView&);
template Result<BoundaryShapeResult<2>> ShapeOfBoundary<2>(
  const BoxAbscissae<2>&, const PointMatrixView&, double);
template Result<Spline<2>> CoonsMap<2>(const Spline<2>&, const CoonsParams&);
template BoxAbscissae<3> GrevilleAbscissae<3>(const SplineSpace<3>&);
template Status FillInside<3>(const BoxAbscissae<3>&, PointMatrix&);
template PointMatrix MultilinearPoints<3>(const BoxAbscissae<3>&, const PointMatrixView&);
template Result<BoundaryShapeResult<3>> ShapeOfBoundary<3>(
  const BoxAbscissae<3>&, const PointMatrixView&, double);
template Result<Spline<3>> CoonsMap<3>(const Spline<3>&, const CoonsParams&);
}
