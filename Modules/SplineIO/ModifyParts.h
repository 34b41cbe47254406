// SPDX-License-Identifier: BSD-3-Clause
// Operations on CAD files and what they did, as parts for another process.
#pragma once
#include <knotwork/CADModel/CADModify.h>

namespace knotwork
{
struct ModifyTask
{
  std::vector<CADOperation> Operations;
  CADModifyParams Params;
};

void AppendTask(const ModifyTask& task, std::vector<std::string>& parts);
/// @return InvalidFormat: the parts are no task.
Result<ModifyTask> TakeTask(const std::vector<std::string>& parts);

void AppendModified(const ModifiedCAD& made, std::vector<std::string>& parts);
/// @return InvalidFormat: the parts are no such thing.
Result<ModifiedCAD> TakeModified(const std::vector<std::string>& parts);
}
