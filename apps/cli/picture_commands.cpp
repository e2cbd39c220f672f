// compare and merge.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.h"
#include "common/exit_codes.h"
#include "common/report.h"
#include "common/values.h"
#include "inputs.h"
#include "relief/error.h"
#include "relief/image.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

struct CompareOptions {
    std::string a, b, layer;
    double threshold = 0;
    bool is_json = false;
};

struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;
};

int run_compare(const CompareOptions& options) {
    if (options.b.empty())
        throw Error(ErrorKind::usage, {"two pictures are needed", "", "relief compare A.exr B.exr"});
    const ImageDifference d =
        compare_images(read_image(options.a), read_image(options.b), options.layer, options.threshold);
    if (options.is_json) {
        const Value json = {
            {"pixels", d.pixels}, {"one_only", d.one_only}, {"over_threshold", d.over_threshold},
            {"max", d.max},       {"mean", d.mean},         {"rms", d.rms}};
        fmt::print("{}\n", write_json(json));
    } else {
        fmt::print("pixels          {}\nin one only     {}\nover threshold  {}\nmax             {:.6g}\n"
                   "mean            {:.6g}\nrms             {:.6g}\n",
                   d.pixels, d.one_only, d.over_threshold, d.max, d.mean, d.rms);
    }
    return d.over_threshold > 0 ? kExitDifferent : kExitDone;
}

/// Pixels of the window without samples in any part.
size_t count_empty_pixels(const Image& image) {
    const std::optional<size_t> samples = image.find_channel("samples.Y");
    if (!samples) return 0;
    size_t count = 0;
    for (size_t k = *samples; k < image.pixels.size(); k += image.channels.size())
        count += image.pixels[k] == 0 ? 1 : 0;
    return count;
}

int run_merge(const MergeOptions& options) {
    if (options.parts.empty() || options.output.empty())
        throw Error(ErrorKind::usage,
                    {"parts and an output file are needed", "", "relief merge A.exr B.exr -o OUT.exr"});
    keep_files(options.parts, options.output);
    check_writable(options.output);
    std::vector<Image> parts;
    for (const std::string& part : options.parts) parts.push_back(read_image(part));
    const Image merged = merge_images(parts);
    write_image(merged, options.output);
    if (const size_t count = count_empty_pixels(merged); count > 0)
        fmt::print(stderr, "relief: warning: {} of {} pixels have no sample: a part is missing\n", count,
                   size_t(merged.width) * size_t(merged.height));
    fmt::print("wrote {}\n", options.output);
    return kExitDone;
}

} // namespace

Command add_compare(CLI::App& verb) {
    const auto options = std::make_shared<CompareOptions>();
    verb.add_option("a", options->a, "first picture")->type_name("A");
    verb.add_option("b", options->b, "second picture")->type_name("B");
    verb.add_option("--layer", options->layer, "depth, N, ...; default: the colour")->type_name("NAME");
    verb.add_option_function<std::string>(
            "--threshold",
            [options](const std::string& text) {
                options->threshold = parse_number("--threshold", text, 0, 1e30);
            },
            "largest difference that is accepted; default 0")
        ->type_name("F");
    verb.add_flag("--json", options->is_json, "print one JSON object");
    return [options] { return run_compare(*options); };
}

Command add_merge(CLI::App& verb) {
    const auto options = std::make_shared<MergeOptions>();
    verb.add_option("parts", options->parts, "tiles and sample ranges of one picture (.exr)")
        ->type_name("PARTS");
    verb.add_option("-o", options->output, "the joined picture")->type_name("FILE");
    return [options] { return run_merge(*options); };
}

} // namespace relief::cli
