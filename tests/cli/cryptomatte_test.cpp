// Cryptomatte layers as another program reads them: OpenImageIO's oiiotool.
#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "command.h"
#include "relief/image.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

/// A wall of two halves that meet in the middle of the picture.
constexpr const char* kScene = R"({
  "version": 1,
  "camera": { "from": [0, 0, 5], "to": [0, 0, 0], "fov_degrees": 30 },
  "environment": { "color": [1, 1, 1] },
  "materials": { "clay": {}, "Gl\u00e4s": { "roughness": 0.1 } },
  "meshes": { "plane": { "file": "plane.obj" } },
  "objects": [
    { "name": "left \"half\"", "mesh": "plane", "material": "clay", "transform": { "translate": [-1, 0, 0] } },
    { "mesh": "plane", "material": "Gl\u00e4s", "transform": { "translate": [1, 0, 0] } }
  ]
})";

class Cryptomatte : public CommandTest {
  protected:
    void render_wall(const std::string& output, std::vector<std::string> more) {
        write("scene.json", kScene);
        more.insert(more.begin(), {"render", "scene.json", "-o", output, "--size", "5x4", "--bounces", "0"});
        const CommandResult result = run(more);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
    }

    std::string run_oiiotool(const std::string& arguments) {
        const std::string line = "cd '" + folder_.string() + "' && oiiotool " + arguments + " 2>&1";
        std::FILE* const pipe = popen(line.c_str(), "r");
        std::string output;
        std::array<char, 4096> buffer;
        while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
            output.append(buffer.data(), count);
        EXPECT_EQ(pclose(pipe), 0) << output;
        return output;
    }
};

void expect_has(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST_F(Cryptomatte, is_read_by_oiiotool) {
    render_wall("wall.exr", {"--spp", "16", "--layers", "CryptoObject,CryptoMaterial"});
    const std::string info = run_oiiotool("--info -v wall.exr");
    expect_has(info, "CryptoObject00.r, CryptoObject00.g, CryptoObject00.b, CryptoObject00.a");
    expect_has(info, "CryptoMaterial02.r, CryptoMaterial02.g, CryptoMaterial02.b, CryptoMaterial02.a");
    expect_has(info, "cryptomatte/3ae39a5/name: \"CryptoObject\"");
    expect_has(info, "cryptomatte/3ae39a5/hash: \"MurmurHash3_32\"");
    expect_has(info, "cryptomatte/3ae39a5/conversion: \"uint32_to_float32\"");
    expect_has(info, "cryptomatte/be359d6/name: \"CryptoMaterial\"");
    for (const char* id : {"ce3e569a", "2e2136b8", "47bdbab6"}) expect_has(info, id);
    // The float of the first of these, everywhere in a pixel of the left half.
    expect_has(run_oiiotool("wall.exr --ch CryptoObject00.r,CryptoObject00.g --cut 1x1+0+2 --printstats"),
               "Constant Color: -798336640.000000 1.000000");
}

/// Ids as the Python package mmh3 5 gives them.
TEST_F(Cryptomatte, has_manifests_that_are_json) {
    render_wall("wall.exr", {"--spp", "1", "--layers", "CryptoObject,CryptoMaterial"});
    const Image image = read_image(folder_ / "wall.exr");
    const auto parse = [&](const char* key) {
        return nlohmann::json::parse(image.metadata.at(std::string("cryptomatte/") + key + "/manifest"));
    };
    EXPECT_EQ(parse("3ae39a5"), (nlohmann::json{{"left \"half\"", "ce3e569a"}, {"plane", "2e2136b8"}}));
    EXPECT_EQ(parse("be359d6"), (nlohmann::json{{"clay", "ec7f5c59"}, {"Gl\u00e4s", "47bdbab6"}}));
}

TEST_F(Cryptomatte, goes_through_compare_inspect_and_merge) {
    const std::vector<std::string> layers{"--layers", "CryptoObject,CryptoMaterial,samples"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), layers.begin(), layers.end());
        return more;
    };
    render_wall("whole.exr", with({"--spp", "9"}));
    render_wall("a.exr", with({"--samples", "0:4"})), render_wall("b.exr", with({"--samples", "4:9"}));
    ASSERT_EQ(run({"merge", "a.exr", "b.exr", "-o", "merged.exr"}).exit_code, 0);
    for (const char* layer : {"CryptoObject00", "CryptoObject01", "CryptoMaterial00"}) {
        const CommandResult same = run({"compare", "whole.exr", "merged.exr", "--layer", layer});
        EXPECT_EQ(same.exit_code, 0) << same.output << same.errors;
        const CommandResult other = run({"compare", "whole.exr", "a.exr", "--layer", layer});
        EXPECT_EQ(other.exit_code, layer == std::string("CryptoObject01") ? 0 : 7) << other.output;
    }
    EXPECT_EQ(read_image(folder_ / "merged.exr").metadata.at("cryptomatte/3ae39a5/manifest"),
              read_image(folder_ / "whole.exr").metadata.at("cryptomatte/3ae39a5/manifest"));
    const CommandResult inspected = run({"inspect", "whole.exr"});
    EXPECT_EQ(inspected.exit_code, 0) << inspected.errors;
}

TEST_F(Cryptomatte, goes_on_after_resume) {
    render_wall("whole.exr", {"--spp", "11", "--layers", "CryptoObject"});
    render_wall("part.exr", {"--spp", "4", "--layers", "CryptoObject", "--checkpoint", "10"});
    render_wall("part.exr", {"--spp", "11", "--layers", "CryptoObject", "--resume", "part.exr"});
    EXPECT_EQ(read_image(folder_ / "part.exr").pixels, read_image(folder_ / "whole.exr").pixels);
    const CommandResult other = run({"render", "scene.json", "--size", "5x4", "--bounces", "0", "--spp", "12",
                                     "--layers", "CryptoMaterial", "--resume", "part.exr"});
    EXPECT_EQ(other.exit_code, 3) << "sums of another layer";
}

} // namespace
} // namespace relief::cli
