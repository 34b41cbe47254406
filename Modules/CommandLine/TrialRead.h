// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Status.h"

#include <functional>
#include <string>

namespace knotwork
{
/// Runs a reader in a child process first: VTK's readers of meshes and OpenCASCADE's crash on some
/// damaged files or never end, and their libraries print on stderr. A crash, more than a minute and
/// one a megabyte, or text that `read` prints there is an error that names the file.
/// @complexity that of the reader
Status TrialRead(const std::string& file, const std::function<void()>& read);
}
