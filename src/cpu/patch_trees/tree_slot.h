// A place of the table of patch trees: one word, so that it is exchanged at once.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cpu/patch_trees/patch_tree.h"

namespace relief::cpu {

/// The address of a tree, whose low bits are free, with as many bits of the hash of its key: trees of other
/// keys are passed by without a look at them.
class TreeSlot {
  public:
    TreeSlot() = default; ///< empty
    TreeSlot(CachedTree* tree, uint64_t hash) : word_(reinterpret_cast<uintptr_t>(tree) | tag(hash)) {}

    CachedTree* tree() const { return reinterpret_cast<CachedTree*>(word_ & ~kTagMask); }
    /// False: empty, or of a key with another hash.
    bool may_hold(uint64_t hash) const { return word_ > kTagMask && (word_ & kTagMask) == tag(hash); }

  private:
    static constexpr uintptr_t kTagMask = alignof(CachedTree) - 1;
    /// Of the bits that do not choose the place in the table.
    static uintptr_t tag(uint64_t hash) { return uintptr_t(hash >> 58) & kTagMask; }

    uintptr_t word_ = 0;
};

} // namespace relief::cpu
