#include "farm/batch.h"

#include <algorithm>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include "farm/attempts.h"
#include "farm/job_file.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

/// The next free number.
fs::path make_batch_folder(const FarmJob& job) {
    const fs::path folder = job.folder / "submitted";
    make_job_folder(job, folder);
    for (int number = 1;; ++number) {
        std::error_code code;
        const fs::path batch = folder / std::to_string(number);
        if (fs::create_directory(batch, code)) return batch;
        if (code)
            throw Error(ErrorKind::failed, {"the folder cannot be made: " + code.message(), batch.string(),
                                            "check free space and rights of the job folder"});
    }
}

} // namespace

std::string quote_word(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string get_program() {
    std::error_code code;
    const fs::path program = fs::read_symlink("/proc/self/exe", code);
    return code ? std::string("relief") : program.string();
}

Batch write_batch(const FarmJob& job, const std::vector<uint32_t>& tasks, size_t most_elements,
                  size_t least_group, int threads) {
    Batch batch;
    batch.folder = make_batch_folder(job);
    batch.tasks_an_element = std::max(least_group, (tasks.size() + most_elements - 1) / most_elements);
    std::string lines;
    for (size_t first = 0; first < tasks.size(); first += batch.tasks_an_element) {
        const size_t last = std::min(tasks.size(), first + batch.tasks_an_element);
        lines += format_tasks({tasks.begin() + ptrdiff_t(first), tasks.begin() + ptrdiff_t(last)}) + "\n";
        ++batch.element_count;
    }
    write_text_file(batch.folder / "tasks.txt", lines);
    const std::string list = quote_word((batch.folder / "tasks.txt").string());
    write_text_file(batch.folder / "run.sh",
                    fmt::format("#!/bin/bash\n"
                                "# run.sh ELEMENT: renders the tasks of a line of tasks.txt, from 0.\n"
                                "tasks=$(sed -n \"$(($1 + 1))p\" {}) && [ -n \"$tasks\" ] || exit 3\n"
                                "exec {} farm work {} --task \"$tasks\" --threads {} --log\n",
                                list, quote_word(get_program()), quote_word(job.folder.string()), threads));
    std::error_code ignored;
    fs::permissions(batch.folder / "run.sh", fs::perms(0755), ignored);
    return batch;
}

} // namespace relief::cli
