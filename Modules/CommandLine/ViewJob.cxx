// SPDX-License-Identifier: BSD-3-Clause
#include "FilterProperties.h"
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineIO/FileFormats.h>
#include <knotwork/SplineIO/Messages.h>
#include <knotwork/SplineIO/vtkCADReader.h>
#include <knotwork/SplineIO/vtkPictureWriter.h>

#include <vtkDataObject.h>
#include <vtkNew.h>

#include <memory>

namespace knotwork
{
namespace
{
struct ViewJob
{
  std::string Input;
  std::string Output;
  vtkNew<vtkPictureWriter> Writer;
  std::unique_ptr<Options> WriterOptions;

  /// Trimmed faces as triangles; their edges are those of faces, unless others are asked for.
  Result<vtkSmartPointer<vtkDataObject>> ReadCAD(Session& session)
  {
    if (Status status = session.Files.CheckInput(this->Input); !status)
    {
      return status;
    }
    vtkNew<vtkCADReader> reader;
    reader->SetFileName(this->Input.c_str());
    reader->SetChordalTolerance(this->Writer->GetChordalTolerance());
    reader->SetThreads(session.Threads);
    if (Status status = session.Run(reader, "'" + this->Input + "'"); !status)
    {
      return status;
    }
    session.NoteReader(reader, this->Input);
    if (this->Writer->GetEdges() == vtkPictureWriter::AUTO)
    {
      this->Writer->SetEdges(vtkPictureWriter::PATCHES);
    }
    return vtkSmartPointer<vtkDataObject>(reader->GetOutputDataObject(2));
  }

  Status Run(Session& session)
  {
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->WriterOptions->Apply(session.Report);
    auto data = HasCADEnding(this->Input) ? this->ReadCAD(session) : session.Read(this->Input);
    if (!data)
    {
      return data.Status;
    }
    session.Report["number_of_points"] = data.Value->GetNumberOfElements(vtkDataObject::POINT);
    session.Report["number_of_cells"] = data.Value->GetNumberOfElements(vtkDataObject::CELL);
    const auto staged = session.Files.Stage(this->Output);
    if (!staged)
    {
      return staged.Status;
    }
    this->Writer->SetInputDataObject(data.Value);
    this->Writer->SetFileName(staged->c_str());
    MessageCapture messages;
    session.Measure(
      [this]
      {
        this->Writer->Write();
        return Status();
      });
    if (this->Writer->GetErrorCode() == 0)
    {
      return {};
    }
    const Status status(CodeOfFilter(this->Writer), messages.FirstError());
    return status.Code == ErrorCode::FileError
      ? AboutFile(status, this->Output, staged->string())
      : Status(status.Code, "'" + this->Input + "': " + status.Detail);
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<ViewJob>();
  app.add_option("input", job->Input, "what is drawn: " + JoinEndings(EndingsThatRead(AnyContent)))
    ->required();
  AddOutput(app, "--output", job->Output, ".png", "the picture")->required();
  job->WriterOptions = std::make_unique<Options>(app);
  AddProperties(*job->WriterOptions, job->Writer);
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "view", "draw a picture of anything that is read",
  "plate.vtu --output plate.png", Make };
}
}
