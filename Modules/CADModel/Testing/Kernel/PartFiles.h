// SPDX-License-Identifier: BSD-3-Clause
// Files of solids that OpenCASCADE makes.
#pragma once
#include "OutputFile.h"
#include <knotwork/CADModel/CADTopology.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>

namespace knotwork
{
inline std::string BREPFile(const TopoDS_Shape& shape, const std::string& name = "part.brep")
{
  EXPECT_TRUE(BRepTools::Write(shape, OutputFile(name).c_str()));
  return OutputFile(name);
}

inline std::string STEPFile(const TopoDS_Shape& shape, const std::string& name = "part.step")
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Writer writer;
  EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  EXPECT_EQ(writer.Write(OutputFile(name).c_str()), IFSelect_RetDone);
  return OutputFile(name);
}

inline TopoDS_Shape BoxAt(const gp_Pnt& corner, double a, double b, double c)
{
  return BRepPrimAPI_MakeBox(corner, a, b, c).Shape();
}

inline TopoDS_Shape CylinderAt(const gp_Pnt& base, const gp_Dir& axis, double radius, double height)
{
  return BRepPrimAPI_MakeCylinder(gp_Ax2(base, axis), radius, height).Shape();
}

/// 10 x 6 x 1 with 3 x 2 holes.
inline TopoDS_Shape PlateWithHoles()
{
  TopoDS_Shape plate = BoxAt(gp_Pnt(0, 0, 0), 10, 6, 1);
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 2; ++j)
    {
      plate = BRepAlgoAPI_Cut(
        plate, CylinderAt(gp_Pnt(2 + 3 * i, 1.5 + 3 * j, -1), gp_Dir(0, 0, 1), 0.6, 3))
                .Shape();
    }
  }
  return plate;
}

inline CADTopology TopologyOf(const std::string& file)
{
  auto read = CADTopology::Read(file);
  EXPECT_TRUE(read) << read.Status.Message();
  return std::move(read.Value);
}
}
