// Numbers that several formulas need.
#ifndef RELIEF_CONSTANTS_H
#ifndef __cplusplus
#define RELIEF_CONSTANTS_H
#endif

const float kPi = 3.14159265358979f;

FN float make_infinity() { return uintBitsToFloat(0x7f800000u); }

#endif
