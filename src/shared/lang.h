// The common dialect of GLSL 4.60 and C++20 (see docs/decisions/one-source-formulas.md). For GLSL this file
// defines the names; C++ instances define them before the include: FN EXACT Float Bool Uint Vec2 Vec3 select.
#ifndef __cplusplus
#ifndef RELIEF_LANG_H
#define RELIEF_LANG_H
#define FN
#define EXACT precise
#define Float float
#define Bool bool
#define Uint uint
#define Vec2 vec2
#define Vec3 vec3
#define select(condition, a, b) ((condition) ? (a) : (b))
#endif
#endif
