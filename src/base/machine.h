// Processor, memory of this process, and available memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace relief {

/// Model of the processor; "cpu" if unknown.
std::string processor_name();

/// Peak resident size of this process, bytes; 0 if unknown.
uint64_t peak_resident_bytes();

/// Bytes that can be allocated without swapping, within the control group's limit; UINT64_MAX if unknown.
uint64_t available_memory_bytes();

} // namespace relief
