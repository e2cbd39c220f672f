#include "farm/attempts.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include "farm/job_states.h"
#include "job_test.h"
#include "relief/error.h"

namespace relief::cli {
namespace {

namespace fs = std::filesystem;

class FarmStates : public FarmJobTest {};

TEST_F(FarmStates, a_name_says_all_of_an_attempt) {
    Attempt attempt;
    attempt.task = 123, attempt.who = "node7-99-5", attempt.state = AttemptState::done;
    attempt.rays = 456, attempt.milliseconds = 789;
    EXPECT_EQ(name_attempt(attempt), "123.node7-99-5.done.456.789");
    for (const AttemptState state :
         {AttemptState::running, AttemptState::done, AttemptState::partial, AttemptState::failed,
          AttemptState::lost, AttemptState::corrupt, AttemptState::retried}) {
        attempt.state = state, attempt.exit_code = 5;
        const std::optional<Attempt> read = parse_attempt_name(name_attempt(attempt));
        ASSERT_TRUE(read);
        EXPECT_EQ(name_attempt(*read), name_attempt(attempt));
    }
    for (const char* name : {"", "1", "1.a", "1.a.gone", "x.a.done.1.2", "1.a.done.1", "1.a.failed",
                             "1.a.done.1.2.3", "-1.a.running", "clock-vm-1-2"})
        EXPECT_FALSE(parse_attempt_name(name)) << name;
}

TEST_F(FarmStates, the_samples_of_a_dead_attempt_are_kept_unless_there_are_others) {
    Attempt attempt;
    attempt.task = 7, attempt.who = "node-1-2";
    add(7, attempt.who, AttemptState::running);
    const auto write_film = [&](const fs::path& file, const char* content) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << content;
    };
    const auto read_partial = [&] {
        std::ifstream file(get_partial_film_file(job_, 7));
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    write_film(get_attempt_film_file(job_, attempt), "first");
    declare_dead(job_, attempt);
    EXPECT_EQ(read_partial(), "first");
    EXPECT_FALSE(fs::exists(get_attempt_film_file(job_, attempt)));
    ASSERT_EQ(list_attempts(job_, 7).size(), 1u);
    EXPECT_EQ(list_attempts(job_, 7)[0].state, AttemptState::lost);
    attempt.who = "node-3-4";
    add(7, attempt.who, AttemptState::running);
    write_film(get_attempt_film_file(job_, attempt), "second");
    declare_dead(job_, attempt);
    EXPECT_EQ(read_partial(), "first");
    EXPECT_FALSE(fs::exists(get_attempt_film_file(job_, attempt)));
    attempt.who = "node-5-6"; // it has ended meanwhile
    declare_dead(job_, attempt);
    EXPECT_EQ(list_attempts(job_, 7).size(), 2u);
}

TEST_F(FarmStates, tasks_cut_frames_into_bands_and_ranges) {
    EXPECT_EQ(job_.task_count(), 12u);
    EXPECT_EQ(describe_task(job_, find_task(job_, 0)), "frame 1, tile 0/2, samples 0:2");
    EXPECT_EQ(describe_task(job_, find_task(job_, 11)), "frame 3, tile 1/2, samples 2:5");
    EXPECT_THROW(find_task(job_, 12), Error);
    EXPECT_EQ(format_tasks(parse_tasks(job_, "5,0-2,7,6,1")), "0-2,5-7");
    for (const char* list : {"", "12", "3-1", "a", "0-12", "-1", "1,,2"})
        EXPECT_THROW(parse_tasks(job_, list), Error) << list;
    RenderSettings settings;
    settings.image.width = 8, settings.image.height = 9;
    apply_task(find_task(job_, 11), settings);
    EXPECT_EQ(settings.image.crop, (Window{0, 4, 8, 9}));
    EXPECT_EQ(settings.image.first_sample, 2);
    EXPECT_EQ(settings.image.spp, 3);
}

TEST_F(FarmStates, the_best_attempt_counts_and_all_are_told) {
    add(0, "a-1-1", AttemptState::lost), add(0, "a-1-2", AttemptState::done);
    add(1, "a-1-1", AttemptState::done), add(1, "a-1-2", AttemptState::done);
    add(2, "a-1-1", AttemptState::partial);
    add(3, "a-1-1", AttemptState::failed), add(3, "a-1-2", AttemptState::partial);
    add(4, "a-1-1", AttemptState::running);
    add(5, "a-1-1", AttemptState::lost);
    add(6, "a-1-1", AttemptState::corrupt), add(6, "a-1-2", AttemptState::retried);
    const JobStates states = read_states(job_);
    const std::vector<TaskState> expected = {TaskState::done,    TaskState::done,    TaskState::partial,
                                             TaskState::failed,  TaskState::running, TaskState::waiting,
                                             TaskState::waiting, TaskState::waiting, TaskState::waiting,
                                             TaskState::waiting, TaskState::waiting, TaskState::waiting};
    EXPECT_EQ(states.tasks, expected);
    EXPECT_EQ(states.lost, 2u);
    EXPECT_EQ(states.partial, 2u);
    EXPECT_EQ(states.corrupt, 1u);
    EXPECT_EQ(states.retried, 1u);
    EXPECT_EQ(states.twice, 1u);
    EXPECT_EQ(states.done_attempts, 3u);
    EXPECT_EQ(states.rays, 3000u);
    EXPECT_EQ(states.running.size(), 1u);
    EXPECT_EQ(states.failed.size(), 1u);
    EXPECT_EQ(states.files_looked_at, 1u) << "the one that runs";
    EXPECT_EQ(list_tasks(states, {TaskState::failed, TaskState::partial}), (std::vector<uint32_t>{2, 3}));
}

TEST_F(FarmStates, attempts_are_told_in_the_order_of_tasks_and_names) {
    job_.frames.resize(10000); // in ten folders, which are read at once
    std::vector<std::string> expected;
    for (uint32_t task = 500; task < job_.task_count(); task += 4000)
        for (const char* who : {"h-1-1", "c-1-1", "a-1-1", "g-1-1", "e-1-1", "b-1-1", "d-1-1", "f-1-1"}) {
            add(task, who, AttemptState::failed);
            expected.push_back(std::to_string(task + 100000) + who);
        }
    std::ranges::sort(expected);
    std::vector<std::string> told;
    const JobStates states = read_states(job_);
    for (const Attempt& attempt : states.failed)
        told.push_back(std::to_string(attempt.task + 100000) + attempt.who);
    EXPECT_EQ(states.folders_read, 10u);
    EXPECT_EQ(told, expected);
}

TEST_F(FarmStates, silence_makes_an_attempt_stale) {
    job_.heartbeat_s = 0.05;
    add(4, "elsewhere-1-1", AttemptState::running);
    fs::last_write_time(job_.folder / "state/000000/4.elsewhere-1-1.running",
                        fs::file_time_type::clock::now() - std::chrono::seconds(2));
    const JobStates states = read_states(job_);
    EXPECT_EQ(states.tasks[4], TaskState::stale);
    ASSERT_EQ(states.stale.size(), 1u);
    declare_lost(job_, states.stale);
    EXPECT_EQ(read_states(job_).tasks[4], TaskState::waiting);
    EXPECT_EQ(read_states(job_).lost, 1u);
}

TEST_F(FarmStates, a_process_of_this_machine_that_is_gone_is_stale_at_once) {
    const pid_t process = fork();
    if (process == 0) _exit(0);
    waitpid(process, nullptr, 0);
    Attempt attempt;
    attempt.who = make_attempt_name();
    EXPECT_FALSE(is_process_gone(attempt)) << "this one";
    const size_t dash = attempt.who.find('-');
    attempt.who = attempt.who.substr(0, dash) + "-" + std::to_string(process) + "-1";
    EXPECT_TRUE(is_process_gone(attempt));
    attempt.who = "elsewhere-" + std::to_string(process) + "-1";
    EXPECT_FALSE(is_process_gone(attempt)) << "of another machine nothing is known";
}

TEST_F(FarmStates, an_attempt_whose_file_is_gone_still_ends) {
    Attempt before, after;
    before.task = after.task = 7, before.who = after.who = "a-1-1", after.state = AttemptState::partial;
    fs::create_directories(get_state_folder(job_, 7));
    change_attempt(job_, before, after);
    EXPECT_EQ(read_states(job_).tasks[7], TaskState::partial);
}

TEST_F(FarmStates, a_folder_that_cannot_be_read_is_not_an_empty_one) {
    add(0, "a-1-1", AttemptState::done);
    const fs::path folder = get_state_folder(job_, 0);
    EXPECT_EQ(read_states(job_).count(TaskState::done), 1u);
    fs::remove_all(folder);
    EXPECT_TRUE(list_attempts(job_, 0).empty()) << "it is not there";
    EXPECT_EQ(read_states(job_).count(TaskState::done), 0u);
    std::ofstream(folder) << "";
    EXPECT_EQ(read_states(job_).count(TaskState::done), 0u) << "no folder";
    fs::remove(folder);
    fs::create_symlink(folder, folder); // for the superuser, too, whom no rights keep out
    const auto message_of = [](const auto& read) -> std::string {
        try {
            read();
        } catch (const Error& error) {
            return error.kind() == ErrorKind::failed ? error.message() + " in " + error.where() : "";
        }
        return "";
    };
    for (const std::string& message :
         {message_of([&] { list_attempts(job_, 0); }), message_of([&] { read_states(job_); })}) {
        EXPECT_NE(message.find("the folder cannot be read: "), std::string::npos) << message;
        EXPECT_NE(message.find(folder.string()), std::string::npos) << message;
    }
}

#ifdef __GLIBC__
TEST_F(FarmStates, all_is_read_where_no_more_threads_can_be_had) {
    job_.frames.resize(2000), job_.tiles = 1, job_.passes = 1;
    for (const uint32_t task : {0u, 1000u}) add(task, "a-1-1", AttemptState::done);
    pthread_attr_t usual, endless;
    ASSERT_EQ(::pthread_getattr_default_np(&usual), 0);
    ASSERT_EQ(::pthread_getattr_default_np(&endless), 0);
    constexpr size_t kMoreThanAddresses = size_t(1) << 56;
    ASSERT_EQ(::pthread_attr_setstacksize(&endless, kMoreThanAddresses), 0);
    ASSERT_EQ(::pthread_setattr_default_np(&endless), 0);
    EXPECT_THROW(std::thread([] {}).join(), std::system_error);
    EXPECT_EQ(read_states(job_).count(TaskState::done), 2u);
    EXPECT_EQ(::pthread_setattr_default_np(&usual), 0);
    ::pthread_attr_destroy(&usual), ::pthread_attr_destroy(&endless);
}
#endif

/// Links that lead nowhere have names, and nothing that could be opened or looked at.
TEST_F(FarmStates, of_640000_tasks_names_alone_are_read) {
    constexpr uint32_t kStep = 160; // making all of the names would take longer than reading them
    job_.frames.resize(10000), job_.tiles = 64, job_.passes = 1;
    for (int k = 0; k < 10000; ++k) job_.frames[size_t(k)] = k + 1;
    for (uint32_t task = 0; task < job_.task_count(); task += kStep) {
        const fs::path folder = get_state_folder(job_, task);
        if (task % 1000 < kStep) fs::create_directories(folder);
        Attempt attempt;
        attempt.task = task, attempt.who = "a-1-1", attempt.state = AttemptState::done;
        fs::create_symlink("nowhere", folder / name_attempt(attempt));
    }
    const JobStates states = read_states(job_);
    EXPECT_EQ(states.count(TaskState::done), 4000u);
    EXPECT_EQ(states.folders_read, 640u);
    EXPECT_EQ(states.names_read, 4000u);
    EXPECT_EQ(states.files_looked_at, 0u);
}

} // namespace
} // namespace relief::cli
