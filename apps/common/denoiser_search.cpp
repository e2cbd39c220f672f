#include "common/denoiser_search.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "relief/error.h"

namespace relief::cli {

namespace {

/// Lines that a shell command prints; none where it fails.
std::vector<std::string> read_lines(const char* command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command, "r"), pclose);
    std::vector<std::string> lines(1);
    for (int c; pipe && (c = std::fgetc(pipe.get())) != EOF;)
        if (c == '\n')
            lines.emplace_back();
        else
            lines.back() += char(c);
    return lines;
}

/// Libraries in packages that ship one, the newest name first.
std::vector<std::filesystem::path> find_in_python() {
    std::vector<std::filesystem::path> found;
    for (const std::string& folder :
         read_lines("python3 -c 'import sys; print(*sys.path, sep=\"\\n\")' 2>/dev/null"))
        for (const char* package : {"pyoidn", "oidn", "bpy"}) {
            std::error_code code;
            const std::filesystem::path place = std::filesystem::path(folder) / package;
            if (folder.empty() || !std::filesystem::is_directory(place, code)) continue;
            for (auto file = std::filesystem::recursive_directory_iterator(place, code);
                 !code && file != std::filesystem::end(file); file.increment(code))
                if (file->path().filename().string().starts_with("libOpenImageDenoise.so.2"))
                    found.push_back(file->path());
        }
    std::sort(found.begin(), found.end(), std::greater<>());
    return found;
}

} // namespace

Denoiser load_denoiser(int threads) {
    DenoiserSettings settings;
    settings.threads = threads;
    if (const char* named = std::getenv("RELIEF_OIDN")) {
        if (!std::filesystem::exists(named))
            throw Error(ErrorKind::device_missing,
                        {"there is no such file or folder", std::string("RELIEF_OIDN=") + named, ""});
        settings.libraries = {named};
        return Denoiser(settings);
    }
    try {
        return Denoiser(settings);
    } catch (const Error& error) {
        settings.libraries = find_in_python();
        if (!settings.libraries.empty()) return Denoiser(settings);
        throw Error(error.kind(),
                    {error.message(), error.where(),
                     "install Open Image Denoise 2, for example by `pip install pyoidn`, or say "
                     "RELIEF_OIDN=FOLDER"});
    }
}

} // namespace relief::cli
