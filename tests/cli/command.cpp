#include "command.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "relief/io.h"

namespace relief::cli {

namespace {

constexpr const char* kPlane = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
constexpr int kMapSize = 16;

/// A bump along the normal (B) that leans to the side (R).
Image make_bump() {
    Image image;
    image.width = image.full_width = image.height = image.full_height = kMapSize;
    image.channels = {"R", "G", "B"};
    for (int y = 0; y < kMapSize; ++y) {
        for (int x = 0; x < kMapSize; ++x) {
            const float dx = float(x) / (kMapSize - 1) - 0.5f, dy = float(y) / (kMapSize - 1) - 0.5f;
            const float bump = std::fmax(0.0f, 1 - 4.1f * (dx * dx + dy * dy));
            image.pixels.insert(image.pixels.end(), {0.2f * bump, 0.0f, 0.6f * bump});
        }
    }
    return image;
}

void redirect(const std::filesystem::path& file, int descriptor) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (opened < 0 || dup2(opened, descriptor) < 0) _exit(127);
    close(opened);
}

} // namespace

void CommandTest::SetUp() {
    std::string pattern = (std::filesystem::temp_directory_path() / "relief-cli-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    program_ = RELIEF_BINARY;
    write("plane.obj", kPlane);
    write_image(make_bump(), folder_ / "bump.exr");
}

void CommandTest::TearDown() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

CommandResult CommandTest::run(const std::vector<std::string>& arguments) { return finish(start(arguments)); }

pid_t CommandTest::start(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
    std::vector<char*> words;
    std::string program = program_.string();
    words.push_back(program.data());
    std::vector<std::string> copies = arguments;
    for (std::string& copy : copies) words.push_back(copy.data());
    words.push_back(nullptr);
    const pid_t process = fork();
    if (process != 0) return process;
    redirect(folder_ / "stdout.txt", STDOUT_FILENO);
    redirect(folder_ / "stderr.txt", STDERR_FILENO);
    if (chdir(folder_.c_str()) != 0) _exit(127);
    if (prepare) prepare();
    execv(program.c_str(), words.data());
    _exit(127);
}

CommandResult CommandTest::finish(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    CommandResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.output = read("stdout.txt");
    result.errors = read("stderr.txt");
    return result;
}

CommandResult CommandTest::render_bump(const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"render",   "plane.obj",     "--vdm", "bump.exr",
                                          "--preset", "blender-brush", "-o",    output};
    const auto add_default = [&](const char* name, const char* value) {
        for (const std::string& word : more) {
            if (word == name) return;
        }
        arguments.insert(arguments.end(), {name, value});
    };
    add_default("--size", "24x16");
    add_default("--spp", "4"), add_default("--bounces", "1");
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
}

std::string CommandTest::read(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

void CommandTest::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
}

} // namespace relief::cli
