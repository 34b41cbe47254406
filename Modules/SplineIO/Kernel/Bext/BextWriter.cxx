// SPDX-License-Identifier: BSD-3-Clause
#include "BextContents.h"
#include "BextFields.h"
#include "BextFile.h"

#include <knotwork/SplineCore/SpaceFamily.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <unordered_map>

namespace knotwork
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr long long LargestInteger = 99999999;
constexpr std::size_t IntegersALine = 10;
constexpr std::size_t RealsALine = 5;

/// Text in columns.
class Columns
{
public:
  void Integer(long long value) { this->Field(std::to_string(value), BextIntegerWidth); }
  /// 17 digits, which give the same double again.
  void Real(double value)
  {
    std::array<char, 40> buffer;
    const auto end = std::to_chars(
      buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific, 16)
                       .ptr;
    std::string word(buffer.data(), end);
    std::replace(word.begin(), word.end(), 'e', 'E');
    this->Field(word, BextRealWidth);
  }
  void EndLine() { this->Text += '\n'; }
  template <typename Number, typename Append>
  void List(const std::vector<Number>& values, std::size_t begin, std::size_t end,
    std::size_t perLine, Append append)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      append(values[i]);
      if ((i - begin + 1) % perLine == 0 || i + 1 == end)
      {
        this->EndLine();
      }
    }
  }

  std::string Text;

private:
  void Field(const std::string& word, std::size_t width)
  {
    this->Text.append(width > word.size() ? width - word.size() : 0, ' ');
    this->Text += word;
  }
};

/// Number of dimensions that the degrees of an element have.
void AppendDegrees(const IntArray<3>& degree, int dimension, Columns& text)
{
  for (int d = 0; d < dimension; ++d)
  {
    text.Integer(degree[static_cast<std::size_t>(d)]);
  }
}

/// Vectors of one length that follow each other.
std::vector<BextBlock> VectorBlocksOf(const ExtractionTable<3>& table)
{
  std::vector<BextBlock> blocks;
  const auto size = [&table](std::size_t v)
  { return table.FirstCoefficient[v + 1] - table.FirstCoefficient[v]; };
  for (std::size_t v = 0; v < table.NumVectors(); ++v)
  {
    if (v == 0 || size(v) != size(v - 1))
    {
      blocks.push_back({ v, v });
    }
    blocks.back().End = v + 1;
  }
  return blocks;
}

std::string TextOf(const BextContents& contents)
{
  const ExtractionTable<3>& table = contents.Table;
  Columns text;
  text.Text = "B E X T 2.0\n";
  text.Integer(contents.PatchId);
  text.Integer(contents.Nodes.rows());
  text.Integer(static_cast<long long>(table.NumElements()));
  text.Integer(static_cast<long long>(table.NumVectors()));
  text.Integer(contents.Rational ? 1 : 0);
  text.EndLine();
  for (Eigen::Index i = 0; i < contents.Nodes.rows(); ++i)
  {
    for (Eigen::Index c = 0; c < 4; ++c)
    {
      text.Real(contents.Nodes(i, c));
    }
    text.EndLine();
  }
  const std::vector<BextBlock> blocks = BlocksOf(table);
  text.Integer(static_cast<long long>(blocks.size()));
  text.EndLine();
  for (const auto& [begin, end] : blocks)
  {
    const auto functions =
      static_cast<long long>(table.FirstFunction[begin + 1] - table.FirstFunction[begin]);
    text.Integer(1);
    text.Integer(static_cast<long long>(end - begin));
    text.Integer(functions);
    text.Integer(functions);
    AppendDegrees(table.Degrees[begin], contents.Dimension, text);
    text.EndLine();
  }
  const auto appendNumber = [&text](int value) { text.Integer(value + 1); };
  for (std::size_t e = 0; e < table.NumElements(); ++e)
  {
    for (const std::vector<int>* numbers : { &table.Functions, &table.Vectors })
    {
      text.List(
        *numbers, table.FirstFunction[e], table.FirstFunction[e + 1], IntegersALine, appendNumber);
    }
  }
  const std::vector<BextBlock> vectors = VectorBlocksOf(table);
  text.Integer(static_cast<long long>(vectors.size()));
  text.Integer(0);
  text.EndLine();
  for (const auto& [begin, end] : vectors)
  {
    text.Integer(static_cast<long long>(end - begin));
    text.Integer(
      static_cast<long long>(table.FirstCoefficient[begin + 1] - table.FirstCoefficient[begin]));
    text.EndLine();
  }
  for (std::size_t v = 0; v < table.NumVectors(); ++v)
  {
    text.List(table.Coefficients, table.FirstCoefficient[v], table.FirstCoefficient[v + 1],
      RealsALine, [&text](double value) { text.Real(value); });
  }
  return std::move(text.Text);
}

/// Corners of the elements, first direction fastest, numbered as they come.
Json VerticesOf(const SplineFile& file, int& numVertices)
{
  Json all = Json::array();
  numVertices = 0;
  for (const AnySpline& any : file.Splines)
  {
    std::visit(
      [&](const auto& spline)
      {
        const auto& space = *spline.Space;
        const std::vector<std::int64_t> points = FamilyOf(space).NumberPoints(space).Ids;
        std::unordered_map<std::int64_t, int> numbers;
        std::size_t first = 0;
        for (const auto& element : space.Elements)
        {
          Json corners = Json::array();
          const std::size_t dimension = element.Degree.size();
          std::size_t size = 1; // points of the element
          for (std::size_t corner = 0; corner < std::size_t{ 1 } << dimension; ++corner)
          {
            std::size_t at = 0;
            size = 1;
            for (std::size_t d = 0; d < dimension; ++d)
            {
              const auto p = static_cast<std::size_t>(element.Degree[d]);
              at += (corner >> d & 1U) != 0 ? size * p : 0;
              size *= p + 1;
            }
            const auto [place, isNew] = numbers.try_emplace(points[first + at], numVertices);
            numVertices += isNew ? 1 : 0;
            corners.push_back(place->second);
          }
          first += size;
          all.push_back(std::move(corners));
        }
      },
      any);
  }
  return all;
}

Json BlocksOfPatches(const SplineFile& file)
{
  Json blocks = Json::array();
  int next = 0;
  for (std::size_t i = 0; i < file.Splines.size(); ++i)
  {
    const int id = file.Ids.empty() ? static_cast<int>(i) : file.Ids[i];
    const int count =
      std::visit([](const auto& spline) { return spline.Space->NumElements(); }, file.Splines[i]);
    Json elements = Json::array();
    for (int e = 0; e < count; ++e)
    {
      elements.push_back(next++);
    }
    blocks.push_back({ { "block_name", "patch " + std::to_string(id) }, { "block_id", id },
      { "elem_ids", std::move(elements) } });
  }
  return blocks;
}

Json ElementsOf(const BextContents& contents)
{
  const ExtractionTable<3>& table = contents.Table;
  Json infos = Json::array();
  for (const auto& [begin, end] : BlocksOf(table))
  {
    Json info = { { "num_elems", end - begin } };
    const char* const keys[] = { "deg_s", "deg_t", "deg_u" };
    for (int d = 0; d < 3; ++d)
    {
      info[keys[d]] =
        d < contents.Dimension ? table.Degrees[begin][static_cast<std::size_t>(d)] : -1;
    }
    infos.push_back(std::move(info));
  }
  Json elements = Json::array();
  for (std::size_t e = 0; e < table.NumElements(); ++e)
  {
    const auto part = [&](const std::vector<int>& numbers)
    {
      return std::vector<int>(numbers.begin() + static_cast<std::ptrdiff_t>(table.FirstFunction[e]),
        numbers.begin() + static_cast<std::ptrdiff_t>(table.FirstFunction[e + 1]));
    };
    elements.push_back({ { "us_cid", e }, { "node_ids", part(table.Functions) },
      { "coeff_vector_ids", part(table.Vectors) } });
  }
  return { { "element_block_info", std::move(infos) }, { "element_blocks", std::move(elements) } };
}

Json CoefficientsOf(const ExtractionTable<3>& table)
{
  Json infos = Json::array();
  for (const auto& [begin, end] : VectorBlocksOf(table))
  {
    infos.push_back({ { "num_coeff_vecs", end - begin },
      { "num_components", table.FirstCoefficient[begin + 1] - table.FirstCoefficient[begin] } });
  }
  Json vectors = Json::array();
  for (std::size_t v = 0; v < table.NumVectors(); ++v)
  {
    const auto begin = table.Coefficients.begin();
    vectors.push_back({ { "components",
      std::vector<double>(begin + static_cast<std::ptrdiff_t>(table.FirstCoefficient[v]),
        begin + static_cast<std::ptrdiff_t>(table.FirstCoefficient[v + 1])) } });
  }
  const std::size_t numBlocks = infos.size();
  return { { "num_dense_coeff_blocks", numBlocks }, { "dense_vector_info", std::move(infos) },
    { "dense_coefficient_vectors", std::move(vectors) }, { "num_sparse_coeff_blocks", 0 },
    { "sparse_vector_info", Json::array() }, { "sparse_coefficient_vectors", Json::array() } };
}
}

Result<std::string> WriteBext(const SplineFile& file)
{
  const Result<BextContents> contents = ContentsOfFile(file);
  if (!contents)
  {
    return contents.Status;
  }
  const auto largest =
    static_cast<long long>(std::max({ static_cast<std::size_t>(contents->Nodes.rows()),
      contents->Table.NumElements(), contents->Table.NumVectors() }));
  const int id = contents->PatchId;
  if (largest > LargestInteger || id > LargestInteger || -10LL * id > LargestInteger)
  {
    return { ErrorCode::TooLarge,
      "patch " + std::to_string(id) + " of up to " + std::to_string(largest) +
        " control points, elements or coefficient vectors: the columns of a BEXT text have 8 "
        "places; write .json" };
  }
  return TextOf(contents.Value);
}

Result<std::string> WriteBextJson(const SplineFile& file)
{
  const Result<BextContents> contents = ContentsOfFile(file);
  if (!contents)
  {
    return contents.Status;
  }
  const ExtractionTable<3>& table = contents->Table;
  Json nodes = Json::array();
  for (Eigen::Index i = 0; i < contents->Nodes.rows(); ++i)
  {
    const auto row = contents->Nodes.row(i);
    nodes.push_back({ row[0], row[1], row[2], row[3] });
  }
  int numVertices = 0;
  Json vertices = VerticesOf(file, numVertices);
  const Json root = { { "dim", contents->Dimension }, { "is_rational", contents->Rational },
    { "patch_id", contents->PatchId }, { "num_nodes", nodes.size() },
    { "num_vertices", numVertices }, { "num_elems", table.NumElements() },
    { "num_coeff_vecs", table.NumVectors() }, { "block_elem_map", BlocksOfPatches(file) },
    { "elements", ElementsOf(contents.Value) }, { "coefficients", CoefficientsOf(table) },
    { "vertex_connectivity", std::move(vertices) }, { "nodes", std::move(nodes) } };
  return root.dump() + "\n";
}
}
