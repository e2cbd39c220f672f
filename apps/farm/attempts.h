// Attempts at tasks, each a file whose name says all of it: TASK.WHO.STATE[.NUMBERS]. A rename takes it from
// one state to the next, so that no two machines ever see half of a change. Only the file of a failed attempt
// has content, the reason; that of a running one holds blanks, which keep room for the reason on a disk that
// fills.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "farm/job.h"

namespace relief::cli {

enum class AttemptState {
    running, ///< its file's time is the last sign of life
    done,
    partial, ///< ended by a signal, with the samples so far kept
    failed,
    lost,    ///< ended without a word
    corrupt, ///< was done, but what it wrote is damaged
    retried  ///< had failed; the task was put up again
};

struct Attempt {
    uint32_t task = 0;
    std::string who; ///< machine, process and time; without dots
    AttemptState state = AttemptState::running;
    int exit_code = 0;         ///< of a failed one, also after it was retried
    uint64_t rays = 0;         ///< of one that is done
    uint64_t milliseconds = 0; ///< from start to end, likewise
};

std::string name_attempt(const Attempt& attempt);
/// nullopt: no attempt is called so.
std::optional<Attempt> parse_attempt_name(std::string_view name);

/// "HOST-PROCESS-TIME" of this process and moment.
std::string make_attempt_name();

/// Whether the process of an attempt is known to have ended: it was on this machine and is there no more.
bool is_process_gone(const Attempt& attempt);

/// Folder of the attempts at a task, and at its neighbours: a thousand tasks share one.
std::filesystem::path get_state_folder(const FarmJob& job, uint32_t task);
std::filesystem::path get_attempt_file(const FarmJob& job, const Attempt& attempt);

/// Makes the file of a running attempt, with room for a reason. Throws Error{failed} where the disk has none;
/// the attempt has failed then, where its file could be made at all.
void begin_attempt(const FarmJob& job, const Attempt& attempt);

/// Writes the reason of an attempt into the room that its file has. A reason that is too long is cut.
void write_reason(const FarmJob& job, const Attempt& attempt, const std::string& reason);

/// Why an attempt failed, the first line of its file. Where it is empty, the disk had no room for it, and the
/// result says that.
std::string read_reason(const FarmJob& job, const Attempt& attempt);

/// All attempts at one task.
std::vector<Attempt> list_attempts(const FarmJob& job, uint32_t task);

/// Renames it; where its file is gone, which another machine may have done, makes a new one. Throws
/// Error{failed}.
void change_attempt(const FarmJob& job, const Attempt& before, const Attempt& after);

/// Notes of another process's attempt that it is dead; keeps the samples that it has written, where the task
/// has none from an earlier one. Nothing happens to one that has ended meanwhile.
void declare_dead(const FarmJob& job, const Attempt& attempt);

/// The last sign of life of a running attempt, seconds ago by the clock of the storage; nullopt: it ended.
std::optional<double> measure_silence(const FarmJob& job, const Attempt& attempt, double now_s);

/// What the clock of the storage says: those of two machines may differ.
double read_storage_clock(const FarmJob& job);

/// Whether so long a silence means that the attempt is dead.
bool is_stale(const FarmJob& job, const Attempt& attempt, double silence_s);

/// Files of a task. The film is that of the whole task, the partial one of some of its samples.
std::filesystem::path get_film_file(const FarmJob& job, uint32_t task);
std::filesystem::path get_partial_film_file(const FarmJob& job, uint32_t task);
/// What a running attempt writes.
std::filesystem::path get_attempt_film_file(const FarmJob& job, const Attempt& attempt);
std::filesystem::path get_preview_file(const FarmJob& job, uint32_t task);
std::filesystem::path get_log_file(const FarmJob& job, uint32_t task);

/// Makes a folder of the job. Throws Error{failed} that tells of rights and space.
void make_job_folder(const std::filesystem::path& folder);

/// Renames a file of the job. Throws Error{failed}.
void rename_job_file(const std::filesystem::path& from, const std::filesystem::path& to);

} // namespace relief::cli
