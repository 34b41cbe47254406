// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Ranges.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace knotwork
{
/// The options of one job. Each is bound to a property of the job's filter by the KNOTWORK_OPTION
/// macros below: same name in kebab-case, default taken from the constructed filter, range from its
/// clamp. What was chosen is set on the filter and written to the report.
class Options
{
public:
  explicit Options(CLI::App& job) : Job(job) {}

  /// A number, a list of them when T is a std::vector of the default's length, or a truth value,
  /// which is on where the option stands without one (see Words.h).
  template <typename T>
  CLI::Option* Add(const char* property, const T& initial, std::function<void(const T&)> set,
    const std::string& help)
  {
    auto value = std::make_shared<T>(initial);
    CLI::Option* option = nullptr;
    if constexpr (std::is_same_v<T, bool>)
    {
      option = this->Job.add_flag("--" + KebabCase(property), *value, help);
      option->option_text(initial ? "[0|1]=1" : "[0|1]=0");
    }
    else
    {
      option = this->Job.add_option("--" + KebabCase(property), *value, help);
      option->capture_default_str();
    }
    this->Bound.push_back({ SnakeCase(property),
      [value, set = std::move(set)](nlohmann::ordered_json& json)
      {
        set(*value);
        json = *value;
      } });
    return option;
  }

  /// One of a list of names, handed to `set` as its position.
  void AddChoice(const char* property, const std::vector<std::string>& names, int initial,
    std::function<void(int)> set, const std::string& help)
  {
    const auto check = CLI::IsMember(names, CLI::ignore_case);
    this
      ->Add<std::string>(
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
        help)
      ->check(check);
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
  static std::string Separate(const std::string& property, char separator)
  {
    std::string name;
    for (std::size_t i = 0; i < property.size(); ++i)
    {
      const auto c = static_cast<unsigned char>(property[i]);
      if (i > 0 && std::isupper(c))
      {
        name += separator;
      }
      name += static_cast<char>(std::tolower(c));
    }
    return name;
  }

  CLI::App& Job;
  std::vector<std::pair<std::string, std::function<void(nlohmann::ordered_json&)>>> Bound;
};
}

/// A clamped number: KNOTWORK_OPTION(options, filter, Iterations, "what it does").
#define KNOTWORK_OPTION(options, filter, property, help)                                           \
  (options)                                                                                        \
    .Add<decltype((filter)->Get##property())>(                                                     \
      #property, (filter)->Get##property(),                                                        \
      [filter](const auto& value) { (filter)->Set##property(value); }, help)                       \
    ->check(InRange((filter)->Get##property##MinValue(), (filter)->Get##property##MaxValue()))

/// A number or truth value without a range of its own.
#define KNOTWORK_FREE_OPTION(options, filter, property, help)                                      \
  (options).Add<decltype((filter)->Get##property())>(                                              \
    #property, (filter)->Get##property(),                                                          \
    [filter](const auto& value) { (filter)->Set##property(value); }, help)

/// One of the names behind the sentence, in the order of the property's values.
#define KNOTWORK_CHOICE(options, filter, property, help, ...)                                      \
  (options).AddChoice(                                                                             \
    #property, { __VA_ARGS__ }, (filter)->Get##property(),                                         \
    [filter](int value) { (filter)->Set##property(value); }, help)

/// A text property.
#define KNOTWORK_TEXT_OPTION(options, filter, property, help)                                      \
  (options).Add<std::string>(                                                                      \
    #property, (filter)->Get##property() ? (filter)->Get##property() : "",                         \
    [filter](const std::string& value) { (filter)->Set##property(value.c_str()); }, help)

/// Three numbers.
#define KNOTWORK_VECTOR_OPTION(options, filter, property, type, help)                              \
  (options)                                                                                        \
    .Add<std::vector<type>>(                                                                       \
      #property, std::vector<type>((filter)->Get##property(), (filter)->Get##property() + 3),      \
      [filter](const std::vector<type>& v) { (filter)->Set##property(v[0], v[1], v[2]); }, help)   \
    ->expected(3)
