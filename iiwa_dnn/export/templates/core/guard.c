#include <float.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || defined(_M_FP_FAST)
#error "infinities and NaN are needed: no -ffast-math, -Ofast, -ffinite-math-only or /fp:fast"
#endif
/* 16 is 0 on a machine that has halves too. */
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "doubles have to be computed as doubles: on 32-bit x86 -msse2 -mfpmath=sse"
#endif

/* No product and sum become one operation: every compiler gives the same commands, to the last bit. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("-ffp-contract=off")
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif
