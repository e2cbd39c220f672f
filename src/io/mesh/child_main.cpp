// run_mesh_reader: the child process's side of io/mesh/child_reader.
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "io/mesh/child_reader.h"
#include "io/mesh/mesh_block.h"
#include "relief/error.h"
#include "relief/io.h"

// Sanitizers reserve terabytes of data by themselves.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RELIEF_UNLIMITED_DATA
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define RELIEF_UNLIMITED_DATA
#endif
#endif

namespace relief {

namespace {

constexpr int kNoTask = 1; ///< exit code where no record could be left

std::optional<int64_t> parse_number(std::string_view word) {
    int64_t value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size() || value < 0) return {};
    return value;
}

void set_limit(__rlimit_resource resource, uint64_t bytes) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return;
    limit.rlim_max = std::min(limit.rlim_max, rlim_t(bytes));
    limit.rlim_cur = limit.rlim_max;
    setrlimit(resource, &limit);
}

void set_limits(int64_t memory_bytes, int64_t stack_bytes) {
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_STACK, uint64_t(stack_bytes));
    set_limit(RLIMIT_FSIZE, uint64_t(memory_bytes)); // of the shared memory; nothing else is written
#ifndef RELIEF_UNLIMITED_DATA
    set_limit(RLIMIT_DATA, uint64_t(memory_bytes));
#endif
}

/// kReadMeshWord tells of the form.
std::optional<MeshReadOptions> parse_uv_sets(std::string_view words) {
    MeshReadOptions options;
    for (bool is_first = true;; is_first = false) {
        const size_t end = std::min(words.find(','), words.size());
        const auto number = parse_number(words.substr(0, end));
        if (!number || *number > kMaxUvSet) return {};
        if (is_first)
            options.uv_set = int(*number);
        else
            options.further_uv_sets.push_back(int(*number));
        if (end == words.size()) return options;
        words.remove_prefix(end + 1);
    }
}

/// Leaves the mesh, or why there is none, in the shared memory.
void leave_mesh(const char* file, const MeshReadOptions& options) {
    try {
        std::vector<std::string> warnings;
        const Mesh mesh = load_mesh(file, options, warnings);
        write_mesh_block(kSharedMemory, mesh, warnings);
    } catch (const std::bad_alloc&) {
        write_memory_block(kSharedMemory);
    } catch (const Error& error) {
        write_error_block(kSharedMemory, error);
    } catch (const std::exception& error) {
        write_error_block(kSharedMemory,
                          Error(ErrorKind::bad_input, {std::string("cannot be read: ") + error.what(), file,
                                                       "the file is damaged: export it again"}));
    }
}

} // namespace

std::optional<int> run_mesh_reader(int argument_count, const char* const* arguments) {
    if (argument_count != 7 || std::strcmp(arguments[1], kReadMeshWord) != 0) return {};
    const auto options = parse_uv_sets(arguments[3]);
    const auto memory = parse_number(arguments[4]), stack = parse_number(arguments[5]);
    const auto parent = parse_number(arguments[6]);
    if (!options || !memory || !stack || !parent) return kNoTask;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != *parent) return kNoTask; // it has ended already
    set_limits(*memory, *stack);
    try {
        leave_mesh(arguments[2], *options);
    } catch (const std::exception&) {
        return kNoTask;
    }
    return 0;
}

} // namespace relief
