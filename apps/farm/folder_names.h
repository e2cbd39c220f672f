// Names in a folder, and nothing else about its files.
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include <dirent.h>
#include <fmt/format.h>

#include "relief/error.h"

namespace relief::cli {

/// Calls `visit(const char*)` for each name that does not begin with a dot; a folder that is not there has
/// none. Throws Error{failed} for one that cannot be read: what is in it is not known. It is readdir alone: a
/// directory_iterator may ask for the type of each file.
template <class Visit> void visit_names(const std::filesystem::path& folder, const Visit& visit) {
    struct Close {
        void operator()(DIR* opened) const { ::closedir(opened); }
    };
    const auto check = [&folder](int code) {
        if (code == 0 || code == ENOENT || code == ENOTDIR) return;
        throw Error(ErrorKind::failed, {fmt::format("the folder cannot be read: {}", std::strerror(code)),
                                        folder.string(), "without it nobody knows which tasks are done"});
    };
    const std::unique_ptr<DIR, Close> opened(::opendir(folder.c_str()));
    if (!opened) return check(errno);
    for (;;) {
        errno = 0; // readdir leaves it as it is where the names end
        const dirent* entry = ::readdir(opened.get());
        if (!entry) return check(errno);
        if (entry->d_name[0] != '.') visit(static_cast<const char*>(entry->d_name));
    }
}

} // namespace relief::cli
