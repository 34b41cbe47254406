// SPDX-License-Identifier: BSD-3-Clause
#include "CADShells.h"

#include <BOPTools_AlgoTools3D.hxx>
#include <BRepBndLib.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <IntTools_Context.hxx>
#include <Precision.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include <algorithm>

namespace knotwork
{
namespace
{
struct Component
{
  std::vector<int> Faces;
  int Body = 0;
  bool Closed = true;
  bool Agrees = true;
  double Volume = 0.0; ///< signed; of closed ones
  Bnd_Box Box;
  TopoDS_Shell Shell;
};

struct FaceOfEdge
{
  int Face;
  bool Reversed;
};

/// Faces of one body reached over edges; turns them so that common edges run in opposite senses.
std::vector<Component> FindComponents(ShellInput& input)
{
  const auto count = input.Faces.size();
  std::vector<std::vector<FaceOfEdge>> facesOfEdge(static_cast<std::size_t>(input.NumEdges));
  for (std::size_t f = 0; f < count; ++f)
  {
    for (const EdgeUse& use : input.Uses[f])
    {
      facesOfEdge[static_cast<std::size_t>(use.Edge)].push_back(
        { static_cast<int>(f), use.Reversed });
    }
  }
  std::vector<Component> components;
  std::vector<int> turned(count, -1); // not reached, kept, turned
  for (std::size_t seed = 0; seed < count; ++seed)
  {
    if (turned[seed] >= 0)
    {
      continue;
    }
    Component component;
    component.Body = input.Bodies[seed];
    component.Faces.push_back(static_cast<int>(seed));
    turned[seed] = 0;
    for (std::size_t next = 0; next < component.Faces.size(); ++next)
    {
      const int face = component.Faces[next];
      const auto f = static_cast<std::size_t>(face);
      for (const EdgeUse& use : input.Uses[f])
      {
        const auto& users = facesOfEdge[static_cast<std::size_t>(use.Edge)];
        component.Closed = component.Closed && users.size() == 2;
        if (users.size() != 2) // an end, or an edge of three faces that orients none
        {
          for (const FaceOfEdge& user : users)
          {
            if (turned[static_cast<std::size_t>(user.Face)] < 0)
            {
              turned[static_cast<std::size_t>(user.Face)] = 0;
              component.Faces.push_back(user.Face);
            }
          }
          continue;
        }
        if (users[0].Face == users[1].Face)
        {
          component.Agrees = component.Agrees && users[0].Reversed != users[1].Reversed;
          continue;
        }
        const FaceOfEdge& other = users[0].Face == face ? users[1] : users[0];
        const int wanted = (use.Reversed == other.Reversed ? 1 : 0) ^ turned[f];
        int& state = turned[static_cast<std::size_t>(other.Face)];
        if (state < 0)
        {
          state = wanted;
          component.Faces.push_back(other.Face);
        }
        component.Agrees = component.Agrees && state == wanted;
      }
    }
    components.push_back(std::move(component));
  }
  for (std::size_t f = 0; f < count; ++f)
  {
    if (turned[f] == 1)
    {
      input.Faces[f].Reverse();
    }
  }
  return components;
}

TopoDS_Shell MakeShell(const ShellInput& input, const std::vector<int>& faces, bool closed)
{
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (int face : faces)
  {
    builder.Add(shell, input.Faces[static_cast<std::size_t>(face)]);
  }
  shell.Closed(closed);
  return shell;
}

void FindVolume(Component& component)
{
  GProp_GProps properties;
  BRepGProp::VolumeProperties(component.Shell, properties);
  component.Volume = properties.Mass();
  BRepBndLib::Add(component.Shell, component.Box, false);
}

TopoDS_Solid SolidOf(const TopoDS_Shell& shell)
{
  TopoDS_Solid solid;
  BRep_Builder builder;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

/// Whether a shell lies in another one: by the first places inside of its faces that do not lie on
/// the other.
bool LiesIn(const ShellInput& input, const Component& inner, const Component& outer)
{
  constexpr std::size_t MostTried = 16;
  BRepClass3d_SolidClassifier classifier(SolidOf(outer.Shell));
  const Handle(IntTools_Context) context = new IntTools_Context;
  for (std::size_t i = 0; i < std::min(MostTried, inner.Faces.size()); ++i)
  {
    const TopoDS_Face& face = input.Faces[static_cast<std::size_t>(inner.Faces[i])];
    gp_Pnt point;
    gp_Pnt2d parameters;
    if (BOPTools_AlgoTools3D::PointInFace(face, point, parameters, context) != 0)
    {
      continue;
    }
    classifier.Perform(point, Precision::Confusion());
    if (classifier.State() == TopAbs_IN || classifier.State() == TopAbs_OUT)
    {
      return classifier.State() == TopAbs_IN;
    }
  }
  return false;
}

/// The smallest closed shell of the same body around a shell turned inward.
Component* ShellAround(
  const ShellInput& input, std::vector<Component>& components, const Component& inner)
{
  Component* best = nullptr;
  for (Component& outer : components)
  {
    if (!outer.Closed || !outer.Agrees || outer.Body != inner.Body ||
      outer.Volume <= -inner.Volume || (best && best->Volume <= outer.Volume))
    {
      continue;
    }
    if (!outer.Box.IsOut(inner.Box) && LiesIn(input, inner, outer))
    {
      best = &outer;
    }
  }
  return best;
}

void Turn(ShellInput& input, Component& component)
{
  for (int face : component.Faces)
  {
    input.Faces[static_cast<std::size_t>(face)].Reverse();
  }
  component.Shell = MakeShell(input, component.Faces, true);
  component.Volume = -component.Volume;
}
}

TopoDS_Shape MakeBodies(ShellInput& input)
{
  std::vector<Component> components = FindComponents(input);
  std::vector<TopoDS_Shape> results;
  for (Component& component : components)
  {
    if (!component.Agrees)
    {
      for (int face : component.Faces)
      {
        results.push_back(MakeShell(input, { face }, false));
      }
      continue;
    }
    component.Shell = MakeShell(input, component.Faces, component.Closed);
    if (component.Closed)
    {
      FindVolume(component);
    }
    else
    {
      results.push_back(component.Shell);
    }
  }
  BRep_Builder builder;
  std::vector<std::vector<TopoDS_Shell>> cavities(components.size());
  for (Component& component : components)
  {
    if (component.Closed && component.Agrees && component.Volume < 0.0)
    {
      if (Component* outer = ShellAround(input, components, component))
      {
        cavities[static_cast<std::size_t>(outer - components.data())].push_back(component.Shell);
      }
      else
      {
        Turn(input, component);
      }
    }
  }
  for (std::size_t c = 0; c < components.size(); ++c)
  {
    if (components[c].Closed && components[c].Agrees && components[c].Volume >= 0.0)
    {
      TopoDS_Solid solid = SolidOf(components[c].Shell);
      for (const TopoDS_Shell& cavity : cavities[c])
      {
        builder.Add(solid, cavity);
      }
      results.push_back(solid);
    }
  }
  if (results.size() == 1)
  {
    return results.front();
  }
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : results)
  {
    builder.Add(compound, shape);
  }
  return compound;
}
}
