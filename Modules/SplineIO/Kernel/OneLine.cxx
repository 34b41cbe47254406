// SPDX-License-Identifier: BSD-3-Clause
#include "OneLine.h"

#include <cstdint>

namespace knotwork
{
namespace
{
constexpr std::size_t MostOfWord = 300;
constexpr std::size_t MostOfMessage = 2000;

bool IsContinuation(unsigned char byte)
{
  return (byte & 0xC0U) == 0x80U;
}

/// Length of the character of UTF-8 at a place, and the character; 0 where there is none.
std::size_t Character(const std::string& text, std::size_t at, std::uint32_t& code)
{
  const auto byte = [&](std::size_t i)
  { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U; };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80 ? 1
    : first >= 0xC2 && first < 0xE0       ? 2
    : first >= 0xE0 && first < 0xF0       ? 3
    : first >= 0xF0 && first < 0xF5       ? 4
                                          : 0;
  code = length < 2 ? first : first & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i)
  {
    if (!IsContinuation(static_cast<unsigned char>(byte(i))))
    {
      return 0;
    }
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return overlong || surrogate || code > 0x10FFFF ? 0 : length;
}

std::string Hexadecimal(std::uint32_t code, int digits)
{
  std::string text;
  for (int i = digits - 1; i >= 0; --i)
  {
    text += "0123456789abcdef"[code >> (4U * static_cast<unsigned>(i)) & 0xFU];
  }
  return text;
}

std::string Escaped(std::uint32_t code)
{
  switch (code)
  {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return code < 0x80 ? "\\x" + Hexadecimal(code, 2) : "\\u" + Hexadecimal(code, 4);
  }
}

/// Controls, and what makes text look like other text.
bool IsHidden(std::uint32_t code)
{
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200B && code <= 0x200F) ||
    (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}

/// First and last bytes of a text, cut between characters.
std::string Shortened(const std::string& text, std::size_t most)
{
  if (text.size() <= most)
  {
    return text;
  }
  const std::string gap = "...";
  std::size_t head = (most - gap.size()) / 2;
  std::size_t tail = text.size() - head;
  while (head > 0 && IsContinuation(static_cast<unsigned char>(text[head])))
  {
    --head;
  }
  while (tail < text.size() && IsContinuation(static_cast<unsigned char>(text[tail])))
  {
    ++tail;
  }
  return text.substr(0, head) + gap + text.substr(tail);
}
}

std::string OneLine(const std::string& message)
{
  std::string line;
  std::string word;
  for (std::size_t at = 0; at < message.size();)
  {
    std::uint32_t code = 0;
    const std::size_t length = Character(message, at, code);
    if (message[at] == ' ')
    {
      line += Shortened(word, MostOfWord) + ' ';
      word.clear();
    }
    else if (length == 0)
    {
      word += "\\x" + Hexadecimal(static_cast<unsigned char>(message[at]), 2);
    }
    else
    {
      word += IsHidden(code) ? Escaped(code) : message.substr(at, length);
    }
    at += length == 0 ? 1 : length;
  }
  return Shortened(line + Shortened(word, MostOfWord), MostOfMessage);
}
}
