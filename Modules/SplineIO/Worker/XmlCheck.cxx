// SPDX-License-Identifier: BSD-3-Clause
#include "XmlCheck.h"

#include "XmlScanner.h"
#include <knotwork/SplineCore/FileEnding.h>

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

bool IsKnownType(const std::string& type)
{
  static const std::array<const char*, 12> known = { "Int8", "UInt8", "Int16", "UInt16", "Int32",
    "UInt32", "Int64", "UInt64", "Float32", "Float64", "String", "Bit" };
  return std::find(known.begin(), known.end(), type) != known.end();
}

/// An attribute as a count: the fallback where it is missing, -1 where it is no count.
double Count(const XmlElement& element, const char* attribute, double fallback)
{
  const std::string* text = element.Find(attribute);
  if (!text || text->empty())
  {
    return fallback;
  }
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text->c_str(), &end, 10);
  return errno == 0 && *end == '\0' && value >= 0 ? static_cast<double>(value) : -1.0;
}

class Checker
{
public:
  Checker(const fs::path& file, const std::string& ending)
    : File(file), IsCollection(ending == ".vtpc")
  {
    std::error_code error;
    this->Bytes = static_cast<double>(fs::file_size(file, error));
    this->Most = 1000.0 + MostValuesOfByte * this->Bytes;
  }

  Status Check()
  {
    if (this->Bytes == 0.0)
    {
      return { ErrorCode::EmptyInput, "'" + this->File.string() + "' is empty" };
    }
    std::ifstream stream(this->File, std::ios::binary);
    XmlScanner scanner(stream);
    const std::string problem = scanner.Scan("VTKFile", "AppendedData",
      [this](const XmlElement& element, const std::vector<XmlElement>& outer)
      { return this->Look(element, outer); });
    if (!problem.empty())
    {
      return this->Damaged("line " + std::to_string(scanner.Line()) + ": " + problem);
    }
    // what remains behind the underscore that appended data begins with
    const double appended = scanner.Stopped() ? this->Bytes - scanner.Position() : 0.0;
    if (this->Farthest >= appended)
    {
      return this->Damaged(this->FarthestPlace + " begins outside of the appended data");
    }
    for (const std::string& part : this->Files)
    {
      if (Status status = this->CheckPart(this->File.parent_path() / part); !status)
      {
        return status;
      }
    }
    return {};
  }

private:
  Status Damaged(const std::string& problem) const
  {
    return { ErrorCode::InvalidTopology,
      "'" + this->File.string() + "' is damaged: " + problem + "; write it again" };
  }

  Status CheckPart(const fs::path& part) const
  {
    std::error_code error;
    const std::string ending = LowerEnding(part.string());
    if (!this->IsCollection || !fs::is_regular_file(part, error))
    {
      return { ErrorCode::EmptyInput,
        "'" + this->File.string() + "' needs the file '" + part.string() +
          "', which is not there" };
    }
    if (ending == ".vtpc")
    {
      return this->Damaged("a part of it is a collection again, '" + part.string() + "'");
    }
    return Checker(part, ending).Check();
  }

  /// What is wrong with an element; empty: nothing.
  std::string Look(const XmlElement& element, const std::vector<XmlElement>& outer)
  {
    if (element.Name == "DataSet" && element.Find("file"))
    {
      this->Files.push_back(*element.Find("file"));
    }
    if (this->IsCollection && (element.Name == "DataSet" || element.Name == "Partitions"))
    {
      return this->CheckCount(element, "index", 1.0, this->Bytes);
    }
    if (element.Name == "Piece")
    {
      for (const auto& [name, value] : element.Attributes)
      {
        if (name.rfind("NumberOf", 0) == 0)
        {
          if (const std::string problem = this->CheckCount(element, name.c_str(), 1.0, this->Most);
              !problem.empty())
          {
            return problem;
          }
        }
      }
    }
    return element.Name == "DataArray" || element.Name == "Array"
      ? this->LookAtArray(element, outer)
      : std::string();
  }

  std::string LookAtArray(const XmlElement& element, const std::vector<XmlElement>& outer)
  {
    const std::string* type = element.Find("type");
    if (!type || !IsKnownType(*type))
    {
      return Place(element) + " has values of the unknown type '" + (type ? *type : "") + "'";
    }
    // tuples of point and cell arrays are as many as the piece has points or cells
    double tuples = 1.0;
    if (outer.size() >= 2)
    {
      for (const char* name : { "NumberOfPoints", "NumberOfCells", "NumberOfLines" })
      {
        tuples = std::max(tuples, Count(outer[outer.size() - 2], name, 1.0));
      }
    }
    std::string problem = this->CheckCount(element, "NumberOfComponents", tuples, this->Most);
    if (problem.empty())
    {
      problem = this->CheckCount(
        element, "NumberOfTuples", Count(element, "NumberOfComponents", 1.0), this->Most);
    }
    const std::string* format = element.Find("format");
    if (!problem.empty() || !format || *format != "appended")
    {
      return problem;
    }
    const double offset = Count(element, "offset", -1.0);
    if (offset > this->Farthest)
    {
      this->Farthest = offset;
      this->FarthestPlace = Place(element);
    }
    return offset >= 0.0 ? std::string() : this->Wrong(element, "offset");
  }

  std::string CheckCount(
    const XmlElement& element, const char* attribute, double times, double most) const
  {
    const double count = Count(element, attribute, 0.0);
    return count >= 0.0 && count * std::max(times, 1.0) <= most ? std::string()
                                                                : this->Wrong(element, attribute);
  }

  std::string Wrong(const XmlElement& element, const char* attribute) const
  {
    const std::string* value = element.Find(attribute);
    return Place(element) +
      (value ? std::string(" has ") + attribute + " " + *value
             : std::string(" has no ") + attribute);
  }

  static std::string Place(const XmlElement& element)
  {
    const std::string* name = element.Find("Name");
    return element.Name + (name && !name->empty() ? " '" + *name + "'" : "");
  }

  fs::path File;
  bool IsCollection;
  double Bytes = 0.0;
  double Most = 0.0;      ///< values that the file can hold
  double Farthest = -1.0; ///< offset of appended data
  std::string FarthestPlace;
  std::vector<std::string> Files; ///< that a collection names
};
}

Status CheckXmlFile(const std::string& file, const std::string& ending)
{
  return ending == ".vtpc" || ending == ".vtu" || ending == ".vtp" || ending == ".vti"
    ? Checker(file, ending).Check()
    : Status();
}
}
