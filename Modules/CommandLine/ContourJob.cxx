// SPDX-License-Identifier: BSD-3-Clause
#include "FileEnding.h"
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineContour.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <memory>

namespace knotwork
{
namespace
{
/// Of vtkSplineContour.
enum Port
{
  Polylines,
  Curves,
  Levels,
  Undecided
};

struct ContourJob
{
  std::string Input;
  std::string Output;
  std::string TableFile;
  std::string UndecidedFile;
  std::vector<double> GivenLevels;
  vtkNew<vtkSplineContour> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    this->Filter->SetInputDataObject(input.Value);
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    for (double level : this->GivenLevels)
    {
      this->Filter->AddLevel(level);
    }
    const bool polylines = LowerEnding(this->Output) == ".vtp";
    this->Filter->SetCurves(!polylines);
    this->Filter->SetThreads(session.Threads);
    if (Status status = session.Run(this->Filter, "'" + this->Input + "'", Levels); !status)
    {
      return status;
    }
    this->AddNumbers(session.Report);
    std::vector<std::string> files(4);
    files[polylines ? Polylines : Curves] = this->Output;
    files[Levels] = this->TableFile;
    files[Undecided] = this->UndecidedFile;
    return session.WriteOutputs(this->Filter, files);
  }

  void AddNumbers(nlohmann::ordered_json& report)
  {
    vtkTable* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(Levels));
    std::vector<double> levels;
    std::vector<int> components;
    std::vector<int> closed;
    std::vector<int> undecided;
    long long points = 0;
    double maxError = 0.0;
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      levels.push_back(table->GetValueByName(row, "Level").ToDouble());
      components.push_back(table->GetValueByName(row, "Components").ToInt());
      closed.push_back(table->GetValueByName(row, "Closed").ToInt());
      undecided.push_back(table->GetValueByName(row, "Undecided").ToInt());
      points += table->GetValueByName(row, "Points").ToLongLong();
      maxError = std::max(maxError, table->GetValueByName(row, "MaxError").ToDouble());
    }
    const auto sum = [](const std::vector<int>& counts)
    {
      long long total = 0;
      for (int count : counts)
      {
        total += count;
      }
      return total;
    };
    report["tolerance"] = table->GetValueByName(0, "Tolerance").ToDouble();
    report["levels"] = levels;
    report["components"] = sum(components);
    report["closed"] = sum(closed);
    report["undecided"] = sum(undecided);
    report["points"] = points;
    report["max_error"] = maxError;
    report["level_components"] = components;
    report["level_closed"] = closed;
    report["level_undecided"] = undecided;
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<ContourJob>();
  app.add_option("input", job->Input, "surfaces (.vtu .vtpc .xml .g2)")->required();
  AddOutput(app, "--output", job->Output, Endings::Contours,
    "polylines, or spline curves with the same bound")
    ->required();
  AddOutput(app, "--table", job->TableFile, Endings::Table, "table of the levels");
  AddOutput(app, "--undecided", job->UndecidedFile, Endings::Polygons,
    "what stayed undecided, if anything");
  app.add_option("--levels", job->GivenLevels, "values of the contours");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineContour* filter = job->Filter;
  options
    .Add<int>(
      "Number", filter->GetNumberOfLevels(), [filter](int n) { filter->SetNumberOfLevels(n); },
      "levels that are chosen when none are given")
    ->check(InRange(filter->GetNumberOfLevelsMinValue(), filter->GetNumberOfLevelsMaxValue()));
  options
    .Add<std::vector<double>>(
      "Range", { filter->GetRange()[0], filter->GetRange()[1] },
      [filter](const std::vector<double>& range) { filter->SetRange(range[0], range[1]); },
      "range of the levels that are chosen; 0 0: that of the values")
    ->expected(2);
  options.Add<std::string>(
    "Field", filter->GetFieldName(),
    [filter](const std::string& name) { filter->SetFieldName(name); },
    "field whose contours are wanted; empty: the coordinates");
  KNOTWORK_OPTION(options, filter, Component, "component of the field; -1: the last, the height");
  KNOTWORK_OPTION(options, filter, Tolerance,
    "largest difference between value and level; 0: a ten-thousandth of the range of the values");
  KNOTWORK_OPTION(options, filter, ChordalTolerance,
    "largest distance in space between pieces and surface; 0: a thousandth of the size");
  KNOTWORK_FREE_OPTION(options, filter, JoinSeams, "whether contours go on over seams");
  KNOTWORK_FREE_OPTION(options, filter, ProjectToLevel, "whether z becomes the level");
  KNOTWORK_OPTION(options, filter, MaximumCells, "cells an element is divided into at most");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "contour",
  "iso-curves of a spline surface to a guaranteed tolerance",
  "terrain.vtu --levels 0.05 0.1 --tolerance 1e-3 --output lines.vtp --report lines.json", Make };
}
}
