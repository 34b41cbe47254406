// SPDX-License-Identifier: BSD-3-Clause
#include "TensorForm.h"

#include "HierarchicalSpace.h"
#include "LROperations.h"
#include "TensorSpace.h"

#include <algorithm>

namespace knotwork
{
namespace
{
template <int Dim>
Result<Spline<Dim>> FinestLevel(const Spline<Dim>& spline, int maxFunctions)
{
  const SplineSpace<Dim>& space = *spline.Space;
  HierarchyBox<Dim> all;
  all.Level = 0;
  for (const auto& element : space.Elements)
  {
    all.Level = std::max(all.Level, element.Level);
  }
  double functions = 1.0;
  std::array<KnotVector, Dim> knots = space.Knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    all.Upper[d] = static_cast<std::int64_t>(space.Knots[d].NumElements()) << all.Level;
    functions *= static_cast<double>(all.Upper[d]) + space.Knots[d].NumFunctions() -
      space.Knots[d].NumElements();
  }
  if (Status status = CheckSize(functions, std::max(maxFunctions, space.NumFunctions)); !status)
  {
    return status;
  }
  for (KnotVector& direction : knots)
  {
    for (int level = 0; level < all.Level; ++level)
    {
      direction = direction.Dyadic();
    }
  }
  Result<SplineSpacePtr<Dim>> tensor = MakeTensorSpace<Dim>(knots);
  if (!tensor)
  {
    return tensor.Status;
  }
  Spline<Dim> finest = spline;
  if (all.Level > 0)
  {
    auto refined = RefineBoxes<Dim>(spline.Space, { all });
    auto transferred =
      refined ? TransferToRefined<Dim>(spline, refined.Value) : Result<Spline<Dim>>(refined.Status);
    if (!transferred)
    {
      return transferred;
    }
    finest = std::move(transferred.Value);
  }
  // functions of one level stand in the order of the tensor product's
  if (finest.Space->NumFunctions != tensor.Value->NumFunctions)
  {
    return { ErrorCode::DimensionMismatch,
      "knots outside the domain carry functions that a hierarchical spline does not have" };
  }
  finest.Space = std::move(tensor.Value);
  return finest;
}
}

template <int Dim>
Result<Spline<Dim>> ToTensor(const Spline<Dim>& spline, int threads, int maxFunctions)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  switch (spline.Space->Kind)
  {
    case SpaceKind::Tensor:
      return spline;
    case SpaceKind::Hierarchical:
      return FinestLevel(spline, maxFunctions);
    case SpaceKind::LocallyRefined:
      if constexpr (Dim == 2)
      {
        return ExpandToTensor(spline, threads, maxFunctions);
      }
      break;
    case SpaceKind::Bezier:
      break;
  }
  return { ErrorCode::DimensionMismatch,
    "Bezier elements without knots are no tensor product; write .vtu" };
}

template Result<Spline<1>> ToTensor<1>(const Spline<1>&, int, int);
template Result<Spline<2>> ToTensor<2>(const Spline<2>&, int, int);
template Result<Spline<3>> ToTensor<3>(const Spline<3>&, int, int);
}
