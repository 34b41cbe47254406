// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFDoc_ColorTool.hxx>

#include <array>
#include <iosfwd>
#include <optional>
#include <string>

namespace knotwork
{
/// An empty document of shapes with names and colours.
Handle(TDocStd_Document) NewDocument();

/// UTF-8; empty: none.
std::string NameOf(const TDF_Label& label);
void SetName(const TDF_Label& label, const std::string& utf8);

/// sRGB, of surfaces before that of all.
std::optional<std::array<double, 3>> ColorOf(
  const Handle(XCAFDoc_ColorTool) & colors, const TDF_Label& label);
void SetColor(const Handle(XCAFDoc_ColorTool) & colors, const TDF_Label& label,
  const std::array<double, 3>& color);

/// The text of a STEP file with the settings of the session: the same document is the same text.
/// @param description  in its header.
bool WriteSTEP(
  const Handle(TDocStd_Document) & document, const char* description, std::ostream& stream);
}
