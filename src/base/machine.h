// What the machine is, what this process holds of it, and what it can still give.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace relief {

/// Model of the processor; "cpu" where the system does not tell.
std::string processor_name();

/// Largest resident size of this process so far, bytes; 0 where the system does not tell.
uint64_t peak_resident_bytes();

/// Bytes that can be allocated without swapping, the limit of the enclosing control group included; the
/// largest uint64_t where the system does not tell.
uint64_t available_memory_bytes();

} // namespace relief
