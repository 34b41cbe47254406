// SPDX-License-Identifier: BSD-3-Clause
#include "Expression.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkExprTkFunctionParser.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <array>
#include <cctype>

namespace knotwork
{
namespace
{
double Evaluate(vtkExprTkFunctionParser* parser, const double* x, const double* normal)
{
  for (int d = 0; d < 3; ++d)
  {
    parser->SetScalarVariableValue(d, x[d]);
    parser->SetScalarVariableValue(3 + d, normal[d]);
  }
  return parser->GetScalarResult();
}

Result<ScalarFunction> FindFunction(const ProblemFunctions& functions, const std::string& text)
{
  const std::size_t dot = text.rfind('.');
  const std::string name = text.substr(1, dot == std::string::npos ? dot : dot - 1);
  const std::string component = dot == std::string::npos ? "0" : text.substr(dot + 1);
  const auto found = functions.find(name);
  if (found == functions.end() || component.size() != 1 || component < "0" || component > "2")
  {
    std::string known;
    for (const auto& [key, function] : functions)
    {
      known += (known.empty() ? "" : ", ") + key;
    }
    return { ErrorCode::InvalidParameter,
      "\"" + text + "\" is no function of the problem; " +
        (known.empty() ? "it has none" : "it has " + known) };
  }
  return ScalarFunction(
    [function = found->second, at = static_cast<std::size_t>(component[0] - '0')](
      const double* x, const double* normal)
    {
      std::array<double, 3> values{};
      function(x, normal, values.data());
      return values[at];
    });
}

/// Whether a text has one of the parser's loops, which need not end.
bool HasLoop(const std::string& text)
{
  std::string word;
  for (const char c : text + ' ')
  {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '_')
    {
      word += static_cast<char>(std::tolower(byte));
      continue;
    }
    if (word == "while" || word == "for" || word == "repeat")
    {
      return true;
    }
    word.clear();
  }
  return false;
}

Result<ScalarFunction> CompileWithVtk(const std::string& text)
{
  if (HasLoop(text))
  {
    return { ErrorCode::InvalidParameter,
      "\"" + text + "\" has a loop, which an expression cannot have; write a sum, or use Python" };
  }
  auto parser = vtkSmartPointer<vtkExprTkFunctionParser>::New();
  // its messages become ours
  vtkNew<vtkCallbackCommand> quiet;
  quiet->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  parser->AddObserver(vtkCommand::ErrorEvent, quiet);
  parser->SetFunction(text.c_str());
  // one that is a number somewhere will do: sqrt(-x) is none at many places
  bool isNumber = false;
  for (const double at : { 0.5, -0.7, 2.0 })
  {
    for (const char* name : { "x", "y", "z", "nx", "ny", "nz" })
    {
      parser->SetScalarVariableValue(name, at);
    }
    isNumber = isNumber || parser->IsScalarResult();
  }
  if (!isNumber)
  {
    return { ErrorCode::InvalidParameter,
      "\"" + text + "\" is no expression of a number in x, y, z and, of loads, nx, ny, nz" };
  }
  return ScalarFunction(
    [parser](const double* x, const double* normal) { return Evaluate(parser, x, normal); });
}
}

CompileExpression MakeCompiler(ProblemFunctions functions)
{
  return [functions = std::move(functions)](const std::string& text)
  { return text[0] == '@' ? FindFunction(functions, text) : CompileWithVtk(text); };
}
}
