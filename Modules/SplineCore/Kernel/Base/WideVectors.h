// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
  __has_include(<sys/platform/x86.h>)
#define KNOTWORK_HAS_WIDE_VECTORS 1
#include <sys/platform/x86.h>
#endif

/// Inner loops for the vectors that the processor at hand has.
///
/// Binaries are built for every processor of their architecture, which on x86-64 means vectors of
/// two doubles. Work that is given to WithWidestVectors is compiled a second time, for AVX2 with
/// fused multiply-add, and that code runs where the processor and the C library allow it. Sources
/// that are STRICT_FLOAT in their CMakeLists.txt (all but the assembly of stiffness matrices) have
/// the same bits both ways, where lanes are added in one order; elsewhere products and sums may be
/// fused. Within a process all calls go the same way, so results do not depend on threads.
namespace knotwork
{
template <int Width>
struct DoublesOf
{
  typedef double Type __attribute__((vector_size(Width * sizeof(double))));
};
/// As many doubles, in one register where the code is compiled for it. Pass by reference: how
/// values are passed depends on the flags.
template <int Width>
using Doubles = typename DoublesOf<Width>::Type;

/// The same where arrays of numbers are: read and written by way of a pointer to it, aligned as
/// VectorArray is. (std::memcpy goes by way of the stack, and waits for it.)
template <int Width>
struct DoublesInMemory
{
  typedef double Type __attribute__((vector_size(Width * sizeof(double)), may_alias));
};

/// Allocates so that code for any vectors may load and store them: without AVX the compiler takes
/// 16 bytes for their alignment.
template <typename T>
struct VectorAllocator
{
  using value_type = T;
  static constexpr std::align_val_t Alignment{ 64 };

  VectorAllocator() = default;
  template <typename Other>
  VectorAllocator(const VectorAllocator<Other>&)
  {
  }
  T* allocate(std::size_t count)
  {
    return static_cast<T*>(::operator new(count * sizeof(T), Alignment));
  }
  void deallocate(T* array, std::size_t) { ::operator delete(array, Alignment); }
  bool operator==(const VectorAllocator&) const { return true; }
  bool operator!=(const VectorAllocator&) const { return false; }
};
/// What arrays of vectors are kept in.
template <typename T>
using VectorArray = std::vector<T, VectorAllocator<T>>;

/// What work is called with: Width doubles are a register.
template <int Width>
using VectorWidth = std::integral_constant<int, Width>;

#ifdef KNOTWORK_HAS_WIDE_VECTORS
/// Whether AVX2 and fused multiply-add may be used. Asks the C library, so that
/// GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2 runs a program as on an older processor.
inline bool HasWideVectors()
{
  static const bool has = CPU_FEATURE_ACTIVE(AVX2) && CPU_FEATURE_ACTIVE(FMA);
  return has;
}

/// All that is called from here and whose body the compiler sees becomes part of this function, and
/// so is compiled for the wider vectors.
template <typename Work>
__attribute__((target("avx2,fma"), flatten, noinline)) void RunWide(const Work& work)
{
  const Work own(work); // what it captures by value is in registers
  own(VectorWidth<4>());
}
#else
inline bool HasWideVectors()
{
  return false;
}
#endif

/// Calls work(VectorWidth<4>) or work(VectorWidth<2>). Costs a call: give it a loop.
template <typename Work>
inline void WithWidestVectors(const Work& work)
{
#ifdef KNOTWORK_HAS_WIDE_VECTORS
  if (HasWideVectors())
  {
    RunWide(work);
    return;
  }
#endif
  work(VectorWidth<2>());
}
}
