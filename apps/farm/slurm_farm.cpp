// farm submit --to slurm: array jobs, and the job behind them that writes the frames.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <sys/wait.h>

#include "common/console.h"
#include "common/exit_codes.h"
#include "common/values.h"
#include "farm/batch.h"
#include "farm/submit.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

constexpr size_t kDefaultArraySize = 1001, kDefaultJobCount = 10000; ///< of slurm.conf
constexpr double kShareOfJobs = 0.8;   ///< of MaxJobCount: others have jobs as well
constexpr double kMemoryMargin = 1.25; ///< frames differ
constexpr double kTimeMargin = 4;      ///< nodes are slower than the machine that planned
constexpr double kLeastMinutes = 10;   ///< files may come slowly
constexpr double kPixelBytes = 256;    ///< of a whole frame, when it is merged

struct Output {
    std::string text;
    int exit_code = 0;
};

/// Of a line of the shell.
Output run_line(const std::string& line) {
    FILE* const pipe = ::popen(line.c_str(), "r");
    if (!pipe) return {"no process can be started", 1};
    Output output;
    std::array<char, 4096> block;
    while (const size_t size = std::fread(block.data(), 1, block.size(), pipe))
        output.text.append(block.data(), size);
    const int status = ::pclose(pipe);
    output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    return output;
}

/// What a program of Slurm prints. Throws Error{failed} where it is missing or fails.
std::string run_slurm(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += quote_word(word) + " ";
    Output output = run_line(line + "2>&1");
    if (output.exit_code == 0) return output.text;
    while (!output.text.empty() && std::isspace(static_cast<unsigned char>(output.text.back())))
        output.text.pop_back();
    const bool is_missing = output.exit_code == 127;
    throw Error(ErrorKind::failed,
                {is_missing ? "there is no such command" : output.text, words.front(),
                 is_missing ? "run this where Slurm is installed, or relief farm submit JOB --to local"
                            : "sinfo tells how the cluster is; --sbatch OPTION adds what it asks for"});
}

/// "Name   = 1001" of the configuration.
size_t find_setting(const std::string& configuration, const std::string& name, size_t otherwise) {
    std::istringstream lines(configuration);
    for (std::string line; std::getline(lines, line);) {
        const size_t equals = line.find('=');
        if (equals == std::string::npos || line.substr(0, line.find(' ')) != name) continue;
        const int value = std::atoi(line.c_str() + equals + 1);
        if (value > 1) return size_t(value);
    }
    return otherwise;
}

/// What one element and the merge ask for.
struct Resources {
    int threads = 1;
    uint64_t memory_mb = 0;
    uint64_t minutes = 0;
};

std::vector<std::string> list_resource_options(const Resources& r) {
    return {fmt::format("--cpus-per-task={}", r.threads), fmt::format("--mem={}M", r.memory_mb),
            fmt::format("--time={}", r.minutes)};
}

Resources estimate_element(const FarmJob& job, size_t tasks, int threads) {
    const JobEstimate& e = job.estimate;
    const double trace_s = e.frame_s * e.threads / threads / double(job.tasks_a_frame());
    const double seconds = double(tasks) * (e.ready_s * e.threads / threads + trace_s);
    return {threads, uint64_t(kMemoryMargin * double(e.memory_bytes)) / 1'000'000 + 1,
            uint64_t(kLeastMinutes + kTimeMargin * seconds / 60)};
}

/// All frames, one after another.
Resources estimate_merge(const FarmJob& job, int threads) {
    const JobEstimate& e = job.estimate;
    const double pixels = double(job.width) * double(job.height);
    const double frame_s = e.ready_s * e.threads / threads + 1e-6 * pixels;
    return {threads,
            uint64_t(kMemoryMargin * (double(e.memory_bytes) + kPixelBytes * pixels)) / 1'000'000 + 1,
            uint64_t(kLeastMinutes + kTimeMargin * frame_s * double(job.frames.size()) / 60)};
}

/// The number of the new job, of "123" or "123;cluster".
std::string submit(std::vector<std::string> words, const SubmitOptions& options,
                   const std::vector<std::string>& behind) {
    words.insert(words.begin(), {"sbatch", "--parsable"});
    words.insert(words.end(), options.sbatch.begin(), options.sbatch.end());
    words.insert(words.end(), behind.begin(), behind.end());
    const std::string output = run_slurm(words);
    std::istringstream lines(output);
    std::string id;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && std::isdigit(static_cast<unsigned char>(line[0])))
            id = line.substr(0, line.find(';'));
    if (id.empty()) throw Error(ErrorKind::failed, {"it names no job: " + output, "sbatch", ""});
    return id;
}

/// Elements [first, first + count) of the batch.
std::string submit_array(const Batch& batch, const Resources& resources, const SubmitOptions& options,
                         size_t first, size_t count) {
    const std::string folder = batch.folder.string();
    std::vector<std::string> words = {"--job-name=relief",
                                      fmt::format("--array=0-{}", count - 1),
                                      "--requeue",
                                      "--open-mode=append",
                                      fmt::format("--output={}/slurm-%A-%a.txt", folder),
                                      "--signal=B:TERM@30"};
    for (std::string& word : list_resource_options(resources)) words.push_back(std::move(word));
    return submit(words, options, {folder + "/slurm.sh", std::to_string(first)});
}

std::string submit_merge(const FarmJob& job, const Batch& batch, const std::vector<std::string>& arrays,
                         const SubmitOptions& options, int threads) {
    // After any end of theirs: after a task that was cancelled, afterok never runs.
    std::vector<std::string> words = {"--job-name=relief-merge",
                                      fmt::format("--dependency=afterany:{}", fmt::join(arrays, ":")),
                                      fmt::format("--output={}/merge.txt", batch.folder.string())};
    for (std::string& word : list_resource_options(estimate_merge(job, threads)))
        words.push_back(std::move(word));
    const std::string command = fmt::format("{} farm merge {} --threads {}", quote_word(get_program()),
                                            quote_word(job.folder.string()), threads);
    words.push_back("--wrap=" + command);
    return submit(words, options, {});
}

} // namespace

int submit_to_slurm(const FarmJob& job, const std::vector<uint32_t>& tasks, const SubmitOptions& options) {
    const std::string configuration = run_slurm({"scontrol", "show", "config"});
    const size_t array_size = find_setting(configuration, "MaxArraySize", kDefaultArraySize);
    const size_t job_count = find_setting(configuration, "MaxJobCount", kDefaultJobCount);
    const int threads = std::max(1, options.threads);
    const size_t most_elements = std::max<size_t>(1, size_t(kShareOfJobs * double(job_count)));
    const Batch batch = write_batch(job, tasks, most_elements, std::max<size_t>(1, options.group), threads);
    write_text_file(batch.folder / "slurm.sh",
                    fmt::format("#!/bin/bash\nexec {} $(($1 + SLURM_ARRAY_TASK_ID))\n",
                                quote_word((batch.folder / "run.sh").string())));
    const Resources resources = estimate_element(job, batch.tasks_an_element, threads);
    std::vector<std::string> arrays;
    for (size_t first = 0; first < batch.element_count; first += array_size - 1) {
        const size_t count = std::min(array_size - 1, batch.element_count - first);
        arrays.push_back(submit_array(batch, resources, options, first, count));
    }
    print_output("submitted {} tasks as {} elements of {} array jobs: {}\n", tasks.size(),
                 batch.element_count, arrays.size(), fmt::join(arrays, ","));
    print_output("each asks for {} MB, {} min and {} processors\n", resources.memory_mb, resources.minutes,
                 threads);
    if (options.merge == MergeStep::with && !arrays.empty())
        print_output("frames are written by job {}, which begins when they have ended\n",
                     submit_merge(job, batch, arrays, options, threads));
    return kExitDone;
}

} // namespace relief::cli
