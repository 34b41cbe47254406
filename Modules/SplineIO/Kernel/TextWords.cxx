// SPDX-License-Identifier: BSD-3-Clause
#include "TextWords.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace knotwork
{
namespace
{
bool IsSpace(char c)
{
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

template <typename Number>
Status ParseFinite(std::string_view word, Number& value)
{
  std::string_view digits = word;
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-')
  {
    digits.remove_prefix(1); // which from_chars does not take
  }
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error == std::errc::invalid_argument || stop != end)
  {
    return { ErrorCode::InvalidFormat, Shown(word) + " is not a number" };
  }
  if (error != std::errc())
  {
    return { ErrorCode::InvalidFormat,
      Shown(word) + " is outside the range of double-precision numbers" };
  }
  if (!std::isfinite(value))
  {
    return { ErrorCode::NonFiniteInput, Shown(word) + " is not a finite number" };
  }
  return {};
}

/// Whether the text of a product stands for the value.
bool Gives(const char* begin, const char* end, double value, double weight)
{
  long double product = 0.0L;
  return ParseFinite(std::string_view(begin, static_cast<std::size_t>(end - begin)), product) &&
    Quotient(product, weight) == value;
}
}

bool WordScanner::AtEnd()
{
  while (this->Position < this->Text.size() && IsSpace(this->Text[this->Position]))
  {
    this->CurrentLine += this->Text[this->Position] == '\n' ? 1 : 0;
    ++this->Position;
  }
  return this->Position == this->Text.size();
}

std::string_view WordScanner::Next()
{
  if (this->AtEnd())
  {
    return {};
  }
  const std::size_t begin = this->Position;
  while (this->Position < this->Text.size() && !IsSpace(this->Text[this->Position]))
  {
    ++this->Position;
  }
  ++this->Words;
  return this->Text.substr(begin, this->Position - begin);
}

bool LineScanner::Next()
{
  while (this->Position < this->Text.size())
  {
    const std::size_t end = std::min(this->Text.find('\n', this->Position), this->Text.size());
    std::string_view line = this->Text.substr(this->Position, end - this->Position);
    this->Position = end + 1;
    ++this->CurrentLine;
    line = line.substr(0, line.find(this->Comment));
    this->CurrentWords = WordScanner(line, this->CurrentLine);
    if (!this->CurrentWords.AtEnd())
    {
      return true;
    }
  }
  return false;
}

std::string Shown(std::string_view word)
{
  constexpr std::size_t longest = 24;
  std::string text = "'";
  for (char c : word.substr(0, longest))
  {
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text + (word.size() > longest ? "...'" : "'");
}

Status ParseReal(std::string_view word, double& value)
{
  return ParseFinite(word, value);
}

Status ParseReal(std::string_view word, long double& value)
{
  // libstdc++ 12 reads beyond the end of a word that begins as "nan" or "inf" do
  const std::size_t first = word.find_first_not_of("+-");
  if (first == std::string_view::npos ||
    std::string_view("0123456789.").find(word[first]) == std::string_view::npos)
  {
    double other = 0.0;
    const Status status = ParseFinite(word, other);
    value = other;
    return status;
  }
  return ParseFinite(word, value);
}

Status ParseInteger(std::string_view word, long long lowest, long long highest, long long& value)
{
  std::string_view digits = word;
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-')
  {
    digits.remove_prefix(1);
  }
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument)
  {
    return { ErrorCode::InvalidFormat, Shown(word) + " is not an integer" };
  }
  if (error != std::errc() || value < lowest || value > highest)
  {
    return { ErrorCode::InvalidFormat,
      Shown(word) + " is outside " + std::to_string(lowest) + " to " + std::to_string(highest) };
  }
  return {};
}

void AppendReal(std::string& text, double value)
{
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), result.ptr);
}

void AppendProduct(std::string& text, double value, double weight)
{
  if (weight == 1.0)
  {
    AppendReal(text, value);
    return;
  }
  std::array<char, 64> buffer;
  char* const begin = buffer.data();
  char* const limit = begin + buffer.size();
  // Decimals of 15 digits are far enough apart that the first one that fits is what another program
  // wrote with as many digits; those of 17 are closer together than the quotients are.
  const long double product = static_cast<long double>(value) * static_cast<long double>(weight);
  char* end = begin;
  for (int digits = 15; digits <= 17; ++digits)
  {
    end = std::to_chars(begin, limit, product, std::chars_format::general, digits).ptr;
    if (Gives(begin, end, value, weight))
    {
      break;
    }
  }
  text.append(begin, end);
}
}
