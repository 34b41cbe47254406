// SPDX-License-Identifier: BSD-3-Clause
#include "Status.h"

#include <exception>
#include <new>
#include <stdexcept>

namespace knotwork
{
const char* ToString(ErrorCode code)
{
  switch (code)
  {
    case ErrorCode::Ok:
      return "ok";
    case ErrorCode::EmptyInput:
      return "the input is empty";
    case ErrorCode::NonFiniteInput:
      return "the input has NaN or infinite values";
    case ErrorCode::InvalidDegree:
      return "the degree is outside [1, 9]";
    case ErrorCode::InvalidKnots:
      return "the knot vector is not valid";
    case ErrorCode::InvalidWeight:
      return "a weight is not a positive finite number";
    case ErrorCode::InvalidParameter:
      return "an option is outside its range";
    case ErrorCode::SizeMismatch:
      return "sizes do not match";
    case ErrorCode::DimensionMismatch:
      return "dimensions do not match";
    case ErrorCode::OutsideDomain:
      return "a parameter lies outside the domain";
    case ErrorCode::InvalidTopology:
      return "the cells or patches do not fit together";
    case ErrorCode::NotInSpace:
      return "the data is not a spline of its space";
    case ErrorCode::SingularSystem:
      return "the equations have no unique solution";
    case ErrorCode::TooLarge:
      return "the input exceeds a size limit";
    case ErrorCode::NotConverged:
      return "the iteration did not converge";
    case ErrorCode::Aborted:
      return "aborted on request";
    case ErrorCode::InvalidFormat:
      return "the text does not follow its file format";
    case ErrorCode::FileError:
      return "a file is not accessible";
    case ErrorCode::LibraryError:
      return "a library has failed";
  }
  return "unknown error";
}

std::string Status::Message() const
{
  std::string text = ToString(this->Code);
  return this->Detail.empty() ? text : text + ": " + this->Detail;
}

Status StatusOfException()
{
  constexpr const char* noMemory = "out of memory; give less, or a coarser request";
  try
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    return { ErrorCode::TooLarge, noMemory };
  }
  catch (const std::length_error&) // as much as no memory has
  {
    return { ErrorCode::TooLarge, noMemory };
  }
  catch (const std::exception& error)
  {
    return { ErrorCode::LibraryError, error.what() };
  }
  catch (...)
  {
    return { ErrorCode::LibraryError, "it does not say why" };
  }
}
}
