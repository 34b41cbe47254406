// SPDX-License-Identifier: BSD-3-Clause
#include "CADOperationText.h"

#include <array>
#include <charconv>
#include <sstream>

namespace knotwork
{
namespace
{
constexpr CADOperationKind Kinds[] = { CADOperationKind::Imprint, CADOperationKind::CutByPlane,
  CADOperationKind::CutByFace, CADOperationKind::CutByCylinder, CADOperationKind::SplitByPlane,
  CADOperationKind::SplitByParameter, CADOperationKind::SplitByCurve, CADOperationKind::Composite,
  CADOperationKind::Heal };

/// What stands behind the first word: f faces, d direction of parameters, i number of a face, n
/// number.
const char* WordsOf(CADOperationKind kind)
{
  switch (kind)
  {
    case CADOperationKind::Imprint:
      return "";
    case CADOperationKind::CutByPlane:
      return "nnnnnn";
    case CADOperationKind::CutByFace:
      return "i";
    case CADOperationKind::CutByCylinder:
      return "nnnnnnn";
    case CADOperationKind::SplitByPlane:
      return "fnnnnnn";
    case CADOperationKind::SplitByParameter:
      return "fdn";
    case CADOperationKind::SplitByCurve:
    case CADOperationKind::Composite:
      return "f";
    case CADOperationKind::Heal:
      return "n";
  }
  return "";
}

template <typename Number>
bool Parse(const std::string& word, Number& number)
{
  const char* end = word.data() + word.size();
  const auto read = std::from_chars(word.data(), end, number);
  return read.ec == std::errc() && read.ptr == end;
}

bool ParseFaces(const std::string& word, std::vector<int>& faces)
{
  std::istringstream stream(word + ",");
  for (std::string part; std::getline(stream, part, ',');)
  {
    int id = 0;
    if (!Parse(part, id) || id < 0)
    {
      return false;
    }
    faces.push_back(id);
  }
  return true;
}

/// @param numbers  those of the words, in their order.
void SetNumbers(const std::vector<double>& numbers, CADOperation& operation)
{
  if (numbers.size() >= 6)
  {
    operation.Point = { numbers[0], numbers[1], numbers[2] };
    operation.Direction = { numbers[3], numbers[4], numbers[5] };
  }
  switch (operation.Kind)
  {
    case CADOperationKind::CutByCylinder:
      operation.Radius = numbers[6];
      break;
    case CADOperationKind::SplitByParameter:
      operation.Share = numbers[0];
      break;
    case CADOperationKind::Heal:
      operation.Tolerance = numbers[0];
      break;
    case CADOperationKind::Imprint:
    case CADOperationKind::CutByPlane:
    case CADOperationKind::CutByFace:
    case CADOperationKind::SplitByPlane:
    case CADOperationKind::SplitByCurve:
    case CADOperationKind::Composite:
      break;
  }
}
}

const char* NameOf(CADOperationKind kind)
{
  switch (kind)
  {
    case CADOperationKind::Imprint:
      return "imprint";
    case CADOperationKind::CutByPlane:
      return "cut-plane";
    case CADOperationKind::CutByFace:
      return "cut-face";
    case CADOperationKind::CutByCylinder:
      return "cut-cylinder";
    case CADOperationKind::SplitByPlane:
      return "split-plane";
    case CADOperationKind::SplitByParameter:
      return "split-iso";
    case CADOperationKind::SplitByCurve:
      return "split-curve";
    case CADOperationKind::Composite:
      return "composite";
    case CADOperationKind::Heal:
      return "heal";
  }
  return "";
}

Result<CADOperation> ParseCADOperation(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
  {
    words.push_back(word);
  }
  if (words.empty())
  {
    return { ErrorCode::EmptyInput, "an operation has no words; give one such as imprint" };
  }
  CADOperation operation;
  const char* wanted = nullptr;
  std::string names;
  for (CADOperationKind kind : Kinds)
  {
    names += std::string(names.empty() ? "" : ", ") + NameOf(kind);
    if (words[0] == NameOf(kind))
    {
      operation.Kind = kind;
      wanted = WordsOf(kind);
    }
  }
  if (!wanted)
  {
    return { ErrorCode::InvalidParameter,
      "'" + words[0] + "' is no operation; give one of " + names };
  }
  const std::string place = words[0] + ": ";
  const std::string kinds = wanted;
  if (words.size() != kinds.size() + 1)
  {
    return { ErrorCode::InvalidParameter,
      place + std::to_string(kinds.size()) + " words must follow, and not " +
        std::to_string(words.size() - 1) };
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < kinds.size(); ++i)
  {
    const std::string& word = words[i + 1];
    double number = 0.0;
    const char* missing = nullptr;
    switch (kinds[i])
    {
      case 'f':
        missing = ParseFaces(word, operation.Faces)
          ? nullptr
          : "is no list of faces; give ids such as 3 or 3,5,8";
        break;
      case 'd':
        missing =
          word == "u" || word == "v" ? nullptr : "is no direction; give u or v behind the faces";
        operation.IsoDirection = word == "u" ? 0 : 1;
        break;
      case 'i':
        missing = Parse(word, operation.Tool) ? nullptr : "is no id of a face";
        break;
      default:
        missing = Parse(word, number) ? nullptr : "is no number";
        numbers.push_back(number);
        break;
    }
    if (missing)
    {
      return { ErrorCode::InvalidParameter, place + "'" + word + "' " + missing };
    }
  }
  SetNumbers(numbers, operation);
  return operation;
}

std::string TextOf(const CADOperation& operation)
{
  std::string text = NameOf(operation.Kind);
  const auto add = [&](const std::string& word) { text += " " + word; };
  const auto addNumber = [&](double number)
  {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    add(std::string(digits.data(), end));
  };
  const auto addFrame = [&]
  {
    for (const Eigen::Vector3d& vector : { operation.Point, operation.Direction })
    {
      for (const double number : vector)
      {
        addNumber(number);
      }
    }
  };
  std::string faces;
  for (const int id : operation.Faces)
  {
    faces += (faces.empty() ? "" : ",") + std::to_string(id);
  }
  switch (operation.Kind)
  {
    case CADOperationKind::Imprint:
      break;
    case CADOperationKind::CutByPlane:
      addFrame();
      break;
    case CADOperationKind::CutByFace:
      add(std::to_string(operation.Tool));
      break;
    case CADOperationKind::CutByCylinder:
      addFrame();
      addNumber(operation.Radius);
      break;
    case CADOperationKind::SplitByPlane:
      add(faces);
      addFrame();
      break;
    case CADOperationKind::SplitByParameter:
      add(faces);
      add(operation.IsoDirection == 0 ? "u" : "v");
      addNumber(operation.Share);
      break;
    case CADOperationKind::SplitByCurve:
    case CADOperationKind::Composite:
      add(faces);
      break;
    case CADOperationKind::Heal:
      addNumber(operation.Tolerance);
      break;
  }
  return text;
}
}
