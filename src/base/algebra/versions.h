/*
   For files of hot loops, to be included first: products and sums may be fused, and a function marked VERSIONS is
   compiled for each generation of vector registers, where GCC can choose between them at run time on x86. Sanitizers
   are loaded too late for that choice. What such a function calls in its loops is INTO_VERSIONS, part of each of them.
*/
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("fp-contract=fast")
#endif

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define VERSIONS __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define VERSIONS
#endif

#if defined(__GNUC__)
#define INTO_VERSIONS static inline __attribute__((always_inline))
#else
#define INTO_VERSIONS static inline
#endif
