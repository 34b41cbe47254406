// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-view PARENT BYTES SECONDS WIDTH HEIGHT ARRAY COMPONENT DIRECTION EDGES COLOUR
// BACKGROUND TOLERANCE
// Draws the data that it gets, see vtkPictureWriter, and hands over a PNG file; see WorkerMain.h.
#include "DataParts.h"
#include "Messages.h"
#include "OffScreen.h"
#include "PictureLines.h"
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/WorkerMain.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SplineIO/vtkPictureWriter.h>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkDoubleArray.h>
#include <vtkLookupTable.h>
#include <vtkMath.h>
#include <vtkNamedColors.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using namespace knotwork;

using Vector = std::array<double, 3>;

struct Wishes
{
  std::array<int, 2> Size;
  std::string Array;
  int Component;
  Vector Direction; ///< from the data to the eye; none: by the data
  int Edges;
  Vector Colour;
  Vector Background;
  double Tolerance;
};

/// One block as it is drawn.
struct Block
{
  vtkSmartPointer<vtkPolyData> Shape;
  PictureLines Lines;
  bool IsSpline = false;
  bool HasCells = false; ///< lines or polygons
};

constexpr const char* Values = "Values"; // array that colours
constexpr long long MaximumElements = 5000;

Result<Vector> ColourOf(const std::string& name)
{
  vtkNew<vtkNamedColors> colours;
  vtkColor4ub found;
  const bool isCode = name.size() == 7 && name[0] == '#' &&
    name.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!isCode && !colours->ColorExists(name))
  {
    return { ErrorCode::InvalidParameter,
      "there is no colour '" + name + "'; name one of CSS, such as steelblue, or write #rrggbb" };
  }
  found = isCode ? colours->HTMLColorToRGBA(name) : colours->GetColor4ub(name);
  return Vector{ found[0] / 255.0, found[1] / 255.0, found[2] / 255.0 };
}

Result<Vector> DirectionOf(const std::string& text)
{
  if (text.empty() || text == "auto")
  {
    return Vector{};
  }
  if (text == "iso")
  {
    return Vector{ -0.6, -1.0, 0.7 };
  }
  Vector found{};
  if (text.size() == 2 && (text[0] == '+' || text[0] == '-') && text[1] >= 'x' && text[1] <= 'z')
  {
    found[static_cast<std::size_t>(text[1] - 'x')] = text[0] == '+' ? 1.0 : -1.0;
    return found;
  }
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  char comma = ',';
  for (int k = 0; k < 3 && stream; ++k)
  {
    comma = ',';
    if (k > 0)
    {
      stream >> comma;
    }
    stream >> found[static_cast<std::size_t>(k)];
    if (comma != ',')
    {
      stream.setstate(std::ios::failbit);
    }
  }
  const double length = vtkMath::Norm(found.data());
  if (!stream || stream.peek() != std::istringstream::traits_type::eof() || !(length > 0.0) ||
    !std::isfinite(length))
  {
    return { ErrorCode::InvalidParameter,
      "there is no direction '" + text +
        "'; write iso, +x, -x, +y, -y, +z, -z, auto or three numbers such as 1,-2,0.5" };
  }
  return found;
}

/// Datasets of a collection in its order.
std::vector<vtkDataSet*> LeavesOf(vtkDataObject* data)
{
  if (auto* one = vtkDataSet::SafeDownCast(data))
  {
    return { one };
  }
  std::vector<vtkDataSet*> found;
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data);
  for (unsigned int i = 0; collection && i < collection->GetNumberOfPartitionedDataSets(); ++i)
  {
    vtkPartitionedDataSet* set = collection->GetPartitionedDataSet(i);
    for (unsigned int k = 0; set && k < set->GetNumberOfPartitions(); ++k)
    {
      if (vtkDataSet* leaf = set->GetPartition(k))
      {
        found.push_back(leaf);
      }
    }
  }
  return found;
}

bool IsBezier(vtkDataSet* data)
{
  const int type = data->GetNumberOfCells() > 0 ? data->GetCellType(0) : VTK_EMPTY_CELL;
  return type == VTK_BEZIER_CURVE || type == VTK_BEZIER_QUADRILATERAL ||
    type == VTK_BEZIER_HEXAHEDRON;
}

Result<vtkSmartPointer<vtkPolyData>> Tessellated(vtkDataSet* splines, double tolerance)
{
  vtkNew<vtkSplineTessellate> filter;
  filter->SetInputDataObject(splines);
  filter->SetChordalTolerance(tolerance);
  filter->SplittingOn();
  MessageCapture messages;
  filter->Update();
  if (messages.HasError() || filter->GetErrorCode() != 0)
  {
    return { CodeOfFilter(filter), messages.FirstError() };
  }
  return vtkSmartPointer<vtkPolyData>(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0)));
}

/// The surface of any cells, curved ones as small polygons.
vtkSmartPointer<vtkPolyData> SurfaceOf(vtkDataSet* cells)
{
  constexpr int subdivision = 3;
  vtkNew<vtkDataSetSurfaceFilter> filter;
  filter->SetInputData(cells);
  filter->SetNonlinearSubdivisionLevel(subdivision);
  filter->PassThroughCellIdsOn();
  filter->SetOriginalCellIdsName("CellOfMesh");
  filter->Update();
  return filter->GetOutput();
}

bool HasCurvedCells(vtkDataSet* data)
{
  vtkNew<vtkCellTypes> types;
  data->GetCellTypes(types);
  for (vtkIdType i = 0; i < types->GetNumberOfTypes(); ++i)
  {
    if (vtkCellTypes::IsLinear(types->GetCellType(i)) == 0)
    {
      return true;
    }
  }
  return false;
}

Result<Block> MakeBlock(vtkDataSet* data, const Wishes& wishes)
{
  Block block;
  const char* elements = nullptr;
  if (IsBezier(data))
  {
    auto found = Tessellated(data, wishes.Tolerance);
    if (!found)
    {
      return found.Status;
    }
    block.Shape = found.Value;
    block.IsSpline = true;
  }
  else if (auto* polygons = vtkPolyData::SafeDownCast(data))
  {
    block.Shape = vtkSmartPointer<vtkPolyData>::New();
    block.Shape->ShallowCopy(polygons);
  }
  else
  {
    block.Shape = SurfaceOf(data);
    elements = HasCurvedCells(data) ? "CellOfMesh" : nullptr;
  }
  if (block.Shape->GetNumberOfCells() == 0) // points alone
  {
    block.Shape->SetPoints(vtkPointSet::SafeDownCast(data)->GetPoints());
    block.Shape->GetPointData()->ShallowCopy(data->GetPointData());
  }
  if (block.Shape->GetCellData()->GetArray("ElementId"))
  {
    elements = "ElementId";
  }
  if (block.Shape->GetNumberOfPolys() > 0 && wishes.Edges != vtkPictureWriter::NONE)
  {
    block.Lines = FindPictureLines(
      block.Shape, wishes.Edges == vtkPictureWriter::CELLS ? nullptr : elements, !block.IsSpline);
  }
  block.HasCells = block.Shape->GetNumberOfPolys() + block.Shape->GetNumberOfLines() > 0;
  return block;
}

/// Where a block has arrays: of its points first.
std::array<vtkDataSetAttributes*, 2> AttributesOf(const Block& block)
{
  return { block.Shape->GetPointData(), block.Shape->GetCellData() };
}

/// The numbers that colour a block, added to its shape. @return whether it has the array.
bool AddValues(Block& block, const Wishes& wishes)
{
  for (vtkDataSetAttributes* data : AttributesOf(block))
  {
    vtkDataArray* array = data->GetArray(wishes.Array.c_str());
    if (!array || wishes.Component >= array->GetNumberOfComponents())
    {
      continue;
    }
    vtkNew<vtkDoubleArray> values;
    values->SetName(Values);
    values->SetNumberOfTuples(array->GetNumberOfTuples());
    const int count = array->GetNumberOfComponents();
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      double value = array->GetComponent(i, std::max(0, wishes.Component));
      if (wishes.Component < 0 && count > 1)
      {
        double square = 0.0;
        for (int k = 0; k < count; ++k)
        {
          square += array->GetComponent(i, k) * array->GetComponent(i, k);
        }
        value = std::sqrt(square);
      }
      values->SetValue(i, value);
    }
    data->AddArray(values);
    return true;
  }
  return false;
}

/// Names of the arrays that could colour, in one text.
std::string NamesOfArrays(const std::vector<Block>& blocks)
{
  std::set<std::string> names;
  for (const Block& block : blocks)
  {
    for (vtkDataSetAttributes* data : AttributesOf(block))
    {
      for (int i = 0; i < data->GetNumberOfArrays(); ++i)
      {
        if (vtkDataArray* array = data->GetArray(i); array && array->GetName())
        {
          names.insert(std::string(array->GetName()) + " (" +
            std::to_string(array->GetNumberOfComponents()) + ")");
        }
      }
    }
  }
  std::string text;
  for (const std::string& name : names)
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

/// From dark blue over green to yellow, as bright as the value is large: told apart without colours
/// too.
vtkSmartPointer<vtkLookupTable> ColoursOf(std::array<double, 2> range)
{
  vtkNew<vtkColorTransferFunction> scale;
  scale->SetColorSpaceToLab();
  scale->AddRGBPoint(0.0, 0.27, 0.30, 0.68);
  scale->AddRGBPoint(0.25, 0.18, 0.50, 0.73);
  scale->AddRGBPoint(0.5, 0.15, 0.67, 0.63);
  scale->AddRGBPoint(0.75, 0.53, 0.82, 0.42);
  scale->AddRGBPoint(1.0, 0.98, 0.91, 0.36);
  constexpr int count = 256;
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(count);
  for (int i = 0; i < count; ++i)
  {
    Vector colour{};
    scale->GetColor(i / (count - 1.0), colour.data());
    table->SetTableValue(i, colour[0], colour[1], colour[2]);
  }
  table->SetNanColor(0.6, 0.6, 0.6, 1.0);
  table->SetRange(range.data());
  return table;
}

/// Finite values of all blocks; empty where there are none.
std::array<double, 2> RangeOfValues(const std::vector<Block>& blocks)
{
  std::array<double, 2> range{ std::numeric_limits<double>::max(),
    std::numeric_limits<double>::lowest() };
  for (const Block& block : blocks)
  {
    for (vtkDataSetAttributes* data : AttributesOf(block))
    {
      if (vtkDataArray* values = data->GetArray(Values))
      {
        std::array<double, 2> one{};
        values->GetFiniteRange(one.data());
        range = { std::min(range[0], one[0]), std::max(range[1], one[1]) };
      }
    }
  }
  return range[0] <= range[1] ? range : std::array<double, 2>{ 0.0, 0.0 };
}

vtkSmartPointer<vtkPolyData> WithNormals(vtkPolyData* shape)
{
  constexpr double sharp = 45.0;
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(shape);
  normals->SetFeatureAngle(sharp);
  normals->ConsistencyOff();
  normals->Update();
  return normals->GetOutput();
}

vtkSmartPointer<vtkActor> ActorOfLines(vtkPolyData* lines, const Vector& ink, double width)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(lines);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(ink[0], ink[1], ink[2]);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  actor->GetProperty()->LightingOff();
  return actor;
}

class Scene
{
public:
  Scene(const Wishes& wishes, std::vector<Block> blocks)
    : Wanted(wishes), Blocks(std::move(blocks)),
      Pixel(std::min(wishes.Size[0], wishes.Size[1]) / 900.0)
  {
    const Vector& ground = wishes.Background;
    const bool isDark = 0.3 * ground[0] + 0.59 * ground[1] + 0.11 * ground[2] < 0.5;
    this->Ink = isDark ? Vector{ 0.94, 0.94, 0.94 } : Vector{ 0.12, 0.14, 0.18 };
  }

  Result<std::string> Draw()
  {
    auto window = MakeOffScreenWindow(this->Wanted.Size[0], this->Wanted.Size[1]);
    if (!window)
    {
      return window.Status;
    }
    this->AddBlocks();
    const double width = this->Colours ? 0.84 : 1.0; // the legend has the rest
    this->View->SetViewport(0.0, 0.0, width, 1.0);
    this->View->SetBackground(this->Wanted.Background.data());
    this->PlaceCamera(width * this->Wanted.Size[0] / this->Wanted.Size[1]);
    window.Value->AddRenderer(this->View);
    vtkNew<vtkRenderer> side;
    if (this->Colours)
    {
      side->SetViewport(width, 0.0, 1.0, 1.0);
      side->SetBackground(this->Wanted.Background.data());
      side->AddActor2D(this->Legend());
      window.Value->AddRenderer(side);
    }
    window.Value->Render();
    vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window.Value);
    image->ReadFrontBufferOff();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(image->GetOutputPort());
    writer->WriteToMemoryOn();
    writer->Write();
    vtkUnsignedCharArray* bytes = writer->GetResult();
    return std::string(reinterpret_cast<const char*>(bytes->GetPointer(0)),
      static_cast<std::size_t>(bytes->GetNumberOfValues()));
  }

private:
  void AddBlocks()
  {
    long long elements = 0;
    for (const Block& block : this->Blocks)
    {
      elements += block.Lines.NumElements;
    }
    const bool showElements = this->Wanted.Edges == vtkPictureWriter::ELEMENTS ||
      this->Wanted.Edges == vtkPictureWriter::CELLS ||
      (this->Wanted.Edges == vtkPictureWriter::AUTO && elements <= MaximumElements);
    if (!this->Wanted.Array.empty())
    {
      this->Colours = ColoursOf(RangeOfValues(this->Blocks));
    }
    for (const Block& block : this->Blocks)
    {
      this->AddShape(block, showElements);
      if (showElements && block.Lines.Elements)
      {
        this->View->AddActor(ActorOfLines(block.Lines.Elements, this->Ink, this->Pixel));
      }
      if (block.Lines.Patches)
      {
        this->View->AddActor(ActorOfLines(block.Lines.Patches, this->Ink, 2.2 * this->Pixel));
      }
    }
  }

  void AddShape(const Block& block, bool showElements)
  {
    vtkSmartPointer<vtkPolyData> shape = block.Shape;
    // normals that come with a mesh may be means across its edges
    const bool isMesh = !block.IsSpline && shape->GetNumberOfPolys() > 0;
    const bool isFlat = isMesh && showElements; // its cells are what is shown
    if (isMesh && !isFlat)
    {
      shape = WithNormals(shape);
    }
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(shape);
    const bool byPoints = shape->GetPointData()->GetArray(Values) != nullptr;
    if (this->Colours && (byPoints || shape->GetCellData()->GetArray(Values)))
    {
      byPoints ? mapper->SetScalarModeToUsePointFieldData()
               : mapper->SetScalarModeToUseCellFieldData();
      mapper->SelectColorArray(Values);
      mapper->SetLookupTable(this->Colours);
      mapper->UseLookupTableScalarRangeOn();
      mapper->InterpolateScalarsBeforeMappingOn();
    }
    else
    {
      mapper->ScalarVisibilityOff();
    }
    if (shape->GetNumberOfPolys() > 0) // lines lie on it
    {
      mapper->SetResolveCoincidentTopologyToPolygonOffset();
      mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(2.0, 2.0);
    }
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    Vector colour = this->Wanted.Colour;
    if (shape->GetNumberOfPolys() == 0) // lines and points need more contrast
    {
      std::transform(colour.begin(), colour.end(), this->Ink.begin(), colour.begin(),
        [](double a, double b) { return (a + b) / 2.0; });
    }
    look->SetColor(colour.data());
    look->SetAmbient(0.3);
    look->SetDiffuse(0.75);
    look->SetLineWidth(static_cast<float>(3.0 * this->Pixel));
    constexpr vtkIdType manyPoints = 20000;
    const double dot = block.Shape->GetNumberOfPoints() > manyPoints ? 2.0 : 5.0;
    look->SetPointSize(static_cast<float>(std::max(1.0, dot * this->Pixel)));
    if (isFlat)
    {
      look->SetInterpolationToFlat();
    }
    if (shape->GetNumberOfPolys() == 0)
    {
      look->LightingOff();
    }
    if (!block.HasCells && shape->GetNumberOfVerts() == 0)
    {
      look->SetRepresentationToPoints();
    }
    this->View->AddActor(actor);
  }

  /// Looks at the middle of the box of all that is drawn, from as near as shows its corners.
  void PlaceCamera(double aspect)
  {
    std::array<double, 6> box{};
    this->View->ComputeVisiblePropBounds(box.data());
    Vector size{ box[1] - box[0], box[3] - box[2], box[5] - box[4] };
    const double largest = *std::max_element(size.begin(), size.end());
    constexpr double thin = 1e-9;
    const auto flat = static_cast<std::size_t>(
      std::min_element(size.rbegin(), size.rend()) - size.rbegin()); // z where several are
    const std::size_t axis = 2 - flat;
    const bool isFlat = size[axis] <= thin * largest;
    Vector to = this->Wanted.Direction;
    const bool isChosen = vtkMath::Norm(to.data()) > 0.0;
    if (!isChosen)
    {
      to = { -0.6, -1.0, 0.7 };
      if (isFlat)
      {
        to = {};
        to[axis] = axis == 1 ? -1.0 : 1.0; // a plane of x and z has x to the right
      }
    }
    vtkMath::Normalize(to.data());
    Vector up{ 0.0, 0.0, 1.0 };
    if (std::abs(to[2]) > 0.999)
    {
      up = { 0.0, 1.0, 0.0 };
    }
    Vector right{};
    vtkMath::Cross(up.data(), to.data(), right.data());
    vtkMath::Normalize(right.data());
    vtkMath::Cross(to.data(), right.data(), up.data());
    vtkCamera* camera = this->View->GetActiveCamera();
    constexpr double degrees = 30.0; // that the height of the view spans
    constexpr double margin = 1.05;
    const double slope = std::tan(vtkMath::RadiansFromDegrees(degrees / 2.0)) / margin;
    double distance = 0.0;
    double height = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const Vector at{ ((corner & 1) - 0.5) * size[0], (((corner >> 1) & 1) - 0.5) * size[1],
        ((corner >> 2) - 0.5) * size[2] };
      const double across = std::max(std::abs(vtkMath::Dot(at.data(), right.data())) / aspect,
        std::abs(vtkMath::Dot(at.data(), up.data())));
      distance = std::max(distance, vtkMath::Dot(at.data(), to.data()) + across / slope);
      height = std::max(height, margin * across);
    }
    distance = distance > 0.0 ? distance : 1.0;
    const Vector middle{ (box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2 };
    camera->SetViewAngle(degrees);
    camera->SetFocalPoint(middle.data());
    camera->SetPosition(
      middle[0] + distance * to[0], middle[1] + distance * to[1], middle[2] + distance * to[2]);
    camera->SetViewUp(up.data());
    if (isFlat && !isChosen)
    {
      camera->ParallelProjectionOn();
      camera->SetParallelScale(height > 0.0 ? height : 1.0);
    }
    this->View->ResetCameraClippingRange();
  }

  vtkSmartPointer<vtkScalarBarActor> Legend() const
  {
    auto legend = vtkSmartPointer<vtkScalarBarActor>::New();
    legend->SetLookupTable(this->Colours);
    legend->SetTitle(this->Wanted.Array.c_str());
    legend->SetNumberOfLabels(5);
    legend->SetLabelFormat("%-#.4g");
    legend->UnconstrainedFontSizeOn();
    legend->SetPosition(0.05, 0.1);
    legend->SetWidth(0.9);
    legend->SetHeight(0.8);
    legend->SetBarRatio(0.25);
    for (vtkTextProperty* text : { legend->GetTitleTextProperty(), legend->GetLabelTextProperty() })
    {
      text->SetColor(this->Ink[0], this->Ink[1], this->Ink[2]);
      text->SetFontSize(static_cast<int>(std::lround(22.0 * this->Pixel)));
      text->ItalicOff();
      text->BoldOff();
      text->ShadowOff();
    }
    return legend;
  }

  const Wishes& Wanted;
  std::vector<Block> Blocks;
  double Pixel; ///< width of a thin line
  Vector Ink{};
  vtkNew<vtkRenderer> View;
  vtkSmartPointer<vtkLookupTable> Colours; ///< null: no array colours
};

Result<Wishes> Understood(const Parts& words)
{
  constexpr std::size_t count = 9;
  if (words.size() != count)
  {
    return { ErrorCode::InvalidParameter, "words are missing" };
  }
  const auto direction = DirectionOf(words[4]);
  const auto colour = ColourOf(words[6]);
  const auto background = ColourOf(words[7]);
  for (const auto* each : { &direction, &colour, &background })
  {
    if (!*each)
    {
      return each->Status;
    }
  }
  return Wishes{ { std::stoi(words[0]), std::stoi(words[1]) }, words[2], std::stoi(words[3]),
    direction.Value, std::stoi(words[5]), colour.Value, background.Value, std::stod(words[8]) };
}

Status Draw(const Parts& words, const Parts& input, Parts& found)
{
  const auto wishes = Understood(words);
  if (!wishes)
  {
    return wishes.Status;
  }
  Parts parts = input;
  std::size_t next = 0;
  const vtkSmartPointer<vtkDataObject> data = TakeData(parts, next);
  std::vector<Block> blocks;
  for (vtkDataSet* leaf : LeavesOf(data))
  {
    if (leaf->GetNumberOfPoints() == 0)
    {
      continue;
    }
    auto block = MakeBlock(leaf, wishes.Value);
    if (!block)
    {
      return block.Status;
    }
    blocks.push_back(std::move(block.Value));
  }
  if (blocks.empty())
  {
    return { ErrorCode::EmptyInput, "there are no points to draw; check the input" };
  }
  bool hasArray = wishes.Value.Array.empty();
  for (Block& block : blocks)
  {
    hasArray = (!wishes.Value.Array.empty() && AddValues(block, wishes.Value)) || hasArray;
  }
  if (!hasArray)
  {
    const std::string names = NamesOfArrays(blocks);
    return { ErrorCode::InvalidParameter,
      "there is no array '" + wishes.Value.Array + "' with such a component; " +
        (names.empty() ? "there are no arrays"
                       : "there are, with numbers of components: " + names) };
  }
  auto picture = Scene(wishes.Value, std::move(blocks)).Draw();
  found.push_back(std::move(picture.Value));
  return picture.Status;
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Draw);
}
