// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeImages.h"

#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <numeric>

namespace knotwork
{
std::vector<FacePlace> FacesOf(const ModelBodies& model)
{
  std::vector<FacePlace> faces;
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    for (TopExp_Explorer face(model.Bodies[b].Shape, TopAbs_FACE); face.More(); face.Next())
    {
      faces.push_back({ b, TopoDS::Face(face.Current()) });
    }
  }
  return faces;
}

TopoDS_Compound Together(const std::vector<TopoDS_Shape>& shapes)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
  {
    builder.Add(compound, shape);
  }
  return compound;
}

TopoDS_Compound Together(const ModelBodies& model)
{
  std::vector<TopoDS_Shape> shapes;
  for (const ModelBody& body : model.Bodies)
  {
    shapes.push_back(body.Shape);
  }
  return Together(shapes);
}

bool IsSolid(const ModelBody& body)
{
  return body.Shape.ShapeType() == TopAbs_SOLID;
}

double VolumeOf(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, 1e-11, false, false);
  return properties.Mass();
}

Status CheckId(int id, const std::vector<FacePlace>& faces)
{
  if (id < 0 || static_cast<std::size_t>(id) >= faces.size())
  {
    return { ErrorCode::InvalidParameter,
      "there is no face " + std::to_string(id) + "; faces have the ids 0 to " +
        std::to_string(faces.size() - 1) };
  }
  return {};
}

Images::Images(const ModelBodies& model) : OfBody(model.Bodies.size()), Holder(model.Bodies.size())
{
  std::iota(this->Holder.begin(), this->Holder.end(), std::size_t{ 0 });
}

/// Puts the images into the place of what they are images of.
void Replace(const Images& images, ModelBodies& model, CADStep& step)
{
  const std::vector<FacePlace> before = FacesOf(model);
  AttributesOfShapes attributes;
  for (const FacePlace& place : before)
  {
    const ShapeAttributes* own = model.Faces.Seek(place.Face);
    if (!own)
    {
      continue;
    }
    const auto keep = [&](const TopoDS_Shape& face)
    {
      if (!attributes.IsBound(face)) // of two faces that became one the first
      {
        attributes.Bind(face, *own);
      }
    };
    if (const auto* parts = images.OfFace.Seek(place.Face))
    {
      for (const TopoDS_Shape& part : *parts)
      {
        keep(part);
      }
    }
    else
    {
      keep(place.Face);
    }
  }
  std::vector<ModelBody> bodies;
  std::vector<std::size_t> origin;
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    const ModelBody& old = model.Bodies[b];
    const std::vector<TopoDS_Shape>& pieces = images.OfBody[b];
    if (images.Holder[b] != b)
    {
      continue;
    }
    const bool isKept =
      pieces.empty() ? !IsSolid(old) : pieces.size() == 1 && pieces[0].IsEqual(old.Shape);
    if (isKept || pieces.empty())
    {
      // without pieces: all of it lay in others
      if (isKept || images.Overlap == 0.0)
      {
        bodies.push_back(old);
        origin.push_back(b);
      }
      continue;
    }
    for (const TopoDS_Shape& piece : pieces)
    {
      ModelBody body = old;
      body.Shape = piece;
      body.IsChanged = true;
      bodies.push_back(body);
      origin.push_back(b);
    }
  }
  model.Bodies = std::move(bodies);
  model.Faces = attributes;
  // ids of the parts in the bodies that came from the face's body
  NCollection_DataMap<TopoDS_Shape, std::vector<std::pair<std::size_t, int>>,
    TopTools_ShapeMapHasher>
    ids;
  const std::vector<FacePlace> after = FacesOf(model);
  for (std::size_t f = 0; f < after.size(); ++f)
  {
    if (!ids.IsBound(after[f].Face))
    {
      ids.Bind(after[f].Face, {});
    }
    ids.ChangeFind(after[f].Face).emplace_back(origin[after[f].Body], static_cast<int>(f));
  }
  step.NewFaces.assign(before.size(), {});
  for (std::size_t f = 0; f < before.size(); ++f)
  {
    const auto add = [&](const TopoDS_Shape& face)
    {
      const auto* found = ids.Seek(face);
      if (!found)
      {
        return;
      }
      for (const auto& [body, id] : *found)
      {
        if (body == images.Holder[before[f].Body])
        {
          step.NewFaces[f].push_back(id);
        }
      }
    };
    if (const auto* parts = images.OfFace.Seek(before[f].Face))
    {
      for (const TopoDS_Shape& part : *parts)
      {
        add(part);
      }
    }
    else
    {
      add(before[f].Face);
    }
  }
}
}
