// Opens a formula file: names shared by GLSL and C++. C++ compiles the scalar instance into relief::scalar;
// SIMD instances define RELIEF_LANES and include the formulas in their own namespace.
#ifndef __cplusplus
#include "formulas/lang.h"
#elif defined(RELIEF_LANES)
#define FN RELIEF_INLINE
#define In(Type) const Type&
#define EXACT
#else
#include "formulas/scalar.h"
namespace relief::scalar {
#define FN inline
#define In(Type) const Type&
#define EXACT
#endif
