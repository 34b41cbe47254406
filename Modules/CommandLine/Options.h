// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Ranges.h"
#include <knotwork/SplineCore/Status.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
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

  /// Title in --help of the options that are added from here on.
  void Group(const std::string& title) { this->Title = title; }

  /// Options that are added from here on belong to one of several things that the job does; 0: to
  /// all of them. One name in several of them is one option, with the default and help of the
  /// first.
  /// @param what  that is, in messages: "a target (--to)".
  void Begin(int branch, const std::string& what)
  {
    this->Branch = branch;
    this->Branches[branch] = what;
  }
  /// Whether an option of a property stands on the command line.
  bool IsGiven(const std::string& property) const;
  /// @return InvalidParameter: an option of other branches alone stands on the command line.
  Status Check(int branch) const;

  /// A number, a list of them as long as the default, a text, or a truth value, which is on where
  /// the option stands without one (see Words.h). T: bool, int, double, std::string, std::vector of
  /// int or double.
  template <typename T>
  void Add(const std::string& property, const T& initial, std::function<void(const T&)> set,
    const std::string& help, CLI::Validator check = {});

  /// One of a list of names, handed to `set` as its position.
  void AddChoice(const std::string& property, const std::vector<std::string>& names, int initial,
    std::function<void(int)> set, const std::string& help);

  /// Sets the properties of a branch and writes the chosen values into the report.
  void Apply(nlohmann::ordered_json& report, int branch = 0) const
  {
    for (const Binding& bound : this->Bound)
    {
      if (bound.Branch == branch)
      {
        bound.Apply(report[bound.Key]);
      }
    }
  }

  /// Max and Maximum are one word on the command line.
  static std::string KebabCase(const std::string& property);
  static std::string SnakeCase(const std::string& property);

private:
  bool IsOf(int branch, const CLI::Option* option) const;

  struct Binding
  {
    int Branch;
    std::string Name; ///< of the property, or what it was renamed to
    std::string Key;  ///< in the report
    const CLI::Option* Option;
    std::shared_ptr<void> Value; ///< that the option sets
    std::function<void(nlohmann::ordered_json&)> Apply;
  };

  CLI::App& Job;
  std::string Title = "Options";
  int Branch = 0;
  std::map<int, std::string> Branches;
  std::set<std::string> LeftOut;
  std::map<std::string, std::string> Names;
  std::vector<Binding> Bound;
};
}
