/* SPDX-License-Identifier: BSD-3-Clause */
/* A library to preload (LD_PRELOAD): memory from malloc and its kin begins now here, now there against the 64 bytes of
 * the widest registers, in steps of 16, so that a result which depends on where a buffer lies shows. */
#define _GNU_SOURCE
#include <errno.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum
{
  Grain = 16, /* what malloc promises; also the size of the header before a block */
  Line = 64
};

typedef struct
{
  void* Start; /* what the library's allocator gave */
  size_t Size; /* what the caller asked for */
} Header;

extern void* __libc_malloc(size_t);
extern void __libc_free(void*);

static atomic_uint Calls;

static Header* HeaderOf(void* block)
{
  return (Header*)((char*)block - sizeof(Header));
}

/* A block of an alignment; offset bytes further on when the alignment is malloc's own. */
static void* Allocate(size_t size, size_t alignment, size_t offset)
{
  const size_t extra = sizeof(Header) + alignment + Line + offset;
  char* start = size > PTRDIFF_MAX - extra ? NULL : __libc_malloc(size + extra);
  if (!start)
  {
    errno = ENOMEM;
    return NULL;
  }
  const uintptr_t to = alignment > Line ? alignment : Line;
  char* block = (char*)(((uintptr_t)start + sizeof(Header) + to - 1) / to * to) + offset;
  HeaderOf(block)->Start = start;
  HeaderOf(block)->Size = size;
  return block;
}

/* The multiples of the golden ratio modulo 1: even, and without a period that could fit a caller's. */
static void* Shifted(size_t size)
{
  const uint32_t call = atomic_fetch_add(&Calls, 1);
  return Allocate(size, Grain, (call * 0x9E3779B1u >> 30) * Grain);
}

void* malloc(size_t size)
{
  return Shifted(size);
}

void free(void* block)
{
  if (block)
  {
    __libc_free(HeaderOf(block)->Start);
  }
}

void* calloc(size_t count, size_t size)
{
  size_t total = 0;
  if (__builtin_mul_overflow(count, size, &total))
  {
    errno = ENOMEM;
    return NULL;
  }
  void* block = Shifted(total); /* of malloc and memset the compiler would make a call of calloc */
  return block ? memset(block, 0, total) : NULL;
}

void* realloc(void* block, size_t size)
{
  void* moved = Shifted(size);
  if (moved && block)
  {
    const size_t old = HeaderOf(block)->Size;
    memcpy(moved, block, old < size ? old : size);
    free(block);
  }
  return moved;
}

void* memalign(size_t alignment, size_t size)
{
  return Allocate(size, alignment < Grain ? Grain : alignment, 0);
}

void* aligned_alloc(size_t alignment, size_t size)
{
  return memalign(alignment, size);
}

int posix_memalign(void** block, size_t alignment, size_t size)
{
  *block = memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}

void* valloc(size_t size)
{
  return memalign(4096, size);
}

void* pvalloc(size_t size)
{
  return memalign(4096, (size + 4095) / 4096 * 4096);
}

size_t malloc_usable_size(void* block)
{
  return block ? HeaderOf(block)->Size : 0;
}
