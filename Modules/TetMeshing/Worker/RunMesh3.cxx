// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-mesh3 PARENT BYTES SECONDS
// Tetrahedra in what an image shows by CGAL's Mesh_3 for another process, see WorkerMain.h and
// ImageMeshParts.h.
#include "ImageMeshParts.h"
#include "LabelledImage.h"
#include "SizeLookup.h"
#include <knotwork/SplineGrid/WorkerMain.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>

#include <map>
#include <unordered_map>

namespace
{
using namespace knotwork;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using LabelledDomain = CGAL::Labeled_mesh_domain_3<Kernel>;

constexpr double FacetAngle = 25.0;                     ///< degrees, of triangles
constexpr double BisectionError = 1e-7;                 ///< of the diagonal
constexpr double NoBound = 1e3;                         ///< of lengths, in diagonals
constexpr double RadiusOfTriangle = 0.5773502691896258; ///< regular, of its edge
constexpr double RadiusOfCell = 0.6123724356957945;

Eigen::Vector3d VectorOf(const Point& point)
{
  return { point.x(), point.y(), point.z() };
}

Point PointOf(const Eigen::Vector3d& v)
{
  return { v.x(), v.y(), v.z() };
}

/// The solid of an image, whose pieces all have points to begin with.
class Domain : public LabelledDomain
{
public:
  explicit Domain(const LabelledImage& image)
    : LabelledDomain([&image](const Point& point) { return image.LabelAt(VectorOf(point)); },
        BoxOf(image), BisectionError),
      Image(&image)
  {
  }

  struct Construct_initial_points // NOLINT(readability-identifier-naming): CGAL's name
  {
    template <typename OutputIterator>
    OutputIterator operator()(OutputIterator points, int = 0) const
    {
      for (auto ends : this->Owner->Image->Crossings())
      {
        const int label = this->Owner->Image->LabelAt(ends[0]);
        constexpr int Halvings = 30;
        for (int i = 0; i < Halvings; ++i)
        {
          const Eigen::Vector3d middle = 0.5 * (ends[0] + ends[1]);
          ends[this->Owner->Image->LabelAt(middle) == label ? 0 : 1] = middle;
        }
        const int other = this->Owner->Image->LabelAt(ends[1]);
        *points++ = std::make_pair(PointOf(ends[1]),
          this->Owner->index_from_surface_patch_index(
            { std::min(label, other), std::max(label, other) }));
      }
      return points;
    }
    const Domain* Owner;
  };
  // NOLINTNEXTLINE(readability-identifier-naming): CGAL's name
  Construct_initial_points construct_initial_points_object() const { return { this }; }

private:
  static Kernel::Iso_cuboid_3 BoxOf(const LabelledImage& image)
  {
    const Eigen::Vector3d upper = image.Upper();
    return { PointOf(-0.1 * upper), PointOf(1.1 * upper) };
  }
  const LabelledImage* Image;
};

using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

/// Lengths of edges everywhere, in regions and on a background grid: the least.
struct Lengths
{
  double Most = 0.0;
  std::map<int, double> OfLabels;
  SizeLookup Field;

  double OfLabel(int label) const
  {
    const auto found = this->OfLabels.find(label);
    return found == this->OfLabels.end() ? this->Most : std::min(this->Most, found->second);
  }
  double At(const Point& point, const Domain::Index& index) const
  {
    double length = this->Field.At(VectorOf(point));
    if (const int* label = boost::get<int>(&index))
    {
      return std::min(length, this->OfLabel(*label));
    }
    if (const auto* pair = boost::get<std::pair<int, int>>(&index))
    {
      return std::min({ length, this->OfLabel(pair->first), this->OfLabel(pair->second) });
    }
    return std::min(length, this->Most);
  }
};

/// Radii of circumscribed spheres, as CGAL asks for them.
struct Radius
{
  using FT = double;
  using Point_3 = Point;
  using Index = Domain::Index;
  double operator()(const Point& point, int, const Index& index) const
  {
    return this->Share * this->Of->At(point, index);
  }
  const Lengths* Of;
  double Share; ///< of an edge
};

/// Corners and labels of the cells, and the triangles between labels, in the order of the mesh.
void Extract(const Complex& mesh, Parts& found)
{
  const Triangulation& cells = mesh.triangulation();
  std::unordered_map<Triangulation::Vertex_handle, int> numbers;
  std::vector<double> points;
  std::vector<std::array<int, 4>> tetrahedra;
  std::vector<int> labels;
  std::vector<std::array<int, 3>> triangles;
  const auto numberOf = [&](Triangulation::Vertex_handle vertex)
  {
    const auto [at, isNew] = numbers.emplace(vertex, static_cast<int>(numbers.size()));
    if (isNew)
    {
      for (const double x : { vertex->point().x(), vertex->point().y(), vertex->point().z() })
      {
        points.push_back(x);
      }
    }
    return at->second;
  };
  const auto labelOf = [&](Triangulation::Cell_handle cell)
  { return mesh.is_in_complex(cell) ? mesh.subdomain_index(cell) : 0; };
  for (auto cell = cells.finite_cells_begin(); cell != cells.finite_cells_end(); ++cell)
  {
    const int label = labelOf(cell);
    if (label == 0)
    {
      continue;
    }
    tetrahedra.push_back({ numberOf(cell->vertex(0)), numberOf(cell->vertex(1)),
      numberOf(cell->vertex(2)), numberOf(cell->vertex(3)) });
    labels.push_back(label);
    for (int i = 0; i < 4; ++i)
    {
      if (labelOf(cell->neighbor(i)) < label) // outward
      {
        triangles.push_back({ numberOf(cell->vertex(Triangulation::vertex_triple_index(i, 0))),
          numberOf(cell->vertex(Triangulation::vertex_triple_index(i, 1))),
          numberOf(cell->vertex(Triangulation::vertex_triple_index(i, 2))) });
      }
    }
  }
  found.push_back(PackNumbers(points.data(), points.size()));
  found.push_back(PackGroups(tetrahedra));
  found.push_back(PackNumbers(labels.data(), labels.size()));
  found.push_back(PackGroups(triangles));
}

Status Run(const Parts&, const Parts& input, Parts& found)
{
  if (input.size() != static_cast<std::size_t>(ImageMeshInput::Count))
  {
    return { ErrorCode::InvalidParameter, "an image and bounds are needed" };
  }
  const auto numbers = [&](ImageMeshInput which)
  { return UnpackNumbers<double>(input[static_cast<std::size_t>(which)]); };
  const auto sizes = UnpackNumbers<int>(input[static_cast<std::size_t>(ImageMeshInput::Size)]);
  const auto spacing = numbers(ImageMeshInput::Spacing);
  const auto bounds = numbers(ImageMeshInput::Bounds);
  const auto bound = [&](ImageMeshBound which) { return bounds[static_cast<std::size_t>(which)]; };
  const LabelledImage image({ sizes[0], sizes[1], sizes[2] },
    { spacing[0], spacing[1], spacing[2] }, numbers(ImageMeshInput::Values),
    static_cast<ImageSolid>(bound(ImageMeshBound::Solid)), bound(ImageMeshBound::Level));
  if (image.Crossings().empty())
  {
    return { ErrorCode::EmptyInput, "nothing is solid" };
  }
  CGAL::get_default_random() = CGAL::Random(1); // the same mesh each time
  const Domain domain(image);
  const double length = bound(ImageMeshBound::EdgeLength);
  Lengths lengths{ length > 0.0 ? length : NoBound * image.Upper().norm(), {},
    SizeLookup(numbers(ImageMeshInput::SizePoints),
      UnpackNumbers<int>(input[static_cast<std::size_t>(ImageMeshInput::SizeCells)]),
      numbers(ImageMeshInput::Sizes)) };
  const auto regions = numbers(ImageMeshInput::Regions);
  for (std::size_t r = 0; r + 3 < regions.size(); r += 4)
  {
    const int label = image.LabelAt({ regions[r], regions[r + 1], regions[r + 2] });
    const auto [at, isNew] = lengths.OfLabels.emplace(label, regions[r + 3]);
    at->second = std::min(at->second, regions[r + 3]);
  }
  const Criteria::Facet_criteria facets(
    FacetAngle, Radius{ &lengths, RadiusOfTriangle }, bound(ImageMeshBound::Distance));
  const Criteria::Cell_criteria cells(
    bound(ImageMeshBound::RadiusEdgeRatio), Radius{ &lengths, RadiusOfCell });
  namespace with = CGAL::parameters;
  with::internal::Mesh_3_options options;
  options.maximal_number_of_vertices = static_cast<std::size_t>(bound(ImageMeshBound::MaxPoints));
  const double angle = bound(ImageMeshBound::MinDihedralAngle);
  const Complex mesh = angle > 0.0
    ? CGAL::make_mesh_3<Complex>(domain, Criteria(facets, cells), with::no_features(),
        with::perturb(with::sliver_bound = angle), with::exude(with::sliver_bound = angle), options)
    : CGAL::make_mesh_3<Complex>(domain, Criteria(facets, cells), with::no_features(),
        with::no_perturb(), with::no_exude(), options);
  if (mesh.number_of_cells_in_complex() == 0)
  {
    return { ErrorCode::LibraryError, "it is smaller than the lengths of edges" };
  }
  Extract(mesh, found);
  return {};
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Run);
}
