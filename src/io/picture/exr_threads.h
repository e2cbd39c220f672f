// The threads that OpenEXR codes with. Its pool belongs to the whole process.
#pragma once

namespace relief {

/// The thread count to open an EXR file with, so that no more threads code it than parallel loops may use
/// here (thread_count()); 0: one after the other. Makes OpenEXR's pool where there is none, and leaves alone
/// the one that a host program made. For any thread.
int prepare_exr_threads();

} // namespace relief
