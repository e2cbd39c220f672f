#include "common/engine_options.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/values.h"
#include "relief/version.h"

namespace relief::cli {

namespace {

constexpr int kMaxDevice = 255;

template <class T> using Word = std::pair<std::string_view, T>;

constexpr std::array<Word<Isa>, 6> kIsas{{{"best", Isa::best},
                                          {"avx512", Isa::avx512},
                                          {"avx2", Isa::avx2},
                                          {"sse4", Isa::sse4},
                                          {"neon", Isa::neon},
                                          {"scalar", Isa::scalar}}};

} // namespace

void add_engine_options(CLI::App& verb, EngineOptions& o, RenderSettings& s) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--engine", "NAME", "cpu (default) or vulkan", [&s](const std::string& text) {
        constexpr std::array<Word<EngineKind>, 2> words{
            {{"cpu", EngineKind::cpu}, {"vulkan", EngineKind::vulkan}}};
        constexpr std::array<std::string_view, 6> kOtherNames = {"gpu", "cuda",  "optix",
                                                                 "vk",  "metal", "opencl"};
        if (std::ranges::find(kOtherNames, to_lower_case(text)) != kOtherNames.end())
            refuse_value("--engine", text, "one of: cpu, vulkan", "GPUs are used by --engine vulkan");
        s.device.engine = parse_word("--engine", text, words);
    });
    add("--device", "N", "of the Vulkan engine, as `relief devices` lists them; default: the best",
        [&o, &s](const std::string& text) {
            s.device.index = int(parse_integer("--device", text, 0, kMaxDevice));
            o.vulkan_only.push_back("--device");
        });
    add("--bottom", "NAME", "of the Vulkan engine: auto (default), or the patch kernel fused or split",
        [&o, &s](const std::string& text) {
            constexpr std::array<Word<BottomForm>, 3> words{{{"auto", BottomForm::automatic},
                                                             {"fused", BottomForm::fused},
                                                             {"split", BottomForm::split}}};
            s.experiment.bottom = parse_word("--bottom", text, words);
            o.vulkan_only.push_back("--bottom");
        });
    add("--threads", "N", "0: all cores (default)", [&s](const std::string& text) {
        s.device.threads = int(parse_integer("--threads", text, 0, kMaxThreads));
    });
    add("--isa", "NAME", "of the CPU engine: best (default), avx512, avx2, sse4, neon, scalar",
        [&o, &s](const std::string& text) {
            s.device.isa = parse_word("--isa", text, kIsas, "relief devices lists those of this machine");
            o.cpu_only.push_back("--isa");
        });
}

std::string_view isa_name(Isa isa) { return std::ranges::find(kIsas, isa, &Word<Isa>::second)->first; }

void complete_engine_options(const EngineOptions& o, RenderSettings& s) {
    const bool is_cpu = s.device.engine == EngineKind::cpu;
    const std::vector<std::string>& others = is_cpu ? o.vulkan_only : o.cpu_only;
    if (!others.empty())
        throw Error(ErrorKind::usage,
                    {fmt::format("{} goes with the {} engine", others.front(), is_cpu ? "Vulkan" : "CPU"),
                     others.front(), is_cpu ? "add --engine vulkan" : "leave out --engine vulkan"});
    if (!is_cpu) s.device.pipeline_cache = choose_pipeline_cache(s.device.index).string();
}

std::filesystem::path choose_pipeline_cache(int device) {
    namespace fs = std::filesystem;
    fs::path folder;
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    if (cache && fs::path(cache).is_absolute()) // XDG specification: ignore relative paths
        folder = cache;
    else if (home && *home)
        folder = fs::path(home) / ".cache";
    else
        return {};
    folder /= "relief";
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) return {};
    return folder / fmt::format("pipelines-{}-{}", RELIEF_VERSION_STRING,
                                device < 0 ? "best" : std::to_string(device));
}

} // namespace relief::cli
