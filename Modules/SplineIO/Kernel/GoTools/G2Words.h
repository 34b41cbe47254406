// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TextWords.h"

namespace knotwork
{
/// Coordinates of a point in a g2 text.
inline constexpr int MaxG2Components = 64;

/// Reads the words of one g2 text; the first failure stays in Outcome and every later step does
/// nothing.
class G2Words
{
public:
  explicit G2Words(std::string_view text) : Words(text) {}

  /// Keeps a failure with its place: the word read last.
  void Fail(ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code,
        "line " + std::to_string(this->Words.Line()) + ", word " +
          std::to_string(this->Words.Count()) + ", " + what };
    }
  }

  std::string_view Word(const char* meaning)
  {
    if (!this->Outcome)
    {
      return {};
    }
    const std::string_view word = this->Words.Next();
    if (word.empty())
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::string(meaning) +
          " is missing: the text ends; the file is truncated or its counts are "
          "too large");
    }
    return word;
  }

  long long Integer(const char* meaning, long long lowest, long long highest,
    ErrorCode code = ErrorCode::InvalidFormat)
  {
    long long value = lowest;
    const std::string_view word = this->Word(meaning);
    if (this->Outcome)
    {
      if (const Status status = ParseInteger(word, lowest, highest, value); !status)
      {
        this->Fail(code, std::string(meaning) + ": " + status.Detail);
        value = lowest;
      }
    }
    return value;
  }

  template <typename Number>
  Number Real(const char* meaning)
  {
    Number value = 0;
    const std::string_view word = this->Word(meaning);
    if (this->Outcome)
    {
      if (const Status status = ParseReal(word, value); !status)
      {
        this->Fail(status.Code, std::string(meaning) + ": " + status.Detail);
      }
    }
    return value;
  }

  WordScanner Words;
  Status Outcome;
};
}
