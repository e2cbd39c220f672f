// What the viewer keeps between two runs: files that were open, and painted maps that were not saved yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "viewer/document.h"
#include "viewer/map_writer.h"

namespace relief::viewer {

/// $XDG_STATE_HOME/relief, else ~/.local/state/relief; empty where neither is known.
std::filesystem::path find_state_folder();

class UserState {
  public:
    static constexpr size_t kMostRecent = 12;

    /// Without a folder nothing is kept. The folder is made when something is written.
    explicit UserState(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The last one first; those that are gone are left out.
    std::vector<std::filesystem::path> read_recent() const;
    void add_recent(const std::filesystem::path& file);

    /// Writes painted maps that are not saved and changed since, in a thread, half a minute after painting
    /// began and then once half a minute; `now` in seconds.
    void keep_painted(double now, Document& document);
    /// The same at once, and waits until they are written: the document is about to go.
    void keep_now(Document& document);
    /// Writes a painted map that another frame has not, in a thread, if it was painted on since it was set
    /// aside last; returns its name, of which `<UDIM>` may be a part, or nothing where nothing is kept. It
    /// stays when the document is saved, until it comes back.
    std::filesystem::path set_aside(const std::filesystem::path& input, const Displacement& map, int frame);
    /// The map is shown again, and what was painted on it is kept and forgotten with the document.
    void take_back(const std::filesystem::path& input, const Displacement& map, int frame);
    /// The document was saved: what this run kept of it goes. Files of earlier runs stay.
    void forget_painted();
    /// What is not saved may go: what this run kept of the document goes, of other frames as well.
    void discard();
    /// Why painted maps could not be written, since the last call.
    std::vector<std::string> take_errors() { return writer_.take_errors(); }
    /// Maps of a scene or mesh that were painted and not saved before it was closed, or a run crashed. Gives
    /// them names that nothing else is written to, `kept-...`.
    std::vector<std::filesystem::path> claim_painted(const std::filesystem::path& input);

  private:
    std::filesystem::path name_painted(const std::filesystem::path& input, const std::string& map) const;
    std::filesystem::path name_aside(const std::filesystem::path& input, const Displacement& map,
                                     int frame) const;

    void write_painted(Document& document);

    std::filesystem::path folder_;
    MapWriter writer_;
    std::set<std::filesystem::path> kept_;  ///< files of this run, of the document that is open
    std::set<std::filesystem::path> aside_; ///< those that were set aside, of them or not
    double last_write_ = 0;
    uint64_t last_count_ = 0; ///< Document::paint_count() then
};

} // namespace relief::viewer
