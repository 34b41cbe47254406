// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineExtrema.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <iostream>
#include <memory>

namespace knotwork
{
namespace
{
struct ExtremaJob
{
  std::string Input;
  std::string Output;
  std::string BoxFile;
  std::string TableFile;
  vtkNew<vtkSplineExtrema> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetInputDataObject(input.Value);
    this->Filter->SetThreads(session.Threads);
    // the table: no point of the chosen kinds is a result, too
    if (Status status = session.Run(this->Filter, "'" + this->Input + "'", 2); !status)
    {
      return status;
    }
    vtkTable* numbers = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    const auto number = [&](const char* name) { return numbers->GetValueByName(0, name).ToInt(); };
    for (const auto& [key, name] : { std::pair{ "minima", "Minima" }, { "maxima", "Maxima" },
           { "saddles", "Saddles" }, { "boundary", "OnBoundary" }, { "clusters", "Clusters" },
           { "cluster_boxes", "ClusterBoxes" }, { "index_sum", "IndexSum" },
           { "euler_characteristic", "EulerCharacteristic" } })
    {
      session.Report[key] = number(name);
    }
    session.Report["proved"] = number("Proved") == 1;
    if (!session.Quiet)
    {
      std::cout << number("Minima") << " minima, " << number("Maxima") << " maxima, "
                << number("Saddles") << " saddles (" << number("OnBoundary")
                << " on the boundary), " << number("Clusters") << " clusters\n";
    }
    return session.WriteOutputs(this->Filter, { this->Output, this->BoxFile, this->TableFile });
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<ExtremaJob>();
  app.add_option("input", job->Input, "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  AddOutput(app, "--output", job->Output, Endings::Points, "critical points as vertices")
    ->required();
  AddOutput(
    app, "--boxes", job->BoxFile, Endings::Polygons, "boxes that hold one point, or a cluster");
  AddOutput(app, "--table", job->TableFile, Endings::Table, "numbers of points and clusters");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineExtrema* filter = job->Filter;
  KNOTWORK_TEXT_OPTION(options, filter, FieldName, "field that is the function; else geometry");
  KNOTWORK_OPTION(options, filter, Component, "of the geometry or the field; 2 is z");
  KNOTWORK_FREE_OPTION(options, filter, Minima, "whether minima are written");
  KNOTWORK_FREE_OPTION(options, filter, Maxima, "whether maxima are written");
  KNOTWORK_FREE_OPTION(options, filter, Saddles, "whether saddles are written");
  KNOTWORK_FREE_OPTION(options, filter, Boundary, "whether the boundary is searched");
  KNOTWORK_FREE_OPTION(options, filter, OnSurface, "on the surface, else in the parameter plane");
  KNOTWORK_OPTION(options, filter, MaximumDepth, "halvings of an element at most");
  KNOTWORK_OPTION(options, filter, MaximumBoxes, "undecided boxes of an element at a time");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "extrema",
  "find all minima, maxima and saddles of a surface, proved",
  "terrain.vtu --output points.vtp --report extrema.json", Make };
}
}
