// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-modify-cad PARENT BYTES SECONDS FILE OUTPUT
// Modifies STEP files by OpenCASCADE for another process, see WorkerMain.h.
#include "ModifyParts.h"
#include <knotwork/SplineGrid/WorkerMain.h>

namespace
{
using namespace knotwork;

Status Modify(const Parts& words, const Parts& input, Parts& found)
{
  if (words.size() != 2)
  {
    return { ErrorCode::InvalidParameter, "file or output is missing" };
  }
  const auto task = TakeTask(input);
  if (!task)
  {
    return task.Status;
  }
  const auto made = ModifyCADText(words[0], words[1], task->Operations, task->Params);
  if (made)
  {
    AppendModified(made.Value, found);
  }
  return made.Status;
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Modify);
}
