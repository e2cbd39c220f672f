// Build and machine information recorded with every measurement.
#pragma once

#include "common/report.h"
#include "relief/render.h"

namespace relief::bench {

/// Of the sources when this was built, as `git describe --always --dirty` has it; "unknown" outside git.
extern const char* const kCommit;

/// {version, commit, compiler} of this build.
Value describe_build();

/// {system, processor, threads} of this machine.
Value describe_machine();

/// Programs that ran or waited to run, as means over the last {one_minute, five_minutes, fifteen_minutes};
/// null if unknown.
Value describe_load();

/// A list of {device, name, driver, kind, memory_bytes, missing}: what the Vulkan engine could run on.
Value describe_vulkan_devices();

/// {engine, name, isa, threads} as a render reported them, and the driver of a Vulkan device.
Value describe_device(const Statistics& statistics);

} // namespace relief::bench
