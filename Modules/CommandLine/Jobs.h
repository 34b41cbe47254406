// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Status.h"

#include <functional>

namespace CLI
{
class App;
}

namespace knotwork
{
class Session;

/// What a job does once its options are parsed.
using Job = std::function<Status(Session&)>;

/// Each adds the options of one job to its subcommand and returns the job.
Job MakeCombineJob(CLI::App& app);
Job MakeContourJob(CLI::App& app);
Job MakeConvertJob(CLI::App& app);
Job MakeCropJob(CLI::App& app);
Job MakeDistanceJob(CLI::App& app);
Job MakeEvaluateJob(CLI::App& app);
Job MakeExtremaJob(CLI::App& app);
Job MakeExtractJob(CLI::App& app);
Job MakeFitJob(CLI::App& app);
Job MakeFlattenJob(CLI::App& app);
Job MakeInfoJob(CLI::App& app);
Job MakeMapJob(CLI::App& app);
Job MakeParameterizeJob(CLI::App& app);
Job MakeRefineJob(CLI::App& app);
Job MakeSourceJob(CLI::App& app);
Job MakeStitchJob(CLI::App& app);
Job MakeTessellateJob(CLI::App& app);
Job MakeTrimJob(CLI::App& app);
Job MakeValidateJob(CLI::App& app);
Job MakeWarpJob(CLI::App& app);
}
