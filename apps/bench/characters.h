// Subdivision surfaces of thousands of faces with displacement maps: the command `relief`, Relief in Blender
// and Cycles, from cold and in a session.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/character_inputs.h"
#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

struct CharactersOptions {
    std::filesystem::path relief; ///< the `relief` command
    std::filesystem::path folder; ///< for scenes and output; not deleted
    int threads = 0;              ///< of every program; 0: all of the machine
    int runs = 3;                 ///< measured runs, >= 1
    int samples = 16;             ///< of the long renders and the compared pictures
    CharacterDetail detail = CharacterDetail::full;
    std::vector<std::pair<int, int>> sizes = {{240, 320}, {1280, 1706}};
    std::vector<std::string> scenes = character_scene_names(); ///< generated ones
    std::vector<CharacterFile> files;
    std::vector<std::filesystem::path> blenders; ///< see find_character_programs()
};

/// Options of a smoke test.
CharactersOptions make_quick_options(CharactersOptions options);

/// Programs that cannot be had are listed in `skipped`. Throws Error{failed} if a program fails later on, and
/// as find_character_programs().
Value run_characters(const CharactersOptions& options, const Report& report);

/// One measure a row.
Table make_characters_table(const Value& result);

/// The goals that one program of Relief reaches beside Cycles: of `ratios`, as {first_sample, render, memory}
/// have summaries, in the case `name`. The crowd has a memory goal of its own.
void add_character_goals(const std::string& name, bool is_crowd, const Value& ratios, Value& goals);

} // namespace relief::bench
