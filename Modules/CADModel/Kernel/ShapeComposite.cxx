// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeComposite.h"

#include "CADComposite.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepTools_History.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS_Iterator.hxx>

#include <algorithm>
#include <set>

namespace knotwork
{
namespace
{
using EdgesWithFaces = TopTools_IndexedDataMapOfShapeListOfShape;

/// An edge with two faces, both of the group; a face that solids share stands there once.
bool IsInterior(const TopTools_ListOfShape& faces, const TopTools_IndexedMapOfShape& group)
{
  TopTools_MapOfShape distinct;
  bool isInside = true;
  for (const TopoDS_Shape& face : faces)
  {
    distinct.Add(face);
    isInside = isInside && group.Contains(face);
  }
  return isInside && distinct.Extent() == 2;
}

Status CheckGroup(const std::vector<int>& ids, const std::vector<FacePlace>& faces)
{
  if (std::set<int>(ids.begin(), ids.end()).size() < 2)
  {
    return { ErrorCode::InvalidParameter,
      "a composite has two or more faces; give the ids of neighbours" };
  }
  for (int id : ids)
  {
    if (Status status = CheckId(id, faces); !status)
    {
      return status;
    }
    if (faces[static_cast<std::size_t>(id)].Body != faces[static_cast<std::size_t>(ids[0])].Body)
    {
      return { ErrorCode::InvalidParameter,
        "faces " + std::to_string(ids[0]) + " and " + std::to_string(id) +
          " are of two bodies; give faces of one" };
    }
  }
  return {};
}

/// Names a face that no chain of common edges leads to.
Status CheckConnected(const std::vector<int>& ids, const TopTools_IndexedMapOfShape& group,
  const EdgesWithFaces& edges, const std::vector<FacePlace>& faces)
{
  DisjointSets sets(group.Extent() + 1);
  for (int e = 1; e <= edges.Extent(); ++e)
  {
    int first = 0;
    for (const TopoDS_Shape& face : edges(e))
    {
      const int index = group.FindIndex(face);
      if (index > 0 && first > 0)
      {
        sets.Unite(first, index);
      }
      first = index > 0 ? index : first;
    }
  }
  for (int id : ids)
  {
    const int index = group.FindIndex(faces[static_cast<std::size_t>(id)].Face);
    if (sets.Find(index) != sets.Find(1))
    {
      return { ErrorCode::InvalidParameter,
        "no chain of edges leads from face " + std::to_string(ids[0]) + " to face " +
          std::to_string(id) + " within the composite; add the faces between them" };
    }
  }
  return {};
}

/// The smallest number that no composite has.
std::string FreeName(const ModelBodies& model, const std::vector<FacePlace>& faces)
{
  std::set<std::string> taken;
  for (const FacePlace& place : faces)
  {
    if (const ShapeAttributes* own = model.Faces.Seek(place.Face))
    {
      taken.insert(ParseCompositeName(own->Name).Group);
    }
  }
  int number = 1;
  while (taken.count(std::to_string(number)) > 0)
  {
    ++number;
  }
  return std::to_string(number);
}

/// Joins faces of the group that lie on one surface.
void Unify(const ModelBodies& model, const TopTools_IndexedMapOfShape& group,
  const EdgesWithFaces& edges, Images& images)
{
  ShapeUpgrade_UnifySameDomain unify(Together(model), false, true, false);
  for (int e = 1; e <= edges.Extent(); ++e)
  {
    if (!IsInterior(edges(e), group))
    {
      unify.KeepShape(edges.FindKey(e));
    }
  }
  unify.Build();
  std::size_t body = 0;
  for (TopoDS_Iterator made(unify.Shape()); made.More() && body < images.OfBody.size();
       made.Next(), ++body)
  {
    images.OfBody[body].push_back(made.Value());
  }
  for (int f = 1; f <= group.Extent(); ++f)
  {
    std::vector<TopoDS_Shape> parts;
    for (const TopoDS_Shape& part : unify.History()->Modified(group(f)))
    {
      parts.push_back(part);
    }
    if (!parts.empty())
    {
      images.OfFace.Bind(group(f), parts);
    }
  }
}
}

Status Compose(const std::vector<int>& ids, ModelBodies& model, CADStep& step)
{
  const std::vector<FacePlace> faces = FacesOf(model);
  if (Status status = CheckGroup(ids, faces); !status)
  {
    return status;
  }
  TopTools_IndexedMapOfShape group;
  for (int id : ids)
  {
    const TopoDS_Face& face = faces[static_cast<std::size_t>(id)].Face;
    const ShapeAttributes* own = model.Faces.Seek(face);
    const std::string known = own ? ParseCompositeName(own->Name).Group : std::string();
    if (!known.empty())
    {
      return { ErrorCode::InvalidParameter,
        "face " + std::to_string(id) + " is in composite " + known +
          "; a face belongs to one composite" };
    }
    group.Add(face);
  }
  EdgesWithFaces edges;
  TopExp::MapShapesAndAncestors(Together(model), TopAbs_EDGE, TopAbs_FACE, edges);
  if (Status status = CheckConnected(ids, group, edges, faces); !status)
  {
    return status;
  }
  const std::string name = FreeName(model, faces);
  Images images(model);
  Unify(model, group, edges, images);
  Replace(images, model, step);
  std::set<int> left;
  for (int id : ids)
  {
    const std::vector<int>& now = step.NewFaces[static_cast<std::size_t>(id)];
    left.insert(now.begin(), now.end());
  }
  step.Composite.Faces.assign(left.begin(), left.end());
  if (left.size() < 2)
  {
    return {}; // one face needs no group
  }
  step.Composite.Name = name;
  const std::vector<FacePlace> after = FacesOf(model);
  for (int id : left)
  {
    const FacePlace& place = after[static_cast<std::size_t>(id)];
    ShapeAttributes attributes;
    if (const ShapeAttributes* own = model.Faces.Seek(place.Face))
    {
      attributes = *own;
    }
    attributes.Name = FormatCompositeName({ name, attributes.Name });
    model.Faces.UnBind(place.Face);
    model.Faces.Bind(place.Face, attributes);
  }
  for (const FacePlace& place : after) // also of a body that shares the faces
  {
    const ShapeAttributes* own = model.Faces.Seek(place.Face);
    if (own && ParseCompositeName(own->Name).Group == name)
    {
      model.Bodies[place.Body].IsChanged = true; // other instances of its product are not in it
    }
  }
  return {};
}

std::string FirstComposite(const ModelBodies& model)
{
  for (const FacePlace& place : FacesOf(model))
  {
    const ShapeAttributes* own = model.Faces.Seek(place.Face);
    const std::string group = own ? ParseCompositeName(own->Name).Group : std::string();
    if (!group.empty())
    {
      return group;
    }
  }
  return {};
}
}
