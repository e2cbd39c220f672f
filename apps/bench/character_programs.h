// The programs that the suite characters compares: the command `relief`, and in each Blender Cycles and,
// where the extension is found, Relief.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/character_inputs.h"
#include "bench/renderers.h"

namespace relief::bench {

struct CharacterTask {
    int width = 240, height = 320;
    int samples = 1, bounces = 4, threads = 1;
    std::filesystem::path picture; ///< EXR without the background; empty: none is kept
};

/// Renders as a program of its own.
class CharacterProgram {
  public:
    enum class Kind { relief, relief_in_blender, cycles };

    CharacterProgram(Kind kind, std::string name, std::vector<std::string> words,
                     std::filesystem::path folder)
        : kind_(kind), name_(std::move(name)), words_(std::move(words)), folder_(std::move(folder)) {}

    Kind kind() const { return kind_; }
    const std::string& name() const { return name_; }

    /// {render_s, from_start_s, resident_peak_bytes} of one render in a process of its own. Throws
    /// Error{failed} with the end of the log where the program fails.
    Measures render(const CharacterInput& input, const CharacterTask& task) const;

    /// {first_s, turned_s, moved_s, changed_s} of pictures one after another in one process; the last is
    /// missing where the object has no map. Throws likewise.
    Measures run_session(const CharacterInput& input, const CharacterTask& task) const;

  private:
    Measures run_blender(const CharacterInput& input, const CharacterTask& task, bool is_session) const;
    Measures run_command(const CharacterInput& input, const CharacterTask& task) const;

    Kind kind_;
    std::string name_;
    std::vector<std::string> words_; ///< the program and the arguments before those of a render
    std::filesystem::path folder_;
};

struct SkippedProgram {
    std::string name, reason;
};

struct CharacterPrograms {
    std::vector<CharacterProgram> programs; ///< the command `relief` first, Cycles of the newest Blender next
    std::vector<SkippedProgram> skipped;
};

/// `blenders`: programs `blender`, or `python3` with the package bpy; none: the one that PATH has. `folder`:
/// for the scripts and other files, made when missing. Throws Error{usage} for a program that is not there.
CharacterPrograms find_character_programs(const std::filesystem::path& relief,
                                          const std::vector<std::filesystem::path>& blenders,
                                          const std::filesystem::path& folder);

} // namespace relief::bench
