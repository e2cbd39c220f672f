// Writes maps in one thread: of those that wait under one name the newest is written alone.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "relief/scene.h"

namespace relief::viewer {

class MapWriter {
  public:
    MapWriter() = default;
    /// Writes what waits.
    ~MapWriter();
    MapWriter(const MapWriter&) = delete;
    MapWriter& operator=(const MapWriter&) = delete;

    /// Takes the place of a map that waits under this name, which may hold `<UDIM>`; makes the folder. Of the
    /// textures that were written there last nothing is written.
    void write(const std::filesystem::path& file, const Displacement& map);
    /// Files of earlier writes may be gone: the next ones are made in any case.
    void forget();
    bool is_busy() const;
    void wait() const;
    /// Why files could not be written, since the last call.
    std::vector<std::string> take_errors();

  private:
    using Textures = std::vector<std::weak_ptr<const Texture>>;

    static bool are_same(const Displacement& map, const Textures& textures);
    void run();

    mutable std::mutex mutex_;
    mutable std::condition_variable has_changed_;
    std::map<std::filesystem::path, Displacement> waiting_;
    std::map<std::filesystem::path, Textures> written_; ///< or about to be
    std::vector<std::string> errors_;
    bool is_writing_ = false, must_end_ = false;
    std::thread thread_; ///< begins with the first write
};

} // namespace relief::viewer
