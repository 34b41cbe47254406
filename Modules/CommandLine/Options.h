// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Ranges.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace knotwork
{
/// The options of one job. Those of its filter are generated from the filter's header:
/// AddProperties (FilterProperties.h) gives every property an option of the same name in
/// kebab-case, with the default of the constructed filter, the range of its clamp and the sentence
/// of its comment. What was chosen is set on the filter and written to the report.
class Options
{
public:
  explicit Options(CLI::App& job) : Job(job) {}

  /// Properties that do not become options, for they follow from others of the job.
  void LeaveOut(std::set<std::string> properties) { this->LeftOut = std::move(properties); }
  /// An option of another name than the property's.
  void Rename(const std::string& property, const std::string& name)
  {
    this->Names[property] = name;
  }

  /// A number, a list of them as long as the default, a text, or a truth value, which is on where
  /// the option stands without one (see Words.h).
  template <typename T>
  void Add(const std::string& property, const T& initial, std::function<void(const T&)> set,
    const std::string& help, CLI::Validator check = {})
  {
    if (this->LeftOut.count(property) != 0)
    {
      return;
    }
    const auto renamed = this->Names.find(property);
    const std::string& name = renamed == this->Names.end() ? property : renamed->second;
    auto value = std::make_shared<T>(initial);
    CLI::Option* option = nullptr;
    if constexpr (std::is_same_v<T, bool>)
    {
      option = this->Job.add_flag("--" + KebabCase(name), *value, help);
      option->option_text(initial ? "[0|1]=1" : "[0|1]=0");
    }
    else
    {
      option = this->Job.add_option("--" + KebabCase(name), *value, help);
      option->capture_default_str()->check(std::move(check));
    }
    if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<double>>)
    {
      option->expected(static_cast<int>(initial.size()));
    }
    this->Bound.push_back({ SnakeCase(name),
      [value, set = std::move(set)](nlohmann::ordered_json& json)
      {
        set(*value);
        json = *value;
      } });
  }

  /// One of a list of names, handed to `set` as its position.
  void AddChoice(const std::string& property, const std::vector<std::string>& names, int initial,
    std::function<void(int)> set, const std::string& help)
  {
    this->Add<std::string>(
      property, names[static_cast<std::size_t>(initial)],
      [names, set = std::move(set)](const std::string& name)
      {
        for (std::size_t i = 0; i < names.size(); ++i)
        {
          if (CLI::detail::to_lower(name) == names[i])
          {
            set(static_cast<int>(i));
          }
        }
      },
      help, CLI::IsMember(names, CLI::ignore_case));
  }

  /// Sets all properties and writes the chosen values into the report.
  void Apply(nlohmann::ordered_json& report) const
  {
    for (const auto& [name, apply] : this->Bound)
    {
      apply(report[name]);
    }
  }

  /// Max and Maximum are one word on the command line.
  static std::string KebabCase(const std::string& property)
  {
    const std::string name = Separate(property, '-');
    return name.compare(0, 4, "max-") == 0 ? "maximum-" + name.substr(4) : name;
  }
  static std::string SnakeCase(const std::string& property) { return Separate(property, '_'); }

private:
  /// Words of a name: each begins with a capital; several of them in a row are one word.
  static std::string Separate(const std::string& property, char separator)
  {
    const auto isUpper = [&](std::size_t i)
    { return i >= property.size() || std::isupper(static_cast<unsigned char>(property[i])); };
    std::string name;
    for (std::size_t i = 0; i < property.size(); ++i)
    {
      if (i > 0 && isUpper(i) && (!isUpper(i - 1) || !isUpper(i + 1)))
      {
        name += separator;
      }
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(property[i])));
    }
    return name;
  }

  CLI::App& Job;
  std::set<std::string> LeftOut;
  std::map<std::string, std::string> Names;
  std::vector<std::pair<std::string, std::function<void(nlohmann::ordered_json&)>>> Bound;
};
}
