// SPDX-License-Identifier: BSD-3-Clause
#include "KnotworkMenu.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDataRepresentation.h"
#include "pqHelpReaction.h"
#include "pqLoadStateReaction.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqProgressManager.h"
#include "pqPropertiesPanel.h"
#include "pqSelectionManager.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "vtkAlgorithm.h"
#include "vtkBoundingBox.h"
#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSelectionHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionPresets.h"
#include "vtkSMTransferFunctionProxy.h"
#include "vtkSmartPointer.h"

#include <QDir>
#include <QFile>
#include <QGuiApplication>
#include <QMainWindow>
#include <QMenu>
#include <QMessageBox>
#include <QTimer>
#include <QToolBar>
#include <QXmlStreamReader>

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace
{
constexpr char Pages[] = "qthelp://knotwork/knotwork/index.html";

/// The folder of the plugin, which holds the examples and the colour maps.
QDir PluginFolder()
{
  Dl_info place;
  return dladdr(reinterpret_cast<const void*>(&PluginFolder), &place) != 0
    ? QFileInfo(place.dli_fname).dir()
    : QDir();
}

void Say(const char* sentence)
{
  QMessageBox::information(pqCoreUtilities::mainWidget(), "Knotwork", sentence);
}

/// An array of what is selected in the pipeline browser.
struct Found
{
  pqOutputPort* Port = nullptr;
  vtkPVArrayInformation* Array = nullptr;
  int Association = 0;
};

/// The first of the names that an array has, of cells or points; Array is null where there is none.
Found FindArray(std::initializer_list<const char*> names, std::initializer_list<int> associations)
{
  Found found;
  found.Port = pqActiveObjects::instance().activePort();
  if (!found.Port)
  {
    return found;
  }
  for (const char* name : names)
  {
    for (const int association : associations)
    {
      found.Array = found.Port->getDataInformation()->GetArrayInformation(name, association);
      found.Association = association;
      if (found.Array)
      {
        return found;
      }
    }
  }
  return found;
}

/// States name the data beside them without a folder.
void LoadExample(const QString& name)
{
  pqServer* server = pqActiveObjects::instance().activeServer();
  QFile state(name);
  if (!server || !state.open(QIODevice::ReadOnly))
  {
    return;
  }
  QString text = QString::fromUtf8(state.readAll());
  for (const QFileInfo& data : QFileInfo(name).dir().entryInfoList(QDir::Files))
  {
    text.replace('"' + data.fileName() + '"', '"' + data.absoluteFilePath() + '"');
  }
  pqApplicationCore::instance()->loadStateFromString(text.toUtf8().constData(), server);
  pqLoadStateReaction::activateView(); // which states do not say
}

/// ParaView 5.11 runs filters in the window's thread and handles no clicks meanwhile, so its button
/// Abort stays grey; the keys that are held can be asked for all the same, at every progress.
void AbortWhileKeysAreHeld()
{
  constexpr Qt::KeyboardModifiers Keys = Qt::ControlModifier | Qt::AltModifier;
  if ((QGuiApplication::queryKeyboardModifiers() & Keys) != Keys)
  {
    return;
  }
  for (pqPipelineSource* source :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    auto* filter = vtkAlgorithm::SafeDownCast(source->getProxy()->GetClientSideObject());
    if (filter && filter->IsA("vtkSplineAlgorithm"))
    {
      filter->SetAbortExecute(1); // those that do not run forget it when they begin
    }
  }
}

/// More pieces a cell where that costs little: the default for all grids (DefaultSettings) leaves a
/// few large cells angular. The user's own default, and what a state says, stay.
void SmoothFewCells(pqDataRepresentation* shown)
{
  constexpr int Default = 3;
  vtkSMProperty* level = shown->getProxy()->GetProperty("NonlinearSubdivisionLevel");
  vtkPVDataInformation* data = shown->getInputDataInformation();
  if (level && data && data->GetArrayInformation("BezierDegrees", vtkDataObject::CELL) &&
    vtkSMPropertyHelper(level).GetAsInt() == Default && data->GetNumberOfCells() <= 2000)
  {
    vtkSMPropertyHelper(level).Set(Default + 1);
    shown->getProxy()->UpdateVTKObjects();
    shown->renderViewEventually();
  }
}

void SmoothWhenShown(pqRepresentation* added)
{
  auto* shown = qobject_cast<pqDataRepresentation*>(added);
  if (shown && !pqApplicationCore::instance()->isLoadingState())
  {
    // its input is connected after it is told of
    QTimer::singleShot(0, shown, [shown] { SmoothFewCells(shown); });
  }
}

/// Filters that menus.xml leaves out of the toolbar: ParaView makes the actions of a plugin's
/// filters before it reads that file, and tells them nothing of it.
void ShortenToolbar()
{
  auto* toolbar = pqCoreUtilities::mainWidget()->findChild<QToolBar*>("Knotwork");
  QFile file(":/Knotwork/ParaViewResources/menus.xml");
  if (!toolbar || !file.open(QIODevice::ReadOnly))
  {
    return;
  }
  QStringList left;
  QXmlStreamReader xml(&file);
  while (!xml.atEnd())
  {
    if (xml.readNext() == QXmlStreamReader::StartElement &&
      xml.attributes().value("omit_from_toolbar") == "1")
    {
      left << xml.attributes().value("name").toString();
    }
  }
  for (QAction* action : toolbar->actions())
  {
    if (left.contains(action->data().toStringList().value(1)))
    {
      action->setProperty("OmitFromToolbar", QStringList("Knotwork"));
      toolbar->removeAction(action);
    }
  }
}

void SelectInvalidCells()
{
  const Found found = FindArray({ "JacobianVerdict", "Verdict" }, { vtkDataObject::CELL });
  if (!found.Array)
  {
    Say("The selected output has no verdicts; apply the filter Jacobian Validator to it.");
    return;
  }
  auto* proxies = found.Port->getServer()->proxyManager();
  const auto source = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(proxies->NewProxy("sources", "ThresholdSelectionSource")));
  vtkSMPropertyHelper(source, "ArrayName").Set(found.Array->GetName());
  vtkSMPropertyHelper(source, "FieldType").Set(0); // cells
  const double range[2] = { -1.5, -0.5 };
  vtkSMPropertyHelper(source, "Thresholds").Set(range, 2);
  source->UpdateVTKObjects();
  const auto selection = vtkSmartPointer<vtkSMProxy>::Take(
    vtkSMSelectionHelper::NewAppendSelectionsFromSelectionSource(source));
  found.Port->setSelectionInput(vtkSMSourceProxy::SafeDownCast(selection), 0);
  pqPVApplicationCore::instance()->selectionManager()->select(found.Port);
  found.Port->renderAllViews();
}

/// A factor of one digit by which the largest displacement becomes a tenth of the body's size.
double WarpFactor(const Found& displacement)
{
  double bounds[6];
  displacement.Port->getDataInformation()->GetBounds(bounds);
  const double size = vtkBoundingBox(bounds).GetDiagonalLength();
  double range[2];
  displacement.Array->GetComponentFiniteRange(-1, range); // of the length
  if (!(range[1] > 0.0))
  {
    return 1.0;
  }
  const double factor = 0.1 * size / range[1];
  const double power = std::pow(10.0, std::floor(std::log10(factor)));
  return power * std::max(1.0, std::floor(factor / power));
}

void WarpByDisplacement()
{
  const Found found = FindArray({ "Displacement" }, { vtkDataObject::POINT });
  if (!found.Array)
  {
    Say("The selected output has no displacement; apply the filter Spline Analysis with the "
        "equation Elasticity to it.");
    return;
  }
  pqPipelineSource* warp = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "WarpVector", found.Port->getSource(), found.Port->getPortNumber());
  vtkSMPropertyHelper(warp->getProxy(), "SelectInputVectors")
    .SetInputArrayToProcess(vtkDataObject::POINT, "Displacement");
  vtkSMPropertyHelper(warp->getProxy(), "ScaleFactor").Set(WarpFactor(found));
  if (auto* panel = pqCoreUtilities::mainWidget()->findChild<pqPropertiesPanel*>())
  {
    panel->apply();
  }
}

void ColorByDeviation()
{
  const Found found = FindArray({ "Distance" }, { vtkDataObject::POINT, vtkDataObject::CELL });
  pqDataRepresentation* shown = pqActiveObjects::instance().activeRepresentation();
  if (!found.Array || !shown)
  {
    Say("The selected output has no distances, or is not shown; Deviation Map, Rigid Alignment, "
        "Spline Point Distance and CAD Fit measure them.");
    return;
  }
  vtkSMProxy* representation = shown->getProxy();
  vtkSMPVRepresentationProxy::SetScalarColoring(representation, "Distance", found.Association);
  vtkSMProxy* colors = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  double range[2];
  found.Array->GetComponentFiniteRange(0, range);
  const double largest = std::max(std::fabs(range[0]), std::fabs(range[1]));
  vtkSMTransferFunctionProxy::ApplyPreset(colors, "Knotwork Deviation", true);
  if (largest > 0.0)
  {
    vtkSMTransferFunctionProxy::RescaleTransferFunction(colors, -largest, largest);
  }
  vtkSMPVRepresentationProxy::SetScalarBarVisibility(
    representation, pqActiveObjects::instance().activeView()->getProxy(), true);
  shown->renderViewEventually();
}
}

KnotworkMenu::KnotworkMenu(QObject* parent) : QActionGroup(parent), Examples(new QMenu("Examples"))
{
  this->setExclusive(false);
  const QDir folder = PluginFolder();
  auto* presets = vtkSMTransferFunctionPresets::GetInstance();
  if (!presets->HasPreset("Knotwork Deviation"))
  {
    presets->ImportPresets(folder.filePath("Presets.json").toUtf8().constData());
  }
  pqApplicationCore::instance()->registerDocumentation(":/Knotwork/Documentation/Knotwork.qch");

  QTimer::singleShot(0, this, &ShortenToolbar);
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::representationAdded, this, &SmoothWhenShown);
  QObject::connect(pqApplicationCore::instance()->getProgressManager(),
    &pqProgressManager::progress, this, &AbortWhileKeysAreHeld);

  const auto add = [this](const char* name, const char* help, void (*work)())
  {
    QAction* action = this->addAction(name);
    action->setObjectName(QString(name).remove(' '));
    action->setStatusTip(help);
    action->setToolTip(help);
    QObject::connect(action, &QAction::triggered, this, work);
  };
  const QDir states(folder.filePath("Examples"));
  for (const QString& name : states.entryList({ "*.pvsm" }, QDir::Files, QDir::Name))
  {
    const QString file = states.filePath(name);
    QAction* action =
      this->Examples->addAction(QFileInfo(name).completeBaseName().replace('_', ' '));
    QObject::connect(action, &QAction::triggered, this, [file] { LoadExample(file); });
  }
  this->Examples->menuAction()->setEnabled(!this->Examples->isEmpty());
  this->addAction(this->Examples->menuAction());
  add("Select Invalid Cells", "Selects the cells that are proved invalid", &SelectInvalidCells);
  add("Warp By Displacement", "Shows a solved body as its displacement bends it",
    &WarpByDisplacement);
  add("Color By Deviation", "Colours distances evenly about zero", &ColorByDeviation);
  add("Pages", "What every filter does, its limits and errors",
    [] { pqHelpReaction::showHelp(Pages); });
}

KnotworkMenu::~KnotworkMenu()
{
  delete this->Examples;
}
