// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADExchange.h"

#include <Message_SequenceOfPrinters.hxx>

#include <functional>
#include <mutex>

namespace knotwork
{
enum class CADFormat
{
  Unknown,
  STEP,
  IGES,
  BREP ///< OpenCASCADE's own text; read only
};

/// By the ending of the file name, in any case.
CADFormat FormatOfFile(const std::string& file);

/// What is said where OpenCASCADE throws: its own text is about its inside.
constexpr const char* FailureOfOpenCASCADE =
  "OpenCASCADE fails on it; write it again from the program that made it";

/// OpenCASCADE's name of a unit, and its length in millimetres.
const char* NameOfUnit(LengthUnit unit);
double Millimetres(LengthUnit unit);

/// The use of OpenCASCADE's global state by one thread: nothing is printed, and settings made here
/// are taken back at the end.
class CADSession
{
public:
  /// @param unit  of lengths in shapes, while reading and writing.
  explicit CADSession(LengthUnit unit);
  ~CADSession();
  CADSession(const CADSession&) = delete;
  CADSession& operator=(const CADSession&) = delete;

  void Set(const char* name, int value);
  void Set(const char* name, double value);
  void Set(const char* name, const char* value);
  /// Reading as OpenCASCADE does when nothing is set.
  void SetDefaultsOfReading();
  /// Whether OpenCASCADE mends shells and solids of STEP and IGES files as it reads them, as it
  /// does by itself.
  void SetMending(bool mends);

  /// Runs what may throw exceptions of OpenCASCADE or of memory; they become InvalidFormat and
  /// TooLarge with the place before the text.
  Status Run(const std::string& place, const std::function<Status()>& body);

private:
  std::unique_lock<std::mutex> Lock;
  Message_SequenceOfPrinters Printers;
  std::vector<std::function<void()>> Restore;
};
}
