#include "denoise/oidn_library.h"

#include <dlfcn.h>

#include <string>
#include <vector>

#include "relief/error.h"

namespace relief::oidn {

namespace {

constexpr const char* kName = "libOpenImageDenoise.so.2";
constexpr const char* kHint =
    "install Open Image Denoise 2, for example by `pip install pyoidn`, or name its folder";

/// False where the library lacks the entry point, as those before 2.0 do.
template <class Function> bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
}

bool find_all(void* library, Functions& f) {
    return find(library, "oidnNewDevice", f.NewDevice) && find(library, "oidnSetDeviceInt", f.SetDeviceInt) &&
           find(library, "oidnGetDeviceInt", f.GetDeviceInt) &&
           find(library, "oidnGetDeviceError", f.GetDeviceError) &&
           find(library, "oidnCommitDevice", f.CommitDevice) &&
           find(library, "oidnReleaseDevice", f.ReleaseDevice) &&
           find(library, "oidnNewFilter", f.NewFilter) &&
           find(library, "oidnSetSharedFilterImage", f.SetSharedFilterImage) &&
           find(library, "oidnSetFilterBool", f.SetFilterBool) &&
           find(library, "oidnSetFilterProgressMonitorFunction", f.SetFilterProgressMonitorFunction) &&
           find(library, "oidnCommitFilter", f.CommitFilter) &&
           find(library, "oidnExecuteFilter", f.ExecuteFilter) &&
           find(library, "oidnReleaseFilter", f.ReleaseFilter);
}

} // namespace

Functions load_functions(std::span<const std::filesystem::path> candidates) {
    std::vector<std::string> files;
    for (const std::filesystem::path& candidate : candidates)
        files.push_back(std::filesystem::is_directory(candidate) ? (candidate / kName).string()
                                                                 : candidate.string());
    files.push_back(kName);
    std::string last;
    for (const std::string& file : files) {
        void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library) {
            last = dlerror();
            continue;
        }
        Functions functions;
        if (find_all(library, functions)) return functions;
        last = file + " is not version 2 of the library";
        dlclose(library);
    }
    throw Error(ErrorKind::device_missing,
                {"the denoiser, Open Image Denoise 2, cannot be loaded", last, kHint});
}

} // namespace relief::oidn
