// The Vulkan engine by way of the command: on whatever device there is, a program that stands in for one
// included.
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

/// Sets a variable of the environment for one test.
class Environment {
  public:
    Environment(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, value.c_str(), 1);
    }
    ~Environment() {
        if (before_.empty())
            unsetenv(name_);
        else
            setenv(name_, before_.c_str(), 1);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    const char* name_;
    std::string before_;
};

class Vulkan : public CommandTest {
  protected:
    /// A cache folder of the test's own.
    Vulkan()
        : cache_("XDG_CACHE_HOME", (std::filesystem::temp_directory_path() / "relief-cli-cache").string()) {}

    Environment cache_;
};

#ifdef RELIEF_VULKAN

TEST_F(Vulkan, makes_the_picture_that_the_cpu_engine_makes) {
    ASSERT_EQ(render_bump("cpu.exr", {"--layers", "depth", "--spp", "1"}).exit_code, 0);
    for (const char* form : {"auto", "split", "fused"}) {
        const CommandResult result =
            render_bump("vulkan.exr", {"--layers", "depth", "--spp", "1", "--engine", "vulkan", "--bottom",
                                       form, "--stats", "s.json"});
        ASSERT_EQ(result.exit_code, 0) << result.errors;
        const json s = json::parse(read("s.json"));
        EXPECT_EQ(s["device"]["engine"], "vulkan");
        EXPECT_NE(s["device"]["name"], "");
        EXPECT_EQ(s["casts"][0]["rays"], 24 * 16);
        EXPECT_EQ(
            run({"compare", "cpu.exr", "vulkan.exr", "--layer", "depth.Z", "--threshold", "1e-4"}).exit_code,
            0)
            << form;
    }
}

TEST_F(Vulkan, keeps_compiled_kernels_between_runs) {
    const Environment cache("XDG_CACHE_HOME", (folder_ / "cache").string());
    ASSERT_EQ(render_bump("a.exr", {"--engine", "vulkan", "--spp", "1", "--bounces", "0"}).exit_code, 0);
    ASSERT_TRUE(exists("cache/relief"));
    size_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder_ / "cache/relief"))
        bytes += file.file_size();
    EXPECT_GT(bytes, 0u);
}

TEST_F(Vulkan, a_device_that_does_not_exist_is_missing) {
    const CommandResult result = render_bump("a.exr", {"--engine", "vulkan", "--device", "200"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.errors.find("200"), std::string::npos) << result.errors;
}

TEST_F(Vulkan, without_a_driver_the_way_out_is_named) {
    const Environment drivers("VK_DRIVER_FILES", "/nowhere.json"), older("VK_ICD_FILENAMES", "/nowhere.json");
    const CommandResult result = render_bump("a.exr", {"--engine", "vulkan"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.errors.find("--engine cpu"), std::string::npos) << result.errors;
}

#else

TEST_F(Vulkan, is_missing_in_a_build_without_it) {
    const CommandResult result = render_bump("a.exr", {"--engine", "vulkan"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.errors.find("this build has no Vulkan"), std::string::npos) << result.errors;
}

#endif

} // namespace
} // namespace relief::cli
