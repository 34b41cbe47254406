// SPDX-License-Identifier: BSD-3-Clause
#include "CADComposite.h"

#include <map>

namespace knotwork
{
namespace
{
const std::string Prefix = "composite:";
}

CompositeName ParseCompositeName(const std::string& faceName)
{
  if (faceName.compare(0, Prefix.size(), Prefix) != 0)
  {
    return { "", faceName };
  }
  const std::string rest = faceName.substr(Prefix.size());
  const std::size_t end = rest.find('/');
  return { rest.substr(0, end), end == std::string::npos ? "" : rest.substr(end + 1) };
}

std::string FormatCompositeName(const CompositeName& name)
{
  if (name.Group.empty())
  {
    return name.Name;
  }
  return Prefix + name.Group + (name.Name.empty() ? "" : "/" + name.Name);
}

std::vector<int> CompositeIds(const std::vector<std::string>& faceNames)
{
  std::map<std::string, int> numbers;
  std::vector<int> ids;
  for (const std::string& faceName : faceNames)
  {
    const std::string group = ParseCompositeName(faceName).Group;
    const auto next = static_cast<int>(numbers.size());
    ids.push_back(group.empty() ? -1 : numbers.emplace(group, next).first->second);
  }
  return ids;
}
}
