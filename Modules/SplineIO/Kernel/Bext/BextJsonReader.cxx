// SPDX-License-Identifier: BSD-3-Clause
#include "BextContents.h"
#include "BextFile.h"
#include "TextWords.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace knotwork
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr long long MostNumbers = std::numeric_limits<int>::max() - 1;

/// Reads values by key; the first failure stays in Outcome.
class JsonReader
{
public:
  explicit JsonReader(const Json& root) : Root(root) {}

  Result<SplineFile> Read()
  {
    this->ReadNodes();
    this->ReadElements();
    this->ReadVectors();
    return this->Outcome ? FileOfContents(this->Contents, 0) : Result<SplineFile>(this->Outcome);
  }

private:
  void Fail(ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, what };
    }
  }

  const Json& At(const Json& object, const char* key, const std::string& where = {})
  {
    static const Json nothing;
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (found == object.end())
    {
      this->Fail(ErrorCode::InvalidFormat,
        where + "\"" + key + "\" is missing; the file is cut off, or of another format");
      return nothing;
    }
    return *found;
  }
  const Json& List(const Json& object, const char* key, const std::string& where = {})
  {
    static const Json none = Json::array();
    const Json& list = this->At(object, key, where);
    if (!list.is_array())
    {
      this->Fail(ErrorCode::InvalidFormat, where + "\"" + key + "\" is not a list");
      return none;
    }
    return list;
  }
  long long Integer(const Json& value, const std::string& name, long long lowest)
  {
    const bool isWhole = value.is_number_integer() &&
      !(value.is_number_unsigned() && value.get<std::uint64_t>() > MostNumbers);
    if (!isWhole || value.get<long long>() < lowest || value.get<long long>() > MostNumbers)
    {
      this->Fail(ErrorCode::InvalidFormat,
        name + " is not a whole number from " + std::to_string(lowest) + " to " +
          std::to_string(MostNumbers));
      return lowest;
    }
    return value.get<long long>();
  }
  double Real(const Json& value, const std::string& name)
  {
    if (!value.is_number())
    {
      this->Fail(ErrorCode::InvalidFormat, name + " is not a number");
      return 0.0;
    }
    const auto number = value.get<double>();
    if (!std::isfinite(number))
    {
      this->Fail(ErrorCode::NonFiniteInput, name + " is not a finite number");
    }
    return number;
  }
  /// A count may be left out; where it stands it must be right.
  void CheckCount(const Json& object, const char* key, std::size_t count, const char* what)
  {
    if (this->Outcome && object.contains(key) &&
      this->Integer(object[key], std::string("\"") + key + "\"", 0) !=
        static_cast<long long>(count))
    {
      this->Fail(ErrorCode::SizeMismatch,
        std::string("\"") + key + "\" is " + object[key].dump() + ", the file has " +
          std::to_string(count) + " " + what);
    }
  }

  void ReadNodes()
  {
    const Json& rows = this->List(this->Root, "nodes");
    this->CheckCount(this->Root, "num_nodes", rows.size(), "control points");
    if (this->Root.contains("is_rational"))
    {
      const Json& flag = this->Root["is_rational"];
      this->Contents.Rational =
        flag.is_boolean() ? flag.get<bool>() : this->Integer(flag, "\"is_rational\"", 0) != 0;
    }
    if (this->Root.contains("patch_id"))
    {
      this->Contents.PatchId =
        static_cast<int>(this->Integer(this->Root["patch_id"], "\"patch_id\"", -MostNumbers));
    }
    this->Contents.Nodes.resize(static_cast<Eigen::Index>(rows.size()), 4);
    for (std::size_t i = 0; i < rows.size() && this->Outcome; ++i)
    {
      const std::string name = "control point " + std::to_string(i);
      if (!rows[i].is_array() || rows[i].size() != 4)
      {
        this->Fail(ErrorCode::InvalidFormat, name + " is not a list of x, y, z and weight");
        return;
      }
      for (std::size_t c = 0; c < 4; ++c)
      {
        this->Contents.Nodes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
          this->Real(rows[i][c], name);
      }
    }
  }

  /// Directions that are not there have the degree -1 or 0, or no key.
  IntArray<3> ReadDegrees(const Json& info, const std::string& name)
  {
    const char* const keys[] = { "deg_s", "deg_t", "deg_u" };
    IntArray<3> degree{};
    int dimension = 0;
    for (std::size_t d = 0; d < 3; ++d)
    {
      const long long p =
        info.contains(keys[d]) ? this->Integer(info[keys[d]], name + ", " + keys[d], -1) : -1;
      degree[d] = static_cast<int>(p > 0 ? p : 0);
      dimension = p > 0 ? static_cast<int>(d) + 1 : dimension;
    }
    if (this->Outcome && dimension == 0)
    {
      this->Fail(ErrorCode::InvalidDegree, name + " has no degree of 1 or more");
    }
    if (this->Outcome && this->Contents.Dimension > 0 && this->Contents.Dimension != dimension)
    {
      this->Fail(ErrorCode::DimensionMismatch,
        name + " has elements of " + std::to_string(dimension) + " parameters, the file " +
          std::to_string(this->Contents.Dimension) +
          "; curves, surfaces and volumes are read from files of their own");
    }
    this->Contents.Dimension = dimension;
    return degree;
  }

  void ReadElements()
  {
    if (this->Root.contains("dim"))
    {
      this->Contents.Dimension = static_cast<int>(this->Integer(this->Root["dim"], "\"dim\"", 1));
    }
    const Json& elements = this->At(this->Root, "elements");
    const Json& infos = this->List(elements, "element_block_info");
    const Json& all = this->List(elements, "element_blocks");
    this->CheckCount(this->Root, "num_elems", all.size(), "elements");
    std::size_t next = 0;
    for (std::size_t b = 0; b < infos.size() && this->Outcome; ++b)
    {
      const std::string name = "element block " + std::to_string(b);
      const long long count =
        this->Integer(this->At(infos[b], "num_elems", name + ": "), name + ", num_elems", 0);
      const IntArray<3> degree = this->Outcome ? this->ReadDegrees(infos[b], name) : IntArray<3>{};
      if (this->Outcome && static_cast<std::size_t>(count) > all.size() - next)
      {
        this->Fail(ErrorCode::SizeMismatch,
          "the blocks up to " + std::to_string(b) + " have " +
            std::to_string(next + static_cast<std::size_t>(count)) + " elements, the file " +
            std::to_string(all.size()));
      }
      for (long long e = 0; e < count && this->Outcome; ++e, ++next)
      {
        this->ReadElement(all[next], degree);
      }
    }
    if (this->Outcome && next < all.size())
    {
      this->Fail(ErrorCode::SizeMismatch,
        "the blocks have " + std::to_string(next) + " elements, the file " +
          std::to_string(all.size()));
    }
  }

  void ReadElement(const Json& element, const IntArray<3>& degree)
  {
    ExtractionTable<3>& table = this->Contents.Table;
    const std::string name = "element " + std::to_string(table.NumElements());
    const Json& nodes = this->List(element, "node_ids", name + ": ");
    const Json& vectors = this->List(element, "coeff_vector_ids", name + ": ");
    if (this->Outcome && nodes.size() != vectors.size())
    {
      this->Fail(ErrorCode::SizeMismatch,
        name + " has " + std::to_string(nodes.size()) + " control points and " +
          std::to_string(vectors.size()) + " coefficient vectors; they belong together");
    }
    for (std::size_t k = 0; k < nodes.size() && this->Outcome; ++k)
    {
      table.Functions.push_back(
        static_cast<int>(this->Integer(nodes[k], name + ", control point", 0)));
      table.Vectors.push_back(
        static_cast<int>(this->Integer(vectors[k], name + ", coefficient vector", 0)));
    }
    table.EndElement(degree);
  }

  /// Sparse vectors have no documented form.
  void ReadVectors()
  {
    const Json& coefficients = this->At(this->Root, "coefficients");
    if (this->Outcome && coefficients.contains("sparse_coefficient_vectors") &&
      !coefficients["sparse_coefficient_vectors"].empty())
    {
      this->Fail(ErrorCode::InvalidFormat,
        "\"sparse_coefficient_vectors\" cannot be read, their form is not documented; write dense "
        "vectors");
    }
    const Json& vectors = this->List(coefficients, "dense_coefficient_vectors");
    this->CheckCount(this->Root, "num_coeff_vecs", vectors.size(), "coefficient vectors");
    for (std::size_t v = 0; v < vectors.size() && this->Outcome; ++v)
    {
      const std::string name = "coefficient vector " + std::to_string(v);
      for (const Json& value : this->List(vectors[v], "components", name + ": "))
      {
        this->Contents.Table.Coefficients.push_back(this->Real(value, name));
      }
      this->Contents.Table.EndVector();
    }
  }

  const Json& Root;
  Status Outcome;
  BextContents Contents;
};
}

Result<SplineFile> ReadBextJson(std::string_view text)
{
  // without exceptions: a text that is no JSON gives a discarded value
  const Json root = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!root.is_object())
  {
    return { ErrorCode::InvalidFormat, "the text is not a JSON object (cut off or damaged?)" };
  }
  return JsonReader(root).Read();
}

bool LooksLikeBextJson(std::string_view beginning)
{
  const std::size_t first = beginning.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || beginning[first] != '{')
  {
    return false;
  }
  const char* const keys[] = { "\"is_rational\"", "\"num_nodes\"", "\"num_elems\"",
    "\"num_coeff_vecs\"", "\"block_elem_map\"", "\"coefficients\"" };
  return std::any_of(std::begin(keys), std::end(keys),
    [&](const char* key) { return beginning.find(key) != std::string_view::npos; });
}
}
