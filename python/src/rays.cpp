// Batches of rays: an array of (N, 8) floats is the library's span of rays, and the hits are arrays over its
// own.
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "base/parallel.h"
#include "exit_gate.h"
#include "parts.h"
#include "relief/intersect.h"
#include "scenes.h"
#include "settings.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

static_assert(sizeof(Ray) == 8 * sizeof(float) && sizeof(HitAttributes) == 11 * sizeof(float));

constexpr size_t kRayGrain = 1 << 14; ///< rays

/// The lowest index for which `is_bad` holds.
template <class IsBad> std::optional<size_t> find_first(size_t count, const IsBad& is_bad) {
    std::atomic<size_t> first{count};
    parallel_for("find_bad_rays", count, kRayGrain, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            if (!is_bad(k)) continue;
            for (size_t known = first; k < known && !first.compare_exchange_weak(known, k);) {
            }
            return;
        }
    });
    return first < count ? std::optional<size_t>(first) : std::nullopt;
}

std::span<const Ray> get_rays(const Array2<float>& rays) {
    return {reinterpret_cast<const Ray*>(rays.data()), rays.shape(0)};
}

bool has_nan(const float* numbers, size_t count) {
    bool is_nan = false;
    for (size_t k = 0; k < count; ++k) is_nan |= std::isnan(numbers[k]);
    return is_nan;
}

[[noreturn]] void refuse_nan(const char* name, size_t row) {
    throw nb::value_error(fmt::format("{}: NaN in row {}", name, row).c_str());
}

/// `name` is that of the argument.
void check_rays(const Array2<float>& rays, const char* name) {
    std::optional<size_t> bad;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        bad = find_first(rays.shape(0), [&](size_t k) { return has_nan(rays.data() + 8 * k, 8); });
    }
    if (bad) refuse_nan(name, *bad);
}

/// Ends are of one ray each, or of all.
nb::object pack_rays(const Array2<float>& origins, const Array2<float>& directions,
                     const Array1<float>& t_min, const Array1<float>& t_max) {
    const size_t count = origins.shape(0);
    std::vector<Ray> rays(count);
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        const float *from = origins.data(), *along = directions.data(), *low = t_min.data(),
                    *high = t_max.data();
        const size_t low_step = t_min.shape(0) == 1 ? 0 : 1, high_step = t_max.shape(0) == 1 ? 0 : 1;
        parallel_for("pack_rays", count, kRayGrain, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k)
                rays[k] = {{from[3 * k], from[3 * k + 1], from[3 * k + 2]},
                           low[low_step * k],
                           {along[3 * k], along[3 * k + 1], along[3 * k + 2]},
                           high[high_step * k]};
        });
    }
    return make_array<float>(std::move(rays), {count, 8});
}

class RayCaster {
  public:
    /// The scene is used up.
    RayCaster(ParsedScene& parsed, const nb::dict& keywords) {
        const IntersectorSettings settings = read_ray_settings(keywords);
        const GateVisit visit;
        const nb::gil_scoped_release release;
        intersector_ = std::make_unique<Intersector>(std::move(parsed.scene), settings);
    }

    /// Bytes of RayHit, 32 a ray; and of HitAttributes as (N, 11) floats, or None.
    nb::object find_closest(const Array2<float>& rays, uint32_t mask, uint32_t wanted) const {
        std::vector<RayHit> hits(rays.shape(0));
        std::vector<HitAttributes> attributes(wanted ? rays.shape(0) : 0);
        {
            const GateVisit visit;
            const nb::gil_scoped_release release;
            intersector_->closest_hits(get_rays(rays), hits, {mask, wanted}, attributes);
        }
        nb::object more = nb::none();
        if (wanted) more = make_array<float>(std::move(attributes), {rays.shape(0), 11});
        return nb::make_tuple(make_array<uint8_t>(std::move(hits), {rays.shape(0), sizeof(RayHit)}), more);
    }

    nb::object find_any(const Array2<float>& rays, uint32_t mask) const {
        std::vector<uint8_t> hits(rays.shape(0));
        {
            const GateVisit visit;
            const nb::gil_scoped_release release;
            intersector_->any_hits(get_rays(rays), hits, mask);
        }
        return make_array<uint8_t>(std::move(hits), {rays.shape(0)});
    }

    std::vector<std::string> list_warnings() const { return intersector_->warnings(); }

  private:
    std::unique_ptr<Intersector> intersector_;
};

} // namespace

void add_rays(nb::module_& module) {
    nb::class_<RayCaster>(module, "Intersector", "A scene prepared for rays.")
        .def(nb::init<ParsedScene&, const nb::dict&>(), nb::arg("scene"), nb::arg("keywords"))
        .def("closest_hits", &RayCaster::find_closest, nb::arg("rays").noconvert(), nb::arg("mask"),
             nb::arg("attributes"))
        .def("any_hits", &RayCaster::find_any, nb::arg("rays").noconvert(), nb::arg("mask"))
        .def_prop_ro("warnings", &RayCaster::list_warnings);
    module.def("pack_rays", &pack_rays, nb::arg("origins"), nb::arg("directions"), nb::arg("t_min"),
               nb::arg("t_max"));
    module.def("check_rays", &check_rays, nb::arg("rays"), nb::arg("name"));
}

} // namespace relief::python
