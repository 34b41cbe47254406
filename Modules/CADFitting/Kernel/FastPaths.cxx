// SPDX-License-Identifier: BSD-3-Clause
#include "FastPaths.h"

#include <knotwork/SplineCore/CoonsMap.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Of the mesh's extent: places that differ by less are the same.
constexpr double Rounding = 1e-13;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Point of the mesh at a corner of a cell, which is given in the directions of its patch.
template <int Dim>
int PointOf(const CellMesh<Dim>& mesh, const MeshPatches<Dim>& layout, int cell, int bits)
{
  int corner = 0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const int ahead = layout.AheadOf[At(cell)][d];
    corner |= ((bits >> d & 1) != 0 ? ahead % 2 : 1 - ahead % 2) << ahead / 2;
  }
  return mesh.Cell(cell)[corner];
}

/// Places of the corners of a patch, first direction fastest.
template <int Dim>
PointMatrix CornersOf(const CompositeProjection<Dim>& composite, int k, const PointMatrix& points)
{
  const MeshPatch<Dim>& patch = composite.Layout.Patches[At(k)];
  PointMatrix corners(1 << Dim, points.cols());
  for (int bits = 0; bits < 1 << Dim; ++bits)
  {
    int index = 0;
    for (int d = Dim - 1; d >= 0; --d)
    {
      const int size = patch.Size[At(d)];
      index = index * size + ((bits >> d & 1) != 0 ? size - 1 : 0);
    }
    corners.row(bits) =
      points.row(PointOf(MeshOf(*composite.Space), composite.Layout, patch.Cells[At(index)], bits));
  }
  return corners;
}

/// Largest distance of the mesh's points from the maps between the corners of their patches.
template <int Dim>
double FarFromMultilinear(const CompositeProjection<Dim>& composite, const PointMatrix& points)
{
  double largest = 0.0;
  for (int k = 0; k < static_cast<int>(composite.Patches.size()); ++k)
  {
    const MeshPatch<Dim>& patch = composite.Layout.Patches[At(k)];
    BoxAbscissae<Dim> abscissae;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = composite.Patches[At(k)]->Knots[d];
      abscissae[d].resize(knots.NumElements() + 1);
      for (int b = 0; b <= knots.NumElements(); ++b)
      {
        abscissae[d][b] = (knots.Breaks()[At(b)] - knots.Begin()) / (knots.End() - knots.Begin());
      }
    }
    const PointMatrix made = MultilinearPoints<Dim>(abscissae, CornersOf(composite, k, points));
    for (std::size_t c = 0; c < patch.Cells.size(); ++c)
    {
      for (int bits = 0; bits < 1 << Dim; ++bits)
      {
        const IntArray<Dim>& place = composite.Layout.IndexOf[At(patch.Cells[c])];
        Eigen::Index row = 0;
        for (int d = Dim - 1; d >= 0; --d)
        {
          row = row * (patch.Size[At(d)] + 1) + place[At(d)] + (bits >> d & 1);
        }
        const int point = PointOf(MeshOf(*composite.Space), composite.Layout, patch.Cells[c], bits);
        largest = std::max(largest, (points.row(point) - made.row(row)).norm());
      }
    }
  }
  return largest;
}

/// Whether all patches are images of one lattice: parallelepipeds, whose edges over their knot
/// intervals are the same vectors but for order and sign.
template <int Dim>
bool IsLattice(
  const CompositeProjection<Dim>& composite, const PointMatrix& points, double tolerance)
{
  PointMatrix first;
  for (int k = 0; k < static_cast<int>(composite.Patches.size()); ++k)
  {
    const PointMatrix corners = CornersOf(composite, k, points);
    PointMatrix steps(Dim, points.cols());
    for (int d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = composite.Patches[At(k)]->Knots[At(d)];
      steps.row(d) = (corners.row(1 << d) - corners.row(0)) / (knots.End() - knots.Begin());
    }
    for (int bits = 0; bits < 1 << Dim; ++bits)
    {
      Eigen::RowVectorXd corner = corners.row(0);
      for (int d = 0; d < Dim; ++d)
      {
        corner += (bits >> d & 1) * (corners.row(1 << d) - corners.row(0));
      }
      if (!((corner - corners.row(bits)).norm() <= tolerance))
      {
        return false;
      }
    }
    if (k == 0)
    {
      first = steps;
    }
    for (int d = 0; d < Dim; ++d)
    {
      bool isFound = false;
      for (int other = 0; other < Dim; ++other)
      {
        isFound = isFound || (steps.row(d) - first.row(other)).norm() <= tolerance ||
          (steps.row(d) + first.row(other)).norm() <= tolerance;
      }
      if (!isFound)
      {
        return false;
      }
    }
  }
  return true;
}

/// Control points of the patches' multilinear maps; none where the space does not have them.
template <int Dim>
PointMatrix MultilinearControlPoints(
  const CompositeProjection<Dim>& composite, const PointMatrix& points, double tolerance)
{
  PointMatrix patches(composite.First.back(), points.cols());
  for (int k = 0; k < static_cast<int>(composite.Patches.size()); ++k)
  {
    patches.middleRows(
      composite.First[At(k)], composite.First[At(k) + 1] - composite.First[At(k)]) =
      MultilinearPoints<Dim>(
        GrevilleAbscissae(*composite.Patches[At(k)]), CornersOf(composite, k, points));
  }
  PointMatrix result = composite.Restriction * patches;
  const PointMatrix back = composite.Prolongation * result;
  return (back - patches).cwiseAbs().maxCoeff() <= tolerance ? result : PointMatrix();
}

/// Whether functions of patches are those of the space: patches meet C^0.
template <int Dim>
bool IsOfUnitRows(const CompositeProjection<Dim>& composite)
{
  return composite.Prolongation.nonZeros() == composite.Prolongation.rows();
}

/// Cells whose functions do not reach the sides of their patches.
template <int Dim>
std::vector<char> CellsInside(const MeshPatches<Dim>& layout)
{
  std::vector<char> isInside(layout.PatchOf.size(), 1);
  for (std::size_t c = 0; c < isInside.size(); ++c)
  {
    const MeshPatch<Dim>& patch = layout.Patches[At(layout.PatchOf[c])];
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const int place = layout.IndexOf[c][d];
      if (place == 0 || place == patch.Size[d] - 1)
      {
        isInside[c] = 0;
      }
    }
  }
  return isInside;
}

/// Why a path is not taken; empty: it is.
template <int Dim>
std::string Refuse(
  FastPath<Dim>& fast, FitPath path, const PointMatrix& points, const FastPathParams& params)
{
  const CompositeProjection<Dim>& composite = *fast.Composite;
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const double tolerance = Rounding * std::max(size, points.cwiseAbs().maxCoeff());
  switch (path)
  {
    case FitPath::Affine:
    case FitPath::Multilinear:
      if (!params.IsMeshTheTarget)
      {
        return "the target is another shape than the mesh itself";
      }
      if (!(FarFromMultilinear(composite, points) <= tolerance))
      {
        return "points are not where the multilinear maps of their patches have them";
      }
      if (path == FitPath::Affine && !IsLattice(composite, points, tolerance))
      {
        return "the elements are not images of one lattice";
      }
      fast.Exact = MultilinearControlPoints(composite, points, 10.0 * tolerance);
      return fast.Exact.rows() > 0 ? "" : "the space does not have the multilinear maps";
    case FitPath::Coons:
      if (params.IsInsideFitted)
      {
        return "the insides of patches lie on the target as well";
      }
      if (!IsOfUnitRows(composite))
      {
        return "patches are smooth across their sides, take the policy full";
      }
      fast.IsInside = CellsInside(composite.Layout);
      return "";
    default:
      return "";
  }
}
}

const char* ToString(FitPath path)
{
  constexpr const char* names[] = { "automatic", "unstructured", "composite", "coons",
    "multilinear", "affine" };
  return names[static_cast<int>(path)];
}

template <int Dim>
Result<Spline<Dim>> FastPath<Dim>::Project(
  const ElementFunction& function, const ProjectionParams& params) const
{
  return this->Composite ? ProjectByPatches<Dim>(*this->Composite, 3, function, params)
                         : ProjectOntoSpace<Dim>(this->Space, 3, function, params);
}

template <int Dim>
Result<Spline<Dim>> FastPath<Dim>::ProjectWhole(
  const ElementFunction& map, const ProjectionParams& params) const
{
  if (this->Exact.rows() > 0)
  {
    return Spline<Dim>{ this->Space, this->Exact, {} };
  }
  if (this->IsInside.empty())
  {
    return this->Project(map, params);
  }
  // control points on the sides are of the cells there alone
  auto made = this->Project(
    [&](int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values)
    {
      if (this->IsInside[At(element)] == 0)
      {
        return map(element, local, parameters, values);
      }
      values.setZero();
      return true;
    },
    params);
  if (made)
  {
    made.Status = this->Complete(made.Value);
  }
  return made;
}

template <int Dim>
Status FastPath<Dim>::Complete(Spline<Dim>& spline) const
{
  if (this->Path != FitPath::Coons)
  {
    return {};
  }
  auto made = CoonsMap<Dim>(spline);
  if (made)
  {
    spline = std::move(made.Value);
  }
  return made.Status;
}

template <int Dim>
FastPath<Dim> ChooseFastPath(
  const SplineSpacePtr<Dim>& space, const PointMatrix& points, const FastPathParams& params)
{
  FastPath<Dim> fast;
  fast.Space = space;
  const bool isAutomatic = params.Path == FitPath::Automatic;
  if (params.Path == FitPath::Unstructured || (isAutomatic && !params.IsFull))
  {
    return fast;
  }
  auto composite = MakeCompositeProjection<Dim>(space, params.Weights);
  std::string note = composite.Status ? "" : composite.Status.Detail;
  if (composite)
  {
    fast.Composite = std::make_shared<CompositeProjection<Dim>>(std::move(composite.Value));
    if (!isAutomatic)
    {
      fast.Path = params.Path;
      note = Refuse(fast, params.Path, points, params);
    }
    else if (Refuse(fast, FitPath::Affine, points, params).empty())
    {
      fast.Path = FitPath::Affine;
    }
    else if (Refuse(fast, FitPath::Multilinear, points, params).empty())
    {
      fast.Path = FitPath::Multilinear;
    }
    else if (IsOfUnitRows(*fast.Composite))
    {
      fast.Path = FitPath::Composite;
    }
    else
    {
      fast.Composite = nullptr;
    }
  }
  if (!note.empty())
  {
    fast = {};
    fast.Space = space;
    fast.Tried = params.Path;
    fast.Note = std::move(note);
  }
  return fast;
}

template struct FastPath<2>;
template struct FastPath<3>;
template FastPath<2> ChooseFastPath(
  const SplineSpacePtr<2>&, const PointMatrix&, const FastPathParams&);
template FastPath<3> ChooseFastPath(
  const SplineSpacePtr<3>&, const PointMatrix&, const FastPathParams&);
}
