// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "OutputOptions.h"
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SplineIO/OutputFiles.h>

#include <nlohmann/json.hpp>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;

namespace knotwork
{
struct CADSummary;

/// One run of a job: reads inputs, runs filters, stages outputs, collects the report. Outputs
/// appear under their names only when everything has succeeded, all of them or none.
class Session
{
public:
  Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  bool Quiet = false;
  int Threads = 0;
  std::string ReportFile;
  OutputFiles Files; ///< that the job writes
  /// Trimming curves of the STEP, IGES or g2 file that was read last; null without any.
  vtkSmartPointer<vtkDataObject> Curves;
  /// Boundary curves of the surfaces that are written as .g2; null: they have none.
  vtkSmartPointer<vtkDataObject> BoundaryCurves;
  int ExitStatus = 0; ///< of the program when the job has succeeded
  /// Parts of the inputs that readers left out, one sentence each: key left_out of the report, and
  /// exit status 5 where the job has none of its own.
  std::vector<std::string> LeftOut;
  /// Flat JSON object of the report; jobs add the numbers they are about.
  nlohmann::ordered_json Report = nlohmann::ordered_json::object();

  /// ReadDataFile of what is not an output; its curves are in Curves then. What of several
  /// processes one cannot read, none can.
  /// @param asTable  text in columns is a table, not points.
  Result<vtkSmartPointer<vtkDataObject>> Read(const std::string& file, bool asTable = false);

  /// The pieces of a .pvtu or .pvtp that fall to this process.
  Result<vtkSmartPointer<vtkDataObject>> ReadPieces(const std::string& file);

  /// Updates a filter with progress on a terminal; messages of VTK become the status. `what` names
  /// the inputs in the message. No points or rows in the output of `port` (of all processes) are an
  /// error. Of several processes each updates its piece, and what fails in one fails in all.
  /// @param warnings  get the filter's, instead of printing: what is to be said if the rest works.
  Status Run(vtkAlgorithm* filter, const std::string& what, int port = 0,
    std::vector<std::string>* warnings = nullptr);

  /// Runs what is no filter; its time is the job's.
  Status Measure(const std::function<Status()>& work);

  /// Adds what a reader left out of a file to LeftOut.
  void NoteReader(vtkAlgorithm* reader, const std::string& file);

  /// Prints warnings of a decoding on stderr, unless quiet.
  void Warn(const std::vector<std::string>& warnings) const;

  /// Whether data of this class and kind can be written in the format that the ending says: asked
  /// before the work, with what the output will be like.
  /// @param asCurves  curves on the surfaces are written instead of them.
  Status CheckFormat(vtkDataObject* like, const std::string& file, bool asCurves = false) const;
  /// CheckFormat of jobs that take grids alone: polygons and points are left to the filter, whose
  /// message names the input.
  Status CheckGridFormat(vtkDataObject* like, const std::string& file, bool asCurves = false) const;

  /// Of a number of every process, which all give at once: the sum, the largest.
  static long long Total(long long own);
  static double Largest(double own);

  /// WriteDataFile of a staged output, with BoundaryCurves; by the first of several processes, all
  /// of which call it, and what is written in pieces by each of them.
  Status Write(vtkDataObject* data, const std::string& file, const DataFileParams& params = {});

  /// Where to write an output: staged by the first of several processes, told to all of them, and
  /// removed by those that are left where a signal ends the run.
  Result<std::filesystem::path> Stage(const std::string& file);

  /// Stages a text.
  Status WriteText(const std::string& text, const std::string& file);

  /// Stages the output of every port whose file has a name.
  Status WriteOutputs(vtkAlgorithm* filter, const std::vector<std::string>& files);

  /// Stages trimmed faces (two grids, see TrimmedGrids.h) as .step, .stp, .iges or .igs; of several
  /// processes those of the first one, and all call it.
  /// @param found  what the written file holds when it is read again.
  Status WriteFaces(
    vtkDataObject* surfaces, vtkDataObject* curves, const std::string& file, CADSummary& found);

  /// Writes the report (if asked for) and moves all staged files to their places.
  Status Commit();

private:
  Result<vtkSmartPointer<vtkDataObject>> ReadWith(
    Result<DataFile> (*read)(const std::string&), const std::string& file);
  /// Of several processes each writes its piece.
  Status WriteInPieces(vtkDataObject* data, const std::string& file, const std::string& encoding);

  /// Keys of a run in several processes: seconds, processor time and memory of each.
  void ReportProcesses();

  double SecondsOfFiles = 0.0;
  double Seconds = 0.0;
  double CpuSeconds = 0.0;
};
}
