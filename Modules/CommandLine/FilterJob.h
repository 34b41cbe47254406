// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FilterProperties.h"
#include "Jobs.h"
#include "Options.h"
#include "Session.h"
#include "Shares.h"

#include <vtkNew.h>
#include <vtkTable.h>

#include <initializer_list>
#include <list>
#include <memory>
#include <set>
#include <string>
#include <utility>

class vtkSplineAlgorithm;

namespace knotwork
{
/// A job that is one filter: files are read into its ports, its options are set, it runs, and its
/// ports are written. What a job has of its own stands in its constructor (tables of inputs,
/// outputs and options) and in the hooks.
class FilterJobBase
{
public:
  FilterJobBase(const FilterJobBase&) = delete;
  FilterJobBase& operator=(const FilterJobBase&) = delete;
  virtual ~FilterJobBase() = default;

  Status Run(Session& session);

protected:
  explicit FilterJobBase(CLI::App& app) : App(app), FilterOptions(app) {}

  /// A file that is read into a port and named in the report. Names that begin with `--` are
  /// options and need not be given.
  /// @param joint  stands before the name of the file in messages, as " onto " in 'a' onto 'b'.
  /// @param key  of the report, where it is not the name.
  void AddInput(
    int port, const char* name, const char* help, const char* joint = "", const char* key = "");
  /// The same of a table, which may be text in columns.
  void AddTableInput(int port, const char* name, const char* help);
  /// What of several processes each gets of the input of a port; the others are whole in all of
  /// them. Output 0 is that of the input with arrays added or points moved (Cells, Points), or
  /// consists of what every process makes (Blocks, First).
  void Divide(int port, Share share);
  /// That of Cells and Points is another output; the first process has output 0 and the others.
  void DivideInto(int outputPort) { this->DividedOutput = outputPort; }
  /// A file that the filter reads itself, and that must be given: it is named in the report and in
  /// messages.
  void AddFile(const char* name, const char* help);
  /// What AddFile's option names.
  const std::string& FileToRead() const { return this->InputFile(NoPort); }
  /// A file that a port is written to. --output must be given, others need not.
  CLI::Option* AddOutput(int port, const char* name, const std::string& endings, const char* help);
  /// What --output names is written by another port.
  void WriteMainFrom(int port) { this->Outputs.front().Port = port; }

  /// Which branch of the options runs (Options::Begin), 0 where there are none; with those of all
  /// branches set.
  virtual Result<int> Branch() { return 0; }
  /// Before the run, with inputs read and options set: checks formats, sets what no option does.
  virtual Status Prepare(Session&) { return {}; }
  /// After the run: the numbers of the report. Of several processes all call it; tables are the
  /// same in all of them, output 0 is each one's, and other outputs are whole in the first one.
  virtual Status AddNumbers(Session&) { return {}; }
  /// Writes the ports that have files.
  virtual Status Write(Session& session);

  /// What each process gets of the input that is divided, now that it is read.
  virtual Share ShareOfInput(vtkDataObject*) const { return this->Divided; }
  /// The input that is divided, before it was.
  vtkDataObject* WholeInput() const;

  /// Whether the numbers need the whole of output 0 in the first process.
  virtual bool NeedsWholeOutput() const { return false; }

  vtkDataObject* Input(int port) const;
  /// Name of the file that a port is read from; empty: none.
  const std::string& InputFile(int port) const;
  /// What --output names.
  const std::string& MainOutput() const { return this->Outputs.front().Name; }
  /// Name of the file that a port is written to; empty: none.
  const std::string& OutputFile(int port) const;
  /// Whether no file needs the divided output in one place, so that each process keeps its share.
  bool DividedOutputStays() const;
  vtkTable* Table(int port) const;

  /// An input is one set of points, not a collection of them.
  Status RequirePointSet(int port) const;

  CLI::App& App;
  Options FilterOptions;
  vtkSplineAlgorithm* Algorithm = nullptr;
  int DecisivePort = 0; ///< no points or rows in this output are an error

private:
  static constexpr int NoPort = -1; ///< of files that the filter reads itself
  struct File
  {
    int Port;
    std::string Key; ///< in the report
    const char* Joint;
    std::string Name;
    bool IsTable = false;
  };
  Status ReadInputs(Session& session);
  /// Outputs of several processes: the tables of the first one in all, the others in the first one.
  Status JoinOutputs(bool withMain);
  Status JoinMainOutput();
  Status JoinDividedOutput();
  std::string InputNames() const;

  /// Whether what processes make of their shares is put one after the other.
  bool MakesPieces() const;

  Share Divided = Share::All; ///< as was said, then as it is
  int DividedPort = NoPort;
  int DividedOutput = 0;
  vtkSmartPointer<vtkDataObject> Undivided; ///< what stands at that port is a share of

  std::list<File> Inputs;  ///< nodes, to which the parser's options point
  std::list<File> Outputs; ///< --output is the first
};

template <typename FilterType>
class FilterJob : public FilterJobBase
{
protected:
  explicit FilterJob(CLI::App& app) : FilterJobBase(app) { this->Algorithm = this->Filter; }

  /// Properties of the filter become options, but for those that follow from other ones.
  void AddProperties(std::set<std::string> leftOut = {})
  {
    this->FilterOptions.LeaveOut(std::move(leftOut));
    knotwork::AddProperties(this->FilterOptions, this->Filter);
  }

  vtkNew<FilterType> Filter;
};

/// Values of a row as keys of a report in snake case, whole numbers as whole numbers.
void ReportRow(vtkTable* table, vtkIdType row, std::initializer_list<const char*> columns,
  nlohmann::ordered_json& report);
/// The same of whole numbers that are truth values.
void ReportTruths(vtkTable* table, vtkIdType row, std::initializer_list<const char*> columns,
  nlohmann::ordered_json& report);

/// What registers a job of a class.
template <typename JobType>
Job MakeJob(CLI::App& app)
{
  auto job = std::make_shared<JobType>(app);
  return [job](Session& session) { return job->Run(session); };
}
}
