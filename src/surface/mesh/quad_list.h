// The patches of a surface by their vertices.
#pragma once

#include <cstddef>
#include <cstdint>

#include "surface/mesh/narrow_indices.h"

namespace relief {

/// A quad, or a triangle when vertex[3] == vertex[2]. Displaced surfaces consist of quads only.
struct Quad {
    std::array<uint32_t, 4> vertex;
    bool is_triangle() const { return vertex[3] == vertex[2]; }
    friend bool operator==(const Quad&, const Quad&) = default;
};

/// Hands out quads by value: they are stored in 8 bytes where the surface has at most 2^16 vertices.
class QuadList {
  public:
    class Iterator {
      public:
        Iterator(const QuadList& list, size_t k) : list_(&list), k_(k) {}
        Quad operator*() const { return (*list_)[k_]; }
        Iterator& operator++() {
            ++k_;
            return *this;
        }
        friend bool operator==(const Iterator&, const Iterator&) = default;

      private:
        const QuadList* list_;
        size_t k_;
    };

    size_t size() const { return vertices_.size(); }
    bool empty() const { return vertices_.empty(); }
    Quad operator[](size_t k) const { return {vertices_[k]}; }
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size()}; }
    void push_back(const Quad& quad) { vertices_.push_back(quad.vertex); }
    /// As NarrowIndices::reset and set.
    void reset(size_t count, uint32_t vertex_count) { vertices_.reset(count, vertex_count); }
    void set(size_t k, const Quad& quad) { vertices_.set(k, quad.vertex); }
    void shrink_to_fit() { vertices_.shrink_to_fit(); }
    static uint64_t byte_count(uint64_t count, uint64_t vertex_count) {
        return NarrowIndices<4>::byte_count(count, vertex_count);
    }
    size_t byte_count() const { return vertices_.byte_count(); }

  private:
    NarrowIndices<4> vertices_;
};

} // namespace relief
