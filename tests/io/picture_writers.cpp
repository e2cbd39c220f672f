// What the writers of pictures do where something is wrong with the picture or the machine.
#include <new>

#include "io/image_output.h"
#include "io/test_files.h"

namespace relief {

using PictureWriters = FileTest;

TEST_F(PictureWriters, too_little_memory_is_not_a_fault_of_the_disk_and_leaves_nothing) {
    const auto encode = [](CheckedFile& file) {
        file.write("begun", 5);
        throw std::bad_alloc();
    };
    EXPECT_THROW(write_checked(folder_ / "a.exr", encode), std::bad_alloc);
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

} // namespace relief
