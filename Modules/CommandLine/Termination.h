// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <filesystem>
#include <mutex>
#include <string>

/// SIGTERM, SIGINT and SIGHUP end the program at once: temporary folders are removed, one line says
/// so on stderr, and the exit status is 128 + the signal's number.
///
/// The signals are blocked in every thread before any library's code runs, those of libraries that
/// make threads while they are loaded included, and a thread of ours waits for them. So handlers
/// that libraries install (METIS, OpenCASCADE) are never called, and cleaning up may do whatever a
/// thread may do. A signal that is ignored when the program begins (nohup) stays ignored.
namespace knotwork::Termination
{
/// Begins to wait. @param job  is named in the line.
void Begin(const std::string& job);

/// While this is held, no signal ends the program: what is done is done whole. Every line about a
/// failure is printed under it, so that there are never two.
std::unique_lock<std::mutex> Hold();

/// The outputs are in their places: a signal is too late. @pre Hold() is held.
void SetDone();

/// Makes a folder of a name that ends in XXXXXX; it is removed when a signal comes.
Result<std::filesystem::path> MakeFolder(const std::filesystem::path& pattern);
void RemoveFolder(const std::filesystem::path& folder);
}
