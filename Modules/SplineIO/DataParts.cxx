// SPDX-License-Identifier: BSD-3-Clause
#include "DataParts.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkXMLDataObjectWriter.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLReader.h>
#include <vtkXMLWriter.h>

#include <cstdlib>

namespace knotwork
{
namespace
{
constexpr int Nothing = -1; ///< type of a partition that is not there

std::string Take(std::vector<std::string>& parts, std::size_t& next)
{
  return next < parts.size() ? std::move(parts[next++]) : std::string();
}

int TakeNumber(std::vector<std::string>& parts, std::size_t& next)
{
  return std::atoi(Take(parts, next).c_str());
}

void AppendCollection(vtkPartitionedDataSetCollection* data, std::vector<std::string>& parts)
{
  vtkDataAssembly* assembly = data->GetDataAssembly();
  parts.push_back(assembly ? assembly->SerializeToXML(vtkIndent()) : "");
  parts.push_back(std::to_string(data->GetNumberOfPartitionedDataSets()));
  for (unsigned int i = 0; i < data->GetNumberOfPartitionedDataSets(); ++i)
  {
    vtkPartitionedDataSet* set = data->GetPartitionedDataSet(i);
    vtkInformation* about = data->HasMetaData(i) ? data->GetMetaData(i) : nullptr;
    const char* name = about ? about->Get(vtkCompositeDataSet::NAME()) : nullptr;
    parts.emplace_back(name ? name : "");
    const unsigned int count = set ? set->GetNumberOfPartitions() : 0;
    parts.push_back(std::to_string(count));
    for (unsigned int k = 0; k < count; ++k)
    {
      AppendParts(set->GetPartitionAsDataObject(k), parts);
    }
  }
}

vtkSmartPointer<vtkDataObject> TakeCollection(std::vector<std::string>& parts, std::size_t& next)
{
  vtkNew<vtkPartitionedDataSetCollection> data;
  if (const std::string assembly = Take(parts, next); !assembly.empty())
  {
    vtkNew<vtkDataAssembly> tree;
    if (tree->InitializeFromXML(assembly.c_str()))
    {
      data->SetDataAssembly(tree);
    }
  }
  const int sets = TakeNumber(parts, next);
  for (int i = 0; i < sets && next < parts.size(); ++i)
  {
    vtkNew<vtkPartitionedDataSet> set;
    const std::string name = Take(parts, next);
    const int count = TakeNumber(parts, next);
    for (int k = 0; k < count && next < parts.size(); ++k)
    {
      set->SetPartition(static_cast<unsigned int>(k), TakeData(parts, next));
    }
    data->SetPartitionedDataSet(static_cast<unsigned int>(i), set);
    if (!name.empty())
    {
      data->GetMetaData(static_cast<unsigned int>(i))
        ->Set(vtkCompositeDataSet::NAME(), name.c_str());
    }
  }
  return data;
}

/// The text without the ranges of norms that VTK keeps with arrays: it writes infinite ones and
/// cannot read them. They are computed again where they are asked for.
std::string WithoutNorms(const std::string& xml)
{
  const std::string begin = "<InformationKey name=\"L2_NORM";
  const std::string end = "</InformationKey>";
  std::string text;
  text.reserve(xml.size());
  std::size_t from = 0;
  for (std::size_t at = xml.find(begin); at != std::string::npos; at = xml.find(begin, from))
  {
    text.append(xml, from, at - from);
    const std::size_t last = xml.find(end, at);
    from = last == std::string::npos ? xml.size() : last + end.size();
  }
  return text.append(xml, from, std::string::npos);
}
}

void AppendParts(vtkDataObject* data, std::vector<std::string>& parts)
{
  const int type = data ? data->GetDataObjectType() : Nothing;
  parts.push_back(std::to_string(type));
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    AppendCollection(collection, parts);
    return;
  }
  if (!data)
  {
    return;
  }
  const auto writer = vtkSmartPointer<vtkXMLWriter>::Take(vtkXMLDataObjectWriter::NewWriter(type));
  if (!writer)
  {
    parts.emplace_back();
    return;
  }
  writer->SetInputDataObject(data);
  // no appended data: VTK's parsers take its beginning for XML with expat's newer versions
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  writer->WriteToOutputStringOn();
  writer->Write();
  parts.push_back(WithoutNorms(writer->GetOutputString()));
}

vtkSmartPointer<vtkDataObject> TakeData(std::vector<std::string>& parts, std::size_t& next)
{
  if (next >= parts.size())
  {
    return nullptr;
  }
  const int type = TakeNumber(parts, next);
  if (type == VTK_PARTITIONED_DATA_SET_COLLECTION)
  {
    return TakeCollection(parts, next);
  }
  const auto reader =
    type == Nothing ? nullptr : vtkXMLGenericDataObjectReader::CreateReader(type, false);
  if (!reader)
  {
    return nullptr;
  }
  reader->ReadFromInputStringOn();
  reader->SetInputString(Take(parts, next));
  bool failed = false;
  vtkNew<vtkCallbackCommand> errors; // and nothing is printed
  errors->SetClientData(&failed);
  errors->SetCallback(
    [](vtkObject*, unsigned long, void* found, void*) { *static_cast<bool*>(found) = true; });
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->Update();
  return failed ? nullptr : vtkSmartPointer<vtkDataObject>(reader->GetOutputDataObject(0));
}
}
