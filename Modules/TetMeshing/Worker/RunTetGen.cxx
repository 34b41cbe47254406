// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-tetgen PARENT BYTES SECONDS SWITCHES REFINEMENT
// Tetrahedra within triangles by TetGen for another process, see WorkerMain.h and TetGenParts.h.
#include "SizeLookup.h"
#include "TetGenEnd.h"
#include "TetGenParts.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/WorkerMain.h>

#define TETLIBRARY
#include <tetgen.h>

#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <new>

namespace
{
using namespace knotwork;

constexpr int RefinementRounds = 8;

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

/// A point of each region, a number for it, and the largest volume of its tetrahedra.
void FillRegions(const std::vector<double>& regions, tetgenio& input)
{
  constexpr std::size_t Given = 4;
  constexpr std::size_t Taken = 5;
  const std::size_t count = regions.size() / Given;
  if (count == 0)
  {
    return;
  }
  input.numberofregions = static_cast<int>(count);
  input.regionlist = new double[Taken * count];
  for (std::size_t r = 0; r < count; ++r)
  {
    const double* from = regions.data() + Given * r;
    double* to = input.regionlist + Taken * r;
    std::copy(from, from + 3, to);
    to[3] = static_cast<double>(r + 1);
    to[4] = from[3];
  }
}

/// What is asked for beside the switches.
struct Bounds
{
  std::vector<double> Regions; ///< as FillRegions takes them
  SizeLookup Sizes;

  bool Any() const { return !this->Regions.empty() || !this->Sizes.IsEmpty(); }
};

/// The first region whose point no tetrahedron has.
Status CheckRegions(const std::vector<double>& regions, const tetgenio& mesh)
{
  const SizeLookup cells({ mesh.pointlist, mesh.pointlist + 3 * mesh.numberofpoints },
    { mesh.tetrahedronlist, mesh.tetrahedronlist + 4 * mesh.numberoftetrahedra },
    std::vector<double>(4 * static_cast<std::size_t>(mesh.numberoftetrahedra), 1.0));
  for (std::size_t r = 0; r + 3 < regions.size(); r += 4)
  {
    if (!std::isfinite(cells.At({ regions[r], regions[r + 1], regions[r + 2] })))
    {
      return { ErrorCode::InvalidParameter,
        "the point (" + Digits(regions[r]) + ", " + Digits(regions[r + 1]) + ", " +
          Digits(regions[r + 2]) +
          ") of a size lies in no region; give a point inside of the region" };
    }
  }
  return {};
}

/// Sets the largest volumes of the tetrahedra of a mesh. @return how many are larger.
int SetVolumes(const Bounds& bounds, tetgenio& mesh)
{
  const auto corner = [&](int cell, int k)
  {
    const int point = mesh.tetrahedronlist[4 * cell + k];
    return Eigen::Map<const Eigen::Vector3d>(mesh.pointlist + 3 * point);
  };
  constexpr double Unbounded = -1.0; // as TetGen takes it
  int larger = 0;
  mesh.tetrahedronvolumelist = new double[static_cast<std::size_t>(mesh.numberoftetrahedra)];
  for (int c = 0; c < mesh.numberoftetrahedra; ++c)
  {
    const Eigen::Vector3d origin = corner(c, 0);
    const Eigen::Vector3d middle = (origin + corner(c, 1) + corner(c, 2) + corner(c, 3)) / 4.0;
    double most = VolumeOfEdge(bounds.Sizes.At(middle));
    if (mesh.numberoftetrahedronattributes > 0)
    {
      const auto region = static_cast<std::size_t>(
        mesh.tetrahedronattributelist[c * mesh.numberoftetrahedronattributes]);
      most = region > 0 && 4 * region <= bounds.Regions.size()
        ? std::min(most, bounds.Regions[4 * region - 1])
        : most;
    }
    const double volume =
      std::abs((corner(c, 1) - origin).cross(corner(c, 2) - origin).dot(corner(c, 3) - origin)) /
      6.0;
    larger += volume > most * (1.0 + SizeMargin) ? 1 : 0;
    mesh.tetrahedronvolumelist[c] = std::isfinite(most) ? most : Unbounded;
  }
  return larger;
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
  if (words.size() != 2 || input.size() != static_cast<std::size_t>(TetGenInput::Count))
  {
    return { ErrorCode::InvalidParameter, "switches, points and triangles are needed" };
  }
  tetgenio in;
  Fill(UnpackNumbers<double>(PartOf(input, TetGenInput::Points)),
    UnpackNumbers<int>(PartOf(input, TetGenInput::Triangles)), in);
  const Bounds bounds{ UnpackNumbers<double>(PartOf(input, TetGenInput::Regions)),
    SizeLookup(UnpackNumbers<double>(PartOf(input, TetGenInput::SizePoints)),
      UnpackNumbers<int>(PartOf(input, TetGenInput::SizeCells)),
      UnpackNumbers<double>(PartOf(input, TetGenInput::Sizes))) };
  auto made = std::make_unique<tetgenio>();
  int oversized = 0;
  try
  {
    const auto make = [&](std::string switches, tetgenio& from)
    {
      auto to = std::make_unique<tetgenio>();
      tetrahedralize(switches.data(), &from, to.get());
      return to;
    };
    if (!bounds.Regions.empty())
    {
      // points outside are more than TetGen bears
      if (Status status = CheckRegions(bounds.Regions, *make("pzQ", in)); !status)
      {
        return status;
      }
      FillRegions(bounds.Regions, in);
    }
    made = make(words[0], in);
    // bounds of tetrahedra that there are: new ones may be where smaller ones are asked for
    oversized = bounds.Any() ? SetVolumes(bounds, *made) : 0;
    for (int round = 0; round < RefinementRounds && oversized > 0; ++round)
    {
      made = make(words[1], *made);
      oversized = SetVolumes(bounds, *made);
    }
  }
  catch (const TetGenEnd& end)
  {
    return Reason(end.Reason);
  }
  const tetgenio& out = *made;
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
  found.push_back(PackNumbers(&oversized, 1));
  return {};
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Run);
}
