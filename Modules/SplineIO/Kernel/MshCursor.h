// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TextWords.h"
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace knotwork
{
/// Numbers of a text, or of binary data in it; the first failure stays in Outcome and every later
/// step does nothing.
class MshCursor
{
public:
  explicit MshCursor(std::string_view text) : Text(text) {}

  void Fail(ErrorCode code, const std::string& what)
  {
    if (!this->Outcome)
    {
      return;
    }
    const auto here = this->Text.begin() + static_cast<std::ptrdiff_t>(this->Last);
    const std::string place = this->IsBinary
      ? "byte " + std::to_string(this->Last)
      : "line " + std::to_string(1 + std::count(this->Text.begin(), here, '\n'));
    this->Outcome = { code,
      place + (this->Section.empty() ? "" : ", $" + this->Section) + ": " + what };
  }

  /// The rest of the line, without white space around it.
  std::string_view Line()
  {
    this->Last = this->At;
    const std::size_t end = std::min(this->Text.find('\n', this->At), this->Text.size());
    std::string_view line = this->Text.substr(this->At, end - this->At);
    this->At = std::min(end + 1, this->Text.size());
    while (!line.empty() && IsSpace(line.back()))
    {
      line.remove_suffix(1);
    }
    while (!line.empty() && IsSpace(line.front()))
    {
      line.remove_prefix(1);
    }
    return line;
  }

  bool AtEnd()
  {
    while (this->At < this->Text.size() && IsSpace(this->Text[this->At]))
    {
      ++this->At;
    }
    return this->At == this->Text.size();
  }

  /// The next word of text; empty at the end.
  std::string_view Word()
  {
    this->AtEnd();
    this->Last = this->At;
    while (this->At < this->Text.size() && !IsSpace(this->Text[this->At]))
    {
      ++this->At;
    }
    return this->Text.substr(this->Last, this->At - this->Last);
  }

  /// An integer of text.
  std::int64_t TextInteger(const char* meaning, std::int64_t lowest, std::int64_t highest)
  {
    long long value = lowest;
    if (!this->Outcome)
    {
      return lowest;
    }
    const std::string_view word = this->Word();
    if (word.empty())
    {
      this->FailShort(meaning);
    }
    else if (const Status status = ParseInteger(word, lowest, highest, value); !status)
    {
      this->Fail(ErrorCode::InvalidFormat, std::string(meaning) + ": " + status.Detail);
      value = lowest;
    }
    return value;
  }

  /// A count that is text in binary files too.
  std::int64_t TextCount(const char* meaning)
  {
    const std::int64_t count = this->TextInteger(meaning, 0, 2147483647);
    if (this->IsBinary)
    {
      this->Line(); // the end of this one
    }
    return count;
  }

  /// A 4 byte integer in binary data.
  int Int(const char* meaning, int lowest = -2147483647, int highest = 2147483647)
  {
    if (!this->IsBinary)
    {
      return static_cast<int>(this->TextInteger(meaning, lowest, highest));
    }
    const auto value = this->Raw<std::int32_t>(meaning);
    return static_cast<int>(this->InRange(value, meaning, lowest, highest));
  }

  /// An 8 byte unsigned integer in binary data.
  std::int64_t Size(const char* meaning)
  {
    constexpr std::int64_t most = std::int64_t{ 1 } << 62U;
    return this->IsBinary ? this->InRange(this->Raw<std::int64_t>(meaning), meaning, 0, most)
                          : this->TextInteger(meaning, 0, most);
  }

  double Real(const char* meaning)
  {
    double value = 0.0;
    if (!this->Outcome)
    {
      return 0.0;
    }
    if (this->IsBinary)
    {
      value = this->Raw<double>(meaning);
      if (!std::isfinite(value))
      {
        this->Fail(ErrorCode::NonFiniteInput, std::string(meaning) + " is not a finite number");
        return 0.0;
      }
    }
    else
    {
      const std::string_view word = this->Word();
      if (word.empty())
      {
        this->FailShort(meaning);
      }
      else if (const Status status = ParseReal(word, value); !status)
      {
        this->Fail(status.Code, std::string(meaning) + ": " + status.Detail);
      }
    }
    if (std::abs(value) > LargestNumber)
    {
      this->Fail(ErrorCode::TooLarge, std::string(meaning) + ": " + BeyondLimit());
    }
    return value;
  }

  /// Fails where the text has no room for so many things of so many numbers, of 4 bytes at least
  /// when binary. @return whether it has.
  bool CheckRoom(const char* meaning, std::int64_t count, std::int64_t numbers)
  {
    const auto left = static_cast<std::int64_t>(this->Text.size() - this->At);
    const std::int64_t least = numbers * (this->IsBinary ? 4 : 2);
    if (this->Outcome && (count < 0 || count > (left + 1) / std::max<std::int64_t>(least, 1)))
    {
      this->Fail(ErrorCode::InvalidFormat,
        "the file has no room for " + std::to_string(count) + " " + meaning +
          "; it is truncated, or the count is wrong");
    }
    return static_cast<bool>(this->Outcome);
  }

  /// Goes behind the line "$End..." of a section. @return whether it is there.
  bool SkipSection(std::string_view name)
  {
    const std::size_t found = this->Text.find("$End" + std::string(name), this->At);
    if (found == std::string_view::npos)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "$End" + std::string(name) + " is missing: the file is truncated");
      return false;
    }
    this->At = found;
    this->Line();
    return true;
  }

  /// Takes "$End" of a section.
  void ExpectEnd(std::string_view name)
  {
    if (this->Outcome && this->Word() != "$End" + std::string(name))
    {
      const std::string_view found =
        this->Text.substr(this->Last, std::min<std::size_t>(this->At - this->Last, 40));
      this->Fail(ErrorCode::InvalidFormat,
        Shown(found) + " stands where $End" + std::string(name) +
          " must; a count is wrong, or the file is truncated");
    }
  }

  Status Outcome;
  bool IsBinary = false; ///< how numbers are read
  bool IsSwapped = false;
  std::string Section;

private:
  static bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  void FailShort(const char* meaning)
  {
    this->Fail(ErrorCode::InvalidFormat,
      std::string(meaning) +
        " is missing: the file ends; it is truncated, or a count is too large");
  }

  std::int64_t InRange(
    std::int64_t value, const char* meaning, std::int64_t lowest, std::int64_t highest)
  {
    if (this->Outcome && (value < lowest || value > highest))
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::string(meaning) + " is " + std::to_string(value) + ", outside [" +
          std::to_string(lowest) + ", " + std::to_string(highest) + "]");
    }
    return this->Outcome ? value : lowest;
  }

  template <typename Number>
  Number Raw(const char* meaning)
  {
    Number value{};
    if (!this->Outcome)
    {
      return value;
    }
    this->Last = this->At;
    if (this->Text.size() - this->At < sizeof(Number))
    {
      this->FailShort(meaning);
      return value;
    }
    char bytes[sizeof(Number)];
    std::memcpy(bytes, this->Text.data() + this->At, sizeof(Number));
    if (this->IsSwapped)
    {
      std::reverse(bytes, bytes + sizeof(Number));
    }
    std::memcpy(&value, bytes, sizeof(Number));
    this->At += sizeof(Number);
    return value;
  }

  std::string_view Text;
  std::size_t At = 0;
  std::size_t Last = 0; ///< where what was read last began
};
}
