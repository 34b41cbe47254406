// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/ElementMesh.h>

#include <cstdlib>

namespace knotwork
{
/// Aborts unless a mesh has all that its elements name, or the error is one line.
inline void CheckElementMesh(const Result<ElementMesh>& mesh)
{
  bool sound = mesh
    ? mesh->Points.allFinite() && mesh->Begin.size() == mesh->KindOf.size() + 1
    : !mesh.Status.Detail.empty() && mesh.Status.Detail.find('\n') == std::string::npos;
  for (const std::int64_t node : mesh->Nodes)
  {
    sound = sound && (!mesh || (node >= 0 && node < mesh->Points.rows()));
  }
  for (std::size_t e = 0; mesh && sound && e < mesh->KindOf.size(); ++e)
  {
    const auto& kind = mesh->Kinds.at(static_cast<std::size_t>(mesh->KindOf[e]));
    sound = mesh->Begin[e + 1] - mesh->Begin[e] == static_cast<std::int64_t>(kind.Places.size());
  }
  if (!sound)
  {
    std::abort();
  }
}
}
