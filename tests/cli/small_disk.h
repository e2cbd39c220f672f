// A disk that is soon full, for one process.
#pragma once

namespace relief::cli {

/// Exit code of a child process that could get no small disk.
inline constexpr int kNoSmallDisk = 77;

/// Mounts a small file system on `folder`, seen by the calling process and its successor alone, which must
/// have one thread. `options` are those of tmpfs: "size=16k". False where the system forbids it.
bool mount_small_disk(const char* folder, const char* options);

} // namespace relief::cli
