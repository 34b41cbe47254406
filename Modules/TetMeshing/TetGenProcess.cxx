// SPDX-License-Identifier: BSD-3-Clause
#include "TetGenProcess.h"

#include "TetGenParts.h"
#include <knotwork/SplineCore/Numbers.h>

namespace knotwork
{
namespace
{
constexpr const char* Program = "knotwork-tetgen";
constexpr const char* Remedy =
  "; repair the surface, or give it better triangles or other bounds of quality";

std::string SwitchesOf(const TetrahedraParams& params)
{
  std::string switches = "pzQ"; // a surface; numbers from 0 on; quiet
  switches += params.KeepBoundary ? "Y" : "";
  if (params.RadiusEdgeRatio > 0.0 || params.MinDihedralAngle > 0.0 || params.MaxVolume > 0.0)
  {
    // a ratio that is no bound, for TetGen has one of its own where none is given
    switches += "q" + Digits(params.RadiusEdgeRatio > 0.0 ? params.RadiusEdgeRatio : 1e3, 10) +
      "/" + Digits(params.MinDihedralAngle, 10);
  }
  if (params.MaxVolume > 0.0)
  {
    switches += "a" + Digits(params.MaxVolume, 10);
  }
  switches += "S" + std::to_string(params.MaxSteinerPoints);
  return switches;
}

template <std::size_t N>
std::vector<std::array<int, N>> Groups(const std::string& part)
{
  const std::vector<int> numbers = UnpackNumbers<int>(part);
  std::vector<std::array<int, N>> groups(numbers.size() / N);
  for (std::size_t i = 0; i < groups.size() * N; ++i)
  {
    groups[i / N][i % N] = numbers[i];
  }
  return groups;
}

Result<Tetrahedra> Decode(const std::vector<std::string>& parts)
{
  const auto part = [&](TetGenAnswer which) -> const std::string&
  { return parts[static_cast<std::size_t>(which)]; };
  if (parts.size() != static_cast<std::size_t>(TetGenAnswer::Count))
  {
    return { ErrorCode::LibraryError, std::string(Program) + " is of another version" };
  }
  Tetrahedra found;
  const std::vector<double> points = UnpackNumbers<double>(part(TetGenAnswer::Points));
  found.Points =
    Eigen::Map<const PointMatrix>(points.data(), static_cast<Eigen::Index>(points.size() / 3), 3);
  found.Cells = Groups<4>(part(TetGenAnswer::Tetrahedra));
  found.Triangles = Groups<3>(part(TetGenAnswer::Triangles));
  found.Sources = UnpackNumbers<int>(part(TetGenAnswer::Sources));
  return found;
}
}

Result<Tetrahedra> RunTetGen(const TriangleMesh& surface, const TetrahedraParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn)
{
  const std::vector<std::string> input{ PackNumbers(surface.Points.data(),
                                          static_cast<std::size_t>(surface.Points.size())),
    PackNumbers(surface.Triangles.data()->data(), 3 * surface.Triangles.size()) };
  const WorkerAnswer answer = RunWorker(Program, { SwitchesOf(params) }, input, limits, goOn);
  switch (answer.End)
  {
    case WorkerEnd::Done:
      return answer.Outcome ? Decode(answer.Parts)
                            : Result<Tetrahedra>(answer.Outcome.Code,
                                "TetGen refuses the surface: " + answer.Outcome.Detail + Remedy);
    case WorkerEnd::Missing:
      return { ErrorCode::LibraryError,
        std::string("the program ") + Program +
          " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
    case WorkerEnd::NotStarted:
      return { ErrorCode::LibraryError,
        "no process could be started for TetGen; end other programs" };
    case WorkerEnd::Late:
      return { ErrorCode::NotConverged,
        "TetGen did not end within " + std::to_string(limits.Seconds) +
          " s; raise TimeLimit, or ask for less quality or fewer points" };
    case WorkerEnd::OutOfMemory:
      return { ErrorCode::TooLarge,
        "TetGen asked for more than " + std::to_string(limits.Memory >> 20U) +
          " MB; raise MemoryLimit, or ask for larger tetrahedra" };
    case WorkerEnd::Aborted:
      return { ErrorCode::Aborted, "" };
    case WorkerEnd::Crashed:
      break;
  }
  return { ErrorCode::LibraryError, std::string("TetGen crashed on the surface") + Remedy };
}
}
