// The command `relief` of this build or of another, run as a process of its own: its picture, its statistics.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/report.h"
#include "relief/render.h"

namespace relief::bench {

/// One render that ended well.
struct FrameRun {
    Value statistics;       ///< the file of `--stats`; other builds may lack keys
    double processor_s = 0; ///< of the whole process, summed over threads
};

struct FrameTask {
    std::filesystem::path scene, picture; ///< a scene file; the EXR file to write
    std::string isa;                      ///< as --isa has it; of the CPU engine only
    uint32_t seed = 0;
};

class FrameProgram {
  public:
    /// `program`: the command; `folder`: for its statistics and compiled kernels, which no other program may
    /// share, made if missing; `settings`: size, samples, bounces, engine, device and threads. Throws
    /// Error{usage} if the program is not an executable file.
    FrameProgram(std::filesystem::path program, std::filesystem::path folder, const RenderSettings& settings);

    /// Writes a sample scene to a folder. This and `render` throw Error{failed} with the whole command if it
    /// fails or does not write its files.
    std::filesystem::path write_scene(const std::string& name, const std::filesystem::path& folder) const;

    FrameRun render(const FrameTask& task) const;

    const std::filesystem::path& program() const { return program_; }

  private:
    std::vector<std::string> make_command(const FrameTask& task) const;

    std::filesystem::path program_, statistics_;
    std::vector<std::string> engine_words_, picture_words_;
    std::vector<std::string> variables_; ///< of its environment
    bool is_cpu_ = true;
};

} // namespace relief::bench
