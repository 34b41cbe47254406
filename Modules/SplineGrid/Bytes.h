// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace knotwork
{
/// What one process hands to another one of the same program (Processes.h): numbers, texts, and
/// vectors of numbers or plain structs, taken in the order in which they were added.
class Bytes
{
public:
  explicit Bytes(std::string text = {}) : Text(std::move(text)) {}

  template <typename T>
  void Add(const T& number)
  {
    static_assert(std::is_arithmetic_v<T>);
    this->AddRaw(&number, 1);
  }
  void Add(const std::string& text)
  {
    this->Add(std::uint64_t{ text.size() });
    this->Text += text;
  }
  template <typename T>
  void Add(const std::vector<T>& values)
  {
    this->Add(std::uint64_t{ values.size() });
    this->AddRaw(values.data(), values.size());
  }
  /// Without their number, which whoever takes them knows.
  template <typename T>
  void AddRaw(const T* values, std::size_t count)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    this->Text.append(reinterpret_cast<const char*>(values), sizeof(T) * count);
  }

  template <typename T>
  T Take()
  {
    T taken{};
    if constexpr (std::is_same_v<T, std::string>)
    {
      taken.resize(this->Take<std::uint64_t>());
      this->TakeRaw(taken.data(), taken.size());
    }
    else
    {
      static_assert(std::is_arithmetic_v<T>);
      this->TakeRaw(&taken, 1);
    }
    return taken;
  }
  template <typename T>
  void Take(std::vector<T>& values)
  {
    values.resize(this->Take<std::uint64_t>());
    this->TakeRaw(values.data(), values.size());
  }
  template <typename T>
  void TakeRaw(T* values, std::size_t count)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    std::copy_n(this->Text.data() + this->At, sizeof(T) * count, reinterpret_cast<char*>(values));
    this->At += sizeof(T) * count;
  }

  bool IsAtEnd() const { return this->At == this->Text.size(); }
  const std::string& Get() const { return this->Text; }

private:
  std::string Text;
  std::size_t At = 0;
};
}
