// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineAnalysis/ProblemDescription.h>

namespace knotwork
{
/// Compiles an expression in x, y, z, nx, ny, nz, in the language of vtkExprTkFunctionParser.
/// @return InvalidParameter with the expression.
Result<ScalarFunction> CompileWithVtk(const std::string& text);
}
