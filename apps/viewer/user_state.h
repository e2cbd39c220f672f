// What the viewer keeps between two runs: files that were open, and painted maps that were not saved yet.
#pragma once

#include <cstddef>
#include <filesystem>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "viewer/document.h"

namespace relief::viewer {

/// $XDG_STATE_HOME/relief, else ~/.local/state/relief; empty where neither is known.
std::filesystem::path find_state_folder();

class UserState {
  public:
    static constexpr size_t kMostRecent = 12;

    /// Without a folder nothing is kept. The folder is made when something is written.
    explicit UserState(std::filesystem::path folder) : folder_(std::move(folder)) {}
    ~UserState();

    /// The last one first; those that are gone are left out.
    std::vector<std::filesystem::path> read_recent() const;
    void add_recent(const std::filesystem::path& file);

    /// Writes painted maps that are not saved, in a thread, once half a minute; `now` in seconds.
    void keep_painted(double now, Document& document);
    /// The document was saved: nothing is left to be kept.
    void forget_painted(const Document& document);
    /// Maps of a scene or mesh that were painted in a run that ended, or crashed, without saving them.
    std::vector<std::filesystem::path> find_painted(const std::filesystem::path& input) const;

  private:
    std::filesystem::path name_painted(const std::filesystem::path& input, const std::string& map) const;

    std::filesystem::path folder_;
    std::future<void> writing_;
    double last_write_ = 0;
};

} // namespace relief::viewer
