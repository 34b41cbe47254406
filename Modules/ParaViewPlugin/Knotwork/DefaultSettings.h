// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace knotwork
{
/// Gives ParaView what it has until the user chooses otherwise: the colours of `JacobianVerdict`
/// and `SurfaceType`, and smooth Bezier cells. Called when the plugin is loaded.
void LoadDefaultSettings();
}
