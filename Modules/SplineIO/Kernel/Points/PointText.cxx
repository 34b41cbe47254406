// SPDX-License-Identifier: BSD-3-Clause
#include "PointText.h"

#include "PointLayout.h"
#include "TextWords.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace knotwork
{
namespace
{
/// Finds the columns that are x, y, z by name.
void FindPosition(PointLayout& layout)
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
        if (LowerName(layout.Names[c]) == names[d])
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

Result<PointLayout> FindPointLayout(std::string_view text)
{
  auto found = FindColumns(text, 3, "x, y, z");
  bool isPlanar = false;
  if (found.Status.Code == ErrorCode::InvalidFormat)
  {
    auto two = FindColumns(text, 2, "x, y");
    isPlanar = two && two->Names.size() == 2 && LowerName(two->Names[0]) == "x" &&
      LowerName(two->Names[1]) == "y";
    if (isPlanar)
    {
      found = std::move(two);
    }
  }
  if (!found)
  {
    return { found.Status.Code,
      found.Status.Code == ErrorCode::EmptyInput ? "the text holds no points"
                                                 : found.Status.Detail };
  }
  PointLayout layout;
  static_cast<NumberColumns&>(layout) = std::move(found.Value);
  if (isPlanar)
  {
    layout.Position[2] = NoColumn;
  }
  else if (!layout.Names.empty())
  {
    FindPosition(layout);
  }
  else if (!layout.Comment.empty() && layout.Comment.front() == '#')
  {
    const std::vector<std::string_view> words = FieldsOf(layout.Comment.substr(1), ' ');
    if (words.size() == layout.Count && LowerName(std::string(words[0])) == "x" &&
      LowerName(std::string(words[1])) == "y" && LowerName(std::string(words[2])) == "z")
    {
      layout.Names.assign(words.begin(), words.end());
    }
  }
  layout.IsFinite.assign(layout.Count, false);
  for (const std::size_t column : layout.Position)
  {
    if (column != NoColumn)
    {
      layout.IsFinite[column] = true;
    }
  }
  return layout;
}

std::vector<std::size_t> PointLayout::Others(std::vector<std::string>& names) const
{
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < this->Count; ++c)
  {
    if (std::find(this->Position.begin(), this->Position.end(), c) == this->Position.end())
    {
      others.push_back(c);
      names.push_back(this->Names.empty() || this->Names[c].empty()
          ? "Column" + std::to_string(c + 1)
          : this->Names[c]);
    }
  }
  return others;
}

Result<PointFile> ReadPointText(std::string_view text, int threads)
{
  const Result<PointLayout> found = FindPointLayout(text);
  if (!found)
  {
    return found.Status;
  }
  const PointLayout& layout = found.Value;
  auto chunks = ReadColumns(text, layout, threads);
  if (!chunks)
  {
    return chunks.Status;
  }
  std::vector<Eigen::Index> rows{ 0 };
  for (const std::vector<double>& numbers : chunks.Value)
  {
    rows.push_back(rows.back() + static_cast<Eigen::Index>(numbers.size() / layout.Count));
  }
  if (rows.back() == 0)
  {
    return { ErrorCode::EmptyInput, "the text holds no points, only names of columns" };
  }
  PointFile file;
  const std::vector<std::size_t> others = layout.Others(file.Names);
  file.Points.resize(rows.back(), 3);
  file.Channels.resize(rows.back(), static_cast<Eigen::Index>(others.size()));
  ParallelFor(chunks->size(), 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const double* numbers = chunks.Value[i].data();
        for (Eigen::Index row = rows[i]; row < rows[i + 1]; ++row, numbers += layout.Count)
        {
          for (std::size_t d = 0; d < 3; ++d)
          {
            const std::size_t column = layout.Position[d];
            file.Points(row, static_cast<Eigen::Index>(d)) =
              column == NoColumn ? 0.0 : numbers[column];
          }
          for (std::size_t c = 0; c < others.size(); ++c)
          {
            file.Channels(row, static_cast<Eigen::Index>(c)) = numbers[others[c]];
          }
        }
        chunks.Value[i] = {};
      }
    });
  return file;
}

bool LooksLikePointText(std::string_view beginning)
{
  const bool printable = std::all_of(beginning.begin(), beginning.end(),
    [](char c) { return c >= ' ' || c == '\n' || c == '\r' || c == '\t' || c < 0; });
  return printable && static_cast<bool>(FindPointLayout(beginning));
}

Result<std::string> WritePointText(const PointFile& file, char separator)
{
  const Eigen::Index n = file.Points.rows();
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
  if (separator == ',' || !file.Names.empty() || n == 0)
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
