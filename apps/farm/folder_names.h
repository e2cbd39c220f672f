// Names in a folder, and nothing else about its files.
#pragma once

#include <filesystem>
#include <memory>

#include <dirent.h>

namespace relief::cli {

/// Calls `visit(const char*)` for each name that does not begin with a dot; a folder that cannot be read has
/// none. It is readdir alone: a directory_iterator may ask for the type of each file.
template <class Visit> void visit_names(const std::filesystem::path& folder, const Visit& visit) {
    struct Close {
        void operator()(DIR* opened) const { ::closedir(opened); }
    };
    const std::unique_ptr<DIR, Close> opened(::opendir(folder.c_str()));
    if (!opened) return;
    while (const dirent* entry = ::readdir(opened.get()))
        if (entry->d_name[0] != '.') visit(static_cast<const char*>(entry->d_name));
}

} // namespace relief::cli
