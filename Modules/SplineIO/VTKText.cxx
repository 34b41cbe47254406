// SPDX-License-Identifier: BSD-3-Clause
#include "VTKText.h"

#include "Base64Stream.h"
#include "ParallelZLib.h"
#include "TextChunks.h"
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
/// What VTK's writers need to write to memory: they crash now and then when a disk is full.
template <typename Writer>
class MemoryWriter : public Writer
{
public:
  static MemoryWriter* New()
  {
    auto* writer = new MemoryWriter;
    writer->InitializeObjectBase();
    return writer;
  }

  TextChunks Text;

protected:
  MemoryWriter() { this->SetDataStream(vtkNew<Base64Stream>()); }

  int StartFile() override
  {
    this->Stream->rdbuf(&this->Text); // in place of the string's
    return this->Writer::StartFile();
  }
};

/// How numbers are written.
struct XmlParams
{
  std::string Encoding;
  int Threads = 0;
};

template <typename Writer>
Status WriteXml(vtkDataObject* data, const std::string& file, const XmlParams& params)
{
  constexpr std::size_t block = 1 << 24; // bytes that are compressed at a time
  vtkNew<MemoryWriter<Writer>> writer;
  writer->SetInputDataObject(data);
  writer->WriteToOutputStringOn();
  vtkNew<ParallelZLib> compressor;
  compressor->Threads = params.Threads;
  writer->SetCompressor(compressor);
  writer->SetCompressionLevel(1); // VTK's 5 takes twice the time and more for a size 7 % less
  writer->SetBlockSize(block);
  if (params.Encoding == "ascii")
  {
    writer->SetDataModeToAscii();
  }
  else if (params.Encoding == "binary")
  {
    writer->SetDataModeToBinary();
  }
  else
  {
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
  }
  if (writer->Write() != 1 || writer->Text.Size() == 0)
  {
    return { ErrorCode::LibraryError, "" };
  }
  FileOutput output(file);
  writer->Text.WriteTo(output.Stream());
  return output.Finish();
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
  vtkPartitionedDataSetCollection* data, const fs::path& file, const XmlParams& params)
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
        ? WriteXml<vtkXMLPolyDataWriter>(piece, path, params)
        : WriteXml<vtkXMLUnstructuredGridWriter>(piece, path, params);
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

Status WriteVTKFile(
  vtkDataObject* data, const std::string& file, const std::string& encoding, int threads)
{
  const XmlParams params{ encoding, threads };
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    return WriteCollection(collection, file, params);
  }
  return vtkPolyData::SafeDownCast(data) ? WriteXml<vtkXMLPolyDataWriter>(data, file, params)
    : vtkImageData::SafeDownCast(data)   ? WriteXml<vtkXMLImageDataWriter>(data, file, params)
                                       : WriteXml<vtkXMLUnstructuredGridWriter>(data, file, params);
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
