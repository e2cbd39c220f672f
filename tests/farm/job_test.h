// A job in a folder of its own, for one test.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "farm/attempts.h"

namespace relief::cli {

class FarmJobTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "relief-farm-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        job_.folder = pattern;
        job_.frames = {1, 2, 3}, job_.tiles = 2, job_.passes = 2, job_.spp = 5;
    }
    void TearDown() override {
        std::error_code ignored;
        std::filesystem::remove_all(job_.folder, ignored);
    }
    void add(uint32_t task, const std::string& who, AttemptState state) const {
        Attempt attempt;
        attempt.task = task, attempt.who = who, attempt.state = state;
        attempt.rays = 1000, attempt.milliseconds = 500, attempt.exit_code = 3;
        std::filesystem::create_directories(get_state_folder(job_, task));
        std::ofstream(get_attempt_file(job_, attempt)) << "";
    }

    FarmJob job_;
};

} // namespace relief::cli
