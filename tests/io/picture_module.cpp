// The module that reads what is no plain EXR: missing, or of another version.
#include "io/picture/picture_library.h"
#include "io/test_files.h"

namespace relief {

using PictureModule = FileTest;

TEST_F(PictureModule, a_missing_module_is_named_with_the_picture_and_what_to_do) {
    const std::string missing = folder_ / "relief_pictures.so";
    const std::string message =
        message_of([&] { load_picture_library(missing, "bump.png"); }, ErrorKind::failed);
    for (const char* part : {"bump.png", "relief_pictures.so", "beside the program", "convert"})
        EXPECT_HAS(message, part);
    EXPECT_HAS(
        message_of([&] { load_picture_library(write("x.so", "no library"), "bump.png"); }, ErrorKind::failed),
        "bump.png");
}

TEST_F(PictureModule, a_library_without_this_versions_entry_is_refused) {
    EXPECT_HAS(message_of([&] { load_picture_library("libz.so.1", "bump.png"); }, ErrorKind::failed),
               "libz.so.1 is of another version of Relief");
}

} // namespace relief
