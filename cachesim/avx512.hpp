// AVX-512 intrinsics, and the mark of a function that uses them. Included by .cpp files only.
#pragma once

// g++ 12 takes _mm512_undefined_epi32() of its own header for a mistake (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#else
#include <immintrin.h>
#endif

/// Before a function that is compiled for InstructionSet::avx512, whatever the rest of its file is compiled for.
#define RAYCACHE_AVX512 __attribute__((target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,bmi,bmi2,popcnt")))
