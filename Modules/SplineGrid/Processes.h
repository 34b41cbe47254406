// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

class vtkMultiProcessController;

/// The processes of VTK's global controller (MPI), one where there is none. What exchanges is
/// called by all of them in the same order. Results are in the order of the processes, so that what
/// is computed from them is the same everywhere.
namespace knotwork::Processes
{
VTKKNOTWORKSPLINEGRID_EXPORT int Count();
VTKKNOTWORKSPLINEGRID_EXPORT int Own(); ///< number of this one, from 0

/// A number of every process, to all of them.
VTKKNOTWORKSPLINEGRID_EXPORT std::vector<int> ExchangeNumber(int number);

/// The sum of the numbers of the processes before this one: where its part of a list begins.
VTKKNOTWORKSPLINEGRID_EXPORT int SumBefore(int number);

/// What every process gives, to all of them.
VTKKNOTWORKSPLINEGRID_EXPORT std::vector<std::string> Exchange(const std::string& bytes);

/// The same of numbers and structs of numbers.
template <typename T>
std::vector<std::vector<T>> Exchange(const std::vector<T>& values)
{
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::vector<T>> all;
  for (const std::string& bytes :
    Exchange(std::string(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size())))
  {
    const auto* first = reinterpret_cast<const T*>(bytes.data());
    all.emplace_back(first, first + bytes.size() / sizeof(T));
  }
  return all;
}

/// What the processes give, to the first of them, one after the other; empty elsewhere.
VTKKNOTWORKSPLINEGRID_EXPORT std::vector<std::string> Collect(const std::string& bytes);

/// What this process has for each of them, itself too, goes there.
/// @param hands  one a process. @return what each has for this one, in their order.
VTKKNOTWORKSPLINEGRID_EXPORT std::vector<std::string> Deal(std::vector<std::string> hands);

/// What one process gives, to all of them.
VTKKNOTWORKSPLINEGRID_EXPORT std::string Broadcast(std::string bytes, int from = 0);

/// The outcome of all: the failure of the first process that has one (one with a text, if there
/// is), which is named where it is not the first of all, else Ok.
/// @param speaker  result: that process, 0 when there is none.
VTKKNOTWORKSPLINEGRID_EXPORT Status Agree(const Status& own, int* speaker = nullptr);

/// What this process has told others so far.
struct Traffic
{
  std::uint64_t Messages = 0; ///< calls that exchange, and messages from one process to another
  std::uint64_t Bytes = 0;    ///< of this process, each once, however many others get it
};
VTKKNOTWORKSPLINEGRID_EXPORT Traffic TrafficSoFar();

/// While one lives this process works by itself: filters do not ask what the others have.
class VTKKNOTWORKSPLINEGRID_EXPORT Alone
{
public:
  Alone();
  ~Alone();
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

private:
  vtkMultiProcessController* Before;
};

/// The part [begin, end) of n things that a process does: parts in the order of the processes,
/// which differ by one at most.
struct Part
{
  std::size_t Begin = 0;
  std::size_t End = 0;
};
VTKKNOTWORKSPLINEGRID_EXPORT Part PartOf(std::size_t n, int process, int count);
}
