// SPDX-License-Identifier: BSD-3-Clause
#include "VTKText.h"

#include <knotwork/SplineCore/FileOutput.h>

#include "vtkBase64Utilities.h"
#include "vtkDataAssembly.h"
#include "vtkDelimitedTextWriter.h"
#include "vtkImageData.h"
#include "vtkIndent.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLImageDataWriter.h"
#include "vtkXMLPolyDataWriter.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
/// VTK's writers crash now and then when a disk is full, so they write to memory.
template <typename Writer>
std::string XmlText(vtkDataObject* data, const std::string& encoding)
{
  vtkNew<Writer> writer;
  writer->SetInputDataObject(data);
  writer->WriteToOutputStringOn();
  writer->SetCompressionLevel(1); // VTK's 5 takes twice the time and more for a size 7 % less
  if (encoding == "ascii")
  {
    writer->SetDataModeToAscii();
  }
  else if (encoding == "binary")
  {
    writer->SetDataModeToBinary();
  }
  else
  {
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
  }
  return writer->Write() == 1 ? writer->GetOutputString() : std::string();
}

template <typename Writer>
Status WriteXml(vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  const std::string text = XmlText<Writer>(data, encoding);
  return text.empty() ? Status(ErrorCode::LibraryError, "") : PutText(text, file);
}

/// A name as the value of an attribute.
std::string Quoted(const std::string& name)
{
  std::string text;
  for (const char c : name)
  {
    text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return '"' + text + '"';
}

/// The tree of names of a collection, as its format has it.
std::string AssemblyText(vtkDataAssembly* assembly)
{
  const std::string xml = assembly->SerializeToXML(vtkIndent());
  std::vector<unsigned char> encoded(2 * xml.size() + 4);
  const auto length = vtkBase64Utilities::Encode(
    reinterpret_cast<const unsigned char*>(xml.data()), xml.size(), encoded.data());
  return "    <DataAssembly encoding=\"base64\">\n      " +
    std::string(reinterpret_cast<const char*>(encoded.data()), length) + "\n    </DataAssembly>\n";
}

/// Every piece is a file in a folder of the collection's name.
Status WriteCollection(
  vtkPartitionedDataSetCollection* data, const fs::path& file, const std::string& encoding)
{
  const std::string stem = file.stem().string();
  const fs::path folder = file.parent_path() / stem;
  std::error_code failure;
  if (!fs::create_directory(folder, failure))
  {
    return { ErrorCode::FileError, failure.message() };
  }
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile "
                     "type=\"vtkPartitionedDataSetCollection\" version=\"1.0\">\n"
                     "  <vtkPartitionedDataSetCollection>\n";
  for (unsigned int p = 0; p < data->GetNumberOfPartitionedDataSets(); ++p)
  {
    const char* name =
      data->HasMetaData(p) ? data->GetMetaData(p)->Get(vtkCompositeDataSet::NAME()) : nullptr;
    text += "    <Partitions index=\"" + std::to_string(p) + '"' +
      (name ? " name=" + Quoted(name) : std::string()) + ">\n";
    for (unsigned int i = 0; i < data->GetNumberOfPartitions(p); ++i)
    {
      vtkDataObject* piece = data->GetPartitionAsDataObject(p, i);
      if (!piece)
      {
        continue;
      }
      const bool isPolyData = vtkPolyData::SafeDownCast(piece) != nullptr;
      const std::string own =
        stem + "_" + std::to_string(p) + "_" + std::to_string(i) + (isPolyData ? ".vtp" : ".vtu");
      const std::string path = (folder / own).string();
      const Status status = isPolyData
        ? WriteXml<vtkXMLPolyDataWriter>(piece, path, encoding)
        : WriteXml<vtkXMLUnstructuredGridWriter>(piece, path, encoding);
      if (!status)
      {
        return { status.Code, status.Detail.substr(status.Detail.rfind(": ") + 2) };
      }
      text += "      <DataSet index=\"" + std::to_string(i) +
        "\" file=" + Quoted(stem + "/" + own) + "/>\n";
    }
    text += "    </Partitions>\n";
  }
  vtkDataAssembly* assembly = data->GetDataAssembly();
  text += assembly ? AssemblyText(assembly) : std::string();
  text += "  </vtkPartitionedDataSetCollection>\n</VTKFile>\n";
  return PutText(text, file.string());
}

}

Status WriteVTKFile(vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    return WriteCollection(collection, file, encoding);
  }
  return vtkPolyData::SafeDownCast(data) ? WriteXml<vtkXMLPolyDataWriter>(data, file, encoding)
    : vtkImageData::SafeDownCast(data)
    ? WriteXml<vtkXMLImageDataWriter>(data, file, encoding)
    : WriteXml<vtkXMLUnstructuredGridWriter>(data, file, encoding);
}

std::string TextOfTable(vtkDataObject* table)
{
  vtkNew<vtkDelimitedTextWriter> writer;
  writer->SetInputDataObject(table);
  writer->WriteToOutputStringOn();
  writer->Write();
  const std::unique_ptr<char[]> text(writer->RegisterAndGetOutputString());
  return text ? text.get() : "";
}
}
