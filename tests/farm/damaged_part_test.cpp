#include "farm/damaged_part.h"

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "farm/attempts.h"
#include "job_test.h"
#include "relief/error.h"

namespace relief::cli {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kTask = 7;

class FarmDamagedPart : public FarmJobTest {
  protected:
    void SetUp() override {
        FarmJobTest::SetUp();
        film_ = get_film_file(job_, kTask);
        fs::create_directories(film_.parent_path());
    }
    void add(const std::string& who, AttemptState state) const { FarmJobTest::add(kTask, who, state); }
    /// As an attempt that ends does.
    void put_film(const std::string& content) const {
        const fs::path own = film_.string() + ".own";
        std::ofstream(own) << content;
        fs::rename(own, film_);
    }
    std::string read_film() const {
        std::ifstream file(film_);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::map<std::string, AttemptState> read_states() const {
        std::map<std::string, AttemptState> states;
        for (const Attempt& attempt : list_attempts(job_, kTask)) states[attempt.who] = attempt.state;
        return states;
    }

    fs::path film_;
};

TEST_F(FarmDamagedPart, it_is_put_aside_and_what_still_runs_goes_on) {
    put_film("bad"), add("a-1-1", AttemptState::done), add("b-1-1", AttemptState::running);
    EXPECT_TRUE(declare_corrupt(job_, kTask, identify_file(film_)));
    EXPECT_FALSE(fs::exists(film_));
    EXPECT_TRUE(fs::exists(film_.string() + ".corrupt"));
    EXPECT_EQ(read_states(), (std::map<std::string, AttemptState>{{"a-1-1", AttemptState::corrupt},
                                                                  {"b-1-1", AttemptState::running}}));
}

TEST_F(FarmDamagedPart, a_good_one_that_took_its_place_stays) {
    put_film("bad"), add("a-1-1", AttemptState::done);
    const std::optional<FileIdentity> read = identify_file(film_);
    put_film("good"), add("b-1-1", AttemptState::done);
    EXPECT_FALSE(declare_corrupt(job_, kTask, read));
    EXPECT_EQ(read_film(), "good");
    EXPECT_FALSE(fs::exists(film_.string() + ".corrupt"));
    EXPECT_EQ(read_states()["b-1-1"], AttemptState::done);
    EXPECT_TRUE(set_aside(film_, *identify_file(film_)));
}

TEST_F(FarmDamagedPart, a_missing_one_counts_unless_it_has_come_since) {
    add("a-1-1", AttemptState::done);
    const std::optional<FileIdentity> read = identify_file(film_);
    EXPECT_FALSE(read);
    put_film("good");
    EXPECT_FALSE(declare_corrupt(job_, kTask, read));
    EXPECT_EQ(read_states()["a-1-1"], AttemptState::done);
    EXPECT_EQ(read_film(), "good");
    fs::remove(film_);
    EXPECT_TRUE(declare_corrupt(job_, kTask, read));
    EXPECT_EQ(read_states()["a-1-1"], AttemptState::corrupt);
}

TEST_F(FarmDamagedPart, one_that_cannot_be_opened_is_not_damaged) {
    EXPECT_NO_THROW(check_openable(film_)) << "it is not there";
    put_film("bad");
    EXPECT_NO_THROW(check_openable(film_));
    fs::remove(film_);
    fs::create_symlink(film_, film_); // for the superuser, too, whom no rights keep out
    EXPECT_THROW(check_openable(film_), Error);
}

} // namespace
} // namespace relief::cli
