// SPDX-License-Identifier: BSD-3-Clause
// The functions of GeoFiles.h that need GDAL. Nothing of the modules is linked here.
#include "GeoFiles.h"

#include <gdal.h>
#include <gdal_frmts.h>
#include <ogr_api.h>
#include <ogr_spatialref.h>
#include <ogr_srs_api.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <sstream>
#include <system_error>

namespace knotwork
{
namespace
{
constexpr std::int64_t LeastCache = std::int64_t{ 1 } << 26U;
constexpr std::int64_t MostCache = std::int64_t{ 1 } << 30U;

/// GDAL keeps its messages to itself while one of these lives.
class Quietly
{
public:
  Quietly()
  {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~Quietly() { CPLPopErrorHandler(); }
  Quietly(const Quietly&) = delete;
  Quietly& operator=(const Quietly&) = delete;

  static bool HasFailed()
  {
    return CPLGetLastErrorType() == CE_Failure || CPLGetLastErrorType() == CE_Fatal;
  }
  /// What GDAL says last, one line.
  static std::string Reason()
  {
    std::string text = CPLGetLastErrorMsg();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "GDAL gives no reason" : text;
  }
};

void RegisterDrivers()
{
  static const bool done = []
  {
    GDALRegister_GTiff();
    RegisterOGRGeoPackage();
    return true;
  }();
  static_cast<void>(done);
}

struct CloseDataset
{
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using DatasetOwner = std::unique_ptr<void, CloseDataset>;

struct DestroySystem
{
  void operator()(OGRSpatialReferenceH system) const { OSRDestroySpatialReference(system); }
};
using SystemOwner = std::unique_ptr<void, DestroySystem>;

/// Null: PROJ does not know it, or the text is empty.
SystemOwner SystemOf(const std::string& text)
{
  if (text.empty())
  {
    return nullptr;
  }
  SystemOwner system(OSRNewSpatialReference(nullptr));
  const char* options[] = { "ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr };
  auto* known = OGRSpatialReference::FromHandle(system.get());
  if (known->SetFromUserInput(text.c_str(), options) != OGRERR_NONE)
  {
    return nullptr;
  }
  OSRSetAxisMappingStrategy(system.get(), OAMS_TRADITIONAL_GIS_ORDER); // x is east
  return system;
}

std::string WktOf(OGRSpatialReferenceH system)
{
  char* text = nullptr;
  std::string wkt;
  if (system && OSRExportToWkt(system, &text) == OGRERR_NONE && text)
  {
    wkt = text;
  }
  CPLFree(text);
  return wkt;
}

/// EPSG codes that GeoTIFF keys tell, as "EPSG:25832"; the text itself where they are none.
std::string CodeOfKeys(const std::string& text)
{
  std::istringstream stream(text);
  std::string word;
  if (!(stream >> word) || word != "GeoKeyDirectory")
  {
    return text;
  }
  constexpr int geographicKey = 2048;
  constexpr int projectedKey = 3072;
  constexpr int verticalKey = 4096;
  constexpr int userDefined = 32767;
  std::vector<int> numbers;
  for (int number = 0; stream >> number;)
  {
    numbers.push_back(number);
  }
  const auto codeOf = [&numbers](int key)
  {
    for (std::size_t at = 4; at + 3 < numbers.size(); at += 4)
    {
      if (numbers[at] == key && numbers[at + 1] == 0 && numbers[at + 3] < userDefined)
      {
        return numbers[at + 3];
      }
    }
    return 0;
  };
  const int plane = codeOf(projectedKey) > 0 ? codeOf(projectedKey) : codeOf(geographicKey);
  const int vertical = codeOf(verticalKey);
  return plane == 0 ? text
                    : "EPSG:" + std::to_string(plane) +
      (vertical > 0 ? "+" + std::to_string(vertical) : std::string());
}

Result<MapReferenceSystem> Find(const std::string& text)
{
  const Quietly quietly;
  const SystemOwner system = SystemOf(CodeOfKeys(text));
  MapReferenceSystem found;
  found.Wkt = WktOf(system.get());
  if (found.Wkt.empty())
  {
    return { ErrorCode::InvalidParameter,
      "the coordinate reference system '" + text.substr(0, 60) +
        "' is unknown; give its number, such as EPSG:25832, or its WKT" };
  }
  const char* authority = OSRGetAuthorityName(system.get(), nullptr);
  const char* code = OSRGetAuthorityCode(system.get(), nullptr);
  const char* name = OSRGetName(system.get());
  found.Name = authority && code ? std::string(authority) + ":" + code : name ? name : "unnamed";
  return found;
}

Status NoRaster(const std::string& file, const std::string& reason)
{
  return { ErrorCode::InvalidFormat, "'" + file + "': " + reason };
}

class TiffSource : public RasterSource
{
public:
  Status Open(const std::string& file)
  {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) // GDAL would know other sources
    {
      return { ErrorCode::FileError,
        "'" + file + "' cannot be read; check its name and permissions" };
    }
    this->File = file;
    const Quietly quietly;
    const char* drivers[] = { "GTiff", nullptr };
    this->Dataset.reset(GDALOpenEx(file.c_str(),
      GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers, nullptr, nullptr));
    if (!this->Dataset)
    {
      return NoRaster(
        file, "it is no GeoTIFF that can be read: " + Quietly::Reason() + "; fetch it again");
    }
    if (const int bands = GDALGetRasterCount(this->Dataset.get()); bands != 1)
    {
      return NoRaster(file,
        "it has " + std::to_string(bands) +
          " bands, heights are one; take one out: gdal_translate -b 1 in.tif out.tif");
    }
    this->Band = GDALGetRasterBand(this->Dataset.get(), 1);
    this->Type = GDALGetRasterDataType(this->Band);
    if (GDALDataTypeIsComplex(this->Type) != 0)
    {
      return NoRaster(file,
        std::string("its numbers are complex (") + GDALGetDataTypeName(this->Type) +
          "); write real ones: gdal_translate -ot Float64 in.tif out.tif");
    }
    if (Status status = this->FindPlace(); !status)
    {
      return status;
    }
    this->FindValues();
    return this->SizeCache();
  }

  Status Read(int firstRow, int rows, double* values) override
  {
    const Quietly quietly;
    const int columns = this->Grid.Columns;
    const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    this->Valid.assign(count, 255);
    const bool isRead = GDALRasterIO(this->Band, GF_Read, 0, firstRow, columns, rows, values,
                          columns, rows, GDT_Float64, 0, 0) == CE_None &&
      (!this->HasMask ||
        GDALRasterIO(GDALGetMaskBand(this->Band), GF_Read, 0, firstRow, columns, rows,
          this->Valid.data(), columns, rows, GDT_Byte, 0, 0) == CE_None);
    if (!isRead)
    {
      return NoRaster(this->File,
        "rows " + std::to_string(firstRow) + " to " + std::to_string(firstRow + rows - 1) +
          " cannot be read: " + Quietly::Reason() + "; it is truncated or damaged, fetch it again");
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      const double value = this->Scale * values[i] + this->Offset;
      values[i] = this->Valid[i] != 0 && std::isfinite(value)
        ? value
        : std::numeric_limits<double>::quiet_NaN();
    }
    return {};
  }

private:
  Status FindPlace()
  {
    this->Grid.Columns = GDALGetRasterXSize(this->Dataset.get());
    this->Grid.Rows = GDALGetRasterYSize(this->Dataset.get());
    auto& t = this->Grid.Transform;
    if (GDALGetGeoTransform(this->Dataset.get(), t.data()) != CE_None)
    {
      return NoRaster(this->File,
        "it does not say where it lies (no geotransform); say it: gdal_translate -a_ullr LEFT TOP "
        "RIGHT BOTTOM in.tif out.tif, or gdalwarp where it has ground control points");
    }
    const double area = t[1] * t[5] - t[2] * t[4];
    const bool isFinite =
      std::all_of(t.begin(), t.end(), [](double x) { return std::isfinite(x); });
    if (!isFinite || !std::isfinite(area) || area == 0.0)
    {
      return NoRaster(this->File,
        "its geotransform gives cells without an area; correct it: gdal_translate -a_ullr");
    }
    OGRSpatialReferenceH system = GDALGetSpatialRef(this->Dataset.get());
    const std::string name = system && OSRIsLocal(system) != 0 ? OSRGetName(system) : "";
    if (name != "unnamed" && name != "unknown") // GDAL's words for none
    {
      this->Grid.ReferenceSystem = WktOf(system);
    }
    return {};
  }

  void FindValues()
  {
    int isThere = 0;
    const double scale = GDALGetRasterScale(this->Band, &isThere);
    this->Scale = isThere != 0 ? scale : 1.0;
    const double offset = GDALGetRasterOffset(this->Band, &isThere);
    this->Offset = isThere != 0 ? offset : 0.0;
    this->HasMask = (GDALGetMaskFlags(this->Band) & GMF_ALL_VALID) == 0;
    const int others = CSLCount(GDALGetMetadata(this->Dataset.get(), "SUBDATASETS")) / 2;
    if (others > 1)
    {
      this->LeftOut.push_back("pages 2 to " + std::to_string(others) + " are left out");
    }
  }

  /// Blocks of a row stay in memory, so that each is decoded once.
  Status SizeCache()
  {
    int side = 0;
    GDALGetBlockSize(this->Band, &side, &this->RowsOfBlock);
    const std::int64_t across = (this->Grid.Columns + std::int64_t{ side } - 1) / side;
    const std::int64_t bytes =
      across * side * this->RowsOfBlock * (GDALGetDataTypeSizeBytes(this->Type) + 1);
    if (bytes > MostCache)
    {
      return { ErrorCode::TooLarge,
        "'" + this->File + "': a row of its blocks takes " + std::to_string(bytes >> 20) +
          " MB, more than 1024; write smaller ones: gdal_translate -co TILED=YES in.tif out.tif" };
    }
    GDALSetCacheMax64(std::max(LeastCache, 2 * bytes));
    return {};
  }

  std::string File;
  DatasetOwner Dataset;
  GDALRasterBandH Band = nullptr;
  GDALDataType Type = GDT_Unknown;
  double Scale = 1.0;
  double Offset = 0.0;
  bool HasMask = false;
  std::vector<unsigned char> Valid;
};

Result<std::shared_ptr<RasterSource>> Open(const std::string& file)
{
  RegisterDrivers();
  auto source = std::make_shared<TiffSource>();
  Status status = source->Open(file);
  return status ? Result<std::shared_ptr<RasterSource>>(source) : status;
}

Status CannotWrite(const std::string& file)
{
  return { ErrorCode::FileError,
    "'" + file + "' cannot be written: " + Quietly::Reason() +
      "; check the folder, its permissions and the room on the disk" };
}

class TiffTarget : public RasterTarget
{
public:
  Status Create(const std::string& file, const RasterGrid& grid, const RasterFormat& format)
  {
    this->File = file;
    const Quietly quietly;
    GDALSetCacheMax64(LeastCache);
    const char* options[] = { "TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256", "COMPRESS=DEFLATE",
      "PREDICTOR=3", "BIGTIFF=IF_SAFER", nullptr };
    this->Dataset.reset(GDALCreate(GDALGetDriverByName("GTiff"), file.c_str(), grid.Columns,
      grid.Rows, 1, format.IsDouble ? GDT_Float64 : GDT_Float32, const_cast<char**>(options)));
    if (!this->Dataset)
    {
      return CannotWrite(file);
    }
    this->Band = GDALGetRasterBand(this->Dataset.get(), 1);
    auto transform = grid.Transform;
    const SystemOwner system = SystemOf(grid.ReferenceSystem);
    const bool isSet = GDALSetGeoTransform(this->Dataset.get(), transform.data()) == CE_None &&
      (!system || GDALSetSpatialRef(this->Dataset.get(), system.get()) == CE_None) &&
      GDALSetRasterNoDataValue(this->Band, format.NoData) == CE_None;
    return isSet ? Status() : CannotWrite(file);
  }

  Status Write(int column, int row, int columns, int rows, const double* values) override
  {
    const Quietly quietly;
    const CPLErr error = GDALRasterIO(this->Band, GF_Write, column, row, columns, rows,
      const_cast<double*>(values), columns, rows, GDT_Float64, 0, 0);
    return error == CE_None && !Quietly::HasFailed() ? Status() : CannotWrite(this->File);
  }

  Status Finish() override
  {
    const Quietly quietly;
    GDALFlushCache(this->Dataset.get());
    Status status = Quietly::HasFailed() ? CannotWrite(this->File) : Status();
    this->Dataset.reset();
    return status && Quietly::HasFailed() ? CannotWrite(this->File) : status;
  }

private:
  std::string File;
  DatasetOwner Dataset;
  GDALRasterBandH Band = nullptr;
};

Result<std::shared_ptr<RasterTarget>> Create(
  const std::string& file, const RasterGrid& grid, const RasterFormat& format)
{
  RegisterDrivers();
  auto target = std::make_shared<TiffTarget>();
  Status status = target->Create(file, grid, format);
  return status ? Result<std::shared_ptr<RasterTarget>>(target) : status;
}

/// All lines of a layer; false: GDAL has an error.
bool AddLines(const LineLayer& lines, OGRLayerH layer)
{
  for (const LineAttribute& attribute : lines.Attributes)
  {
    OGRFieldDefnH field =
      OGR_Fld_Create(attribute.Name.c_str(), attribute.IsInteger ? OFTInteger64 : OFTReal);
    const bool isMade = OGR_L_CreateField(layer, field, 0) == OGRERR_NONE;
    OGR_Fld_Destroy(field);
    if (!isMade)
    {
      return false;
    }
  }
  constexpr int step = 3 * sizeof(double);
  for (std::size_t l = 0; l + 1 < lines.Begins.size(); ++l)
  {
    OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    for (std::size_t a = 0; a < lines.Attributes.size(); ++a)
    {
      const double value = lines.Attributes[a].Values[l];
      lines.Attributes[a].IsInteger
        ? OGR_F_SetFieldInteger64(feature, static_cast<int>(a), static_cast<GIntBig>(value))
        : OGR_F_SetFieldDouble(feature, static_cast<int>(a), value);
    }
    OGRGeometryH line = OGR_G_CreateGeometry(wkbLineString25D);
    const double* first = lines.Points.data() + 3 * lines.Begins[l];
    OGR_G_SetPoints(line, static_cast<int>(lines.Begins[l + 1] - lines.Begins[l]), first, step,
      first + 1, step, first + 2, step);
    OGR_F_SetGeometryDirectly(feature, line);
    const bool isMade = OGR_L_CreateFeature(layer, feature) == OGRERR_NONE;
    OGR_F_Destroy(feature);
    if (!isMade)
    {
      return false;
    }
  }
  return true;
}

Status WriteLayer(const LineLayer& lines, const std::string& file)
{
  RegisterDrivers();
  const Quietly quietly;
  // the same lines make the same bytes
  CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z");
  DatasetOwner dataset(
    GDALCreate(GDALGetDriverByName("GPKG"), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  const SystemOwner system = SystemOf(lines.ReferenceSystem);
  OGRLayerH layer = dataset ? GDALDatasetCreateLayer(dataset.get(), lines.Name.c_str(),
                                system.get(), wkbLineString25D, nullptr)
                            : nullptr;
  const bool isWritten = layer &&
    GDALDatasetStartTransaction(dataset.get(), FALSE) == OGRERR_NONE && AddLines(lines, layer) &&
    GDALDatasetCommitTransaction(dataset.get()) == OGRERR_NONE;
  Status status = isWritten ? Status() : CannotWrite(file);
  if (status)
  {
    GDALFlushCache(dataset.get());
    status = Quietly::HasFailed() ? CannotWrite(file) : status;
  }
  dataset.reset();
  CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr);
  return status && Quietly::HasFailed() ? CannotWrite(file) : status;
}
}
}

extern "C" __attribute__((visibility("default"))) const knotwork::GeoFunctions*
KnotworkGeoFunctions()
{
  using namespace knotwork;
  static const GeoFunctions functions{ &Find, &Open, &Create, &WriteLayer };
  return &functions;
}
