// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-read-vtk PARENT BYTES SECONDS FILE
// Reads .vtu, .vtp, .vti, .vtpc and .vtk by VTK's readers for another process, see WorkerMain.h.
#include "CellCheck.h"
#include "DataParts.h"
#include "Messages.h"
#include "XmlCheck.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/WorkerMain.h>

#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkSTLReader.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPartitionedDataSetCollectionReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <new>

namespace
{
using namespace knotwork;

template <typename Reader>
vtkSmartPointer<vtkDataObject> ReadWith(const std::string& file)
{
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutputDataObject(0);
}

vtkSmartPointer<vtkDataObject> ReadByEnding(const std::string& file, const std::string& ending)
{
  if (ending == ".vtu")
  {
    return ReadWith<vtkXMLUnstructuredGridReader>(file);
  }
  if (ending == ".vtp")
  {
    return ReadWith<vtkXMLPolyDataReader>(file);
  }
  if (ending == ".vti")
  {
    return ReadWith<vtkXMLImageDataReader>(file);
  }
  if (ending == ".vtpc")
  {
    return ReadWith<vtkXMLPartitionedDataSetCollectionReader>(file);
  }
  if (ending == ".obj")
  {
    return ReadWith<vtkOBJReader>(file);
  }
  if (ending == ".ply")
  {
    return ReadWith<vtkPLYReader>(file);
  }
  if (ending == ".stl")
  {
    return ReadWith<vtkSTLReader>(file);
  }
  return ReadWith<vtkUnstructuredGridReader>(file);
}

/// What VTK says, where a user can make something of it.
std::string Reason(std::string text, const std::string& file)
{
  constexpr std::size_t most = 200;
  const std::string place = " for file: " + file;
  if (const std::size_t at = text.find(place); at != std::string::npos)
  {
    text.erase(at, place.size());
  }
  const bool isOfVTK = text.find("vtk") != std::string::npos ||
    text.find("returned failure for request") != std::string::npos;
  return text.empty() || isOfVTK ? std::string() : " (" + text.substr(0, most) + ")";
}

Status Read(const Parts& words, const Parts&, Parts& found)
{
  if (words.size() != 1)
  {
    return { ErrorCode::InvalidParameter, "there is no file" };
  }
  const std::string& file = words[0];
  const std::string ending = LowerEnding(file);
  if (Status status = CheckXmlFile(file, ending); !status)
  {
    return status;
  }
  MessageCapture messages;
  const vtkSmartPointer<vtkDataObject> data = ReadByEnding(file, ending);
  if (messages.FirstError().find("Unable to allocate") != std::string::npos)
  {
    throw std::bad_alloc();
  }
  if (!data || messages.HasError())
  {
    return { ErrorCode::InvalidTopology,
      "'" + file + "' is damaged or not what its ending says" +
        Reason(messages.FirstError(), file) + "; write it again" };
  }
  if (Status status = CheckCells(data); !status)
  {
    return { status.Code, "'" + file + "' is damaged: " + status.Detail + "; write it again" };
  }
  if (Status status = CheckCellSizes(vtkDataSet::SafeDownCast(data)); !status)
  {
    return { status.Code, "'" + file + "': " + status.Detail };
  }
  AppendParts(data, found);
  return {};
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Read);
}
