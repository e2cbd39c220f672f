#include "farm/input_files.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/content_hash.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

int64_t count_nanoseconds(const timespec& time) {
    return int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

/// All but the hash.
InputFile read_properties(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("the file cannot be read: {}", std::strerror(errno)), file.string(),
                     "the shared storage must show it on every machine"});
    if (!S_ISREG(status.st_mode))
        throw Error(ErrorKind::bad_input, {"is a folder, a device, a pipe or the like", file.string(),
                                           "a job reads files, which every machine of the farm sees"});
    return {file,
            uint64_t(status.st_size),
            count_nanoseconds(status.st_mtim),
            count_nanoseconds(status.st_ctim),
            {}};
}

std::string hash_content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    ContentHash hash;
    std::vector<char> block(1 << 20); // its size is part of the hash
    while (stream) {
        stream.read(block.data(), std::streamsize(block.size()));
        if (stream.gcount() > 0) hash.add_bytes(block.data(), size_t(stream.gcount()));
    }
    if (!stream.eof() || stream.bad())
        throw Error(ErrorKind::bad_input, {"the file cannot be read to its end", file.string(),
                                           "check the disk and the rights of the file"});
    return fmt::format("{:016x}", hash.value());
}

} // namespace

InputFile describe_file(const fs::path& file) {
    InputFile result = read_properties(fs::absolute(file).lexically_normal());
    result.hash = hash_content(result.file);
    return result;
}

void check_files(const std::vector<InputFile>& planned, const std::vector<fs::path>& files) {
    std::unordered_map<std::string, const InputFile*> known;
    for (const InputFile& file : planned) known.emplace(file.file.string(), &file);
    for (const fs::path& name : files) {
        const fs::path file = fs::absolute(name).lexically_normal();
        const auto found = known.find(file.string());
        if (found == known.end())
            throw Error(ErrorKind::bad_input,
                        {"the frame reads a file that the job was not planned with", file.string(),
                         "plan the job again: the scene, or the tiles of one of its maps, are others now"});
        const InputFile& before = *found->second;
        const InputFile now = read_properties(file);
        const bool is_untouched = now.size_bytes == before.size_bytes && now.modified == before.modified &&
                                  now.changed == before.changed;
        if (is_untouched) continue;
        if (now.size_bytes != before.size_bytes || hash_content(file) != before.hash)
            throw Error(ErrorKind::bad_input,
                        {"the file was changed after the job was planned", file.string(),
                         "put the file back as it was, or plan the job again into another folder"});
    }
}

Value describe_input_file(const InputFile& file) {
    return {{"file", file.file.string()},
            {"bytes", file.size_bytes},
            {"modified", file.modified},
            {"changed", file.changed},
            {"hash", file.hash}};
}

InputFile read_input_file(const Value& value) {
    return {value["file"].get<std::string>(), value["bytes"].get<uint64_t>(),
            value["modified"].get<int64_t>(), value["changed"].get<int64_t>(),
            value["hash"].get<std::string>()};
}

} // namespace relief::cli
