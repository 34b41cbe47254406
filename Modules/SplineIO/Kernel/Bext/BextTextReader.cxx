// SPDX-License-Identifier: BSD-3-Clause
#include "BextContents.h"
#include "BextFields.h"
#include "BextFile.h"
#include "TextWords.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
constexpr long long MostNumbers = std::numeric_limits<int>::max() - 1;
/// Of a vector: the Bernstein polynomials of three directions.
constexpr long long MostCoefficients = (MaxDegree + 1) * (MaxDegree + 1) * (MaxDegree + 1);
constexpr const char* Title = "B E X T";
constexpr const char* OtherTitle = "BASIS TRANSFORM";

struct ElementBlock
{
  long long NumElements = 0;
  long long NumFunctions = 0;
  IntArray<3> Degree{};
};

struct VectorBlock
{
  long long NumVectors = 0;
  long long NumEntries = 0; ///< of each
};

/// A vector of which only some coefficients are given.
struct SparseVector
{
  std::vector<int> Places; ///< from 0
  std::vector<double> Values;
};

class TextReader
{
public:
  explicit TextReader(std::string_view text) : TextSize(text.size()), Line(text) {}

  Result<SplineFile> Read()
  {
    this->ReadTitle();
    this->ReadCounts();
    this->ReadNodes();
    this->ReadElements();
    this->ReadVectors();
    if (this->Line.Outcome && !this->Line.AtEnd())
    {
      this->Line.Fail(ErrorCode::InvalidFormat,
        "there is something behind the last coefficient; a file of several patches cannot be read, "
        "write one file a patch");
    }
    this->ExpandSparseVectors();
    return this->Line.Outcome ? FileOfContents(this->Contents, 1)
                              : Result<SplineFile>(this->Line.Outcome);
  }

private:
  void ReadTitle()
  {
    if (!this->Line.NextLine("the title"))
    {
      return;
    }
    std::string words;
    while (this->Line.HasField())
    {
      words += (words.empty() ? "" : " ") + std::string(this->Line.Word());
    }
    const auto begins = [&words](const std::string& title) { return words.rfind(title, 0) == 0; };
    this->IsTransform =
      begins(std::string(Title) + " 2.1") || begins(std::string(OtherTitle) + " 2.1");
    if (!this->IsTransform && !begins(std::string(Title) + " 2.0"))
    {
      this->Line.Fail(ErrorCode::InvalidFormat,
        "the title is " + Shown(words) +
          "; 'B E X T 2.0', 'B E X T 2.1' and 'BASIS TRANSFORM 2.1' "
          "can be read");
    }
  }

  /// A count of things that take as many characters each.
  long long Count(const std::string& meaning, std::size_t characters)
  {
    const auto most = static_cast<long long>(this->TextSize / characters);
    const long long count = this->Line.Integer(meaning, 0, MostNumbers);
    if (this->Line.Outcome && count > most)
    {
      this->Line.Fail(ErrorCode::InvalidFormat,
        meaning + " is " + std::to_string(count) + ", more than the text has room for");
    }
    return this->Line.Outcome ? count : 0;
  }

  /// Titles 2.1 may leave the number of the patch out.
  void ReadCounts()
  {
    this->Line.NextLine("the line of counts");
    std::vector<long long> counts;
    while (this->Line.Outcome && this->Line.HasField() && counts.size() < 5)
    {
      counts.push_back(this->Line.Integer("a count", -MostNumbers, MostNumbers));
    }
    if (this->Line.Outcome && counts.size() < (this->IsTransform ? 4U : 5U))
    {
      this->Line.Fail(ErrorCode::InvalidFormat,
        std::to_string(counts.size()) +
          " numbers; needed are patch, control points, elements, coefficient vectors and the flag "
          "of "
          "weights");
    }
    if (!this->Line.Outcome)
    {
      return;
    }
    if (counts.size() == 4)
    {
      counts.insert(counts.begin(), 1);
    }
    const char* const names[] = { "", "control points", "elements", "coefficient vectors" };
    for (std::size_t i = 1; i < 4; ++i)
    {
      // two characters a number; x, y, z and weight of a point, an entry and a vector of an element
      const std::size_t characters = i == 1 ? 8 : i == 2 ? 4 : 2;
      if (counts[i] < 0 || counts[i] > static_cast<long long>(this->TextSize / characters))
      {
        this->Line.Fail(ErrorCode::InvalidFormat,
          std::to_string(counts[i]) + " " + names[i] + " do not fit into the text");
      }
    }
    this->Contents.PatchId = static_cast<int>(counts[0]);
    this->NumNodes = counts[1];
    this->NumElements = counts[2];
    this->NumVectors = counts[3];
    this->Contents.Rational = counts[4] != 0;
  }

  void ReadNodes()
  {
    if (!this->Line.Outcome)
    {
      return;
    }
    this->Contents.Nodes.resize(this->NumNodes, 4);
    for (Eigen::Index i = 0; i < this->NumNodes; ++i)
    {
      const std::string name = "control point " + std::to_string(i + 1);
      if (!this->Line.NextLine(name))
      {
        return;
      }
      for (Eigen::Index c = 0; c < 4; ++c)
      {
        this->Contents.Nodes(i, c) = this->Line.Real(name);
      }
    }
  }

  ElementBlock ReadElementBlock(const std::string& name)
  {
    ElementBlock block;
    this->Line.NextLine(name);
    const long long type = this->Line.Integer(name + ", type", 0, MostNumbers);
    if (this->Line.Outcome && type != 1)
    {
      this->Line.Fail(ErrorCode::InvalidFormat,
        name + " has elements of type " + std::to_string(type) +
          "; only type 1 can be read: curves, quadrilaterals and hexahedra with whole coefficient "
          "vectors");
    }
    block.NumElements = this->Line.Integer(name + ", elements", 1, MostNumbers);
    block.NumFunctions = this->Line.Integer(name + ", control points", 1, MostNumbers);
    const long long vectors = this->Line.Integer(name + ", coefficient vectors", 1, MostNumbers);
    if (this->Line.Outcome && vectors != block.NumFunctions)
    {
      this->Line.Fail(ErrorCode::SizeMismatch,
        name + " has " + std::to_string(block.NumFunctions) + " control points and " +
          std::to_string(vectors) + " coefficient vectors an element; they belong together");
    }
    int dimension = 0;
    while (this->Line.Outcome && dimension < 3 && (dimension == 0 || this->Line.HasField()))
    {
      block.Degree[static_cast<std::size_t>(dimension++)] =
        static_cast<int>(this->Line.Integer(name + ", degree", 0, MostNumbers));
    }
    while (dimension > 1 && block.Degree[static_cast<std::size_t>(dimension) - 1] == 0)
    {
      --dimension; // a direction that is not there
    }
    for (int d = 0; d < dimension; ++d)
    {
      const int degree = block.Degree[static_cast<std::size_t>(d)];
      if (degree < 1 || degree > MaxDegree)
      {
        this->Line.Fail(ErrorCode::InvalidDegree, name + " has degree " + std::to_string(degree));
      }
    }
    if (this->Line.Outcome && this->Contents.Dimension > 0 && this->Contents.Dimension != dimension)
    {
      this->Line.Fail(ErrorCode::DimensionMismatch,
        name + " has elements of " + std::to_string(dimension) + " parameters, the first " +
          std::to_string(this->Contents.Dimension) +
          "; curves, surfaces and volumes are read from files of their own");
    }
    this->Contents.Dimension = dimension;
    return block;
  }

  /// A list that begins a line and may go on in others.
  void ReadNumbers(const std::string& meaning, long long count, std::vector<int>& numbers)
  {
    this->Line.NextLine(meaning);
    for (long long i = 0; i < count && this->Line.Outcome; ++i)
    {
      this->Line.ContinueList(meaning);
      numbers.push_back(static_cast<int>(this->Line.Integer(meaning, 1, MostNumbers)) - 1);
    }
  }
  void ReadReals(const std::string& meaning, long long count, std::vector<double>& numbers)
  {
    this->Line.NextLine(meaning);
    for (long long i = 0; i < count && this->Line.Outcome; ++i)
    {
      this->Line.ContinueList(meaning);
      numbers.push_back(this->Line.Real(meaning));
    }
  }

  void ReadElements()
  {
    this->Line.NextLine("the number of element blocks");
    const long long numBlocks = this->Count("the number of element blocks", 8);
    std::vector<ElementBlock> blocks;
    long long all = 0;
    for (long long b = 0; b < numBlocks && this->Line.Outcome; ++b)
    {
      blocks.push_back(this->ReadElementBlock("element block " + std::to_string(b + 1)));
      all += blocks.back().NumElements;
    }
    if (this->Line.Outcome && all != this->NumElements)
    {
      this->Line.Fail(ErrorCode::SizeMismatch,
        "the blocks have " + std::to_string(all) + " elements, the file " +
          std::to_string(this->NumElements));
    }
    for (const ElementBlock& block : blocks)
    {
      for (long long e = 0; e < block.NumElements && this->Line.Outcome; ++e)
      {
        this->ReadElement(block);
      }
    }
  }

  void ReadElement(const ElementBlock& block)
  {
    ExtractionTable<3>& table = this->Contents.Table;
    const std::string name = "element " + std::to_string(table.NumElements() + 1);
    if (this->IsTransform && this->Line.NextLineIsReal())
    {
      // its box in a parameter domain, which nothing else is known of
      this->Line.NextLine(name + ", box");
      for (int i = 0; i < 2 * this->Contents.Dimension; ++i)
      {
        this->Line.Real(name + ", box");
      }
    }
    this->ReadNumbers(name + ", control points", block.NumFunctions, table.Functions);
    this->ReadNumbers(name + ", coefficient vectors", block.NumFunctions, table.Vectors);
    table.EndElement(block.Degree);
  }

  void ReadVectors()
  {
    this->Line.NextLine("the number of coefficient blocks");
    const long long dense = this->Count("the number of dense coefficient blocks", 4);
    const bool hasSparse = !this->IsTransform || this->Line.HasField();
    const long long sparse =
      hasSparse ? this->Count("the number of sparse coefficient blocks", 4) : 0;
    std::vector<VectorBlock> blocks;
    long long all = 0;
    for (long long b = 0; b < dense + sparse && this->Line.Outcome; ++b)
    {
      const std::string name = "coefficient block " + std::to_string(b + 1);
      this->Line.NextLine(name);
      VectorBlock block;
      block.NumVectors = this->Line.Integer(name + ", vectors", 0, MostNumbers);
      block.NumEntries = this->Line.Integer(name + ", coefficients", 1, MostCoefficients);
      all += block.NumVectors;
      blocks.push_back(block);
    }
    if (this->Line.Outcome && all != this->NumVectors)
    {
      this->Line.Fail(ErrorCode::SizeMismatch,
        "the blocks have " + std::to_string(all) + " coefficient vectors, the file " +
          std::to_string(this->NumVectors));
    }
    for (std::size_t b = 0; b < blocks.size(); ++b)
    {
      for (long long v = 0; v < blocks[b].NumVectors && this->Line.Outcome; ++v)
      {
        this->ReadVector(blocks[b], static_cast<long long>(b) >= dense);
      }
    }
    this->Line.EndLine();
  }

  void ReadVector(const VectorBlock& block, bool isSparse)
  {
    ExtractionTable<3>& table = this->Contents.Table;
    const std::string name =
      "coefficient vector " + std::to_string(table.NumVectors() + this->Sparse.size() + 1);
    if (!isSparse)
    {
      this->ReadReals(name, block.NumEntries, table.Coefficients);
      table.EndVector();
      return;
    }
    this->Sparse.emplace_back();
    this->ReadNumbers(name + ", places", block.NumEntries, this->Sparse.back().Places);
    this->ReadReals(name, block.NumEntries, this->Sparse.back().Values);
    std::vector<int> places = this->Sparse.back().Places;
    std::sort(places.begin(), places.end());
    if (std::adjacent_find(places.begin(), places.end()) != places.end())
    {
      this->Line.Fail(ErrorCode::InvalidTopology, name + " has a place twice");
    }
  }

  /// As many coefficients as the element has that uses the vector first; those that none uses are
  /// left empty.
  void ExpandSparseVectors()
  {
    if (!this->Line.Outcome || this->Sparse.empty())
    {
      return;
    }
    ExtractionTable<3>& table = this->Contents.Table;
    const std::size_t dense = table.NumVectors();
    std::vector<std::size_t> sizes(this->Sparse.size(), 0);
    for (std::size_t e = 0; e < table.NumElements(); ++e)
    {
      for (std::size_t k = table.FirstFunction[e]; k < table.FirstFunction[e + 1]; ++k)
      {
        const auto vector = static_cast<std::size_t>(table.Vectors[k]);
        if (vector >= dense && vector - dense < sizes.size() && sizes[vector - dense] == 0)
        {
          sizes[vector - dense] = static_cast<std::size_t>(NumTensorFunctions<3>(table.Degrees[e]));
        }
      }
    }
    for (std::size_t v = 0; v < sizes.size(); ++v)
    {
      const std::size_t begin = table.Coefficients.size();
      table.Coefficients.resize(begin + sizes[v], 0.0);
      for (std::size_t i = 0; i < this->Sparse[v].Places.size() && sizes[v] > 0; ++i)
      {
        const auto place = static_cast<std::size_t>(this->Sparse[v].Places[i]);
        if (place >= sizes[v])
        {
          this->Line.Outcome = { ErrorCode::InvalidTopology,
            "coefficient vector " + std::to_string(dense + v + 1) + " has place " +
              std::to_string(place + 1) + ", its element " + std::to_string(sizes[v]) +
              " Bernstein polynomials" };
          return;
        }
        table.Coefficients[begin + place] = this->Sparse[v].Values[i];
      }
      table.EndVector();
    }
  }

  std::size_t TextSize;
  BextFields Line;
  BextContents Contents;
  bool IsTransform = false; ///< of the titles 2.1
  long long NumNodes = 0;
  long long NumElements = 0;
  long long NumVectors = 0;
  std::vector<SparseVector> Sparse; ///< numbered behind the dense ones
};

bool BeginsLikeJson(std::string_view text)
{
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}
}

Result<SplineFile> ReadBextText(std::string_view text)
{
  return TextReader(text).Read();
}

Result<SplineFile> ReadBext(std::string_view text)
{
  return BeginsLikeJson(text) ? ReadBextJson(text) : ReadBextText(text);
}

bool LooksLikeBext(std::string_view beginning)
{
  const std::size_t first = beginning.find_first_not_of(" \t\r\n");
  const std::string_view words = beginning.substr(std::min(first, beginning.size()));
  return words.rfind(Title, 0) == 0 || words.rfind(OtherTitle, 0) == 0 ||
    LooksLikeBextJson(beginning);
}
}
