// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Ranges.h"
#include "Session.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/CADModel/CADModify.h>
#include <knotwork/CADModel/CADOperationText.h>
#include <knotwork/CADModel/CADSuggest.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineIO/CurvesInSpace.h>
#include <knotwork/SplineIO/ModifyProcess.h>

#include <CLI/CLI.hpp>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace knotwork
{
namespace
{
/// What an option takes each time that it stands on the command line.
using PlaneWords = std::array<double, 6>;
using CylinderWords = std::array<double, 7>;
using SplitPlaneWords = std::tuple<std::string, double, double, double, double, double, double>;
using SplitIsoWords = std::tuple<std::string, std::string, double>;
using SplitCurveWords = std::tuple<std::string, std::string>;

const char* NameOf(CADSuggestionKind kind)
{
  switch (kind)
  {
    case CADSuggestionKind::Sliver:
      return "sliver";
    case CADSuggestionKind::TinyEdge:
      return "tiny-edge";
    case CADSuggestionKind::TangentFaces:
      return "tangent-faces";
    case CADSuggestionKind::Cut:
      return "cut-face";
  }
  return "";
}

std::string JoinIds(const std::vector<int>& faces, const char* between)
{
  std::string ids;
  for (int id : faces)
  {
    ids += (ids.empty() ? "" : between) + std::to_string(id);
  }
  return ids;
}

/// One line.
std::string InWords(const CADSuggestion& one)
{
  std::ostringstream text;
  const std::string ids = JoinIds(one.Faces, ", ");
  switch (one.Kind)
  {
    case CADSuggestionKind::Sliver:
      text << "face " << ids << " is " << one.Size << " wide";
      break;
    case CADSuggestionKind::TinyEdge:
      text << "an edge of face " << ids << " is " << one.Size << " long";
      break;
    case CADSuggestionKind::TangentFaces:
      text << "faces " << ids << " meet smoothly, at most " << one.Size << " degrees apart";
      break;
    case CADSuggestionKind::Cut:
      text << "--cut-face " << ids << " leaves " << one.Solids << " solids, " << one.Swept
           << " of them swept and " << one.Mapped << " mapped, and " << one.ConcaveEdges
           << " concave edges";
      break;
  }
  text << ", at " << one.Point.x() << " " << one.Point.y() << " " << one.Point.z();
  return text.str();
}

nlohmann::ordered_json InReport(const CADSuggestion& one)
{
  nlohmann::ordered_json entry{ { "kind", NameOf(one.Kind) }, { "faces", one.Faces },
    { "point", std::vector<double>{ one.Point.x(), one.Point.y(), one.Point.z() } } };
  switch (one.Kind)
  {
    case CADSuggestionKind::Sliver:
      entry["width"] = one.Size;
      break;
    case CADSuggestionKind::TinyEdge:
      entry["length"] = one.Size;
      break;
    case CADSuggestionKind::TangentFaces:
      entry["angle"] = one.Size;
      break;
    case CADSuggestionKind::Cut:
      entry["solids"] = one.Solids;
      entry["swept_solids"] = one.Swept;
      entry["mapped_solids"] = one.Mapped;
      entry["concave_edges"] = one.ConcaveEdges;
      break;
  }
  return entry;
}

vtkSmartPointer<vtkTable> TableOf(const CADSuggestions& found)
{
  const auto table = vtkSmartPointer<vtkTable>::New();
  vtkNew<vtkStringArray> kinds;
  kinds->SetName("Kind");
  vtkNew<vtkStringArray> faces;
  faces->SetName("Faces");
  for (const CADSuggestion& one : found.List)
  {
    kinds->InsertNextValue(NameOf(one.Kind));
    faces->InsertNextValue(JoinIds(one.Faces, " "));
  }
  table->AddColumn(kinds);
  table->AddColumn(faces);
  const auto add = [&](auto* column, const char* name, const auto& value)
  {
    column->SetName(name);
    for (const CADSuggestion& one : found.List)
    {
      column->InsertNextValue(value(one));
    }
    table->AddColumn(column);
  };
  using One = const CADSuggestion&;
  add(vtkNew<vtkDoubleArray>().Get(), "Size", [](One one) { return one.Size; });
  add(vtkNew<vtkDoubleArray>().Get(), "X", [](One one) { return one.Point.x(); });
  add(vtkNew<vtkDoubleArray>().Get(), "Y", [](One one) { return one.Point.y(); });
  add(vtkNew<vtkDoubleArray>().Get(), "Z", [](One one) { return one.Point.z(); });
  add(vtkNew<vtkIntArray>().Get(), "Solids", [](One one) { return one.Solids; });
  add(vtkNew<vtkIntArray>().Get(), "SweptSolids", [](One one) { return one.Swept; });
  add(vtkNew<vtkIntArray>().Get(), "MappedSolids", [](One one) { return one.Mapped; });
  add(vtkNew<vtkIntArray>().Get(), "ConcaveEdges", [](One one) { return one.ConcaveEdges; });
  return table;
}

nlohmann::ordered_json InReport(const CADCounts& counts)
{
  return { { "solids", counts.Solids }, { "faces", counts.Faces }, { "edges", counts.Edges },
    { "vertices", counts.Vertices }, { "face_ids", counts.FaceIds }, { "volume", counts.Volume } };
}

nlohmann::ordered_json InReport(const CADHealing& healing)
{
  return { { "turned_faces", healing.TurnedFaces }, { "turned_solids", healing.TurnedSolids },
    { "sewn_edges", healing.SewnEdges }, { "new_solids", healing.NewSolids },
    { "removed_edges", healing.RemovedEdges }, { "removed_faces", healing.RemovedFaces },
    { "closed_gaps", healing.ClosedGaps }, { "messages", healing.Messages },
    { "unmended", healing.Unmended } };
}

class CADModifyJob
{
public:
  explicit CADModifyJob(CLI::App& app) : App(app)
  {
    app.add_option("part", this->Input, "CAD part with solids (.step .stp)")->required();
    AddOutput(app, "--output", this->Output, ".step|.stp|.brep",
      "the part behind the operations; .brep keeps faces that solids share as one");
    this->Add("--imprint",
      app.add_flag(
        "--imprint", this->Imprint, "solids that touch share faces, edges and vertices"));
    this->AddRepeated("--cut-plane", this->CutPlanes, "X Y Z NX NY NZ",
      "cut the solids by the plane through a point with a normal");
    this->AddRepeated("--cut-cylinder", this->CutCylinders, "X Y Z DX DY DZ R",
      "cut the solids by the cylinder around the line through a point along a direction");
    this->AddRepeated("--cut-face", this->CutFaces, "INT",
      "cut the solids by the extended plane, cylinder, sphere or torus of a face");
    this->AddRepeated("--split-plane", this->SplitPlanes, "FACE[,FACE...] X Y Z NX NY NZ",
      "split faces by the plane through a point with a normal");
    this->AddRepeated("--split-iso", this->SplitIsos, "FACE[,FACE...] u|v SHARE",
      "split faces where u (or v) of their surface is constant, at a share of the face's range");
    this->AddRepeated("--split-curve", this->SplitCurves, "FACE[,FACE...] FILE",
      "split faces along the projections of curves: lines of a .vtp, splines of a .g2 or .vtu");
    this->AddRepeated("--composite", this->Composites, "FACE,FACE[,FACE...]",
      "let neighbours count as one face: joined where they lie on one surface, else a group");
    this->AddRepeated("--heal", this->Heals, "TOLERANCE",
      "mend gaps, small edges and wrong orientation within a length; faces become solids");
    app.add_flag("--suggest", this->Suggest,
      "list slivers, tiny edges, chains of tangent faces and cuts that leave simpler solids, of "
      "the "
      "part as it is read");
    AddOutput(app, "--table", this->Table, Endings::Table, "what --suggest lists");
    app
      .add_option("--size", this->SuggestParams.Size,
        "thinner faces and shorter edges are listed; 0: a hundredth of the part's size")
      ->check(InRange(0.0, 1e299))
      ->capture_default_str();
    app
      .add_option("--tangent-angle", this->SuggestParams.TangentAngle,
        "degrees below which faces count as tangent")
      ->check(InRange(1e-6, 45.0))
      ->capture_default_str();
    app
      .add_option("--maximum-cuts", this->SuggestParams.MaxCuts,
        "so many cuts are tried, those at the longest concave edges")
      ->check(InRange(0, 100000))
      ->capture_default_str();
    app.add_option("--unit", this->Unit, "unit of lengths on the command line and in the report")
      ->check(CLI::IsMember(Units(), CLI::ignore_case))
      ->capture_default_str();
    app
      .add_option("--volume-tolerance", this->Params.VolumeTolerance,
        "largest change of the volume by an operation, as a share of it")
      ->check(InRange(0.0, 1.0))
      ->capture_default_str();
  }

  Status Run(Session& session)
  {
    auto operations = this->Operations();
    if (!operations)
    {
      return { operations.Status.Code, "'" + this->Input + "': " + operations.Status.Detail };
    }
    if (Status status = session.Files.CheckInput(this->Input); !status)
    {
      return status;
    }
    if (Status status = this->CheckUse(operations.Value); !status)
    {
      return status;
    }
    const std::vector<std::string> units = Units();
    for (std::size_t i = 0; i < units.size(); ++i)
    {
      if (CLI::detail::to_lower(this->Unit) == units[i])
      {
        this->Params.Unit = static_cast<LengthUnit>(i);
      }
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    session.Report["unit"] = units[static_cast<std::size_t>(this->Params.Unit)];
    if (!operations->empty())
    {
      if (Status status = this->ReadCurves(operations.Value, session); !status)
      {
        return status;
      }
      if (Status status = this->Modify(operations.Value, session); !status)
      {
        return status;
      }
    }
    return this->Suggest ? this->List(session) : Status();
  }

private:
  static std::vector<std::string> Units()
  {
    return { "micrometre", "millimetre", "centimetre", "metre", "inch", "foot" };
  }

  /// What is said of the staged file is said of the output.
  Status Named(Status status, const std::string& staged) const
  {
    for (std::size_t at = 0; (at = status.Detail.find(staged, at)) != std::string::npos;
         at += this->Output.size())
    {
      status.Detail.replace(at, staged.size(), this->Output);
    }
    return status;
  }

  /// Options that go together.
  Status CheckUse(const std::vector<CADOperation>& operations) const
  {
    const std::string place = "'" + this->Input + "': ";
    const bool modifies = !operations.empty();
    if (!modifies && !this->Suggest)
    {
      return { ErrorCode::EmptyInput,
        place + "there is no operation; give one such as --imprint, --cut-plane or --suggest" };
    }
    if (modifies == this->Output.empty())
    {
      return { ErrorCode::InvalidParameter,
        place +
          (modifies ? "operations need --output FILE"
                    : "--output is written by operations, and there is none; leave it out") };
    }
    if (!this->Suggest && !this->Table.empty())
    {
      return { ErrorCode::InvalidParameter, place + "--table is of --suggest; give both" };
    }
    return {};
  }

  Status Modify(const std::vector<CADOperation>& operations, Session& session)
  {
    const auto staged = session.Files.Stage(this->Output);
    if (!staged)
    {
      return staged.Status;
    }
    session.Report["volume_tolerance"] = this->Params.VolumeTolerance;
    std::vector<CADStep> steps;
    const Status status = session.Measure(
      [&]
      {
        auto made = ModifyCADInProcess(this->Input, staged->string(), operations, this->Params);
        steps = std::move(made.Value);
        return made.Status;
      });
    if (!status)
    {
      return this->Named(status, staged->string());
    }
    this->AddSteps(steps, session.Report);
    for (const CADStep& step : steps)
    {
      session.Warn(step.Healing.Unmended);
    }
    return this->Named(
      this->AddFound(staged->string(), steps.back().After, session), staged->string());
  }

  /// Looks for what may be done.
  Status List(Session& session)
  {
    this->SuggestParams.Unit = this->Params.Unit;
    CADSuggestions found;
    const Status status = session.Measure(
      [&]
      {
        auto made = SuggestCADOperations(this->Input, this->SuggestParams);
        found = std::move(made.Value);
        return made.Status;
      });
    if (!status)
    {
      return status;
    }
    session.Report["size"] = found.Size;
    session.Report["tangent_angle"] = this->SuggestParams.TangentAngle;
    session.Report["part"] = InReport(found.Counts);
    session.Report["swept_solids"] = found.Swept;
    session.Report["mapped_solids"] = found.Mapped;
    session.Report["concave_edges"] = found.ConcaveEdges;
    session.Report["untried_cuts"] = found.UntriedCuts;
    auto list = nlohmann::ordered_json::array();
    for (const CADSuggestion& one : found.List)
    {
      list.push_back(InReport(one));
      std::cout << (session.Quiet ? std::string() : InWords(one) + "\n");
    }
    session.Report["suggestions"] = std::move(list);
    return this->Table.empty() ? Status() : session.Write(TableOf(found), this->Table);
  }

  void Add(const char* name, const CLI::Option* option) { this->Kinds[option] = name; }

  /// An option that may stand there any number of times.
  template <typename Words>
  void AddRepeated(const char* name, std::vector<Words>& words, const char* type, const char* help)
  {
    CLI::Option* option = this->App.add_option(name, words, help);
    option->type_name(type)->allow_extra_args(false);
    this->Add(name, option);
  }

  /// What the options say, in their order on the command line.
  Result<std::vector<CADOperation>> Operations() const
  {
    std::vector<CADOperation> operations;
    std::map<std::string, std::size_t> numWords; ///< of each option, so far
    for (const CLI::Option* option : this->App.parse_order())
    {
      const auto kind = this->Kinds.find(option);
      if (kind == this->Kinds.end())
      {
        continue;
      }
      // the parser tells of every word
      const std::size_t word = numWords[kind->second]++;
      const auto size = static_cast<std::size_t>(std::max(option->get_type_size(), 1));
      if (word % size != 0)
      {
        continue;
      }
      if (kind->second == "--imprint" && !this->Imprint)
      {
        continue; // --imprint 0
      }
      auto operation = this->OperationOf(kind->second, word / size);
      if (!operation)
      {
        return operation.Status;
      }
      operations.push_back(std::move(operation.Value));
    }
    return operations;
  }

  /// Words of an operation.
  class Text
  {
  public:
    explicit Text(std::string name) : Words(std::move(name)) {}
    Text& Add(const std::string& word)
    {
      this->Words += " " + word;
      return *this;
    }
    Text& Add(double number) { return this->Add(Digits(number, 17)); }
    template <std::size_t N>
    Text& Add(const std::array<double, N>& numbers)
    {
      for (double number : numbers)
      {
        this->Add(number);
      }
      return *this;
    }

    std::string Words;
  };

  /// @param i  counts how often the option stands on the command line.
  Result<CADOperation> OperationOf(const std::string& name, std::size_t i) const
  {
    Text text(name.substr(2));
    if (name == "--cut-plane")
    {
      text.Add(this->CutPlanes[i]);
    }
    else if (name == "--cut-cylinder")
    {
      text.Add(this->CutCylinders[i]);
    }
    else if (name == "--cut-face")
    {
      text.Add(std::to_string(this->CutFaces[i]));
    }
    else if (name == "--split-plane")
    {
      const auto& [ids, x, y, z, nx, ny, nz] = this->SplitPlanes[i];
      text.Add(ids).Add(PlaneWords{ x, y, z, nx, ny, nz });
    }
    else if (name == "--split-iso")
    {
      const auto& [ids, direction, share] = this->SplitIsos[i];
      text.Add(ids).Add(direction).Add(share);
    }
    else if (name == "--split-curve")
    {
      text.Add(std::get<0>(this->SplitCurves[i]));
    }
    else if (name == "--composite")
    {
      text.Add(this->Composites[i]);
    }
    else if (name == "--heal")
    {
      text.Add(this->Heals[i]);
    }
    return ParseCADOperation(text.Words);
  }

  /// Reads the curves of operations that have some.
  Status ReadCurves(std::vector<CADOperation>& operations, Session& session) const
  {
    std::size_t next = 0;
    for (CADOperation& operation : operations)
    {
      if (operation.Kind != CADOperationKind::SplitByCurve)
      {
        continue;
      }
      const std::string& file = std::get<1>(this->SplitCurves[next++]);
      const auto data = session.Read(file);
      if (!data)
      {
        return data.Status;
      }
      auto curves = CurvesInSpace(data.Value);
      if (!curves)
      {
        return { curves.Status.Code, "'" + file + "': " + curves.Status.Detail };
      }
      operation.Curves = std::move(curves.Value);
    }
    return {};
  }

  static void AddSteps(const std::vector<CADStep>& steps, nlohmann::ordered_json& report)
  {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    double overlap = 0.0;
    for (const CADStep& step : steps)
    {
      overlap += step.Overlap;
      list.push_back({ { "operation", NameOf(step.Kind) }, { "before", InReport(step.Before) },
        { "after", InReport(step.After) }, { "volume_change", step.VolumeChange },
        { "overlap", step.Overlap }, { "new_faces", step.NewFaces } });
      if (step.Kind == CADOperationKind::Composite)
      {
        list.back()["composite"] = { { "name", step.Composite.Name },
          { "faces", step.Composite.Faces } };
      }
      if (step.Kind == CADOperationKind::Heal)
      {
        list.back()["healing"] = InReport(step.Healing);
      }
    }
    const CADCounts& before = steps.front().Before;
    const CADCounts& after = steps.back().After;
    report["solids_before"] = before.Solids;
    report["faces_before"] = before.Faces;
    report["volume_before"] = before.Volume;
    report.update(InReport(after));
    report["shared_faces"] = after.FaceIds - after.Faces;
    report["overlap"] = overlap;
    report["operations"] = std::move(list);
  }

  /// Reads the written file again.
  Status AddFound(const std::string& file, const CADCounts& made, Session& session) const
  {
    const auto found = CheckCAD(file, this->Params.Unit);
    if (!found)
    {
      return found.Status;
    }
    std::error_code ignored;
    session.Report["file_bytes"] = std::filesystem::file_size(file, ignored);
    session.Report["brep_valid"] = found->Valid;
    session.Report["file_solids"] = found->NumSolids;
    session.Report["file_faces"] = found->NumFaces;
    session.Report["file_volume"] = found->Volume;
    session.Report["max_edge_tolerance"] = found->MaxEdgeTolerance;
    session.Report["max_vertex_tolerance"] = found->MaxVertexTolerance;
    if (!found->Valid || found->NumSolids != made.Solids)
    {
      return { ErrorCode::InvalidTopology,
        "'" + file + "' is not valid when it is read again" +
          (found->Defects.empty() ? "" : ": " + found->Defects.front()) + "; move the last cut" };
    }
    return {};
  }

  CLI::App& App;
  std::map<const CLI::Option*, std::string> Kinds; ///< options that are operations
  std::string Input;
  std::string Output;
  std::string Unit = "millimetre";
  std::string Table;
  bool Imprint = false;
  bool Suggest = false;
  std::vector<PlaneWords> CutPlanes;
  std::vector<CylinderWords> CutCylinders;
  std::vector<int> CutFaces;
  std::vector<SplitPlaneWords> SplitPlanes;
  std::vector<SplitIsoWords> SplitIsos;
  std::vector<SplitCurveWords> SplitCurves;
  std::vector<std::string> Composites;
  std::vector<double> Heals;
  CADModifyParams Params;
  CADSuggestParams SuggestParams;
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<CADModifyJob>(app);
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "cadmodify",
  "mend a CAD part, cut its solids, split its faces, make solids that touch share faces",
  "solid.step --cut-plane 0.5 0 0 1 0 0 --output pieces.step --report pieces.json", Make };
}
}
