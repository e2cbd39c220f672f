#include "io/picture_library.h"

#include <filesystem>

#include <dlfcn.h>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

using Entry = const PictureLibrary* (*)();

/// Beside the program, or where the dynamic linker looks: the program names the folder of its build.
void* open_module() {
    std::error_code code;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", code);
    const std::filesystem::path beside = program.parent_path() / RELIEF_PICTURES;
    return dlopen(std::filesystem::exists(beside, code) ? beside.c_str() : RELIEF_PICTURES,
                  RTLD_NOW | RTLD_LOCAL);
}

/// Never unloaded: its libraries have threads and destructors of their own.
const PictureLibrary& load_module(const std::string& name) {
    void* module = open_module();
    const auto entry = module ? reinterpret_cast<Entry>(dlsym(module, kPictureLibraryEntry)) : nullptr;
    if (!entry)
        throw Error(
            ErrorKind::failed,
            {fmt::format("cannot be opened: {}", dlerror()), name,
             fmt::format("put {} beside the program, or convert the picture to EXR", RELIEF_PICTURES)});
    return *entry();
}

} // namespace

const PictureLibrary& get_picture_library(const std::string& name) {
    static const PictureLibrary& library = load_module(name);
    return library;
}

} // namespace relief
