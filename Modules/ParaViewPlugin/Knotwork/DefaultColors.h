// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace knotwork
{
/// Gives ParaView the colours that arrays of Knotwork have until the user chooses others: those of
/// `JacobianVerdict`. Called when the plugin is loaded.
void LoadDefaultColors();
}
