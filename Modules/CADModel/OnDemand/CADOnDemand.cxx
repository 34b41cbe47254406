// SPDX-License-Identifier: BSD-3-Clause
// In place of those of the kernel: functions that load OpenCASCADE, some sixty libraries and 0.1 s,
// when the first of them is called.
#include "CADFunctions.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <dlfcn.h>

namespace knotwork
{
namespace
{
constexpr const char* Library = "knotwork-opencascade.so";

/// Folders of this library and of the program, which a shell may have found by its name alone.
std::vector<std::string> OwnFolders()
{
  Dl_info own{};
  const bool found = dladdr(reinterpret_cast<const void*>(&OwnFolders), &own) != 0;
  std::error_code ignored;
  std::vector<std::string> folders;
  for (const std::string& file : { std::string(found && own.dli_fname ? own.dli_fname : ""),
         std::filesystem::read_symlink("/proc/self/exe", ignored).string() })
  {
    if (const std::size_t end = file.rfind('/'); end != std::string::npos)
    {
      folders.push_back(file.substr(0, end + 1));
    }
  }
  return folders;
}

/// The library from the folder that KNOTWORK_WORKERS names, else from beside this one or from the
/// folder of the other programs. It stays loaded.
const CADFunctions* Load()
{
  const char* chosen = std::getenv("KNOTWORK_WORKERS");
  std::vector<std::string> places;
  if (chosen && *chosen)
  {
    places.emplace_back(chosen);
  }
  else
  {
    for (const std::string& folder : OwnFolders())
    {
      places.push_back(folder);
      places.push_back(folder + KNOTWORK_WORKER_FOLDER);
      places.push_back(folder + "../libexec/knotwork");
    }
  }
  for (const std::string& place : places)
  {
    void* library = dlopen((place + "/" + Library).c_str(), RTLD_NOW | RTLD_LOCAL);
    void* function = library ? dlsym(library, "KnotworkCADFunctions") : nullptr;
    if (function)
    {
      return reinterpret_cast<decltype(&KnotworkCADFunctions)>(function)();
    }
  }
  return nullptr;
}

/// Null: it is not there.
const CADFunctions* Functions()
{
  static const CADFunctions* const functions = Load();
  return functions;
}

Status NoFunctions()
{
  return { ErrorCode::LibraryError,
    std::string("the library ") + Library +
      ", or OpenCASCADE, is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its "
      "folder" };
}
}

Result<CADContents> ReadCAD(const std::string& file, const CADReadParams& params)
{
  return Functions() ? Functions()->Read(file, params) : NoFunctions();
}

Status WriteCAD(const TrimmedModel& model, const std::string& file, const CADWriteParams& params)
{
  return Functions() ? Functions()->Write(model, file, params) : NoFunctions();
}

Result<CADSummary> CheckCAD(const std::string& file, LengthUnit unit, bool volume)
{
  return Functions() ? Functions()->Check(file, unit, volume) : NoFunctions();
}

Result<CADSummary> CheckWrittenCAD(const TrimmedModel& model, const std::string& file)
{
  return Functions() ? Functions()->CheckWritten(model, file) : NoFunctions();
}

Result<ModifiedCAD> ModifyCADText(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params)
{
  return Functions() ? Functions()->ModifyText(file, output, operations, params) : NoFunctions();
}

Result<CADSuggestions> SuggestCADOperations(const std::string& file, const CADSuggestParams& params)
{
  return Functions() ? Functions()->Suggest(file, params) : NoFunctions();
}

Result<CADTopology> CADTopology::Read(const std::string& file, LengthUnit unit)
{
  return Functions() ? Functions()->ReadTopology(file, unit) : NoFunctions();
}

// a topology has been read, so the functions are there

std::vector<std::string> CADTopology::JoinComposites(const CADFlattening& flatten)
{
  return (this->*Functions()->JoinComposites)(flatten);
}

Result<std::vector<std::array<int, 2>>> CADTopology::TouchingSolids() const
{
  return (this->*Functions()->TouchingSolids)();
}

Eigen::Vector3d CADTopology::EdgePoint(int edge, double share) const
{
  return (this->*Functions()->EdgePoint)(edge, share);
}

Eigen::Vector2d CADTopology::UseParameters(int face, int loop, int use, double share) const
{
  return (this->*Functions()->UseParameters)(face, loop, use, share);
}

Eigen::Vector3d CADTopology::FacePoint(int face, const Eigen::Vector2d& parameters) const
{
  return (this->*Functions()->FacePoint)(face, parameters);
}

Eigen::Vector3d CADTopology::FaceNormal(int face, const Eigen::Vector2d& parameters) const
{
  return (this->*Functions()->FaceNormal)(face, parameters);
}

double CADTopology::FaceCurvature(int face, const Eigen::Vector2d& parameters) const
{
  return (this->*Functions()->FaceCurvature)(face, parameters);
}

CADPlace CADTopology::Project(
  int face, const Eigen::Vector3d& point, const Eigen::Vector2d& guess) const
{
  return (this->*Functions()->Project)(face, point, guess);
}

Result<CADPieces> CADPieces::Read(const std::string& file, LengthUnit unit)
{
  return Functions() ? Functions()->ReadPieces(file, unit) : NoFunctions();
}

// pieces have been read

Result<CADTopology> CADPieces::Topology() const
{
  return (this->*Functions()->TopologyOfPieces)();
}

Result<std::vector<CADOperation>> CADPieces::Cuts() const
{
  return (this->*Functions()->CutsOfPieces)();
}

Result<CADPieces> CADPieces::Cut(const CADOperation& operation) const
{
  return (this->*Functions()->CutPieces)(operation);
}
}
