// Hints for what users type in place of options and commands.
#include <sstream>

#include "command.h"

namespace relief::cli {
namespace {

/// A command line, and the hint: parts separated by "|" of which one must be in it; empty: nothing is
/// suggested.
struct Slip {
    const char *line, *hint;
};

constexpr Slip kOptionSlips[] = {
    // Other programs' names.
    {"render plane.obj --width 800", "--size 800xH"},
    {"render plane.obj --width=800", "--size 800xH"},
    {"render plane.obj --height 600", "--size Wx600"},
    {"render --width 800 plane.obj", "'--size WxH'"},
    {"render plane.obj --resolution 800x600", "--size 800x600"},
    {"render plane.obj --res", "--size WxH"},
    {"render plane.obj --quality 64", "--spp 64"},
    {"render plane.obj --samples-per-pixel 64", "--spp 64"},
    {"render plane.obj --output a.exr", "'-o'"},
    {"render plane.obj --out=a.exr", "'-o'"},
    {"render plane.obj -output a.exr", "'-o'"},
    {"render plane.obj --gpu", "--engine vulkan"},
    {"render plane.obj --cuda", "--engine vulkan"},
    {"render plane.obj --engine gpu", "--engine vulkan"},
    {"render plane.obj --light left", "sun:-60,30"},
    {"render plane.obj --turntable -o a.png", "--turntable 36"},
    {"render bump.exr --vdm plane.obj", "relief render MESH --vdm MAP"},
    {"render plane.obj bump.exr", "--vdm bump.exr"},
    {"farm plan plane.obj --noise 0.1", "fixed number of samples"},
    {"render plane.obj --cpu", "--engine cpu"},
    {"render plane.obj --verbose", "'-v'"},
    {"render plane.obj --quiet", "'-q'"},
    {"render plane.obj --jobs 4", "--threads 4"},
    {"render plane.obj -j 4", "--threads 4"},
    {"render plane.obj --max-depth 3", "--bounces 3"},
    {"render plane.obj --displacement bump.exr", "--vdm MAP"},
    {"render plane.obj --hdri sky.hdr", "--env MAP"},
    {"render plane.obj --scale 2", "--vdm-scale 2"},
    {"render plane.obj --subdiv", "--subdivision catmark"},
    {"render plane.obj --region 0,0,8,8", "--crop x0,y0,x1,y1"},
    {"render plane.obj --light-groups key", "--layers light_default,light_NAME"},
    {"render plane.obj --aov N", "--layers LIST"},
    {"render plane.obj --camera 0,0,5", "--from"},
    {"render plane.obj --look-at 0,0,0", "--from"},
    {"compare a.exr b.exr --tolerance 0.1", "--threshold 0.1"},
    {"convert bump.exr --output b.exr", "'-o'"},
    {"merge a.exr --force", "--allow-gaps"},
    {"scene ear --dir x", "'-o'"},
    {"bench paper1 --quiet", "'-q'"},
    {"render plane.obj --bg white", "--background"},
    {"render plane.obj --transparent", "--background transparent"},
    {"render plane.obj --sun 30,40", "--light sun:AZ,EL"},
    {"render plane.obj --floor", "--ground"},
    {"render plane.obj --ev 1", "--exposure EV"},
    {"render plane.obj --gamma 2.2", "--tonemap"},
    {"render plane.obj --magnify 2", "--zoom 2"},
    {"render plane.obj --closer", "--zoom F"},
    {"render --mesh plane.obj", "stand without an option"},
    {"render plane.obj --engine CUDA", "--engine vulkan"},
    {"render plane.obj --distance 3", "--from x,y,z"},
    {"render plane.obj --frames 24", "--turntable 24"},
    {"render plane.obj --hdri-rotation 90", "--env-rotate"},
    {"render plane.obj --adaptive 0.02", "--noise"},
    {"render plane.obj --oidn", "--denoise"},
    {"render plane.obj --cryptomatte", "CryptoObject"},
    {"render plane.obj --units cm", "--vdm-scale"},
    {"render plane.obj --subsurface 1", "'materials'"},
    // Typing mistakes.
    {"render plane.obj --hlep", "'--help'"},
    {"render plane.obj --hepl", "'--help'"},
    {"render plane.obj --sise 8x8", "'--size'"},
    {"render plane.obj --thread 2", "'--threads'"},
    {"render plane.obj --bounce 2", "'--bounces'"},
    {"render plane.obj --pixel_error 2", "'--pixel-error'"},
    {"render plane.obj --pixelError 2", "'--pixel-error'"},
    {"render plane.obj --SPP 4", "'--spp'"},
    {"render plane.obj --ssp 4", "'--spp'"},
    {"render plane.obj -spp 4", "'--spp'"},
    {"render plane.obj -vdm bump.exr", "'--vdm'"},
    {"render plane.obj --spp64", "--spp 64"},
    {"render plane.obj --dev 0", "'--device'"},
    {"render plane.obj --subdivison catmark", "'--subdivision'"},
    {"render plane.obj -O a.exr", "'-o'"},
    {"compare a.exr b.exr --treshold=1", "'--threshold'"},
    {"inspect plane.obj --jason", "'--json'"},
    {"scene rock --instance", "'--instanced'"},
    {"bench paper1 --szie 8x8", "'--size'"},
    // Nothing is near: an option of one letter least of all.
    {"scene ear -x", ""},
    {"scene ear -v", ""},
    {"scene ear --gpu", ""},
    {"devices -x", ""},
    {"compare a.exr b.exr -n", ""},
    {"render plane.obj --raytracing", ""},
    {"render plane.obj -z", ""},
    {"merge a.exr b.exr --kitchen-sink", ""},
    {"--hlep", "'--help'"},
    {"--verbose", ""},
};

constexpr Slip kCommandSlips[] = {
    {"rendr plane.obj", "'render'"},
    {"redner plane.obj", "'render'"},
    {"Render plane.obj", "'render'"},
    {"rend plane.obj", "'render'"},
    {"show plane.obj", "'render'|"},
    {"trace plane.obj", "'render'"},
    {"info plane.obj", "'inspect'"},
    {"inspct a.exr", "'inspect'"},
    {"check a.exr", "'inspect'"},
    {"diff a.exr b.exr", "'compare'"},
    {"join a.exr", "'merge'"},
    {"stitch a.exr", "'merge'"},
    {"export a.obj", "'convert'"},
    {"benchmark", "'bench'"},
    {"gpus", "'devices'"},
    {"demo ear", "'scene'"},
    {"help", "relief --help"},
    {"version", "relief --version"},
    {"plane.obj", "relief render plane.obj"},
    {"frobnicate", ""},
    {"xy", ""},
};

std::vector<std::string> split_words(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

class Hints : public CommandTest {
  protected:
    void expect_hint(const Slip& slip) {
        const CommandResult result = run(split_words(slip.line));
        EXPECT_EQ(result.exit_code, 2) << slip.line << "\n" << result.errors;
        const size_t at = result.errors.find("hint: ");
        ASSERT_NE(at, std::string::npos) << slip.line << "\n" << result.errors;
        const std::string hint = result.errors.substr(at + 6), wanted = slip.hint;
        if (wanted.empty()) {
            EXPECT_EQ(hint.find("did you mean"), std::string::npos) << slip.line << ": " << hint;
            return;
        }
        std::istringstream parts(wanted);
        bool is_there = false;
        for (std::string part; std::getline(parts, part, '|');)
            is_there |= hint.find(part) != std::string::npos;
        EXPECT_TRUE(is_there) << slip.line << ": " << hint;
    }
};

TEST_F(Hints, name_the_option_that_was_probably_meant_or_none) {
    for (const Slip& slip : kOptionSlips) expect_hint(slip);
}

TEST_F(Hints, name_the_command_that_was_probably_meant_or_none) {
    for (const Slip& slip : kCommandSlips) expect_hint(slip);
}

TEST_F(Hints, a_number_is_no_range_of_samples) {
    const CommandResult result = run({"render", "plane.obj", "--samples", "64"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("--spp 64"), std::string::npos) << result.errors;
}

TEST_F(Hints, values_glued_to_options_of_one_letter_are_values) {
    EXPECT_EQ(run({"render", "plane.obj", "--size", "4x4", "--spp", "1", "-oa.exr", "-q"}).exit_code, 0);
    EXPECT_TRUE(exists("a.exr"));
}

} // namespace
} // namespace relief::cli
