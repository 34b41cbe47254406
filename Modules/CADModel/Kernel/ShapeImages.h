// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ShapeOperations.h"

#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>

namespace knotwork
{
/// A face and the body that it is of.
struct FacePlace
{
  std::size_t Body;
  TopoDS_Face Face;
};

/// The place in the list is the face's id.
std::vector<FacePlace> FacesOf(const ModelBodies& model);

TopoDS_Compound Together(const std::vector<TopoDS_Shape>& shapes);
TopoDS_Compound Together(const ModelBodies& model);

bool IsSolid(const ModelBody& body);
double VolumeOf(const TopoDS_Shape& shape);

/// @return InvalidParameter: there is no face of this id.
Status CheckId(int id, const std::vector<FacePlace>& faces);

/// What became of bodies and faces.
struct Images
{
  explicit Images(const ModelBodies& model);

  std::vector<std::vector<TopoDS_Shape>> OfBody; ///< empty: as it was
  std::vector<std::size_t> Holder; ///< of each body: itself, or the one whose images hold its faces
  NCollection_DataMap<TopoDS_Shape, std::vector<TopoDS_Shape>, TopTools_ShapeMapHasher> OfFace;
  double Overlap = 0.0;
};

/// Puts the images into the place of what they are images of.
void Replace(const Images& images, ModelBodies& model, CADStep& step);
}
