// SPDX-License-Identifier: BSD-3-Clause
// Columns of BEXT texts, private to the kernel.
#pragma once
#include "TextWords.h"

namespace knotwork
{
/// Widths of the columns.
inline constexpr std::size_t BextIntegerWidth = 8;
inline constexpr std::size_t BextRealWidth = 24;

/// Fields of lines. Those that fill their columns stand without a blank between them. The first
/// failure stays in Outcome, and every later step does nothing.
class BextFields
{
public:
  explicit BextFields(std::string_view text) : Lines(text, '$') {}

  void Fail(ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, "line " + std::to_string(this->Lines.Line()) + ": " + what };
    }
  }
  /// The next line with words; one that still has some is a failure.
  bool NextLine(const std::string& meaning)
  {
    this->EndLine();
    if (this->Outcome && !this->Lines.Next())
    {
      this->Fail(ErrorCode::InvalidFormat,
        meaning + " is missing: the text ends; the file is truncated or its counts are too large");
    }
    return static_cast<bool>(this->Outcome);
  }
  bool HasField() { return !this->Rest.empty() || !this->Lines.Words().AtEnd(); }
  /// Whether the next line begins with a number that is not whole.
  bool NextLineIsReal() const
  {
    LineScanner next = this->Lines;
    return next.Next() && next.Words().Next().find('.') != std::string_view::npos;
  }
  std::string_view Word() { return this->Lines.Words().Next(); }
  void EndLine()
  {
    if (this->Outcome && this->HasField())
    {
      this->Fail(ErrorCode::InvalidFormat,
        Shown(this->Field(BextRealWidth)) + " is one word more than belongs there");
    }
  }
  long long Integer(const std::string& meaning, long long lowest, long long highest)
  {
    const std::string_view word = this->Next(meaning, BextIntegerWidth);
    long long value = lowest;
    if (this->Outcome)
    {
      this->Keep(meaning, ParseInteger(word, lowest, highest, value));
    }
    return this->Outcome ? value : lowest;
  }
  double Real(const std::string& meaning)
  {
    const std::string_view word = this->Next(meaning, BextRealWidth);
    double value = 0.0;
    if (this->Outcome)
    {
      this->Keep(meaning, ParseReal(word, value));
    }
    return value;
  }
  /// Goes on in the next line where a list does.
  void ContinueList(const std::string& meaning)
  {
    if (this->Outcome && !this->HasField())
    {
      this->NextLine(meaning);
    }
  }
  /// Whether any further line has words.
  bool AtEnd() { return !this->Lines.Next(); }

  Status Outcome;

private:
  std::string_view Next(const std::string& meaning, std::size_t width)
  {
    if (!this->Outcome)
    {
      return {};
    }
    if (!this->HasField())
    {
      this->Fail(ErrorCode::InvalidFormat, meaning + " is missing");
      return {};
    }
    return this->Field(width);
  }
  /// A word, or of one that is too long its first field. Reals may have more digits than columns.
  std::string_view Field(std::size_t width)
  {
    if (this->Rest.empty())
    {
      this->Rest = this->Lines.Words().Next();
    }
    double number = 0.0;
    const bool isOne =
      this->Rest.size() <= width || (width == BextRealWidth && ParseReal(this->Rest, number));
    const std::size_t head = this->Rest.size() % width;
    const std::size_t size = isOne ? this->Rest.size() : head > 0 ? head : width;
    const std::string_view field = this->Rest.substr(0, size);
    this->Rest.remove_prefix(size);
    return field;
  }
  void Keep(const std::string& meaning, const Status& status)
  {
    if (!status)
    {
      this->Fail(status.Code, meaning + ": " + status.Detail);
    }
  }

  LineScanner Lines;
  std::string_view Rest;
};
}
