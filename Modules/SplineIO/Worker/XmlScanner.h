// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <istream>
#include <string>
#include <utility>
#include <vector>

namespace knotwork
{
struct XmlElement
{
  std::string Name;
  std::vector<std::pair<std::string, std::string>> Attributes; ///< values as they stand in the text

  /// The value of an attribute; null without it.
  const std::string* Find(const std::string& attribute) const;
};

/// Goes through the tags of an XML text once. What an honest data file has no need of is an error:
/// document types, CDATA, more than MostNested elements in each other, tags of more than MostOfTag
/// bytes, more than 64 attributes.
class XmlScanner
{
public:
  static constexpr std::size_t MostNested = 100;
  static constexpr std::size_t MostOfTag = 1 << 20;

  /// What is wrong with an element that lies in the outer ones; empty: nothing.
  using Look = std::function<std::string(const XmlElement&, const std::vector<XmlElement>& outer)>;

  explicit XmlScanner(std::istream& stream) : Stream(stream) {}

  /// @param root  name of the outermost element.
  /// @param last  element where the text ends and raw data begins.
  /// @return what is wrong at Line(); empty: nothing.
  std::string Scan(const std::string& root, const std::string& last, const Look& look);

  long long Line() const { return this->LineNumber; }
  /// Whether there was raw data.
  bool Stopped() const { return this->AtData; }
  /// Bytes before the raw data, with the underscore that it begins with.
  double Position() const { return static_cast<double>(this->Taken); }

private:
  int Next();
  bool SkipTo(char mark);
  bool SkipPast(const std::string& end);
  bool TakeTag(std::string& tag);

  std::istream& Stream;
  long long LineNumber = 1;
  long long Taken = 0;
  bool AtData = false;
};
}
