// SPDX-License-Identifier: BSD-3-Clause
#include "OutputOptions.h"

#include <knotwork/SplineIO/OutputFiles.h>

#include <CLI/CLI.hpp>

#include <vector>

namespace knotwork
{
namespace
{
constexpr const char* Group = "Outputs";
}

CLI::Option* AddOutput(CLI::App& app, const std::string& name, std::string& file,
  const std::string& endings, const std::string& help)
{
  const std::string type = endings.empty() ? "FILE" : endings;
  const std::string names = name == "--output" ? "-o," + name : name;
  return app.add_option(names, file, help)->group(Group)->type_name(type);
}

Status PlanOutputs(const CLI::App& job, OutputFiles& files)
{
  for (const CLI::Option* option :
    job.get_options([](const CLI::Option* one) { return one->get_group() == Group; }))
  {
    for (const std::string& file : option->results())
    {
      const std::string endings = option->get_type_name() == "FILE" ? "" : option->get_type_name();
      if (Status status = PlanOutput(option->get_name(), file, endings, files); !status)
      {
        return status;
      }
    }
  }
  return {};
}

Status PlanOutput(const std::string& option, const std::string& file, const std::string& endings,
  OutputFiles& files)
{
  return files.Plan(
    option, file, endings.empty() ? std::vector<std::string>() : CLI::detail::split(endings, '|'));
}
}
