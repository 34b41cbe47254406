// SPDX-License-Identifier: BSD-3-Clause
#include "TessellationParts.h"

#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Status CheckPatch(const BezierForm<Dim>& form, std::size_t index)
{
  const std::string name = "patch " + std::to_string(index);
  if (!form.Space || form.Offsets.size() != form.Space->Elements.size() + 1)
  {
    return { ErrorCode::SizeMismatch, name + " has no Bezier form of its space" };
  }
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const int n = NumTensorFunctions<Dim>(form.Space->Elements[At(e)].Degree);
    const double* block = form.Block(e);
    const std::string place = name + ", element " + std::to_string(e);
    for (int i = 0; i < n * form.NumPlanes(); ++i)
    {
      if (!std::isfinite(block[i]))
      {
        return { ErrorCode::NonFiniteInput, place };
      }
      if (form.Rational && i >= n * form.NumComponents && !(block[i] > 0.0))
      {
        return { ErrorCode::InvalidWeight, place };
      }
    }
  }
  return {};
}
}

template <int Dim>
Result<TessellationMesh> Tessellate(
  const std::vector<BezierForm<Dim>>& patches, const TessellationParams& params)
{
  if (!(params.Tolerance > 0.0) || !std::isfinite(params.Tolerance))
  {
    return { ErrorCode::InvalidParameter, "the tolerance must be positive" };
  }
  if (params.MaximumSubdivision < 0 || params.MaximumSubdivision > 10)
  {
    return { ErrorCode::InvalidParameter, "the maximum subdivision must be in [0, 10]" };
  }
  if (params.Part < 0 || params.Part >= params.Parts)
  {
    return { ErrorCode::InvalidParameter, "the part must be in [0, Parts)" };
  }
  std::int64_t elements = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    Status status = CheckPatch<Dim>(patches[p], p);
    if (!status)
    {
      return status;
    }
    elements += patches[p].Space->NumElements();
    if (patches[p].NumComponents != patches[0].NumComponents)
    {
      return { ErrorCode::SizeMismatch, "patches with different numbers of components" };
    }
  }
  if (elements == 0)
  {
    return { ErrorCode::EmptyInput, "no element to tessellate" };
  }
  TessellationMesh mesh;
  Status status;
  if constexpr (Dim == 1)
  {
    status = TessellateCurves(patches, params, mesh);
  }
  else if constexpr (Dim == 2)
  {
    status = TessellateSurfaces<2>(patches, params, mesh);
  }
  else
  {
    status = params.Output == TessellationOutput::Surface
      ? TessellateSurfaces<3>(patches, params, mesh)
      : TessellateVolumes(patches, params, mesh);
  }
  if (!status)
  {
    return status;
  }
  return mesh;
}

template Result<TessellationMesh> Tessellate<1>(
  const std::vector<BezierForm<1>>&, const TessellationParams&);
template Result<TessellationMesh> Tessellate<2>(
  const std::vector<BezierForm<2>>&, const TessellationParams&);
template Result<TessellationMesh> Tessellate<3>(
  const std::vector<BezierForm<3>>&, const TessellationParams&);
}
