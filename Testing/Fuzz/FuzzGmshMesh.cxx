// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzElementMesh.h"
#include <knotwork/SplineIO/GmshMesh.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  const Result<ElementMesh> mesh = ReadGmshMesh({ reinterpret_cast<const char*>(data), size });
  CheckElementMesh(mesh);
  if (!mesh)
  {
    return 0;
  }
  const Result<std::string> text = WriteGmshMesh(mesh.Value, size % 2 == 0);
  if (text && ReadGmshMesh(text.Value)->Nodes != mesh->Nodes)
  {
    std::abort();
  }
  return 0;
}
