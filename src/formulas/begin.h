// Opens a formula file: the names that GLSL and C++ share. C++ puts formulas of one lane into
// relief::scalar. Instances of many lanes define RELIEF_LANES and include formulas in a namespace of their
// own.
#ifndef __cplusplus
#include "formulas/lang.h"
#elif defined(RELIEF_LANES)
#define FN HWY_INLINE
#define EXACT
#else
#include "formulas/scalar.h"
namespace relief::scalar {
#define FN inline
#define EXACT
#endif
