// SPDX-License-Identifier: BSD-3-Clause
#include "QuadriFlowProcess.h"

#include <knotwork/SplineCore/Numbers.h>

#include <fstream>

namespace knotwork
{
namespace
{
constexpr const char* Program = "blender";
constexpr const char* Script = "knotwork-quadriflow.py";
constexpr int SingleDigits = 9; ///< blender's points are single precision

/// The triangles as an OFF file. @return whether it could be written.
bool WriteTriangles(const std::string& file, const TriangleMesh& mesh)
{
  std::string text = "OFF\n" + std::to_string(mesh.Points.rows()) + " " +
    std::to_string(mesh.Triangles.size()) + " 0\n";
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      text += Digits(mesh.Points(i, k), SingleDigits) + (k < 2 ? ' ' : '\n');
    }
  }
  for (const auto& corners : mesh.Triangles)
  {
    text += '3';
    for (const int corner : corners)
    {
      text += ' ' + std::to_string(corner);
    }
    text += '\n';
  }
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  return static_cast<bool>(stream.flush());
}

/// An OFF file of faces as our script writes it.
/// @param most  points and faces. @return whether it is one.
bool ReadPolygons(const std::string& file, int most, PolygonMesh& mesh)
{
  std::ifstream stream(file);
  std::string word;
  int numPoints = -1;
  int numFaces = -1;
  int numEdges = -1;
  stream >> word >> numPoints >> numFaces >> numEdges;
  if (!stream || word != "OFF" || numPoints < 0 || numFaces < 0 || numPoints > most ||
    numFaces > most)
  {
    return false;
  }
  mesh.Points.resize(numPoints, 3);
  for (Eigen::Index i = 0; i < mesh.Points.size() && stream; ++i)
  {
    stream >> mesh.Points.data()[i];
  }
  mesh.Faces.resize(static_cast<std::size_t>(numFaces));
  constexpr int MostCorners = 1000;
  for (std::vector<int>& face : mesh.Faces)
  {
    int corners = -1;
    stream >> corners;
    if (!stream || corners < 0 || corners > MostCorners)
    {
      return false;
    }
    face.resize(static_cast<std::size_t>(corners));
    for (int& corner : face)
    {
      stream >> corner;
    }
  }
  return static_cast<bool>(stream);
}

std::string HowItEnded(const ProgramAnswer& answer, const WorkerLimits& limits)
{
  switch (answer.End)
  {
    case WorkerEnd::Late:
      return "blender did not end within " + std::to_string(limits.Seconds) +
        " s (TimeLimit allows more)";
    case WorkerEnd::OutOfMemory:
      return "blender asked for more than " + std::to_string(limits.Memory >> 20U) +
        " MB (MemoryLimit allows more)";
    default:
      return "blender crashed";
  }
}
}

Result<PolygonMesh> RunQuadriFlow(const TriangleMesh& mesh, const QuadRequest& request, int threads,
  const WorkerLimits& limits, const std::function<bool()>& goOn)
{
  const std::string script = PathOfWorkerScript(Script);
  if (script.empty())
  {
    return { ErrorCode::LibraryError,
      std::string("the script ") + Script +
        " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
  }
  const TemporaryFolder folder;
  const std::string given = folder.Path() + "/triangles.off";
  const std::string made = folder.Path() + "/faces.off";
  if (folder.Path().empty() || !WriteTriangles(given, mesh))
  {
    return {
      ErrorCode::FileError,
      "no files for blender could be written; make room in the folder for temporary files (TMPDIR)"
    };
  }
  const ProgramAnswer answer = RunForeignProgram(Program,
    { "--background", "--factory-startup", "-noaudio", "--threads", std::to_string(threads),
      "--python-exit-code", "1", "--python", script, "--", given, made,
      std::to_string(request.Faces), request.KeepSharp ? "1" : "0" },
    folder.Path(), limits, goOn);
  switch (answer.End)
  {
    case WorkerEnd::Done:
      break;
    case WorkerEnd::Missing:
      return { ErrorCode::LibraryError,
        "the program blender, which makes the quadrilaterals, is not on PATH; install it (Debian's "
        "package blender)" };
    case WorkerEnd::NotStarted:
      return { ErrorCode::LibraryError, "blender could not be started; end other programs" };
    case WorkerEnd::Aborted:
      return { ErrorCode::Aborted, "" };
    case WorkerEnd::Late:
    case WorkerEnd::OutOfMemory:
      return { ErrorCode::TooLarge, HowItEnded(answer, limits) };
    default:
      return { ErrorCode::NotConverged, HowItEnded(answer, limits) };
  }
  if (answer.ExitStatus != 0)
  {
    return { ErrorCode::NotConverged,
      "blender ended with status " + std::to_string(answer.ExitStatus) };
  }
  PolygonMesh found;
  const int most = 50 * request.Faces + static_cast<int>(mesh.Triangles.size());
  if (!ReadPolygons(made, most, found))
  {
    return { ErrorCode::NotConverged, "blender wrote no faces that can be read" };
  }
  return found;
}
}
