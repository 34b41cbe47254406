// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace knotwork
{
/// Memory that is not written when it is made: what fills it in parallel finds it untouched.
template <typename T>
struct UntouchedAllocator : std::allocator<T>
{
  template <typename U>
  struct rebind
  {
    using other = UntouchedAllocator<U>;
  };
  template <typename U>
  void construct(U*) noexcept
  {
  }
  template <typename U, typename First, typename... Rest>
  void construct(U* at, First&& first, Rest&&... rest)
  {
    ::new (static_cast<void*>(at)) U(std::forward<First>(first), std::forward<Rest>(rest)...);
  }
};
template <typename T>
using UntouchedVector = std::vector<T, UntouchedAllocator<T>>;
}
