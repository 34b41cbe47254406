// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace knotwork
{
/// What TetGen throws when it gives up: its number of the reason.
struct TetGenEnd
{
  int Reason = 0;
};
}
