// For which instruction sets Highway compiles the vector code. Included before anything of Highway.
#pragma once

/// Encryption is not needed, and without its instructions SSE4 is part of x86-64-v2.
#define HWY_DISABLE_PCLMUL_AES
/// Vectors whose length the compiler does not know cannot be members or elements of arrays; these processors have Neon.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
