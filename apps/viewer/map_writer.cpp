#include "viewer/map_writer.h"

#include <exception>
#include <system_error>
#include <utility>

#include "relief/io.h"

namespace relief::viewer {

MapWriter::~MapWriter() {
    {
        const std::lock_guard lock(mutex_);
        must_end_ = true;
    }
    has_changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

bool MapWriter::are_same(const Displacement& map, const Textures& textures) {
    if (map.tiles.size() != textures.size()) return false;
    for (size_t k = 0; k < textures.size(); ++k)
        if (textures[k].lock() != map.tiles[k].texture) return false;
    return true;
}

void MapWriter::write(const std::filesystem::path& file, const Displacement& map) {
    {
        const std::lock_guard lock(mutex_);
        Textures& written = written_[file];
        if (!map.tiles.empty() && are_same(map, written)) return;
        written.clear();
        for (const MapTile& tile : map.tiles) written.emplace_back(tile.texture);
        waiting_.insert_or_assign(file, map);
    }
    has_changed_.notify_all();
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void MapWriter::forget() {
    const std::lock_guard lock(mutex_);
    written_.clear();
}

bool MapWriter::is_busy() const {
    const std::lock_guard lock(mutex_);
    return is_writing_ || !waiting_.empty();
}

void MapWriter::wait() const {
    std::unique_lock lock(mutex_);
    has_changed_.wait(lock, [&] { return !is_writing_ && waiting_.empty(); });
}

std::vector<std::string> MapWriter::take_errors() {
    const std::lock_guard lock(mutex_);
    return std::exchange(errors_, {});
}

void MapWriter::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        has_changed_.wait(lock, [&] { return must_end_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        const auto next = waiting_.extract(waiting_.begin());
        is_writing_ = true;
        lock.unlock();
        std::string error;
        try {
            std::error_code ignored; // the file says what is wrong
            std::filesystem::create_directories(next.key().parent_path(), ignored);
            write_map(next.mapped(), next.key(), MapSamples::float32);
        } catch (const std::exception& failure) {
            error = failure.what();
        }
        lock.lock();
        is_writing_ = false;
        if (!error.empty()) {
            errors_.push_back(error);
            if (!waiting_.contains(next.key())) written_.erase(next.key()); // the next time may do better
        }
        has_changed_.notify_all();
    }
}

} // namespace relief::viewer
