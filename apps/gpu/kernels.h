// What drivers tell of compiled kernels, as JSON and as a table: docs/gpu.md.
#pragma once

#include <functional>
#include <string>

#include "common/report.h"
#include "lab/kernel_report.h"
#include "relief/render.h"

namespace relief::gpu {

/// {device, driver, cases, figures, kernels}.
Value describe_kernels(const KernelReport& report);

/// The same of all kernels, compiled for the device of `settings`; `on_case` is told what comes next. Throws
/// Error{device_missing} where the device or what it tells is missing.
Value list_kernels(const RenderSettings& settings, const std::function<void(const std::string&)>& on_case);

/// A line a kernel, of the figures that the driver tells.
std::string print_kernels(const Value& list);

} // namespace relief::gpu
