// SPDX-License-Identifier: BSD-3-Clause
#include "OffFile.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include <fstream>
#include <sstream>
#include <vector>

namespace knotwork
{
namespace
{
/// The next line that holds more than a comment.
bool NextLine(std::ifstream& stream, std::istringstream& line)
{
  std::string text;
  while (std::getline(stream, text))
  {
    text = text.substr(0, text.find('#'));
    if (text.find_first_not_of(" \t\r") != std::string::npos)
    {
      line.clear();
      line.str(text);
      return true;
    }
  }
  return false;
}
}

Result<vtkSmartPointer<vtkPolyData>> ReadOffFile(const std::string& file)
{
  const auto damaged = [&file](const std::string& what) -> Result<vtkSmartPointer<vtkPolyData>> {
    return { ErrorCode::InvalidFormat, "'" + file + "': " + what };
  };
  std::ifstream stream(file);
  std::istringstream line;
  std::string word;
  if (!NextLine(stream, line) || !(line >> word) || (word != "OFF" && word != "COFF"))
  {
    return damaged("the first word of a mesh in text is OFF");
  }
  vtkIdType numPoints = -1;
  vtkIdType numFaces = -1;
  if (!(line >> numPoints)) // the numbers may follow on the same line
  {
    if (!NextLine(stream, line) || !(line >> numPoints))
    {
      return damaged("numbers of points and faces are missing");
    }
  }
  if (!(line >> numFaces) || numPoints < 0 || numFaces < 0)
  {
    return damaged("numbers of points and faces are missing");
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < numPoints; ++i)
  {
    double p[3];
    if (!NextLine(stream, line) || !(line >> p[0] >> p[1] >> p[2]))
    {
      return damaged("point " + std::to_string(i) + " of " + std::to_string(numPoints) +
        " is missing or no three numbers");
    }
    points->InsertNextPoint(p);
  }
  vtkNew<vtkCellArray> faces;
  std::vector<vtkIdType> corners;
  for (vtkIdType i = 0; i < numFaces; ++i)
  {
    vtkIdType count = 0;
    bool good = NextLine(stream, line) && (line >> count) && count > 0 && count <= numPoints;
    corners.clear();
    for (vtkIdType k = 0; k < count && good; ++k)
    {
      vtkIdType corner = -1;
      good = (line >> corner) && corner >= 0 && corner < numPoints;
      corners.push_back(corner);
    }
    if (!good)
    {
      return damaged("face " + std::to_string(i) + " of " + std::to_string(numFaces) +
        " is missing or has corners that are no points");
    }
    faces->InsertNextCell(count, corners.data());
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(faces);
  return mesh;
}
}
