// Readers of third-party libraries in a child process: the same mesh, and an Error whatever happens to it.
#include <algorithm>
#include <cerrno>
#include <cstring>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/mesh/mesh_block.h"
#include "io/test_files.h"
#include "relief/io.h"
#include "support/fbx_text.h"

namespace relief {

namespace {

using ChildReader = FileTest;

MeshReadOptions in_child() {
    MeshReadOptions options;
    options.reader.program = RELIEF_BINARY;
    return options;
}

void expect_equal(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.source, b.source);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.face_sizes, b.face_sizes);
    EXPECT_EQ(a.position_indices, b.position_indices);
    EXPECT_EQ(a.uv_indices, b.uv_indices);
    EXPECT_EQ(a.normal_indices, b.normal_indices);
    EXPECT_EQ(a.tangents, b.tangents);
    EXPECT_EQ(a.creases, b.creases);
    EXPECT_EQ(a.uv_set, b.uv_set);
    ASSERT_EQ(a.further_uvs.size(), b.further_uvs.size());
    for (size_t k = 0; k < a.further_uvs.size(); ++k) {
        EXPECT_EQ(a.further_uvs[k].number, b.further_uvs[k].number);
        EXPECT_EQ(a.further_uvs[k].uvs, b.further_uvs[k].uvs);
        EXPECT_EQ(a.further_uvs[k].indices, b.further_uvs[k].indices);
    }
}

/// An executable script in place of a reader.
std::filesystem::path make_program(const std::filesystem::path& file) {
    chmod(file.c_str(), 0700);
    return file;
}

TEST_F(ChildReader, reads_what_this_process_would_read) {
    const auto file = write("grid.fbx", make_grid_fbx(5));
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.face_sizes, std::vector<uint32_t>(25, 4));
    EXPECT_EQ(mesh.uv_indices.size(), 100u);
    expect_equal(load_mesh(file, in_child()), mesh);
    const auto parts = write("parts.fbx", make_grid_fbx(2, true));
    const Mesh mixed = load_mesh(parts);
    EXPECT_EQ(std::ranges::count(mixed.uv_indices, kNoIndex), 16);
    expect_equal(load_mesh(parts, in_child()), mixed);
    const auto scene =
        write("scene.json", R"({"meshes": {"g": {"file": "grid.fbx"}}, "objects": [{"mesh": "g"}]})");
    EXPECT_EQ(load_scene(scene, in_child().reader).hash, load_scene(scene).hash);
    MeshSceneOptions options;
    const uint64_t hash = load_mesh_scene(file, options).hash;
    options.reader = in_child().reader;
    EXPECT_EQ(load_mesh_scene(file, options).hash, hash);
}

TEST_F(ChildReader, reports_errors_as_this_process_would) {
    const auto damaged = write("a.fbx", "; FBX\nObjects:  {\n");
    EXPECT_EQ(message_of([&] { load_mesh(damaged, in_child()); }), message_of([&] { load_mesh(damaged); }));
    MeshReadOptions options = in_child();
    options.uv_set = 7;
    EXPECT_HAS(message_of([&] { load_mesh(write("b.fbx", make_grid_fbx(1)), options); }),
               "b.fbx: has no uv set 7");
}

TEST_F(ChildReader, a_node_that_is_its_own_child_ends_in_a_message) {
    const auto file = write("loop.fbx", make_endless_fbx());
    const std::string message = message_of([&] { load_mesh(file, in_child()); });
    EXPECT_HAS(message, "loop.fbx: the FBX reader ended with");
    EXPECT_HAS(message, "export it as glTF, OBJ or PLY");
}

TEST_F(ChildReader, limits_of_time_and_memory_end_in_a_message) {
    const auto file = write("grid.fbx", make_grid_fbx(60));
    MeshReadOptions options = in_child();
    options.reader.seconds = 1e-6;
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }), "grid.fbx: the FBX reader was not done after");
    errno = 0;
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD) << "the child has been waited for";
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    options = in_child();
    options.reader.memory_bytes = 1 << 20;
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }),
               "the FBX reader needs more than 1 MiB of memory");
#endif
}

TEST_F(ChildReader, is_cancelled_at_once) {
    const auto file = write("grid.fbx", make_grid_fbx(60));
    MeshReadOptions options = in_child();
    int calls = 0;
    options.reader.is_cancelled = [&] { return ++calls == 2; };
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }, ErrorKind::failed), "reading was cancelled");
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "the child has been waited for";
}

TEST_F(ChildReader, programs_that_leave_no_mesh_end_in_a_message) {
    const auto file = write("grid.fbx", make_grid_fbx(2));
    MeshReadOptions options;
    options.reader.program = folder_ / "none";
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }, ErrorKind::failed), "cannot be started");
    options.reader.program = make_program(write("silent", "#!/bin/sh\nexit 4\n"));
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }), "ended without a mesh (exit 4)");
    options.reader.program = make_program(write("noise", "#!/bin/sh\nprintf reliefM3andthensome >&3\n"));
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }), "ended without a mesh (exit 0)");
    options.reader.program = make_program(write("killed", "#!/bin/sh\nkill -9 $$\n"));
    EXPECT_HAS(message_of([&] { load_mesh(file, options); }), "ended with signal 9 (Killed)");
}

/// A block in memory of its own.
class Block {
  public:
    Block() : descriptor_(memfd_create("block", MFD_CLOEXEC)) {}
    ~Block() { close(descriptor_); }
    int descriptor() const { return descriptor_; }
    template <class T> void set(off_t place, const T& value) const {
        EXPECT_EQ(pwrite(descriptor_, &value, sizeof value, place), ssize_t(sizeof value));
    }
    BlockContent read() const { return read_mesh_block(descriptor_, 1 << 20).content; }

  private:
    int descriptor_;
};

Mesh make_full_mesh() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.uvs = {{0, 0}, {0.5f, 1}};
    mesh.normals = {{0, 0, 1}};
    mesh.face_sizes = {3};
    mesh.position_indices = {0, 1, 2}, mesh.uv_indices = {0, 1, 1}, mesh.normal_indices = {0, 0, 0};
    mesh.tangents = {{1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 0, 1}};
    mesh.creases = {{0, 2, 1.5f}};
    mesh.uv_set = 1;
    mesh.further_uvs = {{0, {{2, 3}}, {0, 0, 0}}, {5, {{0, 1}, {1, 1}}, {1, 0, kNoIndex}}};
    return mesh;
}

TEST_F(ChildReader, a_block_holds_all_arrays) {
    const Block block;
    write_mesh_block(block.descriptor(), make_full_mesh(), {"one", "two\nlines"});
    const MeshBlock read = read_mesh_block(block.descriptor(), 1 << 20);
    ASSERT_EQ(read.content, BlockContent::mesh);
    expect_equal(read.mesh, make_full_mesh());
    EXPECT_EQ(read.warnings, (std::vector<std::string>{"one", "two?lines"}));
    EXPECT_EQ(read_mesh_block(block.descriptor(), 100).content, BlockContent::nothing) << "too large";
    Mesh without_uvs = make_full_mesh();
    std::ranges::fill(without_uvs.uv_indices, kNoIndex);
    const Block other;
    write_mesh_block(other.descriptor(), without_uvs);
    const MeshBlock read_again = read_mesh_block(other.descriptor(), 1 << 20);
    EXPECT_EQ(read_again.content, BlockContent::mesh);
    expect_equal(read_again.mesh, without_uvs);
}

TEST_F(ChildReader, damaged_blocks_count_as_nothing) {
    constexpr off_t kSizes = 16, kArrays = kSizes + 13 * 8;
    const off_t face_sizes = kArrays + 3 * 12 + 2 * 8 + 12, positions = face_sizes + 4;
    const off_t uvs = positions + 12, normals = uvs + 12, creases = normals + 12 + 3 * 16;
    const auto read_damaged = [](off_t place, auto value) {
        const Block block;
        write_mesh_block(block.descriptor(), make_full_mesh(), {"a warning"});
        block.set(place, value);
        return block.read();
    };
    EXPECT_EQ(read_damaged(face_sizes, uint32_t(3)), BlockContent::mesh) << "the places are right";
    EXPECT_EQ(read_damaged(face_sizes, uint32_t(2)), BlockContent::nothing);
    EXPECT_EQ(read_damaged(face_sizes, uint32_t(0xffffffff)), BlockContent::nothing);
    for (const off_t place : {positions, uvs, normals, creases}) {
        EXPECT_EQ(read_damaged(place, uint32_t(0)), BlockContent::mesh) << place;
        EXPECT_EQ(read_damaged(place + 4, uint32_t(3)), BlockContent::nothing) << place;
    }
    const off_t further = creases + 12 + 3 * 8 + 3 * 8;
    EXPECT_EQ(read_damaged(further + 12, uint32_t(0)), BlockContent::mesh);
    EXPECT_EQ(read_damaged(further + 12, uint32_t(2)), BlockContent::nothing) << "a uv of the other set";
    EXPECT_EQ(read_damaged(creases + 12 + 12, uint32_t(2)), BlockContent::nothing) << "counts of uvs";
    EXPECT_EQ(read_damaged(0, uint32_t(0)), BlockContent::nothing) << "magic";
    EXPECT_EQ(read_damaged(8, uint32_t(17)), BlockContent::nothing) << "content";
    for (off_t size = kSizes; size < kArrays; size += 8)
        for (const uint64_t count : {uint64_t(0), uint64_t(4), uint64_t(1) << 61, ~uint64_t(0)})
            EXPECT_EQ(read_damaged(size, count), BlockContent::nothing) << size << ' ' << count;
    for (const off_t size : {off_t(0), off_t(20), creases, creases + 40}) {
        const Block block;
        write_mesh_block(block.descriptor(), make_full_mesh());
        ASSERT_EQ(ftruncate(block.descriptor(), size), 0);
        EXPECT_EQ(block.read(), BlockContent::nothing) << size;
    }
}

TEST_F(ChildReader, errors_come_back_without_control_characters) {
    const Block block;
    write_error_block(block.descriptor(), Error(ErrorKind::bad_input, {"a \x1b[2J b", "f.fbx", "h"}));
    const MeshBlock read = read_mesh_block(block.descriptor(), 1 << 20);
    ASSERT_EQ(read.content, BlockContent::error);
    EXPECT_EQ(read.error.message, "a ?[2J b");
    EXPECT_EQ(read.error.where, "f.fbx");
    EXPECT_EQ(read.error.hint, "h");
    block.set(12, uint32_t(77));
    EXPECT_EQ(block.read(), BlockContent::nothing) << "there is no such kind of error";
    const Block other;
    write_memory_block(other.descriptor());
    EXPECT_EQ(other.read(), BlockContent::out_of_memory);
}

} // namespace

} // namespace relief
