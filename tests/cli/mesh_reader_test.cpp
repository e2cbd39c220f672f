// The command reads FBX in a child process: its end is a message, and it ends with the command.
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "command.h"
#include "support/fbx_text.h"

namespace relief::cli {
namespace {

class MeshReader : public CommandTest {
  protected:
    void expect_refusal(const std::vector<std::string>& arguments) {
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 3) << result.errors;
        EXPECT_NE(result.errors.find("loop.fbx: the FBX reader ended with"), std::string::npos)
            << result.errors;
        EXPECT_NE(result.errors.find("export it as glTF, OBJ or PLY"), std::string::npos) << result.errors;
    }
};

TEST_F(MeshReader, a_file_that_breaks_it_is_refused_by_every_command) {
    write("loop.fbx", make_endless_fbx());
    write("scene.json", R"({"meshes": {"p": {"file": "loop.fbx"}}, "objects": [{"mesh": "p"}]})");
    for (const char* input : {"loop.fbx", "scene.json"}) {
        expect_refusal({"render", input, "-o", "a.png", "--size", "8x8"});
        expect_refusal({"inspect", input});
        expect_refusal({"convert", input, "-o", "a.ply"});
    }
    expect_refusal({"inspect", "loop.fbx", "--vdm", "bump.exr"});
    expect_refusal({"inspect", "bump.exr", "--mesh", "loop.fbx"});
    expect_refusal({"convert", "bump.exr", "--mesh", "loop.fbx", "--preset", "blender-brush", "--to-space",
                    "object", "-o", "b.exr"});
    expect_refusal({"convert", "loop.fbx", "--vdm", "bump.exr", "-o", "a.ply"});
}

TEST_F(MeshReader, a_mesh_comes_back_whole) {
    write("grid.fbx", make_grid_fbx(3));
    ASSERT_EQ(run({"convert", "grid.fbx", "-o", "grid.obj"}).exit_code, 0);
    const std::string text = read("grid.obj");
    size_t faces = 0;
    for (size_t at = 0; (at = text.find("\nf ", at)) != std::string::npos; ++at) ++faces;
    EXPECT_EQ(faces, 9u);
    const CommandResult help = run({"--help-all"});
    EXPECT_EQ(help.output.find("read-mesh"), std::string::npos) << "is no option of the user's";
}

/// A child of a process of one thread; 0: none now.
pid_t find_child(pid_t process) {
    const std::string id = std::to_string(process);
    std::ifstream stream("/proc/" + id + "/task/" + id + "/children");
    pid_t child = 0;
    stream >> child;
    return child;
}

/// Whether the reader has begun: it ties its life to its parent's, then it sets its limits.
bool has_begun(pid_t process) {
    std::ifstream stream("/proc/" + std::to_string(process) + "/limits");
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with("Max file size")) return line.find("unlimited") == std::string::npos;
    return false;
}

/// Ended, though nobody may have waited for it yet.
bool is_gone(pid_t process) {
    std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
    std::string id, name, state;
    stream >> id >> name >> state;
    return !stream || state == "Z" || state == "X";
}

TEST_F(MeshReader, an_interrupt_ends_the_command_and_the_reader) {
    using Clock = std::chrono::steady_clock;
    write("grid.fbx", make_grid_fbx(150));
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t process = start({"render", "grid.fbx", "-o", "a.png", "--size", "8x8"});
        pid_t child = 0;
        for (int k = 0; k < 10000 && (child == 0 || !has_begun(child)); ++k) {
            child = find_child(process);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ASSERT_NE(child, 0) << read("stderr.txt");
        kill(child, SIGSTOP); // it will not be done before the command is
        kill(process, signal);
        const Clock::time_point start = Clock::now();
        EXPECT_EQ(finish(process).exit_code, 128 + signal);
        while (!is_gone(child) && Clock::now() - start < std::chrono::seconds(5))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), 0.2);
        EXPECT_TRUE(is_gone(child));
        EXPECT_FALSE(exists("a.png"));
    }
}

} // namespace
} // namespace relief::cli
