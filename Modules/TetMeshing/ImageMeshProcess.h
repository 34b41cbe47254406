// SPDX-License-Identifier: BSD-3-Clause
// CGAL's Mesh_3 in a process of its own, private to the module.
#pragma once
#include "ImageMeshParts.h"
#include <knotwork/SplineGrid/WorkerProcess.h>
#include <knotwork/TetMeshing/SolidMesh.h>

class vtkImageData;

namespace knotwork
{
/// Values at points of a box.
struct VolumeImage
{
  std::array<int, 3> Size{};
  Eigen::Vector3d Origin = Eigen::Vector3d::Zero();   ///< of the first point
  Eigen::Vector3d Spacing = Eigen::Vector3d::Ones();  ///< > 0
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity(); ///< columns of length 1
  std::vector<double> Values;                         ///< x first

  double Diagonal() const;
};

/// @param name  of an array of points; empty: the active scalars, or the only array of one
/// component. @param areLabels  values are whole numbers.
/// @return InvalidTopology for an image without a volume; InvalidParameter for an array that is not
/// there, or a value that is no label; NonFiniteInput.
Result<VolumeImage> DecodeImage(vtkImageData* data, const std::string& name, bool areLabels);

struct ImageMeshParams
{
  ImageSolid Solid = ImageSolid::Below;
  double Level = 0.0;
  double Distance = 0.0; ///< of triangles from the surface, > 0
  TetrahedraParams Tetrahedra;
};

struct ImageTetrahedra
{
  TriangleMesh Surface; ///< between cells of two labels, and around them
  Tetrahedra Solid;     ///< with Labels
};

/// Fills what an image shows by the program knotwork-mesh3.
/// @param goOn  false ends it.
/// @return the errors of RunMesher; EmptyInput where nothing is solid.
/// @source Boissonnat, Oudot, Graphical Models 67 (2005) 405; Rineau, Yvinec, IMR 16 (2007) 443.
Result<ImageTetrahedra> RunImageMesher(const VolumeImage& image, const ImageMeshParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn);
}
