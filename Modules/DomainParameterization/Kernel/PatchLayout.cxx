// SPDX-License-Identifier: BSD-3-Clause
#include "PatchLayout.h"

#include "LayoutAssembly.h"

namespace knotwork
{
template <int Dim>
Result<CompatibleLayout<Dim>> MakeCompatible(
  const PatchLayout<Dim>& layout, const LayoutParams& params)
{
  LayoutAssembly<Dim> assembly(layout, params);
  Status status = assembly.CheckInput();
  if (status)
  {
    status = assembly.PrepareSides();
  }
  bool mirrored = true;
  while (status && mirrored) // once more after something was mirrored
  {
    for (const auto step : { &LayoutAssembly<Dim>::FindSides, &LayoutAssembly<Dim>::MatchSides,
           &LayoutAssembly<Dim>::OrientSides })
    {
      status = status ? (assembly.*step)() : status;
    }
    if (status)
    {
      const auto found = assembly.Mirror();
      status = found.Status;
      mirrored = found.Value;
    }
  }
  for (const auto step : { &LayoutAssembly<Dim>::MatchAllWeights, &LayoutAssembly<Dim>::UniteRows,
         &LayoutAssembly<Dim>::MakeSpaces, &LayoutAssembly<Dim>::SetPoints })
  {
    status = status ? (assembly.*step)() : status;
  }
  if (!status)
  {
    return status;
  }
  return std::move(assembly.Out);
}

template <int Dim>
Result<CompatibleLayout<Dim>> MakeCompatible(const SideList<Dim>& sides,
  const std::array<SideOrigin, 2 * Dim>& origins, const BoundaryParams& params)
{
  const LayoutParams layoutParams{ params.GapTolerance, 1, 1, params.MaxFunctions };
  const PatchLayout<Dim> none;
  LayoutAssembly<Dim> assembly(none, layoutParams);
  assembly.Arrange(sides, origins);
  Status status;
  for (const auto step : { &LayoutAssembly<Dim>::OrientSides, &LayoutAssembly<Dim>::MatchAllWeights,
         &LayoutAssembly<Dim>::UniteRows, &LayoutAssembly<Dim>::CheckDirections,
         &LayoutAssembly<Dim>::MakeSpaces, &LayoutAssembly<Dim>::SetPoints })
  {
    status = status ? (assembly.*step)() : status;
  }
  return status ? Result<CompatibleLayout<Dim>>(std::move(assembly.Out)) : status;
}

template Result<CompatibleLayout<2>> MakeCompatible(
  const SideList<2>&, const std::array<SideOrigin, 4>&, const BoundaryParams&);
template Result<CompatibleLayout<3>> MakeCompatible(
  const SideList<3>&, const std::array<SideOrigin, 6>&, const BoundaryParams&);
template Result<CompatibleLayout<2>> MakeCompatible(const PatchLayout<2>&, const LayoutParams&);
template Result<CompatibleLayout<3>> MakeCompatible(const PatchLayout<3>&, const LayoutParams&);
}
