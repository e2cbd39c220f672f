#include "io/mesh/fbx_source.h"

#include <charconv>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "io/file_system.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr uint32_t kOldest = 7100; ///< version

void refuse_old_version(uint32_t version, const std::filesystem::path& file) {
    if (version == 0 || version >= kOldest) return;
    throw Error(ErrorKind::bad_input, {fmt::format("is an FBX file of version {}.{}; Relief reads 7.1 to 7.7",
                                                   version / 1000, version / 100 % 10),
                                       file.string(), "export it as FBX 2020 (7.x), binary"});
}

/// Returns the version that the head of a file states whose records cannot be followed, or 0.
uint32_t find_version(std::string_view bytes) {
    constexpr size_t kHead = 4096, kPlace = 23;
    if (bytes.starts_with(kFbxMagic)) {
        uint32_t version = 0;
        if (bytes.size() >= kPlace + sizeof version)
            std::memcpy(&version, bytes.data() + kPlace, sizeof version);
        return version;
    }
    constexpr std::string_view kWord = "FBXVersion: ";
    bytes = bytes.substr(0, kHead);
    const size_t word = bytes.find(kWord);
    uint32_t version = 0;
    if (word != std::string_view::npos)
        std::from_chars(bytes.data() + word + kWord.size(), bytes.data() + bytes.size(), version);
    return version;
}

} // namespace

FbxSource read_fbx_source(const std::filesystem::path& file) {
    FbxSource source{read_file_bytes(file), {}};
    std::optional<FbxDocument> document = FbxDocument::parse(source.bytes);
    if (!document) {
        refuse_old_version(find_version(source.bytes), file);
        source.facts.warnings.emplace_back("its records cannot be followed to their end, so that nothing is "
                                           "known of hidden nodes, blend shapes, creases and inactive "
                                           "rotations: export the file again");
        return source;
    }
    refuse_old_version(document->get_version(), file);
    source.facts = prepare_fbx(*document);
    source.bytes = document->write(); // the document refers to the bytes until then
    return source;
}

} // namespace relief
