// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryJson.h"

#include "TextWords.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace knotwork
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr std::size_t MaxComponents = 3;

/// Reads one object of the list; the first failure stays in Outcome.
class SideReader
{
public:
  SideReader(const Json& side, std::string name) : Side(side), Name(std::move(name)) {}

  Status Outcome;

  template <int Dim>
  Spline<Dim> Read()
  {
    std::array<KnotVector, Dim> knots;
    const std::vector<Json> degrees = this->List(Dim == 1 ? "degree" : "degrees", Dim);
    std::vector<Json> vectors;
    if constexpr (Dim == 1)
    {
      vectors.push_back(this->At("knots"));
    }
    else
    {
      vectors = this->List("knots", Dim);
    }
    for (std::size_t d = 0; d < Dim && this->Outcome; ++d)
    {
      if (!degrees[d].is_number_integer())
      {
        this->Fail(Dim == 1 ? "degree" : "degrees", "is not a whole number");
        break;
      }
      const long long degree = degrees[d].get<long long>();
      const std::vector<double> values = this->Numbers(vectors[d], "knots");
      const int bounded = degree >= 0 && degree <= MaxDegree ? static_cast<int>(degree) : -1;
      auto made = KnotVector::Create(bounded, values);
      this->Keep(made.Status);
      knots[d] = std::move(made.Value);
    }
    Spline<Dim> spline;
    if (!this->Outcome)
    {
      return spline;
    }
    auto space = MakeTensorSpace<Dim>(knots);
    this->Keep(space.Status);
    spline.Space = space.Value;
    this->ReadPoints(spline.ControlPoints);
    if (this->Side.contains("weights") && this->Outcome)
    {
      const std::vector<double> weights = this->Numbers(this->Side["weights"], "weights");
      const bool ones =
        std::all_of(weights.begin(), weights.end(), [](double w) { return w == 1.0; });
      if (!ones)
      {
        spline.Weights = Eigen::Map<const Eigen::VectorXd>(
          weights.data(), static_cast<Eigen::Index>(weights.size()));
      }
    }
    if (this->Outcome)
    {
      this->Keep(spline.Check());
    }
    return spline;
  }

private:
  void Fail(const char* key, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { ErrorCode::InvalidFormat, this->Name + ": \"" + key + "\" " + what };
    }
  }
  void Keep(const Status& status)
  {
    if (this->Outcome && !status)
    {
      this->Outcome = { status.Code, this->Name + ": " + status.Detail };
    }
  }

  const Json& At(const char* key)
  {
    static const Json nothing;
    const auto found = this->Side.find(key);
    if (found == this->Side.end())
    {
      this->Fail(key, "is missing");
      return nothing;
    }
    return *found;
  }

  /// A list of so many entries; one entry may stand without a list.
  std::vector<Json> List(const char* key, std::size_t size)
  {
    const Json& value = this->At(key);
    std::vector<Json> list;
    if (size == 1 && !value.is_array())
    {
      list.push_back(value);
    }
    else if (value.is_array() && value.size() == size)
    {
      list.assign(value.begin(), value.end());
    }
    else
    {
      this->Fail(key, "is not a list of " + std::to_string(size));
      list.resize(size);
    }
    return list;
  }

  std::vector<double> Numbers(const Json& list, const char* key)
  {
    std::vector<double> values;
    if (!list.is_array())
    {
      this->Fail(key, "is not a list of numbers");
      return values;
    }
    values.reserve(list.size());
    for (const Json& value : list)
    {
      if (!value.is_number())
      {
        this->Fail(key, "has an entry " + std::to_string(values.size()) + " that is no number");
        return values;
      }
      values.push_back(value.get<double>());
    }
    return values;
  }

  void ReadPoints(PointMatrix& points)
  {
    const Json& rows = this->At("control_points");
    if (!rows.is_array() || rows.empty() || !rows[0].is_array() || rows[0].empty() ||
      rows[0].size() > MaxComponents)
    {
      this->Fail("control_points", "is not a list of points of 1 to 3 coordinates");
      return;
    }
    points.resize(
      static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
    for (std::size_t i = 0; i < rows.size() && this->Outcome; ++i)
    {
      const std::vector<double> row = this->Numbers(rows[i], "control_points");
      if (row.size() != rows[0].size())
      {
        this->Fail("control_points",
          "has a point " + std::to_string(i) + " of " + std::to_string(row.size()) +
            " coordinates, the first has " + std::to_string(rows[0].size()));
        return;
      }
      std::copy(row.begin(), row.end(), points.row(static_cast<Eigen::Index>(i)).data());
    }
  }

  const Json& Side;
  std::string Name;
};

template <int Dim>
Result<SplineFile> ReadSides(const Json& list, const char* key)
{
  SplineFile file;
  if (!list.is_array() || list.empty())
  {
    return { ErrorCode::EmptyInput, std::string("\"") + key + "\" holds no side" };
  }
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    std::string name = "side " + std::to_string(i);
    if (list[i].is_object() && list[i].contains("side") && list[i]["side"].is_string())
    {
      name += " (" + Shown(list[i]["side"].get<std::string>()) + ")";
    }
    if (!list[i].is_object())
    {
      return { ErrorCode::InvalidFormat, name + " is not an object" };
    }
    SideReader reader(list[i], name);
    Spline<Dim> side = reader.Read<Dim>();
    if (!reader.Outcome)
    {
      return reader.Outcome;
    }
    file.Splines.emplace_back(std::move(side));
  }
  return file;
}
}

Result<SplineFile> ReadBoundaryJson(std::string_view text)
{
  // without exceptions: a text that is no JSON gives a discarded value
  const Json root = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!root.is_object())
  {
    return { ErrorCode::InvalidFormat, "the text is not a JSON object (cut off or damaged?)" };
  }
  if (root.contains("curves"))
  {
    return ReadSides<1>(root["curves"], "curves");
  }
  if (root.contains("faces"))
  {
    return ReadSides<2>(root["faces"], "faces");
  }
  return { ErrorCode::InvalidFormat,
    "the JSON object has neither \"curves\" nor \"faces\": it is no boundary of a domain" };
}

bool LooksLikeBoundaryJson(std::string_view beginning)
{
  const std::size_t first = beginning.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && beginning[first] == '{';
}
}
