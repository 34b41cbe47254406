// SPDX-License-Identifier: BSD-3-Clause
#include "Expression.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkExprTkFunctionParser.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

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
}

Result<ScalarFunction> CompileWithVtk(const std::string& text)
{
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
