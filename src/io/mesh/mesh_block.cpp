#include "io/mesh/mesh_block.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "base/text_reading.h"

namespace relief {

namespace {

constexpr std::array<char, 8> kBlockMagic = {'r', 'e', 'l', 'i', 'e', 'f', 'M', '3'};
constexpr size_t kArrays = 13;

/// The sizes are those of the arrays of a mesh, or of the three texts of an error.
struct Header {
    std::array<char, 8> magic{};
    uint32_t content = 0;
    uint32_t error_kind = 0;
    std::array<uint64_t, kArrays> sizes{};
};

/// Numbers of uv sets, that of the mesh first, and further ones behind one another.
struct UvSets {
    struct Entry {
        int32_t number = 0;
        uint32_t uv_count = 0; ///< of a further one
    };
    std::vector<Entry> entries;
    std::vector<Vec2f> uvs;
    std::vector<uint32_t> indices; ///< one a corner of each
};

UvSets join_uv_sets(const Mesh& mesh) {
    UvSets sets;
    sets.entries.push_back({mesh.uv_set, 0});
    for (const UvSet& set : mesh.further_uvs) {
        sets.entries.push_back({set.number, uint32_t(set.uvs.size())});
        sets.uvs.insert(sets.uvs.end(), set.uvs.begin(), set.uvs.end());
        sets.indices.insert(sets.indices.end(), set.indices.begin(), set.indices.end());
    }
    return sets;
}

/// False where the counts are not those of the mesh.
bool part_uv_sets(const UvSets& sets, Mesh& mesh) {
    const size_t corners = mesh.position_indices.size();
    if (sets.entries.empty() || sets.indices.size() != (sets.entries.size() - 1) * corners) return false;
    mesh.uv_set = sets.entries[0].number;
    auto uv = sets.uvs.begin();
    auto index = sets.indices.begin();
    for (size_t k = 1; k < sets.entries.size(); ++k) {
        const auto [number, count] = sets.entries[k];
        if (count > size_t(sets.uvs.end() - uv)) return false;
        mesh.further_uvs.push_back(
            {number, {uv, uv + ptrdiff_t(count)}, {index, index + ptrdiff_t(corners)}});
        uv += ptrdiff_t(count), index += ptrdiff_t(corners);
    }
    return uv == sets.uvs.end();
}

/// Calls `visit(array, place)` for all arrays, in the order of the block. `warnings`: one per line.
template <class AnyMesh, class AnySets, class Text, class Visit>
void visit_arrays(AnyMesh& mesh, AnySets& sets, Text& warnings, const Visit& visit) {
    visit(mesh.positions, 0), visit(mesh.uvs, 1), visit(mesh.normals, 2);
    visit(mesh.face_sizes, 3);
    visit(mesh.position_indices, 4), visit(mesh.uv_indices, 5), visit(mesh.normal_indices, 6);
    visit(mesh.tangents, 7), visit(mesh.creases, 8);
    visit(sets.entries, 9), visit(sets.uvs, 10), visit(sets.indices, 11);
    visit(warnings, 12);
}

constexpr uint64_t kMostText = 1 << 20; ///< bytes of errors or warnings

void replace_control_characters(std::string& text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ') || c == 127; }, '?');
}

std::string join_lines(const std::vector<std::string>& lines) {
    std::string text;
    for (std::string line : lines) {
        replace_control_characters(line);
        if (text.size() + line.size() < kMostText) text += line + '\n';
    }
    return text;
}

std::vector<std::string> split_lines(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        lines.emplace_back(take_line(text));
        replace_control_characters(lines.back());
    }
    return lines;
}

/// Reads and writes one after the other, from the start of the file.
class Cursor {
  public:
    explicit Cursor(int descriptor) : descriptor_(descriptor) {}

    void write(const void* bytes, size_t count) {
        const char* from = static_cast<const char*>(bytes);
        while (count > 0) {
            const ssize_t done = pwrite(descriptor_, from, std::min(count, kMostAtOnce), at_);
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) throw std::system_error(errno, std::generic_category(), "shared memory");
            from += done, count -= size_t(done), at_ += done;
        }
    }

    /// False where the file ends before.
    bool read(void* bytes, size_t count) {
        char* to = static_cast<char*>(bytes);
        while (count > 0) {
            const ssize_t done = pread(descriptor_, to, std::min(count, kMostAtOnce), at_);
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            to += done, count -= size_t(done), at_ += done;
        }
        return true;
    }

  private:
    static constexpr size_t kMostAtOnce = size_t(1) << 30;
    int descriptor_;
    off_t at_ = 0;
};

template <class Array> void write_array(Cursor& cursor, const Array& array) {
    static_assert(std::is_trivially_copyable_v<typename Array::value_type>);
    cursor.write(array.data(), array.size() * sizeof(typename Array::value_type));
}

/// Resizes `array` and fills it; `left`: bytes of the block that nothing has been read from.
template <class Array> bool read_array(Cursor& cursor, uint64_t size, uint64_t& left, Array& array) {
    constexpr uint64_t kBytes = sizeof(typename Array::value_type);
    if (size > left / kBytes) return false;
    left -= size * kBytes;
    array.resize(size_t(size));
    return cursor.read(array.data(), size_t(size * kBytes));
}

bool has_good_indices(const std::vector<uint32_t>& indices, uint64_t corners, size_t count) {
    return indices.size() == corners &&
           std::all_of(indices.begin(), indices.end(), [&](uint32_t index) { return index < count; });
}

/// As has_good_indices, with kNoIndex for corners of faces without uvs.
bool has_good_uv_indices(const std::vector<uint32_t>& indices, uint64_t corners, size_t count) {
    return indices.size() == corners &&
           std::ranges::all_of(indices, [&](uint32_t index) { return index == kNoIndex || index < count; });
}

/// Whether all of the mesh can be walked by its indices; whether its values make sense is asked later.
bool is_consistent(const Mesh& mesh) {
    uint64_t corners = 0;
    for (const uint32_t size : mesh.face_sizes) {
        if (size < 3) return false;
        corners += size;
    }
    if (!has_good_indices(mesh.position_indices, corners, mesh.positions.size())) return false;
    if (!mesh.uv_indices.empty() && !has_good_uv_indices(mesh.uv_indices, corners, mesh.uvs.size()))
        return false;
    for (const UvSet& set : mesh.further_uvs)
        if (!has_good_uv_indices(set.indices, corners, set.uvs.size())) return false;
    if (!mesh.normal_indices.empty() && !has_good_indices(mesh.normal_indices, corners, mesh.normals.size()))
        return false;
    if (!mesh.tangents.empty() && mesh.tangents.size() != corners) return false;
    return std::all_of(mesh.creases.begin(), mesh.creases.end(), [&](const Crease& crease) {
        return crease.first < mesh.positions.size() && crease.second < mesh.positions.size();
    });
}

bool read_mesh(Cursor& cursor, const Header& header, uint64_t left, MeshBlock& block) {
    bool is_whole = header.sizes[kArrays - 1] <= kMostText;
    UvSets sets;
    std::string warnings;
    visit_arrays(block.mesh, sets, warnings, [&](auto& array, size_t place) {
        is_whole = is_whole && read_array(cursor, header.sizes[place], left, array);
    });
    block.warnings = split_lines(warnings);
    return is_whole && left == 0 && part_uv_sets(sets, block.mesh) && is_consistent(block.mesh);
}

bool read_error(Cursor& cursor, const Header& header, uint64_t left, MeshBlock& block) {
    if (left > kMostText) return false;
    if (header.error_kind < uint32_t(ErrorKind::failed) ||
        header.error_kind > uint32_t(ErrorKind::out_of_memory))
        return false;
    block.error_kind = ErrorKind(header.error_kind);
    size_t place = 0;
    for (std::string* text : {&block.error.message, &block.error.where, &block.error.hint}) {
        if (!read_array(cursor, header.sizes[place++], left, *text)) return false;
        replace_control_characters(*text);
    }
    return left == 0;
}

} // namespace

// The magic is written last: a block that is not whole has none.
void write_mesh_block(int descriptor, const Mesh& mesh, const std::vector<std::string>& warnings) {
    Header header;
    header.content = uint32_t(BlockContent::mesh);
    Cursor cursor(descriptor);
    const UvSets sets = join_uv_sets(mesh);
    const std::string text = join_lines(warnings);
    visit_arrays(mesh, sets, text,
                 [&](const auto& array, size_t place) { header.sizes[place] = array.size(); });
    cursor.write(&header, sizeof header);
    visit_arrays(mesh, sets, text, [&](const auto& array, size_t) { write_array(cursor, array); });
    Cursor(descriptor).write(kBlockMagic.data(), kBlockMagic.size());
}

void write_error_block(int descriptor, const Error& error) {
    Header header;
    header.content = uint32_t(BlockContent::error), header.error_kind = uint32_t(error.kind());
    Cursor cursor(descriptor);
    header.sizes[0] = error.message().size(), header.sizes[1] = error.where().size();
    header.sizes[2] = error.hint().size();
    cursor.write(&header, sizeof header);
    for (const std::string* text : {&error.message(), &error.where(), &error.hint()})
        write_array(cursor, *text);
    Cursor(descriptor).write(kBlockMagic.data(), kBlockMagic.size());
}

void write_memory_block(int descriptor) {
    Header header;
    header.magic = kBlockMagic, header.content = uint32_t(BlockContent::out_of_memory);
    Cursor(descriptor).write(&header, sizeof header);
}

MeshBlock read_mesh_block(int descriptor, uint64_t most_bytes) {
    MeshBlock block;
    struct stat status {};
    Header header;
    Cursor cursor(descriptor);
    if (fstat(descriptor, &status) != 0 || uint64_t(status.st_size) > most_bytes) return block;
    if (!cursor.read(&header, sizeof header) || header.magic != kBlockMagic) return block;
    const uint64_t left = uint64_t(status.st_size) - sizeof header;
    if (header.content == uint32_t(BlockContent::out_of_memory))
        block.content = BlockContent::out_of_memory;
    else if (header.content == uint32_t(BlockContent::error) && read_error(cursor, header, left, block))
        block.content = BlockContent::error;
    else if (header.content == uint32_t(BlockContent::mesh) && read_mesh(cursor, header, left, block))
        block.content = BlockContent::mesh;
    return block;
}

} // namespace relief
