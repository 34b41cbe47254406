// SPDX-License-Identifier: BSD-3-Clause
#include "FileEnding.h"

namespace knotwork
{
std::string LowerEnding(const std::string& file)
{
  const std::size_t slash = file.find_last_of('/');
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t dot = file.find_last_of('.');
  if (dot == std::string::npos || dot <= begin) // a name that begins with a point is hidden
  {
    return {};
  }
  std::string ending = file.substr(dot);
  for (char& c : ending)
  {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return ending;
}
}
