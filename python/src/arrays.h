// NumPy arrays from and to vectors of plain structs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

namespace relief::python {

/// Contiguous arrays in the memory of the processor; read-only ones as well.
template <class T>
using Array1 = nanobind::ndarray<const T, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
template <class T>
using Array2 = nanobind::ndarray<const T, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;
template <class T>
using Array3 = nanobind::ndarray<const T, nanobind::ndim<3>, nanobind::c_contig, nanobind::device::cpu>;

/// An array over memory that `owner` keeps.
template <class T>
nanobind::object view_memory(const void* data, std::initializer_list<size_t> shape, nanobind::handle owner) {
    return nanobind::cast(
        nanobind::ndarray<nanobind::numpy, T>(const_cast<void*>(data), shape.size(), shape.begin(), owner));
}

/// An array that takes over the memory of a vector, whose elements are T or structs of them.
template <class T, class Element>
nanobind::object make_array(std::vector<Element>&& values, std::initializer_list<size_t> shape) {
    auto kept = std::make_unique<std::vector<Element>>(std::move(values));
    void* const data = kept->data();
    const nanobind::capsule owner(kept.release(),
                                  [](void* p) noexcept { delete static_cast<std::vector<Element>*>(p); });
    return view_memory<T>(data, shape, owner);
}

/// A vector of structs of N numbers each, of an array of (count, N) or (count) of them.
template <class Element, class Array> std::vector<Element> copy_array(const Array& array) {
    const size_t bytes = array.size() * sizeof(typename Array::Scalar);
    std::vector<Element> values(bytes / sizeof(Element));
    if (bytes > 0) std::memcpy(static_cast<void*>(values.data()), array.data(), bytes);
    return values;
}

} // namespace relief::python
