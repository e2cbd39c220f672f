// What is said where Open Image Denoise is missing or is something else; the real library is tested by `make
// peers`.
#include "relief/denoise.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "relief/error.h"

namespace relief {

TEST(Denoiser, names_what_is_missing_and_the_way_to_get_it) {
    DenoiserSettings settings;
    settings.libraries = {std::filesystem::temp_directory_path() / "no-denoiser-here.so"};
    try {
        const Denoiser denoiser(settings);
        EXPECT_EQ(denoiser.version()[0], '2') << "the system has the library";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::device_missing);
        EXPECT_NE(error.hint().find("pip install pyoidn"), std::string::npos) << error.what();
    }
}

TEST(Denoiser, refuses_a_library_that_is_not_one) {
    DenoiserSettings settings;
    settings.libraries = {"libm.so.6"};
    try {
        EXPECT_EQ(Denoiser(settings).version()[0], '2') << "the system has the library";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::device_missing);
    }
}

} // namespace relief
