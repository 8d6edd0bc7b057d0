#pragma once

#include <motor/api.hpp>

/// A function whose name contains the instruction set, because it fixes the layout of packed
/// vectors. A program for AVX and a libkreisel without AVX do not fit together: linking fails,
/// because this function is missing.
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
