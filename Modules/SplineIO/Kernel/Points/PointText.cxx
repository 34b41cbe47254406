// SPDX-License-Identifier: BSD-3-Clause
#include "PointText.h"

#include "TextWords.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <array>
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

/// Fields of a line, trimmed; one separator at the end is no field.
std::vector<std::string_view> Fields(std::string_view line, char separator)
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

std::string Unquoted(std::string_view word)
{
  if (word.size() > 1 && word.front() == '"' && word.back() == '"')
  {
    word = word.substr(1, word.size() - 2);
  }
  return std::string(word);
}

std::string Lower(std::string word)
{
  for (char& c : word)
  {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return word;
}

/// Columns of a text.
struct Layout
{
  std::size_t Begin = 0;    ///< of the first line of numbers
  std::size_t HeadLine = 1; ///< number of the line that tells the columns
  char Separator = ' ';
  std::size_t Columns = 0;
  std::array<std::size_t, 3> Position{ 0, 1, 2 }; ///< columns of x, y, z
  std::vector<std::string> Names;                 ///< of all columns; empty: without names

  bool IsCoordinate(std::size_t column) const
  {
    return std::find(this->Position.begin(), this->Position.end(), column) != this->Position.end();
  }
};

/// Finds the columns that are x, y, z by name.
void FindPosition(Layout& layout)
{
  constexpr const char* known[][3] = { { "x", "y", "z" }, { "points:0", "points:1", "points:2" },
    { "points_0", "points_1", "points_2" } };
  for (const auto& names : known)
  {
    std::array<std::size_t, 3> found{};
    int count = 0;
    for (std::size_t d = 0; d < 3; ++d)
    {
      for (std::size_t c = 0; c < layout.Names.size(); ++c)
      {
        if (Lower(layout.Names[c]) == names[d])
        {
          found[d] = c;
          ++count;
          break;
        }
      }
    }
    if (count == 3)
    {
      layout.Position = found;
      return;
    }
  }
}

/// Whether a word is no number and does not begin like one.
bool IsName(std::string_view word)
{
  double number = 0.0;
  return ParseReal(word, number).Code == ErrorCode::InvalidFormat &&
    (word.empty() ||
      std::string_view("+-.0123456789").find(word.front()) == std::string_view::npos);
}

Result<Layout> FindLayout(std::string_view text)
{
  Layout layout;
  std::size_t at = text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0; // byte order mark
  std::size_t lineNumber = 0;
  std::string_view comment;
  std::string_view line;
  while (at < text.size())
  {
    layout.Begin = at;
    ++lineNumber;
    line = Trimmed(NextLine(text, at));
    if (!IsComment(line))
    {
      break;
    }
    comment = line;
    line = {};
  }
  if (line.empty())
  {
    return { ErrorCode::EmptyInput, "the text holds no points" };
  }
  layout.HeadLine = lineNumber;
  layout.Separator = line.find(';') != std::string_view::npos ? ';'
    : line.find(',') != std::string_view::npos                ? ','
                                                              : ' ';
  const std::vector<std::string_view> head = Fields(line, layout.Separator);
  layout.Columns = head.size();
  if (layout.Columns < 3)
  {
    return { ErrorCode::InvalidFormat,
      "line " + std::to_string(lineNumber) + " has " + std::to_string(layout.Columns) +
        (layout.Columns == 1 ? " column (" : " columns (") + Shown(head.front()) +
        "); a line has x, y, z, separated by blanks, commas or semicolons" };
  }
  // a damaged number names no column: the line would be lost without a word
  if (std::all_of(head.begin(), head.begin() + 3, IsName))
  {
    layout.Begin = at;
    for (std::string_view word : head)
    {
      layout.Names.push_back(Unquoted(word));
    }
    FindPosition(layout);
  }
  else if (!comment.empty() && comment.front() == '#')
  {
    std::vector<std::string_view> words = Fields(comment.substr(1), ' ');
    if (words.size() == layout.Columns && Lower(std::string(words[0])) == "x" &&
      Lower(std::string(words[1])) == "y" && Lower(std::string(words[2])) == "z")
    {
      layout.Names.assign(words.begin(), words.end());
    }
  }
  return layout;
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
  LineReader(std::string_view text, const Layout& layout) : Text(text), Columns(layout) {}

  void Read(std::size_t begin, std::size_t end, Chunk& chunk) const
  {
    const char* p = this->Text.data() + begin;
    const char* const stop = this->Text.data() + end;
    const std::size_t columns = this->Columns.Columns;
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
        Fields(whole, this->Columns.Separator).size() == columns)
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
    if (error != std::errc() || (!std::isfinite(value) && this->Columns.IsCoordinate(column)) ||
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
    const std::vector<std::string_view> fields = Fields(line, this->Columns.Separator);
    for (std::size_t c = 0; c < std::min(fields.size(), this->Columns.Columns); ++c)
    {
      double value = 0.0;
      const Status status = fields[c].empty()
        ? Status(ErrorCode::InvalidFormat, "there is no number")
        : ParseReal(fields[c], value);
      if (!status && (status.Code != ErrorCode::NonFiniteInput || this->Columns.IsCoordinate(c)))
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
      std::to_string(this->Columns.HeadLine) + " has " + std::to_string(this->Columns.Columns) +
      (end == this->Text.size() && fields.size() < this->Columns.Columns
          ? "; the file is truncated, or the line incomplete"
          : Remedy);
    return damage;
  }

  std::string_view Text;
  const Layout& Columns;
};

void AppendName(const std::string& name, char separator, std::string& text)
{
  for (char c : name)
  {
    const bool harmful = c == '\n' || c == '\r' || c == '"' || c == ';' || c == ',' ||
      (separator == ' ' && (c == ' ' || c == '\t'));
    text += harmful ? '_' : c;
  }
}
}

Result<PointFile> ReadPointText(std::string_view text, int threads)
{
  const Result<Layout> found = FindLayout(text);
  if (!found)
  {
    return found.Status;
  }
  const Layout& layout = found.Value;
  std::vector<std::size_t> starts{ layout.Begin };
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
  const LineReader reader(text, layout);
  ParallelFor(chunks.size(), 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        reader.Read(starts[i], starts[i + 1], chunks[i]);
      }
    });
  std::vector<Eigen::Index> rows{ 0 };
  for (const Chunk& chunk : chunks)
  {
    if (chunk.First.Code != ErrorCode::Ok)
    {
      const auto lines = std::count(text.begin(), text.begin() + chunk.First.At, '\n') + 1;
      return { chunk.First.Code, "line " + std::to_string(lines) + chunk.First.What };
    }
    rows.push_back(rows.back() + static_cast<Eigen::Index>(chunk.Numbers.size() / layout.Columns));
  }
  if (rows.back() == 0)
  {
    return { ErrorCode::EmptyInput, "the text holds no points, only names of columns" };
  }
  PointFile file;
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < layout.Columns; ++c)
  {
    if (!layout.IsCoordinate(c))
    {
      others.push_back(c);
      file.Names.push_back(layout.Names.empty() || layout.Names[c].empty()
          ? "Column" + std::to_string(c + 1)
          : layout.Names[c]);
    }
  }
  file.Points.resize(rows.back(), 3);
  file.Channels.resize(rows.back(), static_cast<Eigen::Index>(others.size()));
  ParallelFor(chunks.size(), 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const double* numbers = chunks[i].Numbers.data();
        for (Eigen::Index row = rows[i]; row < rows[i + 1]; ++row, numbers += layout.Columns)
        {
          for (std::size_t d = 0; d < 3; ++d)
          {
            file.Points(row, static_cast<Eigen::Index>(d)) = numbers[layout.Position[d]];
          }
          for (std::size_t c = 0; c < others.size(); ++c)
          {
            file.Channels(row, static_cast<Eigen::Index>(c)) = numbers[others[c]];
          }
        }
        chunks[i].Numbers = {};
      }
    });
  return file;
}

bool LooksLikePointText(std::string_view beginning)
{
  const bool printable = std::all_of(beginning.begin(), beginning.end(),
    [](char c) { return c >= ' ' || c == '\n' || c == '\r' || c == '\t' || c < 0; });
  return printable && static_cast<bool>(FindLayout(beginning));
}

Result<std::string> WritePointText(const PointFile& file, char separator)
{
  const Eigen::Index n = file.Points.rows();
  if (n == 0)
  {
    return { ErrorCode::EmptyInput, "there is no point to write" };
  }
  if (file.Channels.cols() != static_cast<Eigen::Index>(file.Names.size()) ||
    (file.Channels.cols() > 0 && file.Channels.rows() != n))
  {
    return { ErrorCode::SizeMismatch, "the channels do not fit the points or their names" };
  }
  if (Status status = CheckCoordinates(file.Points); !status)
  {
    return status;
  }
  std::string text;
  if (separator == ',' || !file.Names.empty())
  {
    text = separator == ',' ? "x,y,z" : "# x y z";
    for (const std::string& name : file.Names)
    {
      text += separator;
      AppendName(name, separator, text);
    }
    text += '\n';
  }
  for (Eigen::Index i = 0; i < n; ++i)
  {
    for (Eigen::Index c = 0; c < 3 + file.Channels.cols(); ++c)
    {
      if (c > 0)
      {
        text += separator;
      }
      const double value = c < 3 ? file.Points(i, c) : file.Channels(i, c - 3);
      AppendReal(text, std::isnan(value) ? std::fabs(value) : value); // no "-nan"
    }
    text += '\n';
  }
  return text;
}
}
