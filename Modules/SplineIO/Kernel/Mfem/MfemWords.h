// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TextWords.h"
#include <knotwork/SplineCore/Numbers.h>

#include <cmath>

namespace knotwork
{
/// The words of an MFEM text without comments; the first failure stays in Outcome and every later
/// step does nothing.
class MfemWords
{
public:
  explicit MfemWords(std::string_view text) : Most(text.size() / 2 + 1), Lines(text, '#') {}

  void Fail(ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, "line " + std::to_string(this->Lines.Line()) + ": " + what };
    }
  }

  /// The next word without taking it; empty at the end.
  std::string_view Peek()
  {
    while (this->Ahead.empty())
    {
      if (!this->Lines.Words().AtEnd())
      {
        this->Ahead = this->Lines.Words().Next();
      }
      else if (!this->Lines.Next())
      {
        return {};
      }
    }
    return this->Ahead;
  }

  std::string_view Word(const std::string& meaning)
  {
    if (!this->Outcome)
    {
      return {};
    }
    const std::string_view word = this->Peek();
    if (word.empty())
    {
      this->Fail(ErrorCode::InvalidFormat,
        meaning + " is missing: the text ends; the file is truncated or its counts are too large");
    }
    this->Ahead = {};
    return word;
  }

  /// Takes one of the format's words.
  void Expect(std::string_view word)
  {
    const std::string_view found = this->Word("'" + std::string(word) + "'");
    if (this->Outcome && found != word)
    {
      this->Fail(ErrorCode::InvalidFormat, Shown(found) + " stands where " + Shown(word) + " must");
    }
  }

  int Integer(const std::string& meaning, long long lowest, long long highest,
    ErrorCode code = ErrorCode::InvalidFormat)
  {
    long long value = lowest;
    const std::string_view word = this->Word(meaning);
    if (this->Outcome)
    {
      if (const Status status = ParseInteger(word, lowest, highest, value); !status)
      {
        this->Fail(code, meaning + ": " + status.Detail);
        value = lowest;
      }
    }
    return static_cast<int>(value);
  }

  /// A number of things of so many words each, which the text has room for.
  int Count(const std::string& meaning, double words)
  {
    const int count = this->Integer(meaning, 0, 2147483646 / 16);
    this->CheckRoom(meaning, count * words);
    return this->Outcome ? count : 0;
  }

  void CheckRoom(const std::string& meaning, double words)
  {
    if (this->Outcome && words > static_cast<double>(this->Most))
    {
      this->Fail(ErrorCode::InvalidFormat,
        meaning + ": the file has no room for " + std::to_string(static_cast<long long>(words)) +
          " numbers; it is truncated, or its counts are wrong");
    }
  }

  double Real(const char* meaning)
  {
    double value = 0.0;
    const std::string_view word = this->Word(meaning);
    if (this->Outcome)
    {
      if (const Status status = ParseReal(word, value); !status)
      {
        this->Fail(status.Code, std::string(meaning) + ": " + status.Detail);
      }
      else if (std::abs(value) > LargestNumber)
      {
        this->Fail(ErrorCode::TooLarge, std::string(meaning) + ": " + BeyondLimit());
      }
    }
    return value;
  }

  Status Outcome;

private:
  std::size_t Most; ///< words that the text can have
  LineScanner Lines;
  std::string_view Ahead;
};
}
