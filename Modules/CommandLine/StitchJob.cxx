// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceFitting/vtkSplineStitch.h>

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
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

  /// The inputs, as many as fit in a message.
  std::string Names() const
  {
    constexpr std::size_t Most = 4;
    std::string names;
    for (std::size_t i = 0; i < std::min(this->Inputs.size(), Most); ++i)
    {
      names += (i == 0 ? "'" : ", '") + this->Inputs[i] + "'";
    }
    return this->Inputs.size() <= Most
      ? names
      : names + " and " + std::to_string(this->Inputs.size() - Most) + " more";
  }

  /// What is wrong with the first file that holds no sound splines; Ok: the error is elsewhere.
  Status FindDamage() const
  {
    for (std::size_t i = 0; i < this->Inputs.size(); ++i)
    {
      auto decoded = DecodeSplineModel(
        this->Filter->GetInputDataObject(0, static_cast<int>(i)), this->Filter->GetThreads());
      if (!decoded)
      {
        return { decoded.Status.Code, "'" + this->Inputs[i] + "': " + decoded.Status.Message() };
      }
    }
    return {};
  }

  Status Run(Session& session)
  {
    for (const std::string& file : this->Inputs)
    {
      auto input = session.Read(file);
      if (!input)
      {
        return input.Status;
      }
      if (input.Value->GetNumberOfElements(vtkDataObject::CELL) == 0)
      {
        return { ErrorCode::EmptyInput, "'" + file + "' holds no cells; leave it out" };
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
    this->Filter->UpdateDataObject();
    vtkDataObject* like = this->Filter->GetOutputDataObject(0);
    if (Status status = session.CheckFormat(like, this->Output); !status)
    {
      return status;
    }
    if (Status status = session.Run(this->Filter, this->Names()); !status)
    {
      Status damage = this->FindDamage();
      return damage ? status : damage;
    }
    vtkTable* numbers = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    ReportRow(numbers, 0,
      { "Tiles", "Edges", "Functions", "FunctionsAdded", "MaxChange", "MaxJumpBefore", "MaxJump",
        "MaxSlopeJumpBefore", "MaxSlopeJump" },
      session.Report);
    return session.WriteOutputs(this->Filter, { this->Output, this->EdgeFile });
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<StitchJob>();
  app
    .add_option(
      "tiles", job->Inputs, "surfaces, one or several a file (.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  AddOutput(app, "--output", job->Output, Endings::Splines, "the tiles as LR splines")->required();
  AddOutput(app, "--edges", job->EdgeFile, Endings::Table, "table of the edges and their jumps");
  app.add_option("--pair", job->Pairs,
    "a pair of sides that are one curve: tile, side, tile, side, 1 if they run against each other "
    "else 0; may be repeated");
  job->FilterOptions = std::make_unique<Options>(app);
  AddProperties(*job->FilterOptions, job->Filter);
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "stitch",
  "make tiles that were fitted apart meet, continuously or smoothly",
  "west.vtu east.vtu --matching geometry --output both.vtu --report both.json", Make };
}
}
