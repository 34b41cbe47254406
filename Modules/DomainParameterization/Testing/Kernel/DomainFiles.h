// SPDX-License-Identifier: BSD-3-Clause
// Boundaries as JSON files, where the environment variable KNOTWORK_DOMAIN_CASES names their
// folder.
#pragma once
#include <knotwork/DomainParameterization/DomainBoundary.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace knotwork::cases
{
/// null without the variable or the file.
inline nlohmann::json ReadJson(const std::string& name)
{
  const char* folder = std::getenv("KNOTWORK_DOMAIN_CASES");
  if (!folder)
  {
    return {};
  }
  std::ifstream file(std::string(folder) + "/" + name + ".json");
  return file ? nlohmann::json::parse(file) : nlohmann::json();
}

template <int Dim>
DomainBoundary<Dim> ReadBoundary(const nlohmann::json& json)
{
  DomainBoundary<Dim> boundary;
  for (const auto& item : json[Dim == 2 ? "curves" : "faces"])
  {
    std::array<KnotVector, Dim - 1> knots;
    for (std::size_t d = 0; d < Dim - 1; ++d)
    {
      const auto& degree = Dim == 2 ? item["degree"] : item["degrees"][d];
      const auto& values = Dim == 2 ? item["knots"] : item["knots"][d];
      knots[d] = KnotVector::Create(degree, values.template get<std::vector<double>>()).Value;
    }
    Spline<Dim - 1> side;
    side.Space = MakeTensorSpace<Dim - 1>(knots).Value;
    side.ControlPoints.resize(side.Space->NumFunctions, Dim);
    side.Weights.resize(side.Space->NumFunctions);
    for (int i = 0; i < side.Space->NumFunctions; ++i)
    {
      side.Weights[i] = item["weights"][static_cast<std::size_t>(i)];
      for (int c = 0; c < Dim; ++c)
      {
        side.ControlPoints(i, c) =
          item["control_points"][static_cast<std::size_t>(i)][static_cast<std::size_t>(c)];
      }
    }
    boundary.Sides.push_back(side);
  }
  return boundary;
}
}
