// SPDX-License-Identifier: BSD-3-Clause
#include "XmlCheck.h"

#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
/// Values a byte of file: compressed ones may be many.
constexpr double MostValuesOfByte = 10000.0;

/// The part that is XML: everything before appended data.
std::string ReadText(const fs::path& file)
{
  constexpr const char* appended = "<AppendedData";
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  std::array<char, 1 << 16> buffer;
  std::size_t searched = 0;
  while (stream.read(buffer.data(), buffer.size()), stream.gcount() > 0)
  {
    text.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
    if (const auto end = text.find(appended, searched); end != std::string::npos)
    {
      text.resize(end);
      break;
    }
    searched = text.size() - std::min<std::size_t>(text.size(), 16);
  }
  return text;
}

/// An attribute as a count: the fallback where it is missing, -1 where it is no count.
double Count(const pugi::xml_node& node, const char* attribute, double fallback)
{
  const char* text = node.attribute(attribute).value();
  if (*text == '\0')
  {
    return fallback;
  }
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text, &end, 10);
  return errno == 0 && *end == '\0' && value >= 0 ? static_cast<double>(value) : -1.0;
}

bool IsKnownType(const std::string& type)
{
  static const std::array<const char*, 12> known = { "Int8", "UInt8", "Int16", "UInt16", "Int32",
    "UInt32", "Int64", "UInt64", "Float32", "Float64", "String", "Bit" };
  return std::find(known.begin(), known.end(), type) != known.end();
}

struct Checker : pugi::xml_tree_walker
{
  double Most = 0.0; ///< values that the file can hold
  std::string Problem;
  std::vector<std::string> Files; ///< that a collection names

  bool for_each(pugi::xml_node& node) override
  {
    const std::string tag = node.name();
    if (tag == "DataSet" && node.attribute("file"))
    {
      this->Files.emplace_back(node.attribute("file").value());
    }
    else if (tag == "Piece")
    {
      for (const pugi::xml_attribute& attribute : node.attributes())
      {
        const std::string name = attribute.name();
        if (name.rfind("NumberOf", 0) == 0)
        {
          this->CheckCount(node, name.c_str(), 1.0);
        }
      }
    }
    else if (tag == "DataArray" || tag == "Array")
    {
      if (!IsKnownType(node.attribute("type").value()))
      {
        this->Problem =
          Place(node) + " has values of the unknown type '" + node.attribute("type").value() + "'";
      }
      // tuples of point and cell arrays are as many as the piece has points or cells
      const pugi::xml_node piece = node.parent().parent();
      double tuples = 1.0;
      for (const char* name : { "NumberOfPoints", "NumberOfCells", "NumberOfLines" })
      {
        tuples = std::max(tuples, Count(piece, name, 1.0));
      }
      this->CheckCount(node, "NumberOfComponents", tuples);
      this->CheckCount(node, "NumberOfTuples", Count(node, "NumberOfComponents", 1.0));
    }
    return this->Problem.empty();
  }

  void CheckCount(const pugi::xml_node& node, const char* attribute, double times)
  {
    const double count = Count(node, attribute, 0.0);
    if (!(count >= 0.0 && count * std::max(times, 1.0) <= this->Most) && this->Problem.empty())
    {
      this->Problem = Place(node) + " has " + attribute + " " + node.attribute(attribute).value();
    }
  }

  static std::string Place(const pugi::xml_node& node)
  {
    const std::string name = node.attribute("Name").value();
    return std::string(node.name()) + (name.empty() ? "" : " '" + name + "'");
  }
};

Status Check(const fs::path& file, bool collection)
{
  std::error_code error;
  Checker checker;
  checker.Most = 1000.0 + MostValuesOfByte * static_cast<double>(fs::file_size(file, error));
  const std::string text = ReadText(file);
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_minimal); // what was parsed remains
  document.traverse(checker);
  if (!checker.Problem.empty())
  {
    return { ErrorCode::InvalidTopology, "'" + file.string() + "' is damaged: " + checker.Problem };
  }
  for (const std::string& part : checker.Files)
  {
    const fs::path path = file.parent_path() / part;
    if (!collection || !fs::is_regular_file(path, error))
    {
      return { ErrorCode::EmptyInput,
        "'" + file.string() + "' needs the file '" + path.string() + "', which is not there" };
    }
    if (Status status = Check(path, false); !status)
    {
      return status;
    }
  }
  return {};
}
}

Status CheckXmlFile(const std::string& file, const std::string& ending)
{
  const bool collection = ending == ".vtpc";
  if (!collection && ending != ".vtu" && ending != ".vtp")
  {
    return {};
  }
  return Check(file, collection);
}
}
