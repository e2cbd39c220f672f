// Numbered files: those of a time, which may lie between two frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// One file, or two and how far a time lies from the first to the second.
struct SequenceFiles {
    std::string first, second; ///< `second` empty: one alone
    int64_t first_number = 0, second_number = 0;
    double weight = 0; ///< of the second, (0, 1)
};

/// A text that stands for both files; the name of one alone.
std::string name_blend(const SequenceFiles& files);

/// Files by names with `####`, relative to a folder. Each folder is listed once after refresh(), and again
/// only where a file is not in the list.
class FileSequences {
  public:
    explicit FileSequences(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Those beside a time. Before the first number and after the last, that one's file; what is missing in
    /// between is named as if it were there.
    SequenceFiles find_beside(const std::string& pattern, double frame);
    /// The file of the whole part, with the same ends.
    SequenceFiles find_whole(const std::string& pattern, double frame);
    void refresh();

  private:
    struct Numbers {
        std::vector<int64_t> sorted;
        bool is_fresh = false;
    };
    int64_t hold(const std::string& pattern, int64_t number);
    std::vector<int64_t> list_numbers(const std::string& pattern) const;

    std::filesystem::path folder_;
    std::map<std::string, Numbers> numbers_;
};

} // namespace relief
