// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <utility>

namespace knotwork
{
/// Why a kernel function produced no result. One enumeration for all kernels: a value is a kind of
/// failure, the detail of the Status names the place and the remedy.
enum class ErrorCode
{
  Ok = 0,
  EmptyInput,        ///< nothing to work on
  NonFiniteInput,    ///< NaN or infinity in the data
  InvalidDegree,     ///< degree outside [1, 9]
  InvalidKnots,      ///< too short, decreasing, empty domain or a multiplicity above degree + 1
  InvalidWeight,     ///< a weight that is zero, negative or not finite
  InvalidParameter,  ///< an option outside its documented range
  SizeMismatch,      ///< two inputs whose numbers of rows or columns do not fit each other
  DimensionMismatch, ///< a space or geometry of the wrong dimension
  OutsideDomain,     ///< a parameter outside the spline's domain
  InvalidTopology,   ///< cells, patches or boxes that do not fit together
  NotInSpace,        ///< the data is not a spline of the space, beyond the stated tolerance
  SingularSystem,    ///< the equations have no unique solution
  TooLarge,          ///< a count that exceeds the documented limits
  NotConverged,      ///< an iteration stopped at its limit before its goal
  Aborted,           ///< the progress callback asked to stop
  InvalidFormat,     ///< text that does not follow its file format
  FileError,         ///< a file that the system does not let read or write
  LibraryError       ///< a library below, or a program of ours, that failed for reasons of its own
};

/// One plain sentence for a code, without a full stop.
const char* ToString(ErrorCode code);

/// Outcome of a kernel function: a code and a detail that names the place and the remedy.
struct Status
{
  ErrorCode Code = ErrorCode::Ok;
  std::string Detail; ///< empty when Ok

  Status() = default;
  Status(ErrorCode code, std::string detail) : Code(code), Detail(std::move(detail)) {}
  explicit operator bool() const { return this->Code == ErrorCode::Ok; }
  /// "sentence of the code: detail", one line; "ok" when Ok.
  std::string Message() const;
};

/// What an exception of a library means, asked for where it is caught (inside `catch`): TooLarge
/// when memory ran out, else LibraryError with the library's words. Kernels throw nothing
/// themselves.
Status StatusOfException();

/// A value or the reason why there is none. The value is default-constructed unless Ok.
template <typename T>
struct Result
{
  knotwork::Status Status;
  T Value{};

  Result() = default;
  Result(T value) : Value(std::move(value)) {}
  Result(knotwork::Status status) : Status(std::move(status)) {}
  Result(ErrorCode code, std::string detail) : Status(code, std::move(detail)) {}
  explicit operator bool() const { return static_cast<bool>(this->Status); }
  T* operator->() { return &this->Value; }
  const T* operator->() const { return &this->Value; }
};
}
