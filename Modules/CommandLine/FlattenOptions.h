// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>

#include <string>

class vtkMeshParameterization;

namespace knotwork
{
class Options;

/// The options of every job that lays a mesh into the plane.
/// @param methodName  of the option that chooses the method ("Method", "Flatten").
void AddFlattenOptions(Options& options, vtkMeshParameterization* filter, const char* methodName);

/// The numbers of the filter's summary. The method that was used is `<prefix>method`.
void ReportFlattening(
  vtkMeshParameterization* filter, const std::string& prefix, nlohmann::ordered_json& report);
}
