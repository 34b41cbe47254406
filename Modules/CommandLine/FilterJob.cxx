// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <knotwork/SplineIO/PieceFiles.h>

#include <vtkDataObject.h>
#include <vtkPointSet.h>
#include <vtkVariant.h>

#include <algorithm>

namespace knotwork
{
namespace
{
const std::string NoFile;

template <typename Files>
const std::string& NameOf(const Files& files, int port)
{
  const auto file =
    std::find_if(files.begin(), files.end(), [port](const auto& f) { return f.Port == port; });
  return file == files.end() ? NoFile : file->Name;
}

/// @param result  null: what there is stays.
void Replace(vtkDataObject* output, vtkDataObject* result)
{
  if (result && result != output)
  {
    output->ShallowCopy(result);
  }
}

/// As a key of the report: --first-map is first_map.
std::string Key(std::string name)
{
  name.erase(0, name.find_first_not_of('-'));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
}

void FilterJobBase::AddInput(
  int port, const char* name, const char* help, const char* joint, const char* key)
{
  this->Inputs.push_back({ port, *key == '\0' ? Key(name) : key, joint, {} });
  this->App.add_option(name, this->Inputs.back().Name, help)->required(*name != '-');
}

void FilterJobBase::AddTableInput(int port, const char* name, const char* help)
{
  this->AddInput(port, name, help, " by ");
  this->Inputs.back().IsTable = true;
}

void FilterJobBase::AddFile(const char* name, const char* help)
{
  this->AddInput(NoPort, name, help, " with ", "input");
}

CLI::Option* FilterJobBase::AddOutput(
  int port, const char* name, const std::string& endings, const char* help)
{
  const bool isMain = this->Outputs.empty();
  this->Outputs.push_back({ port, Key(name), "", {} });
  return knotwork::AddOutput(this->App, name, this->Outputs.back().Name, endings, help)
    ->required(isMain);
}

void FilterJobBase::Divide(int port, Share share)
{
  this->Divided = share;
  this->DividedPort = port;
}

Status FilterJobBase::Run(Session& session)
{
  if (Status status = this->ReadInputs(session); !status)
  {
    return status;
  }
  for (const File& input : this->Inputs)
  {
    if (!input.Name.empty())
    {
      session.Report[input.Key] = input.Name;
    }
  }
  if (!this->MainOutput().empty())
  {
    session.Report["output"] = this->MainOutput();
  }
  this->FilterOptions.Apply(session.Report);
  const auto branch = this->Branch();
  if (!branch)
  {
    return branch.Status;
  }
  if (branch.Value != 0)
  {
    if (Status status = this->FilterOptions.Check(branch.Value); !status)
    {
      return status;
    }
    this->FilterOptions.Apply(session.Report, branch.Value);
  }
  this->Algorithm->SetThreads(session.Threads);
  if (Status status = Processes::Agree(this->Prepare(session)); !status)
  {
    return status;
  }
  const std::string names = this->InputNames();
  if (Status status =
        session.Run(this->Algorithm, names.empty() ? "shape" : names, this->DecisivePort);
      !status)
  {
    return status;
  }
  const bool isAlone = Processes::Count() == 1;
  const bool isEarly = this->NeedsWholeOutput();
  Status status = isAlone ? Status() : Processes::Agree(this->JoinOutputs(isEarly));
  status = status ? Processes::Agree(this->AddNumbers(session)) : status;
  if (status && !isAlone && !isEarly)
  {
    status = Processes::Agree(this->JoinMainOutput());
  }
  return status ? this->Write(session) : status;
}

bool FilterJobBase::MakesPieces() const
{
  return this->Divided == Share::Blocks || this->Divided == Share::First;
}

Status FilterJobBase::JoinMainOutput()
{
  if (this->DividedOutput != 0)
  {
    return {}; // the first process has it
  }
  vtkDataObject* output = this->Algorithm->GetOutputDataObject(0);
  if (IsPieceIndex(this->MainOutput()) && !this->NeedsWholeOutput())
  {
    return {};
  }
  if (this->MainOutput().empty() && !this->NeedsWholeOutput())
  {
    return {};
  }
  if (this->MakesPieces() || !this->Undivided)
  {
    auto appended = AppendShares(output);
    if (appended)
    {
      Replace(output, appended.Value);
    }
    return appended.Status;
  }
  return this->JoinDividedOutput();
}

bool FilterJobBase::DividedOutputStays() const
{
  const std::string& file = this->OutputFile(this->DividedOutput);
  return this->MakesPieces() || file.empty() || IsPieceIndex(file);
}

Status FilterJobBase::JoinDividedOutput()
{
  vtkDataObject* output = this->Algorithm->GetOutputDataObject(this->DividedOutput);
  if (this->DividedOutputStays())
  {
    return {};
  }
  if (!this->Undivided)
  {
    const auto appended = AppendShares(output);
    if (appended)
    {
      Replace(output, appended.Value);
    }
    return appended.Status;
  }
  Replace(
    output, JoinShares(this->Divided, this->Undivided, this->Input(this->DividedPort), output));
  return {};
}

Status FilterJobBase::JoinOutputs(bool withMain)
{
  Status status;
  for (int port = 1; port < this->Algorithm->GetNumberOfOutputPorts() && status; ++port)
  {
    vtkDataObject* output = this->Algorithm->GetOutputDataObject(port);
    if (vtkTable::SafeDownCast(output))
    {
      Replace(output, SameForAll(output));
      continue;
    }
    if (this->DividedOutput != 0)
    {
      status = port == this->DividedOutput ? this->JoinDividedOutput() : status;
      continue;
    }
    auto appended = AppendShares(output);
    status = appended.Status;
    if (status)
    {
      Replace(output, appended.Value);
    }
  }
  return status && withMain ? this->JoinMainOutput() : status;
}

Status FilterJobBase::ReadInputs(Session& session)
{
  for (const File& input : this->Inputs)
  {
    if (input.Name.empty() || input.Port == NoPort)
    {
      continue;
    }
    const bool isPart =
      input.Port == this->DividedPort && Processes::Count() > 1 && IsPieceIndex(input.Name);
    auto data = isPart ? session.ReadPieces(input.Name) : session.Read(input.Name, input.IsTable);
    if (!data)
    {
      return data.Status;
    }
    if (input.Port == this->DividedPort && Processes::Count() > 1 && !isPart)
    {
      this->Undivided = data.Value;
      this->Divided = this->ShareOfInput(data.Value);
      data.Value = ShareOf(data.Value, this->Divided);
    }
    this->Algorithm->SetInputDataObject(input.Port, data.Value);
  }
  return {};
}

std::string FilterJobBase::InputNames() const
{
  std::string names;
  for (const File& input : this->Inputs)
  {
    names +=
      input.Name.empty() ? "" : (names.empty() ? "" : input.Joint) + ("'" + input.Name + "'");
  }
  return names;
}

Status FilterJobBase::Write(Session& session)
{
  std::vector<std::string> files;
  for (const File& output : this->Outputs)
  {
    const auto port = static_cast<std::size_t>(output.Port);
    files.resize(std::max(files.size(), port + 1));
    files[port] = output.Name;
  }
  return session.WriteOutputs(this->Algorithm, files);
}

vtkDataObject* FilterJobBase::WholeInput() const
{
  return this->Undivided ? this->Undivided.Get() : this->Input(this->DividedPort);
}

vtkDataObject* FilterJobBase::Input(int port) const
{
  return this->Algorithm->GetInputDataObject(port, 0);
}

const std::string& FilterJobBase::InputFile(int port) const
{
  return NameOf(this->Inputs, port);
}

const std::string& FilterJobBase::OutputFile(int port) const
{
  return NameOf(this->Outputs, port);
}

vtkTable* FilterJobBase::Table(int port) const
{
  return vtkTable::SafeDownCast(this->Algorithm->GetOutputDataObject(port));
}

Status FilterJobBase::RequirePointSet(int port) const
{
  if (vtkPointSet::SafeDownCast(this->Input(port)))
  {
    return {};
  }
  return { ErrorCode::InvalidTopology,
    "'" + this->InputFile(port) + "' is no single set of points; give one of its parts" };
}

void ReportRow(vtkTable* table, vtkIdType row, std::initializer_list<const char*> columns,
  nlohmann::ordered_json& report)
{
  for (const char* column : columns)
  {
    const vtkVariant value = table->GetValueByName(row, column);
    nlohmann::ordered_json& entry = report[Options::SnakeCase(column)];
    if (value.IsString())
    {
      entry = value.ToString();
    }
    else if (value.IsDouble())
    {
      entry = value.ToDouble();
    }
    else
    {
      entry = value.ToLongLong();
    }
  }
}

void ReportTruths(vtkTable* table, vtkIdType row, std::initializer_list<const char*> columns,
  nlohmann::ordered_json& report)
{
  for (const char* column : columns)
  {
    report[Options::SnakeCase(column)] = table->GetValueByName(row, column).ToInt() != 0;
  }
}
}
