// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADFitting/TargetDistances.h>
#include <knotwork/CADFitting/vtkDatumAlignment.h>
#include <knotwork/CADFitting/vtkRigidAlignment.h>

#include <vtkDataArray.h>
#include <vtkVariant.h>

namespace knotwork
{
namespace
{
constexpr int Numbers = 1; ///< port of both filters

enum Branches
{
  OntoTarget = 1,
  ByDatums
};

std::vector<double> TupleOf(vtkTable* table, const char* column)
{
  auto* const values = vtkDataArray::SafeDownCast(table->GetColumnByName(column));
  std::vector<double> tuple(static_cast<std::size_t>(values->GetNumberOfComponents()));
  values->GetTuple(0, tuple.data());
  return tuple;
}

/// Onto a target, or by datums where no target is given.
class AlignJob : public FilterJob<vtkRigidAlignment>
{
public:
  explicit AlignJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "scan",
      "triangle mesh or points (.off .obj .ply .stl .vtp .vtu .xyz .txt .csv .g2)", "", "input");
    this->AddInput(1, "--to",
      "what to move the scan onto: a CAD part (.step .stp .iges .igs .brep), triangles (.stl .off "
      ".obj .ply .vtp) or a spline (.vtu .vtpc .xml .g2)",
      " onto ");
    this->AddOutput(0, "--output", Endings::Sampled, "the scan at its place, with its distances");
    this->AddOutput(Numbers, "--table", Endings::Table, "the motion and its numbers");
    this->FilterOptions.Begin(OntoTarget, "the alignment with a target (--to)");
    this->AddProperties();
    this->FilterOptions.Begin(ByDatums, "the alignment by datums");
    this->FilterOptions.Rename("Tolerance", "RecognitionTolerance");
    knotwork::AddProperties(this->FilterOptions, this->Datums);
  }

protected:
  Result<int> Branch() override
  {
    const Options& options = this->FilterOptions;
    this->HasDatums = options.IsGiven("DatumPlane") || options.IsGiven("DatumAxis") ||
      options.IsGiven("DatumPoint");
    const bool hasTarget = !this->InputFile(1).empty();
    if (hasTarget == this->HasDatums)
    {
      return { hasTarget ? ErrorCode::InvalidParameter : ErrorCode::EmptyInput,
        hasTarget ? "give either a target (--to) or datums"
                  : "give what to move the scan onto (--to), or its datums (--datum-plane, "
                    "--datum-axis)" };
    }
    return hasTarget ? OntoTarget : ByDatums;
  }

  Status Prepare(Session& session) override
  {
    if (this->HasDatums)
    {
      this->Datums->SetInputDataObject(this->Input(0));
      this->Datums->SetThreads(session.Threads);
      this->Algorithm = this->Datums;
    }
    const Status status = this->RequirePointSet(0);
    return status ? session.CheckFormat(this->Input(0), this->MainOutput()) : status;
  }

  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    if (this->HasDatums)
    {
      ReportRow(table, 0, { "Regions", "FreeMotions" }, session.Report);
    }
    else
    {
      ReportTruths(table, 0, { "Converged", "Ambiguous", "Signed" }, session.Report);
      ReportRow(table, 0,
        { "EqualPoses", "FreeMotions", "Iterations", "LastStep", "Points", "Inliers",
          "InlierFraction", "InlierRms", "OutlierDistance", "TargetSize" },
        session.Report);
      for (const char* name : { "Rms", "Min", "Max", "Mean", "MeanAbsolute" })
      {
        session.Report[Options::SnakeCase(name) + "_distance"] =
          table->GetValueByName(0, name).ToDouble();
      }
      session.Report["percentile_levels"] = PercentileLevels;
      session.Report["percentiles"] = TupleOf(table, "Percentiles");
    }
    session.Report["motion"] = TupleOf(table, "Motion");
    return {};
  }

private:
  vtkNew<vtkDatumAlignment> Datums;
  bool HasDatums = false;
};

const JobRegistration Registration{ "align",
  "move a scan onto a CAD part, a spline or a mesh, or to a coordinate system of its faces",
  "scan.xyz --to terrain.vtu --output aligned.vtp --report aligned.json", MakeJob<AlignJob> };
}
}
