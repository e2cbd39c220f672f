// The pool of OpenEXR is the process's: a host program may have set it, and a caller may want fewer threads.
#include "io/picture/exr_threads.h"

#include <OpenEXR/ImfThreading.h>

#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

class ExrThreads : public FileTest {
  protected:
    ~ExrThreads() override { Imf::setGlobalThreadCount(old_count_); }

    int old_count_ = Imf::globalThreadCount();
};

TEST_F(ExrThreads, the_pool_of_a_host_program_is_left_alone) {
    Imf::setGlobalThreadCount(3);
    Image image;
    image.width = 40, image.height = 100, image.channels = {"R"}, image.pixels.assign(4000, 0.5f);
    for (const int threads : {1, 2, 7})
        with_io_threads(threads, [&] {
            write_image(image, folder_ / "a.exr");
            EXPECT_EQ(read_image(folder_ / "a.exr").pixels, image.pixels);
        });
    EXPECT_EQ(Imf::globalThreadCount(), 3);
}

TEST_F(ExrThreads, no_more_threads_are_made_and_used_than_the_caller_may_use) {
    Imf::setGlobalThreadCount(0);
    with_io_threads(1, [] { EXPECT_EQ(prepare_exr_threads(), 0); });
    EXPECT_EQ(Imf::globalThreadCount(), 0);
    with_io_threads(2, [] { EXPECT_LE(prepare_exr_threads(), 2); });
    EXPECT_LE(Imf::globalThreadCount(), 2);
    Imf::setGlobalThreadCount(16);
    // Two blocks a thread: at most as many at a time as threads.
    with_io_threads(4, [] { EXPECT_LE(prepare_exr_threads(), 2); });
}

} // namespace relief
