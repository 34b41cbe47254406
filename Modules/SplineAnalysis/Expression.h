// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineAnalysis/ProblemDescription.h>

#include <map>

namespace knotwork
{
/// Functions that a problem names: at a position and a normal (3 coordinates each), up to three
/// values.
using ProblemFunction =
  std::function<void(const double* position, const double* normal, double* values)>;
using ProblemFunctions = std::map<std::string, ProblemFunction>;

/// Compiles an expression in x, y, z, nx, ny, nz, in the language of vtkExprTkFunctionParser, or
/// finds a function: "@name" is its first value, "@name.1" the second. @return InvalidParameter
/// with the expression, or with the names of the functions there are.
CompileExpression MakeCompiler(ProblemFunctions functions);
}
