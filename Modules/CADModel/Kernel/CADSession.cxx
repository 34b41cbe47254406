// SPDX-License-Identifier: BSD-3-Clause
#include "CADSession.h"

#include <knotwork/SplineCore/FileEnding.h>

#include <IGESCAFControl_Reader.hxx>
#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Shell.hxx>
#include <ShapeFix_Solid.hxx>
#include <ShapeProcess_ShapeContext.hxx>
#include <Standard_Failure.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSAlgo.hxx>
#include <XSAlgo_AlgoContainer.hxx>

#include <algorithm>
#include <new>

namespace knotwork
{
namespace
{
std::mutex& GlobalState()
{
  static std::mutex mutex;
  return mutex;
}

/// What OpenCASCADE calls on every shape that it has read: completes faces, with curves in their
/// parameters, seams and edges at poles, and leaves their orientation as it is written.
class CompletedFaces : public XSAlgo_AlgoContainer
{
public:
  TopoDS_Shape ProcessShape(const TopoDS_Shape& shape, double precision, double maxTolerance,
    const char*, const char*, Handle(Standard_Transient) & info, const Message_ProgressRange& range,
    bool) const override
  {
    const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(shape);
    fix->SetPrecision(precision);
    fix->SetMaxTolerance(maxTolerance);
    fix->FixSolidTool()->FixShellOrientationMode() = 0;
    fix->FixShellTool()->FixOrientationMode() = 0;
    fix->Perform(range);
    const Handle(ShapeProcess_ShapeContext) changes = new ShapeProcess_ShapeContext(shape, "");
    changes->RecordModification(fix->Context());
    info = changes; // names and colours follow
    return fix->Shape();
  }
};
}

CADFormat FormatOfFile(const std::string& file)
{
  const std::string ending = LowerEnding(file);
  if (ending == ".step" || ending == ".stp")
  {
    return CADFormat::STEP;
  }
  if (ending == ".iges" || ending == ".igs")
  {
    return CADFormat::IGES;
  }
  return ending == ".brep" ? CADFormat::BREP : CADFormat::Unknown;
}

const char* NameOfUnit(LengthUnit unit)
{
  constexpr const char* Names[NumLengthUnits] = { "UM", "MM", "CM", "M", "INCH", "FT" };
  return Names[static_cast<int>(unit)];
}

double Millimetres(LengthUnit unit)
{
  constexpr double Lengths[NumLengthUnits] = { 1e-3, 1.0, 10.0, 1000.0, 25.4, 304.8 };
  return Lengths[static_cast<int>(unit)];
}

CADSession::CADSession(LengthUnit unit) : Lock(GlobalState())
{
  Handle(Message_Messenger) messenger = Message::DefaultMessenger();
  this->Printers = messenger->Printers();
  messenger->ChangePrinters().Clear();
  STEPCAFControl_Controller::Init(); // make the settings known
  IGESControl_Controller::Init();
  this->Set("xstep.cascade.unit", NameOfUnit(unit));
  const bool naming = XCAFDoc_ShapeTool::AutoNaming(); // "SHELL" is no name
  this->Restore.emplace_back([naming] { XCAFDoc_ShapeTool::SetAutoNaming(naming); });
  XCAFDoc_ShapeTool::SetAutoNaming(false);
}

CADSession::~CADSession()
{
  for (auto undo = this->Restore.rbegin(); undo != this->Restore.rend(); ++undo)
  {
    (*undo)();
  }
  Message::DefaultMessenger()->ChangePrinters() = this->Printers;
}

void CADSession::Set(const char* name, int value)
{
  const int old = Interface_Static::IVal(name);
  this->Restore.emplace_back([name, old] { Interface_Static::SetIVal(name, old); });
  Interface_Static::SetIVal(name, value);
}

void CADSession::Set(const char* name, double value)
{
  const double old = Interface_Static::RVal(name);
  this->Restore.emplace_back([name, old] { Interface_Static::SetRVal(name, old); });
  Interface_Static::SetRVal(name, value);
}

void CADSession::Set(const char* name, const char* value)
{
  const char* current = Interface_Static::CVal(name);
  const std::string old = current ? current : "";
  this->Restore.emplace_back([name, old] { Interface_Static::SetCVal(name, old.c_str()); });
  Interface_Static::SetCVal(name, value);
}

void CADSession::SetDefaultsOfReading()
{
  this->Set("read.precision.mode", 0); // the file's
  this->Set("read.precision.val", 1e-4);
  this->Set("read.maxprecision.mode", 0);
  this->Set("read.maxprecision.val", 1.0);
  this->Set("read.stdsameparameter.mode", 0);
  this->Set("read.surfacecurve.mode", 0);
}

void CADSession::SetMending(bool mends)
{
  const Handle(XSAlgo_AlgoContainer) old = XSAlgo::AlgoContainer();
  this->Restore.emplace_back([old] { XSAlgo::SetAlgoContainer(old); });
  XSAlgo::SetAlgoContainer(
    mends ? new XSAlgo_AlgoContainer : Handle(XSAlgo_AlgoContainer)(new CompletedFaces));
}

Status CADSession::Run(const std::string& place, const std::function<Status()>& body)
{
  try
  {
    return body();
  }
  catch (const Standard_Failure&) // its text is of the library's inside
  {
    return { ErrorCode::InvalidFormat, place + ": " + FailureOfOpenCASCADE };
  }
  catch (const std::bad_alloc&)
  {
    return { ErrorCode::TooLarge, place + ": out of memory" };
  }
}
}
