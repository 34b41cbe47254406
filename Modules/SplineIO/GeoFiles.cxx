// SPDX-License-Identifier: BSD-3-Clause
#include "GeoFiles.h"

#include <knotwork/SplineGrid/WorkerProcess.h>

#include <dlfcn.h>

namespace knotwork
{
namespace
{
constexpr const char* Library = "knotwork-gdal.so";

/// The library from where the programs of RunWorker are. It stays loaded.
const GeoFunctions* Load()
{
  const std::string path = PathOfWorkerScript(Library);
  void* library = path.empty() ? nullptr : dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = library ? dlsym(library, "KnotworkGeoFunctions") : nullptr;
  return function ? reinterpret_cast<decltype(&KnotworkGeoFunctions)>(function)() : nullptr;
}

/// Null: it is not there.
const GeoFunctions* Functions()
{
  static const GeoFunctions* const functions = Load();
  return functions;
}

Status NoFunctions()
{
  return { ErrorCode::LibraryError,
    std::string("the library ") + Library +
      ", or GDAL, is missing; install all of Knotwork, set KNOTWORK_WORKERS to its folder, or "
      "build it anew with the package libgdal-dev installed" };
}
}

Result<MapReferenceSystem> FindReferenceSystem(const std::string& text)
{
  return Functions() ? Functions()->FindSystem(text) : NoFunctions();
}

Result<std::shared_ptr<RasterSource>> OpenRaster(const std::string& file)
{
  return Functions() ? Functions()->Open(file) : NoFunctions();
}

Result<std::shared_ptr<RasterTarget>> CreateRaster(
  const std::string& file, const RasterGrid& grid, const RasterFormat& format)
{
  return Functions() ? Functions()->Create(file, grid, format) : NoFunctions();
}

Status WriteLineLayer(const LineLayer& layer, const std::string& file)
{
  return Functions() ? Functions()->WriteLines(layer, file) : NoFunctions();
}
}
