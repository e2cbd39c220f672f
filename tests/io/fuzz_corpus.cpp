// Every input that a fuzzer starts from, through its target: what a target requires holds without libFuzzer
// as well. A target that finds otherwise ends the process; the last line printed names the input.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "io/file_system.h"

#define RELIEF_FUZZ_TARGET(name) extern "C" int fuzz_##name(const uint8_t* data, size_t size);
RELIEF_FUZZ_TARGETS
#undef RELIEF_FUZZ_TARGET

namespace {

using FuzzTarget = int (*)(const uint8_t*, size_t);

const std::map<std::string, FuzzTarget>& get_targets() {
#define RELIEF_FUZZ_TARGET(name) {#name, fuzz_##name},
    static const std::map<std::string, FuzzTarget> targets = {RELIEF_FUZZ_TARGETS};
#undef RELIEF_FUZZ_TARGET
    return targets;
}

TEST(FuzzTargets, hold_for_every_file_of_their_corpus) {
    for (const auto& [name, target] : get_targets()) {
        size_t inputs = 0;
        for (const auto& entry : std::filesystem::directory_iterator(RELIEF_FUZZ_CORPUS "/" + name)) {
            std::printf("%s\n", entry.path().c_str());
            std::fflush(stdout);
            const std::string bytes = relief::read_file_bytes(entry.path());
            EXPECT_EQ(target(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()), 0);
            ++inputs;
        }
        EXPECT_GT(inputs, 0u) << name;
    }
}

} // namespace
