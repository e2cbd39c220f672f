// A folder of its own for each test, and what the tests write into it.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "relief/error.h"

namespace relief {

class FileTest : public testing::Test {
  protected:
    FileTest() {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / (std::string("relief_") + info->test_suite_name() +
                                                            "_" + info->name() + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~FileTest() override {
        std::error_code code;
        std::filesystem::remove_all(folder_, code);
    }

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }

    template <class T>
    std::filesystem::path write_pixels(const std::string& name, int width, int height, int channels,
                                       OIIO::TypeDesc type, const std::vector<T>& values) const {
        const std::filesystem::path file = folder_ / name;
        auto output = OIIO::ImageOutput::create(file.string());
        OIIO::ImageSpec spec(width, height, channels, type);
        if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
        EXPECT_TRUE(output->open(file.string(), spec)) << output->geterror();
        EXPECT_TRUE(output->write_image(type, values.data())) << output->geterror();
        EXPECT_TRUE(output->close());
        return file;
    }

    /// The message of the relief::Error that `body` must throw.
    static std::string message_of(const std::function<void()>& body, ErrorKind kind = ErrorKind::bad_input) {
        try {
            body();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            return error.what();
        }
        ADD_FAILURE() << "no error was thrown";
        return {};
    }

    std::filesystem::path folder_;
};

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

inline const char* const kQuadObj = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                    "usemtl x\nf 1/1 2/2 3/3 4/4\n";

} // namespace relief
