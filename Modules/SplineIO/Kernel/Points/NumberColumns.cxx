// SPDX-License-Identifier: BSD-3-Clause
#include "NumberColumns.h"

#include "TextWords.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = std::size_t(1) << 20;
constexpr const char* Remedy = "; correct or remove the line";

bool IsBlank(char c)
{
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

std::string_view Trimmed(std::string_view text)
{
  while (!text.empty() && IsBlank(text.front()))
  {
    text.remove_prefix(1);
  }
  while (!text.empty() && IsBlank(text.back()))
  {
    text.remove_suffix(1);
  }
  return text;
}

/// Of a trimmed line.
bool IsComment(std::string_view line)
{
  return line.empty() || line.front() == '#' || line.front() == '%' || line.substr(0, 2) == "//";
}

/// The line that begins at a place; moves the place behind it.
std::string_view NextLine(std::string_view text, std::size_t& at)
{
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = text.substr(at, end - at);
  at = std::min(end + 1, text.size());
  return line;
}

std::string Unquoted(std::string_view word)
{
  if (word.size() > 1 && word.front() == '"' && word.back() == '"')
  {
    word = word.substr(1, word.size() - 2);
  }
  return std::string(word);
}

/// Whether a word is no number and does not begin like one.
bool IsName(std::string_view word)
{
  double number = 0.0;
  return ParseReal(word, number).Code == ErrorCode::InvalidFormat &&
    (word.empty() ||
      std::string_view("+-.0123456789").find(word.front()) == std::string_view::npos);
}

/// What is wrong with a line.
struct Damage
{
  std::size_t At = std::string_view::npos; ///< of the line
  ErrorCode Code = ErrorCode::Ok;
  std::string What;
};

/// Lines of a part of the text.
struct Chunk
{
  std::vector<double> Numbers;
  Damage First;
};

class LineReader
{
public:
  LineReader(std::string_view text, const NumberColumns& columns) : Text(text), Columns(columns) {}

  void Read(std::size_t begin, std::size_t end, Chunk& chunk) const
  {
    const char* p = this->Text.data() + begin;
    const char* const stop = this->Text.data() + end;
    const std::size_t columns = this->Columns.Count;
    chunk.Numbers.reserve((end - begin) / 8);
    while (p < stop)
    {
      const char* const line = p;
      std::size_t count = 0;
      while (count < columns && this->ReadNumber(p, stop, count, chunk.Numbers))
      {
        ++count;
      }
      while (p < stop && IsBlank(*p))
      {
        ++p;
      }
      if (count == columns && (p == stop || *p == '\n'))
      {
        p += p < stop ? 1 : 0;
        continue;
      }
      // rare: comments, empty lines, one separator at the end, damage
      std::size_t at = static_cast<std::size_t>(line - this->Text.data());
      const std::size_t lineBegin = at;
      const std::string_view whole = Trimmed(NextLine(this->Text, at));
      if (count == columns && p < stop && *p == this->Columns.Separator &&
        FieldsOf(whole, this->Columns.Separator).size() == columns)
      {
        p = this->Text.data() + at;
        continue;
      }
      chunk.Numbers.resize(chunk.Numbers.size() - count);
      if (!IsComment(whole))
      {
        chunk.First = this->Describe(whole, lineBegin, at);
        return;
      }
      p = this->Text.data() + at;
    }
  }

private:
  /// One number and the separator before it.
  bool ReadNumber(
    const char*& p, const char* stop, std::size_t column, std::vector<double>& numbers) const
  {
    while (p < stop && IsBlank(*p))
    {
      ++p;
    }
    if (column > 0 && this->Columns.Separator != ' ')
    {
      if (p == stop || *p != this->Columns.Separator)
      {
        return false;
      }
      ++p;
      while (p < stop && IsBlank(*p))
      {
        ++p;
      }
    }
    const char* first = p;
    if (stop - first > 1 && *first == '+' && first[1] != '-')
    {
      ++first;
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(first, stop, value);
    if (error != std::errc() || (!std::isfinite(value) && this->Columns.MustBeFinite(column)) ||
      (end < stop && !IsBlank(*end) && *end != '\n' && *end != this->Columns.Separator))
    {
      return false;
    }
    numbers.push_back(value);
    p = end;
    return true;
  }

  Damage Describe(std::string_view line, std::size_t begin, std::size_t end) const
  {
    Damage damage{ begin, ErrorCode::InvalidFormat, {} };
    const std::vector<std::string_view> fields = FieldsOf(line, this->Columns.Separator);
    for (std::size_t c = 0; c < std::min(fields.size(), this->Columns.Count); ++c)
    {
      double value = 0.0;
      const Status status = fields[c].empty()
        ? Status(ErrorCode::InvalidFormat, "there is no number")
        : ParseReal(fields[c], value);
      if (!status && (status.Code != ErrorCode::NonFiniteInput || this->Columns.MustBeFinite(c)))
      {
        const bool decimals =
          this->Columns.Separator != ',' && fields[c].find(',') != std::string_view::npos;
        damage.Code = status.Code;
        damage.What = ", column " + std::to_string(c + 1) + ": " + status.Detail +
          (decimals ? "; decimals have a point, and all lines are separated alike" : Remedy);
        return damage;
      }
    }
    damage.What = " has " + std::to_string(fields.size()) + " columns, line " +
      std::to_string(this->Columns.HeadLine) + " has " + std::to_string(this->Columns.Count) +
      (end == this->Text.size() && fields.size() < this->Columns.Count
          ? "; the file is truncated, or the line incomplete"
          : Remedy);
    return damage;
  }

  std::string_view Text;
  const NumberColumns& Columns;
};

}

std::vector<std::string_view> FieldsOf(std::string_view line, char separator)
{
  std::vector<std::string_view> fields;
  line = Trimmed(line);
  if (separator == ' ')
  {
    WordScanner words(line);
    while (!words.AtEnd())
    {
      fields.push_back(words.Next());
    }
    return fields;
  }
  while (true)
  {
    const std::size_t end = line.find(separator);
    fields.push_back(Trimmed(line.substr(0, end)));
    if (end == std::string_view::npos)
    {
      break;
    }
    line.remove_prefix(end + 1);
  }
  if (fields.size() > 1 && fields.back().empty())
  {
    fields.pop_back();
  }
  return fields;
}

std::string LowerName(std::string word)
{
  for (char& c : word)
  {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return word;
}

Result<NumberColumns> FindColumns(
  std::string_view text, std::size_t least, const std::string& meaning)
{
  NumberColumns columns;
  std::size_t at = text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0; // byte order mark
  std::size_t lineNumber = 0;
  std::string_view line;
  while (at < text.size())
  {
    columns.Begin = at;
    ++lineNumber;
    line = Trimmed(NextLine(text, at));
    if (!IsComment(line))
    {
      break;
    }
    columns.Comment = line;
    line = {};
  }
  if (line.empty())
  {
    return { ErrorCode::EmptyInput, "the text holds no numbers" };
  }
  columns.HeadLine = lineNumber;
  columns.Separator = line.find(';') != std::string_view::npos ? ';'
    : line.find(',') != std::string_view::npos                 ? ','
                                                               : ' ';
  const std::vector<std::string_view> head = FieldsOf(line, columns.Separator);
  columns.Count = head.size();
  if (columns.Count < least)
  {
    return { ErrorCode::InvalidFormat,
      "line " + std::to_string(lineNumber) + " has " + std::to_string(columns.Count) +
        (columns.Count == 1 ? " column (" : " columns (") + Shown(head.front()) + "); a line has " +
        meaning + ", separated by blanks, commas or semicolons" };
  }
  // a damaged number names no column: the line would be lost without a word
  const auto first =
    head.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(3, head.size()));
  if (std::all_of(head.begin(), first, IsName))
  {
    columns.Begin = at;
    for (const std::string_view word : head)
    {
      columns.Names.push_back(Unquoted(word));
    }
  }
  return columns;
}

Result<std::vector<std::vector<double>>> ReadColumns(
  std::string_view text, const NumberColumns& columns, int threads)
{
  std::vector<std::size_t> starts{ columns.Begin };
  while (text.size() - starts.back() > ChunkSize)
  {
    const std::size_t end = text.find('\n', starts.back() + ChunkSize);
    if (end == std::string_view::npos)
    {
      break;
    }
    starts.push_back(end + 1);
  }
  starts.push_back(text.size());
  std::vector<Chunk> chunks(starts.size() - 1);
  const LineReader reader(text, columns);
  ParallelFor(chunks.size(), 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        reader.Read(starts[i], starts[i + 1], chunks[i]);
      }
    });
  std::vector<std::vector<double>> numbers;
  for (Chunk& chunk : chunks)
  {
    if (chunk.First.Code != ErrorCode::Ok)
    {
      const auto lines = std::count(text.begin(), text.begin() + chunk.First.At, '\n') + 1;
      return { chunk.First.Code,
        "line " + std::to_string(columns.LinesBefore + static_cast<std::size_t>(lines)) +
          chunk.First.What };
    }
    numbers.push_back(std::move(chunk.Numbers));
  }
  return numbers;
}
}
