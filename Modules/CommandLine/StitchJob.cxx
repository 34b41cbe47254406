// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineStitch.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <memory>
#include <tuple>

namespace knotwork
{
namespace
{
struct StitchJob
{
  std::vector<std::string> Inputs;
  std::string Output;
  std::string EdgeFile;
  std::vector<std::tuple<int, int, int, int, int>> Pairs;
  vtkNew<vtkSplineStitch> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    for (const std::string& file : this->Inputs)
    {
      auto input = session.Read(file);
      if (!input)
      {
        return input.Status;
      }
      this->Filter->AddInputDataObject(input.Value);
    }
    session.Report["input"] = this->Inputs;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    for (const auto& [tileA, sideA, tileB, sideB, reversed] : this->Pairs)
    {
      this->Filter->AddPair(tileA, sideA, tileB, sideB, reversed);
    }
    if (!this->Pairs.empty())
    {
      this->Filter->SetMatching(vtkSplineStitch::PAIRS);
      session.Report["matching"] = "pairs";
    }
    this->Filter->SetThreads(session.Threads);
    const std::string what = "'" + this->Inputs.front() + "'" +
      (this->Inputs.size() > 1 ? " and " + std::to_string(this->Inputs.size() - 1) + " more" : "");
    if (Status status = session.Run(this->Filter, what); !status)
    {
      return status;
    }
    vtkTable* numbers = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    for (const char* name : { "Tiles", "Edges", "Functions", "FunctionsAdded" })
    {
      session.Report[Options::SnakeCase(name)] = numbers->GetValueByName(0, name).ToInt();
    }
    for (const char* name :
      { "MaxChange", "MaxJumpBefore", "MaxJump", "MaxSlopeJumpBefore", "MaxSlopeJump" })
    {
      session.Report[Options::SnakeCase(name)] = numbers->GetValueByName(0, name).ToDouble();
    }
    return session.WriteOutputs(this->Filter, { this->Output, this->EdgeFile });
  }
};
}

Job MakeStitchJob(CLI::App& app)
{
  auto job = std::make_shared<StitchJob>();
  app
    .add_option(
      "tiles", job->Inputs, "surfaces, one or several a file (.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  app.add_option("--output", job->Output, "the tiles as LR splines (.vtu .g2)")->required();
  app.add_option("--edges", job->EdgeFile, "table of the edges and their jumps (.csv)");
  app.add_option("--pair", job->Pairs,
    "a pair of sides that are one curve: tile, side, tile, side, 1 if they run against each other "
    "else 0; may be repeated");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineStitch* filter = job->Filter;
  KNOTWORK_OPTION(options, filter, Continuity, "0: tiles meet; 1: their derivatives do, too");
  options.AddChoice(
    "Matching", { "domain", "geometry", "pairs" }, filter->GetMatching(),
    [filter](int matching) { filter->SetMatching(matching); },
    "neighbours: by the boxes of their parameters, by points of their sides, or as --pair says");
  KNOTWORK_OPTION(options, filter, Tolerance, "what counts as the same place, relative");
  return [job](Session& session) { return job->Run(session); };
}
}
