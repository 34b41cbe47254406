// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace knotwork
{
namespace
{
/// Words of a name: each begins with a capital; several of them in a row are one word.
std::string Separate(const std::string& property, char separator)
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
}

template <typename T>
void Options::Add(const std::string& property, const T& initial, std::function<void(const T&)> set,
  const std::string& help, CLI::Validator check)
{
  if (this->LeftOut.count(property) != 0)
  {
    return;
  }
  const auto renamed = this->Names.find(property);
  const std::string& name = renamed == this->Names.end() ? property : renamed->second;
  const auto bind = [&](const CLI::Option* option, const std::shared_ptr<T>& value)
  {
    this->Bound.push_back({ this->Branch, name, SnakeCase(name), option, value,
      [value, set](nlohmann::ordered_json& json)
      {
        set(*value);
        json = *value;
      } });
  };
  const auto known = std::find_if(this->Bound.begin(), this->Bound.end(),
    [&](const Binding& bound) { return bound.Name == name && bound.Branch != this->Branch; });
  if (known != this->Bound.end())
  {
    bind(known->Option, std::static_pointer_cast<T>(known->Value));
    return;
  }
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
  option->group(this->Title);
  bind(option, value);
}

// here alone: the parser's templates take longer to compile than all else of a job
template void Options::Add<bool>(const std::string&, const bool&, std::function<void(const bool&)>,
  const std::string&, CLI::Validator);
template void Options::Add<int>(const std::string&, const int&, std::function<void(const int&)>,
  const std::string&, CLI::Validator);
template void Options::Add<long long>(const std::string&, const long long&,
  std::function<void(const long long&)>, const std::string&, CLI::Validator);
template void Options::Add<double>(const std::string&, const double&,
  std::function<void(const double&)>, const std::string&, CLI::Validator);
template void Options::Add<std::string>(const std::string&, const std::string&,
  std::function<void(const std::string&)>, const std::string&, CLI::Validator);
template void Options::Add<std::vector<int>>(const std::string&, const std::vector<int>&,
  std::function<void(const std::vector<int>&)>, const std::string&, CLI::Validator);
template void Options::Add<std::vector<double>>(const std::string&, const std::vector<double>&,
  std::function<void(const std::vector<double>&)>, const std::string&, CLI::Validator);

void Options::AddChoice(const std::string& property, const std::vector<std::string>& names,
  int initial, std::function<void(int)> set, const std::string& help)
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

bool Options::IsGiven(const std::string& property) const
{
  return std::any_of(this->Bound.begin(), this->Bound.end(),
    [&](const Binding& bound) { return bound.Name == property && bound.Option->count() > 0; });
}

bool Options::IsOf(int branch, const CLI::Option* option) const
{
  return std::any_of(this->Bound.begin(), this->Bound.end(),
    [&](const Binding& bound)
    { return bound.Option == option && (bound.Branch == branch || bound.Branch == 0); });
}

Status Options::Check(int branch) const
{
  for (const Binding& bound : this->Bound)
  {
    if (!this->IsOf(branch, bound.Option) && bound.Option->count() > 0)
    {
      return { ErrorCode::InvalidParameter,
        "--" + KebabCase(bound.Name) + " is of " + this->Branches.at(bound.Branch) +
          " and means nothing for " + this->Branches.at(branch) + ": leave it out" };
    }
  }
  return {};
}

std::string Options::KebabCase(const std::string& property)
{
  const std::string name = Separate(property, '-');
  return name.compare(0, 4, "max-") == 0 ? "maximum-" + name.substr(4) : name;
}

std::string Options::SnakeCase(const std::string& property)
{
  return Separate(property, '_');
}
}
