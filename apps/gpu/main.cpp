// relief-gpu: tests and benchmarks of the Vulkan engine on a machine with nothing but a driver.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/machine.h"
#include "bench/paper1.h"
#include "bench/tables.h"
#include "common/console.h"
#include "gpu/kernels.h"
#include "gpu/parity.h"
#include "relief/error.h"

namespace relief::gpu {
namespace {

struct Options {
    std::filesystem::path output;
    std::filesystem::path pipeline_cache;
    int device = -1;
    bool is_quick = false;
    bool is_json = false;
    std::vector<std::string> scenes; ///< empty: all
    std::string only;                ///< substring of case names
    std::vector<int> size;           ///< pixels; empty: the default
    int runs = 5;
    uint64_t tessellated_limit_mebibytes = 4096;
};

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw Error(ErrorKind::failed, {"the file could not be written", file.string(), ""});
}

void report(const std::string& line) { print_error("relief-gpu: {}\n", line); }

RenderSettings make_settings(const Options& options) {
    RenderSettings settings;
    settings.device.engine = EngineKind::vulkan;
    settings.device.index = options.device;
    settings.device.pipeline_cache = options.pipeline_cache.string();
    return settings;
}

int run_parity_verb(const Options& options) {
    ParityOptions parity;
    parity.settings = make_settings(options);
    if (!options.scenes.empty()) parity.scenes = options.scenes;
    parity.only = options.only;
    if (options.size.size() == 2)
        parity.settings.image.width = options.size[0], parity.settings.image.height = options.size[1];
    if (options.is_quick) {
        parity.settings.image.width = 96, parity.settings.image.height = 64;
        parity.noise_samples = 16;
        if (options.scenes.empty()) parity.scenes = {"ear"};
    }
    Value result = {{"build", bench::describe_build()}, {"machine", bench::describe_machine()}};
    result.update(run_parity(parity, report));
    print_output("parity: {} passed, {} failed\n", result["passed"].get<int>(), result["failed"].get<int>());
    if (!options.output.empty()) write_text(options.output, write_json(result, 1));
    return result["failed"] == 0 && result["passed"] > 0 ? 0 : 1;
}

int run_bench_verb(const Options& options) {
    const std::filesystem::path folder = options.output.empty() ? "paper1" : options.output;
    std::filesystem::create_directories(folder);
    bench::Paper1Options paper1;
    paper1.settings = make_settings(options);
    paper1.runs = options.runs;
    paper1.tessellated_limit_bytes = options.tessellated_limit_mebibytes << 20;
    if (!options.scenes.empty()) paper1.scenes = options.scenes;
    if (options.is_quick) {
        paper1 = bench::make_quick_options(paper1);
        if (options.scenes.empty()) paper1.scenes = {"bark"};
    }
    const Value result = bench::run_paper1(paper1, report);
    write_text(folder / "paper1.json", write_json(result, 1));
    write_text(folder / "paper1.csv", write_csv(bench::make_paper1_table(result)));
    for (const Value& goal : result["goals"])
        print_output("{}: {:.4g} {}, goal {:.4g}\n", goal["name"].get<std::string>(),
                     goal["reached"].get<double>(), goal["unit"].get<std::string>(),
                     goal["goal"].get<double>());
    return 0;
}

int run_kernels_verb(const Options& options) {
    Value result = {{"build", bench::describe_build()}};
    result.update(list_kernels(make_settings(options), report));
    if (!options.output.empty())
        write_text(options.output, write_json(result, 1));
    else
        print_output("{}", options.is_json ? write_json(result, 1) : print_kernels(result));
    return result["kernels"].size() > 0 ? 0 : 1;
}

int run_devices_verb() {
    const Value devices = bench::describe_vulkan_devices();
    print_output("{}", write_json(devices, 1));
    return devices.empty() ? int(ErrorKind::device_missing) : 0;
}

void add_options(CLI::App& verb, Options& options, const char* output) {
    verb.add_option("-o", options.output, output);
    verb.add_option("--device", options.device, "index of the device; default: the best one");
    verb.add_option("--pipeline-cache", options.pipeline_cache, "file that keeps compiled kernels");
    verb.add_option("--scenes", options.scenes, "some of the scenes")->delimiter(',');
    verb.add_flag("--quick", options.is_quick, "tiny pictures of one scene: only shows that it works");
}

int run(int argument_count, char** arguments) {
    CLI::App app("Relief on a GPU: checks and measurements", "relief-gpu");
    app.require_subcommand(1);
    Options options;
    CLI::App* parity = app.add_subcommand("parity", "The Vulkan engine against the CPU engine");
    add_options(*parity, options, "JSON file");
    parity->add_option("--only", options.only, "part of the names of the cases to run, e.g. means");
    parity->add_option("--size", options.size, "pixels, WxH; default 1280x720. Means: a quarter of it")
        ->delimiter('x')
        ->expected(2)
        ->check(CLI::Range(1, 16384));
    CLI::App* paper1 = app.add_subcommand("bench", "Table and figures of Harada 2015");
    add_options(*paper1, options, "folder for JSON and CSV; default: paper1");
    paper1->add_option("--runs", options.runs, "that count, after one to warm up")
        ->check(CLI::Range(1, 1000));
    paper1
        ->add_option("--tessellated-limit", options.tessellated_limit_mebibytes,
                     "MiB: pre-tessellated scenes above are left out; default 4096")
        ->check(CLI::Range(0, 1 << 30));
    CLI::App* kernels = app.add_subcommand("kernels", "What the driver tells of all compiled kernels");
    kernels->add_option("-o", options.output, "JSON file; default: a table on the terminal");
    kernels->add_option("--device", options.device, "index of the device; default: the best one");
    kernels->add_flag("--json", options.is_json, "JSON on the terminal");
    CLI::App* devices = app.add_subcommand("devices", "List the Vulkan devices as JSON");
    try {
        app.parse(argument_count, arguments);
    } catch (const CLI::ParseError& error) {
        std::ostringstream help, fault;
        const int exit_code = app.exit(error, help, fault);
        write_output(help.str()), write_error(fault.str());
        return exit_code == 0 ? 0 : int(ErrorKind::usage);
    }
    if (devices->parsed()) return run_devices_verb();
    if (kernels->parsed()) return run_kernels_verb(options);
    return parity->parsed() ? run_parity_verb(options) : run_bench_verb(options);
}

int run_guarded(int argument_count, char** arguments) {
    try {
        return run(argument_count, arguments);
    } catch (const Error& error) {
        print_error("relief-gpu: error: {}\n", error.what());
        return int(error.kind());
    } catch (const std::exception& error) {
        print_error("relief-gpu: error: {}\n", error.what());
        return int(ErrorKind::failed);
    }
}

} // namespace
} // namespace relief::gpu

int main(int argument_count, char** arguments) {
    relief::open_console();
    return relief::close_console(relief::gpu::run_guarded(argument_count, arguments));
}
