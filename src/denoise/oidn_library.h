// The C interface of Open Image Denoise 2, loaded at run time: what oidn.h declares of it, without that
// header.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace relief::oidn {

struct DeviceHandle;
struct FilterHandle;
using Device = DeviceHandle*;
using Filter = FilterHandle*;
using ProgressFunction = bool (*)(void* user, double fraction); ///< false cancels

constexpr int kDeviceCpu = 1, kFormatFloat3 = 3;
constexpr int kErrorNone = 0, kErrorOutOfMemory = 4, kErrorCancelled = 6;

/// Entry points, by their names without the prefix oidn.
struct Functions {
    Device (*NewDevice)(int type);
    void (*SetDeviceInt)(Device, const char* name, int value);
    int (*GetDeviceInt)(Device, const char* name);
    int (*GetDeviceError)(Device, const char** message);
    void (*CommitDevice)(Device);
    void (*ReleaseDevice)(Device);
    Filter (*NewFilter)(Device, const char* type);
    void (*SetSharedFilterImage)(Filter, const char* name, void* pixels, int format, size_t width,
                                 size_t height, size_t byte_offset, size_t pixel_byte_stride,
                                 size_t row_byte_stride);
    void (*SetFilterBool)(Filter, const char* name, bool value);
    void (*SetFilterProgressMonitorFunction)(Filter, ProgressFunction, void* user);
    void (*CommitFilter)(Filter);
    void (*ExecuteFilter)(Filter);
    void (*ReleaseFilter)(Filter);
};

/// The first library of `candidates` that can be loaded, as DenoiserSettings::libraries. It stays loaded: its
/// threads outlive a device. Throws Error{device_missing}.
Functions load_functions(std::span<const std::filesystem::path> candidates);

} // namespace relief::oidn
