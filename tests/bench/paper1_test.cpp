#include "bench/paper1.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "relief/error.h"

namespace relief::bench {
namespace {

TEST(Paper1, knows_its_scenes) {
    for (const std::vector<std::string>& scenes :
         {std::vector<std::string>{}, std::vector<std::string>{"bark", "ear"}}) {
        Paper1Options options;
        options.scenes = scenes;
        try {
            run_paper1(options, [](const std::string&) {});
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
        }
    }
}

} // namespace
} // namespace relief::bench
