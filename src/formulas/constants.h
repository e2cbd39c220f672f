// Shared constants.
#ifndef RELIEF_CONSTANTS_H
#define RELIEF_CONSTANTS_H
#include "formulas/begin.h"

const uint kNone = 0xffffffffu; ///< invalid index
const float kPi = 3.14159265358979f;

FN float make_infinity() { return uintBitsToFloat(0x7f800000u); }

#include "formulas/end.h"
#endif
