// SPDX-License-Identifier: BSD-3-Clause
#include "XmlScanner.h"

#include <algorithm>
#include <cstring>

namespace knotwork
{
namespace
{
constexpr const char* Blanks = " \t\r\n";
constexpr std::size_t MostAttributes = 64;
constexpr std::size_t MostShown = 40; ///< of a tag in a message

bool IsName(const std::string& name)
{
  return !name.empty() && std::strchr("-.0123456789", name[0]) == nullptr &&
    std::all_of(name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) || std::strchr("-._:", c) || c >= 0x80; });
}

/// Name and attributes of what stands between < and >; false where that is no tag.
bool Parse(const std::string& tag, XmlElement& element)
{
  std::size_t at = std::min(tag.find_first_of(Blanks), tag.size());
  element.Name = tag.substr(0, at);
  while ((at = tag.find_first_not_of(Blanks, at)) != std::string::npos)
  {
    const std::size_t equal = tag.find('=', at);
    if (equal == std::string::npos || element.Attributes.size() >= MostAttributes)
    {
      return false;
    }
    std::string name = tag.substr(at, equal - at);
    name.resize(name.find_last_not_of(Blanks) + 1);
    const std::size_t quote = tag.find_first_not_of(Blanks, equal + 1);
    if (quote == std::string::npos || (tag[quote] != '"' && tag[quote] != '\''))
    {
      return false;
    }
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end == std::string::npos || !IsName(name))
    {
      return false;
    }
    element.Attributes.emplace_back(std::move(name), tag.substr(quote + 1, end - quote - 1));
    at = end + 1;
  }
  return IsName(element.Name);
}
}

const std::string* XmlElement::Find(const std::string& attribute) const
{
  for (const auto& [name, value] : this->Attributes)
  {
    if (name == attribute)
    {
      return &value;
    }
  }
  return nullptr;
}

int XmlScanner::Next()
{
  const int c = this->Stream.rdbuf()->sbumpc();
  this->Taken += c == std::char_traits<char>::eof() ? 0 : 1;
  this->LineNumber += c == '\n' ? 1 : 0;
  return c;
}

bool XmlScanner::SkipTo(char mark)
{
  int c = this->Next();
  while (c != mark && c != std::char_traits<char>::eof())
  {
    c = this->Next();
  }
  return c == mark;
}

bool XmlScanner::SkipPast(const std::string& end)
{
  std::string last;
  for (int c = this->Next(); c != std::char_traits<char>::eof(); c = this->Next())
  {
    last += static_cast<char>(c);
    if (last.size() > end.size())
    {
      last.erase(0, 1);
    }
    if (last == end)
    {
      return true;
    }
  }
  return false;
}

/// Up to the > that ends it, which does not count within quotes. A comment ends after <!--.
bool XmlScanner::TakeTag(std::string& tag)
{
  char quote = '\0';
  for (int c = this->Next(); c != std::char_traits<char>::eof(); c = this->Next())
  {
    if (quote == '\0' && c == '>')
    {
      return true;
    }
    if (c == '<' || tag.size() >= MostOfTag)
    {
      return false;
    }
    if (quote == c)
    {
      quote = '\0';
    }
    else if (quote == '\0' && (c == '"' || c == '\''))
    {
      quote = static_cast<char>(c);
    }
    tag += static_cast<char>(c);
    if (tag == "!--")
    {
      return true;
    }
  }
  return false;
}

std::string XmlScanner::Scan(const std::string& root, const std::string& last, const Look& look)
{
  std::vector<XmlElement> open;
  bool ended = false;
  while (this->SkipTo('<'))
  {
    std::string tag;
    const bool taken = this->TakeTag(tag);
    if (tag == "!--")
    {
      if (!this->SkipPast("-->"))
      {
        return "a comment has no end";
      }
      continue;
    }
    if (tag[0] == '!')
    {
      return "document types, entities and the like are not read";
    }
    if (!taken)
    {
      return "a tag has no end";
    }
    if (tag[0] == '?')
    {
      continue;
    }
    if (tag[0] == '/')
    {
      const std::string name = tag.substr(1, tag.find_last_not_of(Blanks));
      if (open.empty() || open.back().Name != name)
      {
        return "</" + name + "> ends what has not begun";
      }
      open.pop_back();
      ended = open.empty();
      continue;
    }
    const bool isEmpty = tag.back() == '/';
    tag.resize(tag.size() - (isEmpty ? 1 : 0));
    XmlElement element;
    if (!Parse(tag, element))
    {
      return "<" + tag.substr(0, MostShown) + (tag.size() > MostShown ? "..." : "") + "> is no tag";
    }
    if (ended || (open.empty() && element.Name != root))
    {
      return "<" + element.Name + "> stands outside of <" + root + ">";
    }
    if (open.size() >= MostNested)
    {
      return "more than " + std::to_string(MostNested) + " elements lie in each other";
    }
    if (std::string problem = look(element, open); !problem.empty())
    {
      return problem;
    }
    if (element.Name == last && !isEmpty)
    {
      this->AtData = this->SkipTo('_');
      return this->AtData ? "" : "appended data does not begin with _";
    }
    if (!isEmpty)
    {
      open.push_back(std::move(element));
    }
  }
  return ended     ? ""
    : open.empty() ? "there is no <" + root + ">"
                   : "<" + open.back().Name + "> has no end";
}
}
