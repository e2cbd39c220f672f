#include "io/mesh/child_reader.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/machine.h"
#include "io/file_system.h"
#include "io/mesh/mesh_block.h"
#include "relief/error.h"

extern char** environ; // handed on: it says where the child's shared libraries are

namespace relief {

namespace {

using Clock = std::chrono::steady_clock;

constexpr uint64_t kMostBytes = INT64_MAX; ///< of a limit, as the child reads it
constexpr double kLargeFile = 64 << 20;    ///< bytes, from which on the limit of time grows with the file
const char* const kOtherFormat = "the file is damaged or unusual: export it as glTF, OBJ or PLY";

/// Memory without a name in the file system.
class SharedMemory {
  public:
    SharedMemory() : descriptor_(memfd_create("relief mesh", MFD_CLOEXEC)) {
        if (descriptor_ < 0)
            throw Error(ErrorKind::failed,
                        {fmt::format("no shared memory can be made: {}", std::strerror(errno)), "", ""});
    }
    ~SharedMemory() { close(descriptor_); }
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    int descriptor() const { return descriptor_; }

  private:
    int descriptor_;
};

/// A process that is killed, if it still runs, when this goes out of scope.
class Child {
  public:
    Child(const std::filesystem::path& program, const std::vector<std::string>& words, int shared_memory) {
        std::vector<char*> arguments;
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, shared_memory, kSharedMemory);
        // What a library or the C++ runtime says before it ends the process is not for the user.
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addclosefrom_np(&actions, kSharedMemory + 1);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        sigset_t signals;
        sigfillset(&signals);
        posix_spawnattr_setsigdefault(&attributes, &signals);
        sigemptyset(&signals);
        posix_spawnattr_setsigmask(&attributes, &signals);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
        const int code =
            posix_spawn(&process_, program.c_str(), &actions, &attributes, arguments.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&actions);
        if (code != 0)
            throw Error(ErrorKind::failed,
                        {fmt::format("the reader of meshes cannot be started: {}", std::strerror(code)),
                         program.string(), "name a program that reads meshes in its child process"});
    }
    ~Child() {
        if (is_ended_) return;
        kill(process_, SIGKILL);
        while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// The status of waitpid() once the process has ended; 0 where the program ignores SIGCHLD.
    std::optional<int> find_status() {
        int status = 0;
        const pid_t ended = waitpid(process_, &status, WNOHANG);
        if (ended == 0 || (ended < 0 && errno == EINTR)) return {};
        is_ended_ = true;
        return ended < 0 ? 0 : status;
    }

  private:
    pid_t process_ = 0;
    bool is_ended_ = false;
};

std::string name_reader(const std::filesystem::path& file) {
    std::string kind = get_lower_extension(file).substr(1);
    for (char& c : kind)
        if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    return fmt::format("the {} reader", kind);
}

[[noreturn]] void report_failure(const std::filesystem::path& file, const std::string& what) {
    throw Error(ErrorKind::bad_input,
                {fmt::format("{} {}", name_reader(file), what), file.string(), kOtherFormat});
}

void refuse_cancelled(const std::filesystem::path& file, const MeshReaderSettings& settings) {
    if (settings.is_cancelled && settings.is_cancelled())
        throw Error(ErrorKind::failed, {"reading was cancelled", file.string(), ""});
}

/// Bytes that the reader may hold. Half: the mesh is there twice for a moment, in the child and here.
uint64_t get_memory_limit(const MeshReaderSettings& settings) {
    return std::min(settings.memory_bytes > 0 ? settings.memory_bytes : available_memory_bytes() / 2,
                    kMostBytes);
}

double get_seconds_limit(const std::filesystem::path& file, const MeshReaderSettings& settings) {
    std::error_code ignored;
    const auto bytes = std::filesystem::file_size(file, ignored);
    return settings.seconds * (ignored ? 1 : std::max(1.0, double(bytes) / kLargeFile));
}

/// Waits for the end of the child. Sleeps short at first: most files take milliseconds.
int wait_for(Child& child, const std::filesystem::path& file, const MeshReaderSettings& settings) {
    constexpr Clock::duration kShortest = std::chrono::microseconds(200),
                              kLongest = std::chrono::milliseconds(5);
    const double limit_s = get_seconds_limit(file, settings);
    const Clock::time_point start = Clock::now();
    for (;;) {
        refuse_cancelled(file, settings);
        if (const std::optional<int> status = child.find_status()) return *status;
        const Clock::duration waited = Clock::now() - start;
        if (std::chrono::duration<double>(waited).count() > limit_s)
            report_failure(file, fmt::format("was not done after {:.3g} s", limit_s));
        std::this_thread::sleep_for(std::clamp(waited / 32, kShortest, kLongest));
    }
}

[[noreturn]] void fail_for_memory(const std::filesystem::path& file, uint64_t limit) {
    report_failure(file, fmt::format("needs more than {} MiB of memory", limit >> 20));
}

Mesh take_mesh(const std::filesystem::path& file, int status, MeshBlock block, uint64_t memory_limit) {
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        if (signal == SIGXFSZ) fail_for_memory(file, memory_limit); // the limit of the shared memory
        const char* name = sigdescr_np(signal);
        report_failure(file, fmt::format("ended with signal {} ({})", signal, name ? name : "unknown"));
    }
    switch (block.content) {
    case BlockContent::mesh:
        return std::move(block.mesh);
    case BlockContent::error:
        throw Error(block.error_kind, std::move(block.error));
    case BlockContent::out_of_memory:
        fail_for_memory(file, memory_limit);
    case BlockContent::nothing:
        break;
    }
    report_failure(file, fmt::format("ended without a mesh (exit {})", WEXITSTATUS(status)));
}

std::string list_uv_sets(const MeshReadOptions& options) {
    std::string list = std::to_string(options.uv_set);
    for (const int number : options.further_uv_sets) list += "," + std::to_string(number);
    return list;
}

} // namespace

Mesh read_mesh_in_child(const std::filesystem::path& file, const MeshReadOptions& options,
                        std::vector<std::string>& warnings) {
    const MeshReaderSettings& settings = options.reader;
    const uint64_t memory_limit = get_memory_limit(settings);
    const SharedMemory memory;
    const std::vector<std::string> words = {settings.program.filename().string(),
                                            kReadMeshWord,
                                            file.string(),
                                            list_uv_sets(options),
                                            std::to_string(memory_limit),
                                            std::to_string(std::min(settings.stack_bytes, kMostBytes)),
                                            std::to_string(getpid())};
    Child child(settings.program, words, memory.descriptor());
    const int status = wait_for(child, file, settings);
    refuse_cancelled(file, settings); // an interrupt from the terminal ends the child as well
    MeshBlock block = read_mesh_block(memory.descriptor(), memory_limit);
    std::ranges::move(block.warnings, std::back_inserter(warnings));
    return take_mesh(file, status, std::move(block), memory_limit);
}

} // namespace relief
