// SPDX-License-Identifier: BSD-3-Clause
#include "ContactWarnings.h"

namespace knotwork
{
std::vector<std::string> ContactWarnings(const CADTopology& model)
{
  constexpr std::size_t MostNamed = 3;
  const auto found = model.TouchingSolids();
  if (!found)
  {
    return { "whether solids touch is not known: " + found.Status.Detail };
  }
  const auto& pairs = found.Value;
  if (pairs.empty())
  {
    return {};
  }
  std::string text = "solids";
  for (std::size_t i = 0; i < std::min(pairs.size(), MostNamed); ++i)
  {
    text +=
      (i > 0 ? ", " : " ") + std::to_string(pairs[i][0]) + " and " + std::to_string(pairs[i][1]);
  }
  if (pairs.size() > MostNamed)
  {
    text += ", and " + std::to_string(pairs.size() - MostNamed) + " other pairs,";
  }
  return { text +
    " touch in faces that they do not share: their meshes do not meet there; write the file again "
    "with cadmodify --imprint" };
}
}
