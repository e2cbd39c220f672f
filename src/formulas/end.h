// Closes what formulas/begin.h opened.
#ifdef __cplusplus
#undef FN
#undef In
#undef EXACT
#ifndef RELIEF_LANES
} // namespace relief::scalar
#endif
#endif
