// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-tetgen PARENT BYTES SECONDS SWITCHES
// Tetrahedra within triangles by TetGen for another process, see WorkerMain.h and TetGenParts.h.
#include "TetGenEnd.h"
#include "TetGenParts.h"
#include <knotwork/SplineGrid/WorkerMain.h>

#define TETLIBRARY
#include <tetgen.h>

#include <new>

namespace
{
using namespace knotwork;

const std::string& PartOf(const Parts& parts, TetGenInput which)
{
  return parts[static_cast<std::size_t>(which)];
}

/// Arrays of tetgenio are its own: it deletes them.
void Fill(const std::vector<double>& points, const std::vector<int>& corners, tetgenio& input)
{
  input.firstnumber = 0;
  input.numberofpoints = static_cast<int>(points.size() / 3);
  input.pointlist = new double[points.size()];
  std::copy(points.begin(), points.end(), input.pointlist);
  input.numberoffacets = static_cast<int>(corners.size() / 3);
  input.facetlist = new tetgenio::facet[corners.size() / 3];
  input.facetmarkerlist = new int[corners.size() / 3];
  for (int f = 0; f < input.numberoffacets; ++f)
  {
    tetgenio::facet& facet = input.facetlist[f];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    std::copy(corners.begin() + 3 * f, corners.begin() + 3 * f + 3, facet.polygonlist->vertexlist);
    input.facetmarkerlist[f] = f + 1; // 0 is none
  }
}

Status Reason(int number)
{
  switch (number)
  {
    case 1:
      throw std::bad_alloc();
    case 3:
      return { ErrorCode::InvalidTopology, "facets of the surface intersect" };
    case 4:
      return { ErrorCode::InvalidTopology,
        "parts of the surface are nearer to each other than TetGen can tell apart" };
    case 5:
      return { ErrorCode::InvalidTopology, "facets of the surface overlap" };
    default:
      return { ErrorCode::LibraryError, "TetGen met an error of its own" };
  }
}

Status Run(const Parts& words, const Parts& input, Parts& found)
{
  if (words.size() != 1 || input.size() != static_cast<std::size_t>(TetGenInput::Count))
  {
    return { ErrorCode::InvalidParameter, "switches, points and triangles are needed" };
  }
  tetgenio in;
  tetgenio out;
  Fill(UnpackNumbers<double>(PartOf(input, TetGenInput::Points)),
    UnpackNumbers<int>(PartOf(input, TetGenInput::Triangles)), in);
  try
  {
    std::string switches = words[0];
    tetrahedralize(switches.data(), &in, &out);
  }
  catch (const TetGenEnd& end)
  {
    return Reason(end.Reason);
  }
  if (out.numberofcorners != 4 || (out.numberoftrifaces > 0 && !out.trifacemarkerlist))
  {
    return { ErrorCode::LibraryError, "TetGen hands over no tetrahedra of four corners" };
  }
  const auto count = [](int n, int of)
  { return static_cast<std::size_t>(n) * static_cast<std::size_t>(of); };
  std::vector<int> sources(
    out.trifacemarkerlist, out.trifacemarkerlist + count(out.numberoftrifaces, 1));
  for (int& source : sources)
  {
    --source;
  }
  found.push_back(PackNumbers(out.pointlist, count(out.numberofpoints, 3)));
  found.push_back(PackNumbers(out.tetrahedronlist, count(out.numberoftetrahedra, 4)));
  found.push_back(PackNumbers(out.trifacelist, count(out.numberoftrifaces, 3)));
  found.push_back(PackNumbers(sources.data(), sources.size()));
  return {};
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Run);
}
