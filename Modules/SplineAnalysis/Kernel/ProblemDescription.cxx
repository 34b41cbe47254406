// SPDX-License-Identifier: BSD-3-Clause
#include "ProblemDescription.h"

#include "StiffnessMatrix.h"

#include <nlohmann/json.hpp>

#include <limits>
#include <set>

namespace knotwork
{
namespace
{
using Json = nlohmann::ordered_json;

/// Reads parts of a problem; the first failure stays in Outcome.
class ProblemReader
{
public:
  ProblemReader(GalerkinEquation equation, const GalerkinMaterial& material)
    : Equation(equation), Default(material), Components(NumSolutionComponents(equation))
  {
  }

  Status Outcome;

  ProblemDescription Read(const Json& root)
  {
    ProblemDescription problem;
    problem.Equation = this->Equation;
    problem.Materials = { this->Default };
    if (!this->IsObject(root, "the problem",
          { "material", "materials", "material_array", "source", "conditions", "exact" }))
    {
      return problem;
    }
    if (root.contains("material") && root.contains("materials"))
    {
      this->Fail("\"material\"", "stands beside \"materials\"; keep one of them");
    }
    if (root.contains("material"))
    {
      problem.Materials = { this->Material(root["material"], "\"material\"", nullptr) };
    }
    if (root.contains("materials"))
    {
      this->ReadMaterials(root["materials"], problem);
    }
    if (root.contains("material_array"))
    {
      problem.MaterialArray = this->Text(root["material_array"], "\"material_array\"");
    }
    if (problem.MaterialArray.empty() && problem.Materials.size() > 1)
    {
      this->Fail("\"materials\"",
        "has several and nothing says which element has which; name a cell array in "
        "\"material_array\"");
    }
    if (root.contains("source"))
    {
      problem.Source = this->Values(root["source"], "\"source\"", this->Components, false);
    }
    if (root.contains("exact"))
    {
      problem.Exact = this->Values(root["exact"], "\"exact\"", this->Components, false);
    }
    if (root.contains("conditions"))
    {
      const Json& list = root["conditions"];
      if (!list.is_array())
      {
        this->Fail("\"conditions\"", "is not a list");
      }
      for (std::size_t i = 0; i < list.size() && this->Outcome; ++i)
      {
        problem.Conditions.push_back(this->Condition(list[i], "condition " + std::to_string(i)));
      }
    }
    return problem;
  }

private:
  void Fail(const std::string& place, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { ErrorCode::InvalidFormat, place + " " + what };
    }
  }

  bool IsObject(const Json& value, const std::string& place, const std::set<std::string>& keys)
  {
    std::string known;
    for (const std::string& key : keys)
    {
      known += (known.empty() ? "" : ", ") + key;
    }
    if (!value.is_object())
    {
      this->Fail(place, "is not an object with keys out of: " + known);
      return false;
    }
    for (const auto& [key, entry] : value.items())
    {
      if (keys.count(key) == 0)
      {
        this->Fail(place, "has the unknown key \"" + key + "\"; known are: " + known);
        return false;
      }
    }
    return true;
  }

  double Number(const Json& value, const std::string& place)
  {
    if (!value.is_number())
    {
      this->Fail(place, "is not a number");
      return 0.0;
    }
    return value.get<double>();
  }

  long long WholeNumber(const Json& value, const std::string& place)
  {
    if (!value.is_number_integer())
    {
      this->Fail(place, "is not a whole number");
      return 0;
    }
    return value.get<long long>();
  }

  std::string Text(const Json& value, const std::string& place)
  {
    if (!value.is_string() || value.get<std::string>().empty())
    {
      this->Fail(place, "is not a text");
      return {};
    }
    return value.get<std::string>();
  }

  template <std::size_t N>
  std::array<double, N> Numbers(const Json& value, const std::string& place)
  {
    std::array<double, N> numbers{};
    if (!value.is_array() || value.size() != N)
    {
      this->Fail(place, "is not a list of " + std::to_string(N) + " numbers");
      return numbers;
    }
    for (std::size_t i = 0; i < N; ++i)
    {
      numbers[i] = this->Number(value[i], place);
    }
    return numbers;
  }

  std::optional<ProblemValue> Value(const Json& value, const std::string& place, bool mayBeFree)
  {
    if (value.is_null() && mayBeFree)
    {
      return {};
    }
    if (value.is_string())
    {
      return ProblemValue{ 0.0, this->Text(value, place) };
    }
    if (!value.is_number())
    {
      this->Fail(place,
        std::string("has an entry that is neither a number nor an expression in quotes") +
          (mayBeFree ? ", nor null for a free component" : ""));
      return {};
    }
    return ProblemValue{ value.get<double>(), "" };
  }

  /// One value may stand without a list.
  ProblemValues Values(const Json& value, const std::string& place, int count, bool mayBeFree)
  {
    ProblemValues values;
    if (count == 1 && !value.is_array())
    {
      values.push_back(this->Value(value, place, false));
      return values;
    }
    if (value.is_string() && value.get<std::string>()[0] == '@') // one function for all
    {
      for (int i = 0; i < count; ++i)
      {
        values.push_back(ProblemValue{ 0.0, value.get<std::string>() + "." + std::to_string(i) });
      }
      return values;
    }
    if (!value.is_array() || value.size() != static_cast<std::size_t>(count))
    {
      this->Fail(
        place, "is not a list of " + std::to_string(count) + (count == 1 ? " entry" : " entries"));
      return values;
    }
    for (const Json& entry : value)
    {
      values.push_back(this->Value(entry, place, mayBeFree));
    }
    return values;
  }

  GalerkinMaterial Material(const Json& value, const std::string& place, long long* number)
  {
    GalerkinMaterial material = this->Default;
    std::set<std::string> keys = this->Components == 1
      ? std::set<std::string>{ "conductivity" }
      : std::set<std::string>{ "youngs_modulus", "poissons_ratio" };
    if (number)
    {
      keys.insert("number");
    }
    if (!this->IsObject(value, place, keys))
    {
      return material;
    }
    const auto read = [&](const char* key, double& into)
    {
      if (value.contains(key))
      {
        into = this->Number(value[key], place + ": \"" + key + "\"");
      }
    };
    read("conductivity", material.Conductivity);
    read("youngs_modulus", material.YoungsModulus);
    read("poissons_ratio", material.PoissonsRatio);
    if (number && value.contains("number"))
    {
      *number = this->WholeNumber(value["number"], place + ": \"number\"");
    }
    return material;
  }

  void ReadMaterials(const Json& list, ProblemDescription& problem)
  {
    if (!list.is_array() || list.empty())
    {
      this->Fail("\"materials\"", "is not a list of materials");
      return;
    }
    problem.Materials.clear();
    std::set<long long> seen;
    for (std::size_t i = 0; i < list.size() && this->Outcome; ++i)
    {
      const std::string place = "material " + std::to_string(i);
      auto number = static_cast<long long>(i);
      problem.Materials.push_back(this->Material(list[i], place, &number));
      problem.MaterialNumbers.push_back(number);
      if (!seen.insert(number).second)
      {
        this->Fail(place, "has the number " + std::to_string(number) + ", which another one has");
      }
    }
  }

  ProblemRegion Region(const Json& condition, const std::string& place)
  {
    ProblemRegion region;
    const int count = static_cast<int>(condition.contains("on")) +
      static_cast<int>(condition.contains("along")) + static_cast<int>(condition.contains("at"));
    if (count != 1)
    {
      this->Fail(place,
        "needs one of \"on\" (facets), \"along\" (edges) and \"at\" (a point), which say where it "
        "acts");
      return region;
    }
    if (condition.contains("at"))
    {
      region.Kind = RegionKind::Point;
      const Json& at = condition["at"];
      const std::string name = place + ": \"at\"";
      if (at.is_array() && at.size() == 2)
      {
        const auto x = this->Numbers<2>(at, name);
        region.At = { x[0], x[1], 0.0 };
      }
      else
      {
        region.At = this->Numbers<3>(at, name);
      }
      return region;
    }
    const bool isFacets = condition.contains("on");
    region.Kind = isFacets ? RegionKind::Facets : RegionKind::Edges;
    const Json& where = isFacets ? condition["on"] : condition["along"];
    const std::string name = place + (isFacets ? ": \"on\"" : ": \"along\"");
    if (where == "boundary" && isFacets)
    {
      return region;
    }
    std::set<std::string> keys{ "patch", "side", "box", "where", "group" };
    if (!isFacets)
    {
      keys.insert("sides");
    }
    if (!this->IsObject(where, name, keys))
    {
      return region;
    }
    if (where.empty())
    {
      this->Fail(name, "is empty; write \"boundary\" for all of it");
    }
    const auto index = [&](const char* key, int& into)
    {
      if (where.contains(key))
      {
        const long long number = this->WholeNumber(where[key], name + ": \"" + key + "\"");
        if (number < 0 || number > std::numeric_limits<int>::max())
        {
          this->Fail(name + ": \"" + key + "\"", "is not a number from 0 on");
        }
        into = static_cast<int>(number);
      }
    };
    index("patch", region.Patch);
    index("side", region.Side);
    if (where.contains("sides"))
    {
      const auto sides = this->Numbers<2>(where["sides"], name + ": \"sides\"");
      region.Side = static_cast<int>(sides[0]);
      region.Other = static_cast<int>(sides[1]);
      if (region.Side != sides[0] || region.Other != sides[1] || region.Side < 0 ||
        region.Other < 0 || region.Side > 5 || region.Other > 5 || where.contains("side"))
      {
        this->Fail(name + ": \"sides\"",
          "are not two of the sides 0 to 5 that meet in edges, without another \"side\"");
      }
    }
    if (where.contains("box"))
    {
      region.Box = this->Numbers<6>(where["box"], name + ": \"box\"");
      for (std::size_t d = 0; d < 6; d += 2)
      {
        if ((*region.Box)[d] > (*region.Box)[d + 1])
        {
          this->Fail(name + ": \"box\"",
            "has a lower end above the upper one; its numbers are the ends of x, of y and of z");
        }
      }
    }
    if (where.contains("where"))
    {
      region.Where = this->Text(where["where"], name + ": \"where\"");
    }
    if (where.contains("group"))
    {
      const Json& group = where["group"];
      if (group.is_string())
      {
        region.GroupName = this->Text(group, name + ": \"group\"");
      }
      else
      {
        region.Group = this->WholeNumber(group, name + ": \"group\"");
      }
    }
    return region;
  }

  ProblemCondition Condition(const Json& value, const std::string& place)
  {
    ProblemCondition condition;
    const bool isPoisson = this->Components == 1;
    const std::string given = isPoisson ? "value" : "displacement";
    const std::string load = isPoisson ? "flux" : "traction";
    std::set<std::string> kinds{ given, load, "force" };
    if (!isPoisson)
    {
      kinds.insert("pressure");
    }
    std::set<std::string> keys = kinds;
    keys.insert({ "on", "along", "at" });
    if (!this->IsObject(value, place, keys))
    {
      return condition;
    }
    condition.Region = this->Region(value, place);
    std::string kind;
    for (const std::string& key : kinds)
    {
      if (value.contains(key))
      {
        if (!kind.empty())
        {
          this->Fail(place, "has both \"" + kind + "\" and \"" + key + "\"; make two of it");
        }
        kind = key;
      }
    }
    if (kind.empty())
    {
      this->Fail(place,
        "says nothing; give one of \"" + given + "\", \"" + load + "\", " +
          (isPoisson ? "" : "\"pressure\", ") + "\"force\"");
      return condition;
    }
    const RegionKind region = condition.Region.Kind;
    if (kind != given && (kind == "force") != (region != RegionKind::Facets))
    {
      this->Fail(place,
        "has a \"" + kind + "\" that does not act there: " +
          (kind == "force" ? "forces act \"at\" points and \"along\" edges"
                           : "it acts \"on\" facets"));
    }
    condition.Kind = kind == given ? ConditionKind::Value
      : kind == load               ? ConditionKind::Load
      : kind == "force"            ? ConditionKind::Force
                                   : ConditionKind::Pressure;
    condition.Values = this->Values(value[kind], place + ": \"" + kind + "\"",
      condition.Kind == ConditionKind::Pressure ? 1 : this->Components,
      condition.Kind == ConditionKind::Value);
    return condition;
  }

  GalerkinEquation Equation;
  GalerkinMaterial Default;
  int Components;
};
}

Result<ProblemDescription> ReadProblem(
  std::string_view text, GalerkinEquation equation, const GalerkinMaterial& material)
{
  Json root;
  try
  {
    root = Json::parse(text);
  }
  catch (const Json::parse_error& error)
  {
    return { ErrorCode::InvalidFormat,
      "the problem is not JSON, at byte " + std::to_string(error.byte) +
        "; the module's page has an example" };
  }
  catch (const Json::out_of_range&)
  {
    return { ErrorCode::InvalidFormat, "the problem has a number beyond all doubles" };
  }
  ProblemReader reader(equation, material);
  ProblemDescription problem = reader.Read(root);
  return reader.Outcome ? Result<ProblemDescription>(std::move(problem))
                        : Result<ProblemDescription>(reader.Outcome);
}
}
