// A list of tasks that was handed to a queue, cut into elements, and the script that runs one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "farm/job.h"

namespace relief::cli {

struct Batch {
    std::filesystem::path folder; ///< of its files, inside of the job
    size_t element_count = 0, tasks_an_element = 1;
};

/// Writes JOB/submitted/N/tasks.txt, a line of tasks for each element, and run.sh, which renders those of
/// one: `run.sh ELEMENT`. So many tasks share an element that there are at most `most_elements`, and at least
/// `least_group`. Throws Error{failed}.
Batch write_batch(const FarmJob& job, const std::vector<uint32_t>& tasks, size_t most_elements,
                  size_t least_group, int threads);

/// In single quotes, as shells take it.
std::string quote_word(const std::string& word);

/// This program, as other machines call it.
std::string get_program();

} // namespace relief::cli
