// Runs the built command in a folder of its own and keeps what it said.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sys/types.h>

namespace relief::cli {

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

struct CommandResult {
    int exit_code = -1; ///< 128 + signal where a signal ended it
    std::string output, errors;
};

/// A fresh folder a test, with a quad plane `plane.obj` and a map `bump.exr` for it.
class CommandTest : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    /// Runs `relief` with these arguments inside the folder.
    CommandResult run(const std::vector<std::string>& arguments);

    /// Starts it without waiting; `finish` waits and collects. `prepare` runs in the new process before it
    /// becomes the command, and may call only what is safe after fork().
    pid_t start(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
    CommandResult finish(pid_t process);

    /// Renders the bumpy plane, 24x16 pixels and 4 samples unless the arguments say otherwise.
    CommandResult render_bump(const std::string& output, const std::vector<std::string>& more);

    std::string read(const std::string& name) const;
    void write(const std::string& name, const std::string& text) const;
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

    std::filesystem::path folder_;
    std::filesystem::path program_; ///< what runs: the built command
};

} // namespace relief::cli
