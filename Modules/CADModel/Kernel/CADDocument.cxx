// SPDX-License-Identifier: BSD-3-Clause
#include "CADDocument.h"

#include <Quantity_Color.hxx>
#include <TDataStd_Name.hxx>
#include <XCAFDoc_DocumentTool.hxx>

#include <algorithm>

namespace knotwork
{
Handle(TDocStd_Document) NewDocument()
{
  Handle(TDocStd_Document) document = new TDocStd_Document("Knotwork");
  XCAFDoc_DocumentTool::Set(document->Main(), false);
  return document;
}

std::string NameOf(const TDF_Label& label)
{
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name))
  {
    return {};
  }
  const TCollection_ExtendedString& text = name->Get();
  std::string utf8(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  Standard_PCharacter out = utf8.data();
  utf8.resize(static_cast<std::size_t>(text.ToUTF8CString(out)));
  return utf8;
}

void SetName(const TDF_Label& label, const std::string& utf8)
{
  TDataStd_Name::Set(label, TCollection_ExtendedString(utf8.c_str(), true));
}

std::optional<std::array<double, 3>> ColorOf(
  const Handle(XCAFDoc_ColorTool) & colors, const TDF_Label& label)
{
  Quantity_Color color;
  if (colors->GetColor(label, XCAFDoc_ColorSurf, color) ||
    colors->GetColor(label, XCAFDoc_ColorGen, color))
  {
    std::array<double, 3> rgb{};
    color.Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
    return rgb;
  }
  return {};
}

void SetColor(const Handle(XCAFDoc_ColorTool) & colors, const TDF_Label& label,
  const std::array<double, 3>& color)
{
  const auto share = [&](std::size_t c) { return std::min(std::max(color[c], 0.0), 1.0); };
  colors->SetColor(
    label, Quantity_Color(share(0), share(1), share(2), Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
}
}
