// Exit codes of the command that are not an ErrorKind.
#pragma once

namespace relief::cli {

inline constexpr int kExitDone = 0;
inline constexpr int kExitWarnings = 6;  ///< warnings under --strict
inline constexpr int kExitDifferent = 7; ///< compare: difference over the threshold
inline constexpr int kExitSignalBase =
    128; ///< plus the signal: interrupted after a partial picture was saved

} // namespace relief::cli
