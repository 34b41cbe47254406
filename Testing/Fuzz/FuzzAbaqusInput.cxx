// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzElementMesh.h"
#include <knotwork/SplineIO/AbaqusInput.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  CheckElementMesh(ReadAbaqusInput({ reinterpret_cast<const char*>(data), size }));
  return 0;
}
