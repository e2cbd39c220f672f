// compare and merge.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "aim_options.h"
#include "commands.h"
#include "common/console.h"
#include "common/denoiser_search.h"
#include "common/exit_codes.h"
#include "common/inputs.h"
#include "common/report.h"
#include "common/values.h"
#include "relief/error.h"
#include "relief/image.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "render_frames.h"

namespace relief::cli {

namespace {

struct CompareOptions {
    std::string a, b, layer;
    double threshold = 0;
    bool is_json = false, is_quiet = false;
};

struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;
    bool allows_gaps = false, is_denoised = false, is_quiet = false;
    DisplayArguments display;
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
        print_output("{}\n", write_json(json));
    } else if (!options.is_quiet) {
        print_output("pixels          {}\nin one only     {}\nover threshold  {}\nmax             {:.6g}\n"
                     "mean            {:.6g}\nrms             {:.6g}\n",
                     d.pixels, d.one_only, d.over_threshold, d.max, d.mean, d.rms);
    }
    return d.over_threshold > 0 ? kExitDifferent : kExitDone;
}

/// Of the whole picture: to the last that a part has or that is missing.
int get_sample_count(const std::vector<PictureGap>& gaps, const Image& picture) {
    const std::string& samples = picture.metadata.at("relief:samples"); // "A:B"
    int count = std::atoi(samples.c_str() + samples.find(':') + 1);
    for (const PictureGap& gap : gaps) count = std::max(count, gap.last_sample);
    return count;
}

/// "samples 4:8 of rows 0 to 99", as --samples and --crop take them.
std::string describe_gap(const PictureGap& gap, const Image& picture, int sample_count) {
    const bool is_wide = gap.x0 <= picture.x0 && gap.x1 >= picture.x0 + picture.width;
    const bool is_high = gap.y0 <= picture.y0 && gap.y1 >= picture.y0 + picture.height;
    const bool has_none = gap.first_sample == 0 && gap.last_sample == sample_count;
    const std::string samples = fmt::format("samples {}:{}", gap.first_sample, gap.last_sample);
    if (is_wide && is_high) return samples;
    const std::string window = fmt::format("--crop {},{},{},{}", gap.x0, gap.y0, gap.x1, gap.y1);
    const std::string place = is_wide ? fmt::format("rows {} to {} ({})", gap.y0, gap.y1 - 1, window)
                                      : "window " + window.substr(7);
    return has_none ? place : samples + " of " + place;
}

/// What is missing, for people; a few of many.
std::string describe_gaps(const std::vector<PictureGap>& gaps, const Image& picture) {
    constexpr size_t kMost = 6;
    const int sample_count = get_sample_count(gaps, picture);
    std::string text;
    for (size_t k = 0; k < std::min(gaps.size(), kMost); ++k)
        text += (k > 0 ? "; " : "") + describe_gap(gaps[k], picture, sample_count);
    return gaps.size() > kMost ? fmt::format("{}; and {} more", text, gaps.size() - kMost) : text;
}

/// Only .exr says, by alpha and layer "samples", that a black pixel has no sample.
void refuse_black_pixels(const std::vector<PictureGap>& gaps, const Image& picture,
                         const std::string& output) {
    const int sample_count = get_sample_count(gaps, picture);
    const bool has_empty = std::any_of(gaps.begin(), gaps.end(), [&](const PictureGap& gap) {
        return gap.first_sample == 0 && gap.last_sample == sample_count;
    });
    if (has_empty && get_lower_extension(output) != ".exr")
        throw Error(ErrorKind::usage,
                    {"pixels without a sample would be black in it", output, "-o FILE.exr"});
}

int run_merge(const MergeOptions& options) {
    if (options.parts.empty() || options.output.empty())
        throw Error(ErrorKind::usage,
                    {"parts and an output file are needed", "", "relief merge A.exr B.exr -o OUT.exr"});
    if (is_frame_pattern(options.output))
        throw Error(ErrorKind::usage, {"a joined picture has no number of a frame", options.output,
                                       fmt::format("-o {}", name_frame(options.output, 1).string())});
    keep_files(options.parts, options.output);
    check_display(options.display, options.output);
    check_writable(options.output);
    std::optional<Denoiser> denoiser;
    if (options.is_denoised) denoiser = load_denoiser(0);
    std::vector<Image> parts;
    for (const std::string& part : options.parts) parts.push_back(read_image(part));
    Image merged = merge_images(parts);
    if (const std::vector<PictureGap> gaps = find_gaps(parts); !gaps.empty()) {
        const std::string message = "the picture is not whole, missing: " + describe_gaps(gaps, merged);
        if (!options.allows_gaps)
            throw Error(
                ErrorKind::bad_input,
                {message, options.output, "add the missing parts, or --allow-gaps to join what is there"});
        refuse_black_pixels(gaps, merged, options.output);
        if (!options.is_quiet) print_error("relief: warning: {}\n", message);
    }
    if (denoiser) denoiser->denoise(merged);
    add_display_entries(options.display, merged);
    write_image(merged, options.output);
    print_output("wrote {}\n", options.output);
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
    verb.add_flag("-q", options->is_quiet, "print no table: the exit code tells");
    return [options] { return run_compare(*options); };
}

Command add_merge(CLI::App& verb) {
    const auto options = std::make_shared<MergeOptions>();
    verb.add_option("parts", options->parts, "tiles and sample ranges of one picture (.exr)")
        ->type_name("PARTS");
    verb.add_option("-o", options->output, "the joined picture")->type_name("FILE");
    verb.add_flag("--allow-gaps", options->allows_gaps,
                  "join parts of a picture that lack pixels or samples of it, otherwise refused");
    verb.add_flag("--denoise", options->is_denoised,
                  "by Open Image Denoise 2: parts need the layers guide_albedo, guide_N and direct");
    verb.add_flag("-q", options->is_quiet, "no warnings on stderr");
    add_display_options(verb, options->display);
    return [options] { return run_merge(*options); };
}

} // namespace relief::cli
