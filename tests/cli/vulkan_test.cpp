// The Vulkan engine by way of the command: on whatever device there is, a program that stands in for one
// included. Every run is validated (tests/vulkan/validation).
#include <cstdint>
#include <cstdlib>
#include <set>

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

/// The same keys, all the way down; of arrays the first elements.
void expect_same_keys(const json& a, const json& b, const std::string& path) {
    EXPECT_EQ(a.type_name(), std::string(b.type_name())) << path;
    if (a.is_array() && !a.empty() && !b.empty()) expect_same_keys(a[0], b[0], path + "[0]");
    if (!a.is_object() || !b.is_object()) return;
    for (const auto& [key, value] : a.items()) {
        ASSERT_TRUE(b.contains(key)) << path << "." << key;
        expect_same_keys(value, b[key], path + "." + key);
    }
    EXPECT_EQ(a.size(), b.size()) << path;
}

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

TEST_F(Vulkan, makes_one_picture_by_every_method) {
    const std::vector<std::string> common{"--layers", "depth,N", "--spp",   "2",
                                          "--engine", "vulkan",  "--method"};
    for (const char* method : {"compute", "fragment", "hybrid"}) {
        std::vector<std::string> all = common;
        all.insert(all.end(), {method, "--stats", "s.json"});
        const CommandResult result = render_bump(std::string(method) + ".exr", all);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_EQ(json::parse(read("s.json"))["casts"][0]["rays"], 2 * 24 * 16) << method;
        for (const char* layer : {"", "depth.Z", "N.X"}) {
            std::vector<std::string> compare{"compare", "compute.exr", std::string(method) + ".exr"};
            if (*layer) compare.insert(compare.end(), {"--layer", layer});
            EXPECT_EQ(run(compare).exit_code, 0) << method << " " << layer;
        }
    }
    EXPECT_NE(run({"devices"}).output.find("compute fragment hybrid"), std::string::npos);
}

TEST_F(Vulkan, names_what_a_method_does_not_go_with) {
    const auto expect_refusal = [&](std::vector<std::string> options, const char* hint) {
        const CommandResult result = render_bump("a.exr", options);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.errors.find(hint), std::string::npos) << result.errors;
        EXPECT_FALSE(exists("a.exr"));
    };
    expect_refusal({"--method", "hybrid"}, "--engine vulkan");
    expect_refusal({"--engine", "vulkan", "--method", "rays"}, "hybrid");
    expect_refusal({"--engine", "vulkan", "--method", "hybrid", "--lod", "ray"}, "--lod field");
    expect_refusal({"--engine", "vulkan", "--method", "hybrid", "--leaf", "box"}, "--leaf exact");
    expect_refusal({"--engine", "vulkan", "--method", "fragment", "--bottom", "fused"}, "--bottom auto");
}

TEST_F(Vulkan, keeps_compiled_kernels_between_runs) {
    const Environment cache("XDG_CACHE_HOME", (folder_ / "cache").string());
    ASSERT_EQ(render_bump("a.exr", {"--engine", "vulkan", "--spp", "1"}).exit_code, 0);
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

TEST_F(Vulkan, fills_the_statistics_that_the_cpu_engine_fills) {
    const std::vector<std::string> options{"--spp", "2", "--size", "320x180", "--level", "4", "--stats"};
    const auto render_with = [&](const char* engine) {
        std::vector<std::string> all = options;
        all.insert(all.end(), {std::string(engine) + ".json", "--engine", engine});
        EXPECT_EQ(render_bump("a.exr", all).exit_code, 0);
        return json::parse(read(std::string(engine) + ".json"));
    };
    const json cpu = render_with("cpu"), vulkan = render_with("vulkan");
    expect_same_keys(cpu, vulkan, "");
    EXPECT_EQ(vulkan["rays"]["camera"], 2 * 320 * 180);
    EXPECT_EQ(vulkan["rays"]["camera"], cpu["rays"]["camera"]);
    EXPECT_NEAR(vulkan["rays"]["shadow"].get<double>(), cpu["rays"]["shadow"].get<double>(),
                0.01 * cpu["rays"]["shadow"].get<double>());
    EXPECT_EQ(vulkan["casts"].size(), cpu["casts"].size());
    uint64_t pairs = 0, built = 0;
    for (const json& cast : vulkan["casts"]) pairs += cast["pairs"].get<uint64_t>();
    EXPECT_EQ(vulkan["pairs"]["emitted"], pairs);
    EXPECT_GT(vulkan["pairs"]["with_hit"], 0);
    for (const json& count : vulkan["bottom"]["levels"]) built += count.get<uint64_t>();
    EXPECT_EQ(vulkan["bottom"]["built"], built);
    EXPECT_EQ(vulkan["bottom"]["levels"][4], 1) << "one patch, one tree, kept";
    double stages = 0;
    for (const json& seconds : vulkan["stage_s"]) stages += seconds.get<double>();
    EXPECT_NEAR(stages, vulkan["time_s"]["render"].get<double>(),
                0.1 * vulkan["time_s"]["render"].get<double>());
}

/// Under the layer that makes a sound device fail; see tests/vulkan/fault_layer.
class FaultyVulkan : public Vulkan {
  protected:
    Environment path_{"VK_ADD_LAYER_PATH", RELIEF_FAULT_LAYER};
    Environment layer_{"VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_RELIEF_fault"};
};

TEST_F(FaultyVulkan, a_lacking_feature_is_named_with_the_way_out) {
    const Environment fault("RELIEF_FAULT_FEATURE", "shaderInt64");
    const CommandResult result = render_bump("a.exr", {"--engine", "vulkan"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.errors.find("lacks shaderInt64"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("--engine cpu"), std::string::npos) << result.errors;
    const CommandResult list = run({"devices"});
    EXPECT_EQ(list.exit_code, 0);
    EXPECT_NE(list.output.find("lacks shaderInt64"), std::string::npos) << list.output;
    EXPECT_EQ(render_bump("a.exr", {"--engine", "cpu"}).exit_code, 0);
}

TEST_F(FaultyVulkan, a_feature_that_only_some_methods_need_stops_only_those) {
    const Environment fault("RELIEF_FAULT_FEATURE", "fragmentStoresAndAtomics");
    for (const char* method : {"fragment", "hybrid"}) {
        const CommandResult result = render_bump("a.exr", {"--engine", "vulkan", "--method", method});
        EXPECT_EQ(result.exit_code, 4);
        EXPECT_NE(result.errors.find("lacks fragmentStoresAndAtomics"), std::string::npos) << result.errors;
        EXPECT_NE(result.errors.find("--method compute"), std::string::npos) << result.errors;
    }
    const CommandResult list = run({"devices"});
    EXPECT_NE(list.output.find("methods compute\n"), std::string::npos) << list.output;
    EXPECT_NE(list.output.find("lacks fragmentStoresAndAtomics"), std::string::npos) << list.output;
    EXPECT_EQ(render_bump("a.exr", {"--engine", "vulkan", "--spp", "1"}).exit_code, 0);
}

TEST_F(FaultyVulkan, a_lost_device_is_told_with_the_way_out) {
    const Environment fault("RELIEF_FAULT_LOST_SUBMIT", "20");
    const CommandResult result = render_bump("a.exr", {"--engine", "vulkan"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.errors.find("lost"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("--engine cpu"), std::string::npos) << result.errors;
    EXPECT_FALSE(exists("a.exr"));
}

TEST_F(FaultyVulkan, a_memory_too_small_for_the_scene_is_refused_in_bytes) {
    const Environment fault("RELIEF_FAULT_HEAP_BYTES", "1000000");
    const CommandResult result = render_bump("a.exr", {"--engine", "vulkan"});
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_NE(result.errors.find("of 1000000 bytes"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("--engine cpu"), std::string::npos) << result.errors;
}

TEST_F(FaultyVulkan, a_small_memory_takes_more_batches_to_the_same_picture) {
    const auto render_within = [&](const char* heap_bytes, const std::string& output) {
        const Environment fault("RELIEF_FAULT_HEAP_BYTES", heap_bytes);
        const CommandResult result =
            render_bump(output, {"--engine", "vulkan", "--size", "160x90", "--layers", "depth,N", "--spp",
                                 "2", "--stats", "s.json"});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return json::parse(read("s.json"))["memory_bytes"]["ray_buffers"].get<uint64_t>();
    };
    EXPECT_LT(render_within("8000000", "small.exr"), render_within("2000000000", "large.exr"));
    for (const char* layer : {"depth", "N"})
        EXPECT_EQ(run({"compare", "small.exr", "large.exr", "--layer", layer}).exit_code, 0) << layer;
    EXPECT_EQ(run({"compare", "small.exr", "large.exr"}).exit_code, 0);
}

TEST_F(FaultyVulkan, memory_that_ends_on_the_way_costs_a_fresh_start_and_nothing_else) {
    const auto render_tiles = [&](const std::string& output) {
        return render_bump(output, {"--engine", "vulkan", "--size", "160x90", "--level", "9", "--layers",
                                    "depth", "--spp", "1", "--stats", "s.json"});
    };
    ASSERT_EQ(render_tiles("whole.exr").exit_code, 0);
    const json whole = json::parse(read("s.json"));
    std::set<std::string> refusals; // while the tracer is created, and in the cast, when tiles are requested
    for (int submissions = 1; submissions <= 8; ++submissions) {
        const Environment fault("RELIEF_FAULT_MEMORY_AFTER", std::to_string(submissions));
        const CommandResult result = render_tiles("again.exr");
        ASSERT_EQ(result.exit_code, 0) << submissions << ": " << result.errors;
        if (const size_t place = result.errors.find("fault layer:"); place != std::string::npos)
            refusals.insert(result.errors.substr(place, result.errors.find('\n', place)));
        EXPECT_EQ(json::parse(read("s.json"))["rays"]["total"], whole["rays"]["total"]) << submissions;
        EXPECT_EQ(run({"compare", "whole.exr", "again.exr"}).exit_code, 0) << submissions;
        EXPECT_EQ(run({"compare", "whole.exr", "again.exr", "--layer", "depth"}).exit_code, 0) << submissions;
    }
    EXPECT_GE(refusals.size(), 2u);
}

TEST_F(Vulkan, measures_trees_that_the_device_builds_and_walks) {
    const CommandResult result =
        run({"bench", "paper2", "--quick", "--engine", "vulkan", "--scenes", "body", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json mesh = json::parse(read("paper2/paper2.json"))["meshes"][0];
    EXPECT_EQ(mesh["combinations_that_agree"], mesh["casts"].size());
    int built = 0;
    for (const json& build : mesh["builds"]) {
        if (build["built_on"] != "device") continue;
        ++built;
        EXPECT_EQ(build["parts"].size(), 5u);
        EXPECT_GT(build["share_of_bandwidth_bound"]["median"], 0);
    }
    EXPECT_EQ(built, 3);
}

TEST_F(Vulkan, measures_the_three_methods) {
    const CommandResult result =
        run({"bench", "paper3", "--quick", "--engine", "vulkan", "--scenes", "body", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("paper3/paper3.json"));
    EXPECT_EQ(s["scenes"][0]["ways"].size(), 12u);
    for (const json& way : s["scenes"][0]["ways"])
        if (way["outcome"] == "measured") EXPECT_EQ(way["pixels_that_differ"], 0) << way["method"];
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
