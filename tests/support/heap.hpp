#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

/// Counts heap allocations: every operator new, and every malloc and the like called from the
/// including file, which contains the header-only code. The linker passes them through here
/// (kreisel_counts_requests in tests/CMakeLists.txt). For one file of a program.
namespace kreisel::test::heap {

inline std::size_t requests = 0;
inline std::size_t bytes = 0;

inline void note(std::size_t size) {
  ++requests;
  bytes += size;
}

/// Number of allocations of the action.
template <class Action>
std::size_t requests_of(const Action& action) {
  const std::size_t before = requests;
  action();
  return requests - before;
}

}  // namespace kreisel::test::heap

extern "C" {

void* __real_malloc(std::size_t);
void* __real_calloc(std::size_t, std::size_t);
void* __real_realloc(void*, std::size_t);
void* __real_aligned_alloc(std::size_t, std::size_t);
int __real_posix_memalign(void**, std::size_t, std::size_t);

void* __wrap_malloc(std::size_t size) {
  kreisel::test::heap::note(size);
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  kreisel::test::heap::note(count * size);
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  kreisel::test::heap::note(size);
  return __real_realloc(old, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  kreisel::test::heap::note(size);
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  kreisel::test::heap::note(size);
  return __real_posix_memalign(result, alignment, size);
}
}

// Not inline: otherwise the compiler looks through delete to free and finds no matching malloc.
[[gnu::noinline]] void* operator new(std::size_t size) {
  kreisel::test::heap::note(size);
  if (void* memory = __real_malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size) { return operator new(size); }
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
