// SPDX-License-Identifier: BSD-3-Clause
// A square as text of GoTools.
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineIO/GoToolsG2.h>

int main()
{
  const auto square = knotwork::MakeShape({});
  const auto text = knotwork::WriteG2(square.Value);
  return text && knotwork::ReadG2(text.Value) ? 0 : 1;
}
