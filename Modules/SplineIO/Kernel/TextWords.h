// SPDX-License-Identifier: BSD-3-Clause
// Words and numbers of text formats, independent of the locale.
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace knotwork
{
/// The words of a text, separated by white space, with their places.
class WordScanner
{
public:
  explicit WordScanner(std::string_view text, std::size_t firstLine = 1)
    : Text(text), CurrentLine(firstLine)
  {
  }
  /// Skips white space. @return whether there is no further word.
  bool AtEnd();
  /// The next word; empty at the end.
  std::string_view Next();
  /// Line and number (from 1) of the word that Next gave last.
  std::size_t Line() const { return this->CurrentLine; }
  std::size_t Count() const { return this->Words; }
  /// Most words that can follow.
  std::size_t Remaining() const { return (this->Text.size() - this->Position + 1) / 2; }

private:
  std::string_view Text;
  std::size_t Position = 0;
  std::size_t CurrentLine;
  std::size_t Words = 0;
};

/// The lines of a text that hold words, without comments, with their places.
class LineScanner
{
public:
  /// @param comment  from this character on a line is a comment.
  LineScanner(std::string_view text, char comment) : Text(text), Comment(comment) {}
  /// The next line with words, scanned by Words(). @return whether there is one.
  bool Next();
  WordScanner& Words() { return this->CurrentWords; }
  /// Number (from 1) of the current line; after the last one that of the text's end.
  std::size_t Line() const { return this->CurrentLine; }

private:
  std::string_view Text;
  char Comment;
  std::size_t Position = 0;
  std::size_t CurrentLine = 0;
  WordScanner CurrentWords{ {} };
};

/// A word as messages show it: in quotes, shortened, without control characters.
std::string Shown(std::string_view word);

/// A finite number. @return InvalidFormat or NonFiniteInput that shows the word.
Status ParseReal(std::string_view word, double& value);
/// The same with the range and precision of long double.
Status ParseReal(std::string_view word, long double& value);
/// An integer in [lowest, highest]. @return InvalidFormat that shows the word and the range.
Status ParseInteger(std::string_view word, long long lowest, long long highest, long long& value);

/// Appends the fewest digits that ParseReal turns into the same number.
void AppendReal(std::string& text, double value);
/// Appends at most 17 digits of a number c such that Quotient(c, weight) is the value.
void AppendProduct(std::string& text, double value, double weight);
inline double Quotient(long double product, double weight)
{
  return static_cast<double>(product / static_cast<long double>(weight));
}
}
