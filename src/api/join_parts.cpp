#include "api/join_parts.h"

#include <algorithm>
#include <istream>
#include <memory>
#include <utility>
#include <vector>

#include "api/picture_report.h"
#include "relief/error.h"

namespace relief {

namespace {

/// The film of a part, and the number of samples before its own.
std::pair<Film, int> read_part(const FilmPart& part, RenderSettings settings, uint64_t scene_hash,
                               const std::shared_ptr<const InstanceMattes>& mattes, const Film& film) {
    const int before = part.first_sample - settings.image.first_sample;
    settings.image.crop = part.window, settings.image.first_sample = part.first_sample;
    Film read = make_film(settings.image, mattes);
    const Window &inner = read.window(), &outer = film.window();
    if (settings.image.noise > 0 && before > 0)
        throw Error(ErrorKind::bad_input,
                    {"samples that follow others are not joined where noise ends pixels", "",
                     "render parts of the picture with all their samples, or without image.noise"});
    const bool is_inside = inner.x0 >= outer.x0 && inner.y0 >= outer.y0 && inner.x1 <= outer.x1 &&
                           inner.y1 <= outer.y1 && before >= 0;
    if (!is_inside)
        throw Error(ErrorKind::bad_input, {"it is not of the pixels and samples of this picture", "", ""});
    const std::unique_ptr<std::istream> stream = part.open();
    if (!stream || !*stream) throw Error(ErrorKind::bad_input, {"it cannot be read", "", ""});
    read.read(*stream, describe_samples(settings, scene_hash));
    return {std::move(read), before};
}

} // namespace

void resume_film(const Checkpoints& checkpoints, const std::string& identity, Film& film) {
    if (!checkpoints.resume) return;
    try {
        film.read(*checkpoints.resume, identity);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input || checkpoints.resume_name.empty()) throw;
        throw Error(error.kind(), {error.message(), checkpoints.resume_name, error.hint()});
    }
}

void join_parts(const std::vector<FilmPart>& parts, const RenderSettings& settings, uint64_t scene_hash,
                const std::shared_ptr<const InstanceMattes>& mattes, Film& film) {
    std::vector<const FilmPart*> order;
    for (const FilmPart& part : parts) order.push_back(&part);
    std::ranges::stable_sort(order, {}, [](const FilmPart* part) { return part->first_sample; });
    std::vector<Error::Parts> faults;
    for (const FilmPart* part : order) try {
            const auto [read, before] = read_part(*part, settings, scene_hash, mattes, film);
            // Behind a fault a part may lack the samples before it, which is no fault of its own.
            if (faults.empty()) film.join(read, uint32_t(before));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::bad_input) throw;
            faults.push_back({error.message(), part->name, error.hint()});
        }
    if (faults.empty()) return;
    throw Error(ErrorKind::bad_input, faults.front(), {faults.begin() + 1, faults.end()});
}

} // namespace relief
