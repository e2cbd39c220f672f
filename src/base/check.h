// DCHECK: assertion against internal misuse. Active in debug and sanitizer builds, gone in release.
#pragma once

#include <cstdio>
#include <cstdlib>

#ifdef RELIEF_DCHECKS
#define DCHECK(condition)                                                                                    \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            std::fprintf(stderr, "%s:%d: DCHECK(%s) failed\n", __FILE__, __LINE__, #condition);              \
            std::abort();                                                                                    \
        }                                                                                                    \
    } while (false)
#else
#define DCHECK(condition) static_cast<void>(sizeof(!(condition)))
#endif
