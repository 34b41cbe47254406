// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>

#include <string>

class vtkMeshParameterization;

namespace knotwork
{
/// The numbers of the filter's summary. The method that was used is `<prefix>method`.
void ReportFlattening(
  vtkMeshParameterization* filter, const std::string& prefix, nlohmann::ordered_json& report);
}
