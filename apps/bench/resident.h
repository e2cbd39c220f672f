// Resident memory of this process and its peak over a scope.
#pragma once

#include <cstdint>
#include <optional>

namespace relief::bench {

/// Starts at construction, after returning freed memory to the system.
class ResidentMeter {
  public:
    ResidentMeter();
    /// Peak resident bytes above the size at construction; nullopt if unknown.
    std::optional<uint64_t> growth() const;

  private:
    std::optional<uint64_t> start_;
};

} // namespace relief::bench
