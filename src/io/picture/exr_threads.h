// The threads that OpenEXR codes with. Its pool belongs to the whole process.
#pragma once

namespace relief {

/// The thread count to open an EXR file with, at most thread_count(); 0: serial. Makes OpenEXR's pool where
/// there is none, and leaves a host program's alone. For any thread.
int prepare_exr_threads();

} // namespace relief
