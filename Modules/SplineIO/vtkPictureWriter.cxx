// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPictureWriter.h"

#include "DataParts.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/WorkerProcess.h>

#include "vtkDataObject.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

#include <string>
#include <vector>

vtkStandardNewMacro(vtkPictureWriter);

namespace
{
using namespace knotwork;

constexpr const char* Program = "knotwork-view";
constexpr int MaximumSize = 8192; // of what Mesa's software draws

Status WhyNone(WorkerEnd end, const WorkerLimits& limits)
{
  switch (end)
  {
    case WorkerEnd::Missing:
      return { ErrorCode::LibraryError,
        std::string("no picture can be drawn: the program ") + Program +
          " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
    case WorkerEnd::NotStarted:
      return { ErrorCode::LibraryError,
        "no picture can be drawn: no process could be started for it; end other programs" };
    case WorkerEnd::Late:
      return { ErrorCode::TooLarge,
        "the picture was not ready within " + std::to_string(limits.CpuSeconds) +
          " s; draw a part, or raise the tolerance" };
    case WorkerEnd::OutOfMemory:
      return { ErrorCode::TooLarge,
        "the picture needs more than " + std::to_string(limits.Memory >> 20U) +
          " MB; draw a part, a smaller picture, or raise the tolerance" };
    case WorkerEnd::Aborted:
      return { ErrorCode::Aborted, "" };
    case WorkerEnd::Done:
    case WorkerEnd::Crashed:
      break;
  }
  return { ErrorCode::LibraryError,
    std::string("no picture can be drawn: ") + Program +
      " crashed; install libegl1 and libgl1-mesa-dri anew" };
}
}

vtkPictureWriter::~vtkPictureWriter()
{
  this->SetFileName(nullptr);
}

int vtkPictureWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPartitionedDataSetCollection");
  return 1;
}

Status vtkPictureWriter::Draw()
{
  const std::string file = this->FileName ? this->FileName : "";
  if (LowerEnding(file) != ".png")
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': a picture is written as .png; change the ending" };
  }
  for (const int side : this->Size)
  {
    if (side < 16 || side > MaximumSize)
    {
      return { ErrorCode::InvalidParameter,
        "a picture of " + std::to_string(this->Size[0]) + " x " + std::to_string(this->Size[1]) +
          " pixels cannot be drawn; each side is 16 to " + std::to_string(MaximumSize) };
    }
  }
  std::vector<std::string> parts;
  AppendParts(this->GetInput(), parts);
  WorkerLimits limits;
  limits.Memory = std::uint64_t{ 1 } << 34U;
  const std::vector<std::string> words{ std::to_string(this->Size[0]),
    std::to_string(this->Size[1]), this->Array, std::to_string(this->Component), this->Direction,
    std::to_string(this->Edges), this->Color, this->Background,
    std::to_string(this->ChordalTolerance) };
  const WorkerAnswer answer = RunWorker(Program, words, parts, limits);
  if (answer.End != WorkerEnd::Done)
  {
    return WhyNone(answer.End, limits);
  }
  return answer.Outcome ? PutText(answer.Parts.front(), file) : answer.Outcome;
}

void vtkPictureWriter::WriteData()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  Status status;
  try
  {
    status = this->Draw();
  }
  catch (...) // of a library, out of memory
  {
    status = knotwork::StatusOfException();
  }
  if (!status)
  {
    this->SetErrorCode(knotwork::FilterErrorCode(status));
    vtkErrorMacro("" << status.Message());
  }
}
