// SPDX-License-Identifier: BSD-3-Clause
#include "CADModify.h"

#include "CADDocument.h"
#include "CADFile.h"
#include "CADSession.h"
#include "ModelDocument.h"
#include "ShapeComposite.h"
#include <knotwork/SplineCore/FileOutput.h>

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Standard_OStream.hxx>
#include <TopoDS_Compound.hxx>

#include <sstream>

namespace knotwork
{
namespace
{
/// The bodies at their places, with what they share, in millimetres.
void WriteBREP(const ModelBodies& model, double millimetres, std::ostream& stream)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const ModelBody& body : model.Bodies)
  {
    builder.Add(compound, body.Shape);
  }
  gp_Trsf scale;
  scale.SetScale(gp_Pnt(), millimetres);
  BRepTools::Write(
    millimetres == 1.0 ? compound : BRepBuilderAPI_Transform(compound, scale, true).Shape(),
    stream);
}
}

Result<ModifiedCAD> ModifyCADText(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params)
{
  const std::string place = "'" + file + "'";
  if (operations.empty())
  {
    return { ErrorCode::EmptyInput, place + ": there is no operation; give one or more" };
  }
  if (!(params.VolumeTolerance >= 0.0 && params.VolumeTolerance <= 1.0))
  {
    return { ErrorCode::InvalidParameter, "VolumeTolerance must lie in [0, 1]" };
  }
  const CADFormat format = FormatOfFile(output);
  if (FormatOfFile(file) != CADFormat::STEP)
  {
    return { ErrorCode::InvalidParameter, place + ": the ending must be .step or .stp" };
  }
  if (format != CADFormat::STEP && format != CADFormat::BREP)
  {
    return { ErrorCode::InvalidParameter,
      "'" + output + "': the ending must be .step, .stp or .brep" };
  }
  ModifiedCAD made;
  std::vector<CADStep>& steps = made.Steps;
  CADSession session(params.Unit);
  session.SetDefaultsOfReading();
  session.Set("read.stepcaf.subshapes.name", 1);
  session.Set("write.stepcaf.subshapes.name", 1);
  session.Set("write.surfacecurve.mode", 1);
  session.Set("write.step.assembly", 2); // when it is off, names and colours of products are lost
  const Status status = session.Run(place,
    [&]() -> Status
    {
      const bool healsFirst = operations.front().Kind == CADOperationKind::Heal;
      session.SetMending(!healsFirst); // what is mended on the way is counted nowhere
      Handle(TDocStd_Document) document;
      LengthUnit unit = LengthUnit::Millimetre;
      if (Status loaded = LoadModel(session, file, document, unit); !loaded)
      {
        return loaded;
      }
      session.SetMending(true);
      session.Set("write.step.unit", NameOfUnit(unit));
      const double scale = Millimetres(params.Unit) / Millimetres(unit);
      ModelDocument tree(document);
      ModelBodies model = tree.Take();
      if (Status valid = healsFirst ? Status() : CheckBodies(model); !valid)
      {
        return { valid.Code, place + ": " + valid.Detail + "; heal it first" };
      }
      for (const CADOperation& operation : operations)
      {
        CADStep step;
        if (Status done = RunOperation(operation, scale, model, step); !done)
        {
          return { done.Code,
            place + ", operation " + std::to_string(steps.size() + 1) + ": " + done.Detail };
        }
        const bool keepsVolume = operation.Kind != CADOperationKind::Heal;
        if (keepsVolume && !(step.VolumeChange <= params.VolumeTolerance))
        {
          std::ostringstream detail;
          detail << place << ", operation " << steps.size() + 1 << ": the volume changes by "
                 << step.VolumeChange << " of itself, more than " << params.VolumeTolerance
                 << "; edges of the file lie off their faces, or the cut runs along a face: move "
                    "it, heal the part or ask for a larger volume tolerance";
          return { ErrorCode::InvalidTopology, detail.str() };
        }
        steps.push_back(std::move(step));
      }
      std::ostringstream text;
      if (format == CADFormat::BREP)
      {
        const std::string group = FirstComposite(model);
        if (!group.empty())
        {
          return { ErrorCode::InvalidParameter,
            "'" + output + "': composite " + group +
              " travels in the names of its faces, which BREP files have not; write .step" };
        }
        WriteBREP(model, Millimetres(unit), text);
        made.Text = text.str();
        return {};
      }
      if (!WriteSTEP(tree.Put(model), "Modified", text))
      {
        return { ErrorCode::InvalidFormat,
          "'" + output + "' cannot be written: OpenCASCADE made no text" };
      }
      CADSummary summary;
      if (Status read = CheckSTEPText(text.str(), summary); !read)
      {
        return read;
      }
      if (!summary.Valid || summary.NumSolids != steps.back().After.Solids)
      {
        return { ErrorCode::InvalidFormat,
          "'" + output +
            "' is not written: OpenCASCADE reads something else in it; move the last cut" };
      }
      made.Text = text.str();
      return {};
    });
  return status ? Result<ModifiedCAD>(std::move(made)) : Result<ModifiedCAD>(status);
}

Result<std::vector<CADStep>> ModifyCAD(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params)
{
  auto made = ModifyCADText(file, output, operations, params);
  const Status status = made ? PutText(made->Text, output) : made.Status;
  return status ? Result<std::vector<CADStep>>(std::move(made->Steps))
                : Result<std::vector<CADStep>>(status);
}
}
