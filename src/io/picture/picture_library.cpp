#include "io/picture/picture_library.h"

#include <filesystem>

#include <dlfcn.h>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

#ifdef RELIEF_PICTURES

using Entry = const PictureLibrary* (*)();

#define RELIEF_QUOTE(text) #text
#define RELIEF_QUOTE_VALUE(macro) RELIEF_QUOTE(macro)

/// Beside the program, or where the dynamic linker looks: the program names the folder of its build.
std::string find_module() {
    std::error_code code;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", code);
    const std::filesystem::path beside = program.parent_path() / RELIEF_PICTURES;
    return std::filesystem::exists(beside, code) ? beside.string() : RELIEF_PICTURES;
}

[[noreturn]] void fail(const std::string& name, const std::string& hint) {
    throw Error(ErrorKind::failed, {fmt::format("cannot be opened: {}", dlerror()), name, hint});
}

#endif

} // namespace

#ifdef RELIEF_PICTURES

const PictureLibrary& load_picture_library(const std::string& module, const std::string& name) {
    // Never unloaded: its libraries have threads and destructors of their own.
    void* const handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle)
        fail(name, fmt::format("put {} beside the program, or convert the picture to EXR", RELIEF_PICTURES));
    const auto entry =
        reinterpret_cast<Entry>(dlsym(handle, RELIEF_QUOTE_VALUE(RELIEF_PICTURE_LIBRARY_ENTRY)));
    if (!entry)
        fail(name, fmt::format("{} is of another version of Relief: put the one that was built with the "
                               "program beside it",
                               module));
    return *entry();
}

const PictureLibrary& get_picture_library(const std::string& name) {
    static const PictureLibrary& library = load_picture_library(find_module(), name);
    return library;
}

#else

const PictureLibrary& get_picture_library(const std::string& name) {
    throw Error(
        ErrorKind::failed,
        {"needs OpenImageIO and OpenColorIO, which this build of Relief is without", name,
         "save it as EXR, or as PNG, HDR, JPEG or TIFF of grey or RGB; Python takes arrays in place of "
         "pictures"});
}

#endif

} // namespace relief
