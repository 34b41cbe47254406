// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADModel/CADExchange.h>

#include <string>
#include <vector>

namespace knotwork
{
/// The fewest digits that give the same number again, whatever the locale.
std::string ExactText(double value);
double ExactNumber(const std::string& text);

/// What a STEP or IGES file holds for another process: exact, edges and vertices numbered in the
/// order of their first use. @return failures of TrimmedModel::Check.
Status AppendCAD(const CADContents& contents, std::vector<std::string>& parts);

/// The contents of such parts. @return failures of DecodeTrimmedModel.
Result<CADContents> TakeCAD(std::vector<std::string>& parts);
}
