// What this process has resident, and the most that something of it took.
#pragma once

#include <cstdint>
#include <optional>

namespace relief::bench {

/// Counts from its construction on. Memory that was freed before is given back to the system first.
class ResidentMeter {
  public:
    ResidentMeter();
    /// Most bytes resident since then above what was resident then; nothing where the system does not tell.
    std::optional<uint64_t> growth() const;

  private:
    std::optional<uint64_t> start_;
};

} // namespace relief::bench
