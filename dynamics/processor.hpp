#pragma once

#include <motor/api.hpp>

/// Vectors of four numbers are laid out and passed as the processor has them. A program for AVX and a
/// libkreisel without it do not fit together: the program does not link, for want of this function.
#if defined(__AVX512F__)
#define KREISEL_SAME_MARCH same_march_as_libkreisel_avx512
#elif defined(__AVX__)
#define KREISEL_SAME_MARCH same_march_as_libkreisel_avx
#else
#define KREISEL_SAME_MARCH same_march_as_libkreisel_without_avx
#endif

namespace kreisel::detail {

KREISEL_API void KREISEL_SAME_MARCH();

}  // namespace kreisel::detail
