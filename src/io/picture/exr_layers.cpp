#include "io/picture/exr_layers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <utility>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/picture/exr_pixels.h"
#include "io/picture/exr_reading.h"
#include "io/picture/exr_stream.h"
#include "io/picture/exr_threads.h"
#include "io/picture/picture_error.h"
#include "io/picture/picture_text.h"
#include "relief/error.h"

namespace relief {

namespace {

using Layer = PicturePart::Layer;

std::string to_lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

const char* get_type_name(Imf::PixelType type) {
    return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint";
}

std::vector<Layer> list_layers(const Imf::ChannelList& channels) {
    std::map<std::string, std::vector<std::string>> names; // by layer
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const std::string name = it.name();
        const size_t dot = name.rfind('.');
        if (dot == std::string::npos)
            names[""].push_back(name);
        else
            names[name.substr(0, dot)].push_back(name.substr(dot + 1));
    }
    std::vector<Layer> layers;
    for (auto& [name, own] : names) {
        size_t known = 0;
        Layer layer{name, order_layer(std::move(own), known), {}};
        for (const std::string& channel : layer.channels) {
            const std::string full = name.empty() ? channel : name + "." + channel;
            layer.types.emplace_back(get_type_name(channels[full].type));
        }
        layers.push_back(std::move(layer));
    }
    return layers;
}

PicturePart make_part(const Imf::Header& header) {
    PicturePart part;
    if (header.hasName()) part.name = header.name();
    set_exr_windows(header, part);
    part.layers = list_layers(header.channels());
    part.is_deep = header.hasType() && Imf::isDeepData(header.type());
    return part;
}

std::vector<PicturePart> list_parts(const Imf::MultiPartInputFile& file) {
    std::vector<PicturePart> parts;
    for (int k = 0; k < file.parts(); ++k) parts.push_back(make_part(file.header(k)));
    return parts;
}

bool has_chroma(const Layer& layer) {
    const auto has = [&](const char* name) {
        return std::ranges::find(layer.channels, name) != layer.channels.end();
    };
    return has("Y") && has("RY") && has("BY");
}

/// Channels that are read of a layer: those that its names say are one colour or vector, or all.
std::vector<std::string> choose_channels(const Layer& layer) {
    size_t known = 0;
    std::vector<std::string> channels = order_layer(layer.channels, known);
    if (known > 0) channels.resize(known);
    return channels;
}

/// A place among the parts, and what is read of it.
struct Chosen {
    size_t part = 0;
    std::string layer;
    std::vector<std::string> channels; ///< without the layer's name
};

std::string get_full_name(const std::string& layer, const std::string& channel) {
    return layer.empty() ? channel : layer + "." + channel;
}

/// The layer of a part that is read where none is named: one of three channels or more, the unnamed one
/// first.
const Layer& find_usual_layer(const PicturePart& part) {
    const auto has_vector = [](const Layer& layer) {
        return has_chroma(layer) || choose_channels(layer).size() >= 3;
    };
    const auto found = std::ranges::find_if(part.layers, has_vector);
    return found == part.layers.end() ? part.layers.front() : *found;
}

class Chooser {
  public:
    Chooser(const std::vector<PicturePart>& parts, const PictureName& choice)
        : parts_(parts), choice_(choice) {}

    Chosen run() const {
        if (choice_.part.empty() && choice_.layer.empty()) return choose_usual();
        if (choice_.part.empty()) {
            if (const auto found = find_anywhere(choice_.layer)) return *found;
            refuse("layer", choice_.layer);
        }
        if (const auto found = find_in_part(choice_.part, choice_.layer)) return *found;
        if (const auto found = find_with_colons()) return *found;
        if (find_part(choice_.part)) refuse("layer", choice_.layer);
        refuse("part", choice_.part);
    }

    /// Lists all layers and channels that `chosen` leaves out, except alpha.
    std::vector<std::string> list_rest(const Chosen& chosen) const {
        std::vector<std::string> rest;
        for (size_t part = 0; part < parts_.size(); ++part)
            for (const Layer& layer : parts_[part].layers) {
                const bool is_chosen = part == chosen.part && layer.name == chosen.layer;
                if (!is_chosen) {
                    rest.push_back(describe(part, layer.name, layer.channels));
                    continue;
                }
                std::vector<std::string> left;
                for (const std::string& channel : layer.channels)
                    if (std::ranges::find(chosen.channels, channel) == chosen.channels.end() &&
                        to_lower(channel) != "a")
                        left.push_back(channel);
                if (!left.empty()) rest.push_back(describe(part, layer.name, left));
            }
        return rest;
    }

    std::string describe(size_t part, const std::string& layer,
                         const std::vector<std::string>& channels) const {
        const std::string names = make_printable(fmt::format("{}", fmt::join(channels, " ")));
        const std::string what = layer.empty() ? fmt::format("channels {}", names)
                                               : fmt::format("layer '{}' ({})", make_printable(layer), names);
        if (parts_.size() == 1) return what;
        return parts_[part].name.empty()
                   ? fmt::format("{} of part {}", what, part)
                   : fmt::format("{} of part '{}'", what, make_printable(parts_[part].name));
    }

    /// A name for the first thing that `chosen` leaves out.
    std::string name_another(const Chosen& chosen) const {
        for (size_t part = 0; part < parts_.size(); ++part)
            for (const Layer& layer : parts_[part].layers) {
                if (part == chosen.part && layer.name == chosen.layer) continue;
                PictureName name{choice_.file, "", layer.name};
                if (layer.name.empty() || part != chosen.part)
                    name.part = parts_[part].name.empty() ? std::to_string(part) : parts_[part].name;
                return make_printable(join_picture_name(name));
            }
        return join_picture_name({choice_.file, "", "CHANNEL"});
    }

  private:
    Chosen take(size_t part, const Layer& layer) const {
        return {part, layer.name, has_chroma(layer) ? layer.channels : choose_channels(layer)};
    }

    std::optional<size_t> find_part(const std::string& name) const {
        for (size_t k = 0; k < parts_.size(); ++k)
            if (parts_[k].name == name) return k;
        for (size_t k = 0; k < parts_.size(); ++k)
            if (std::to_string(k) == name) return k;
        return std::nullopt;
    }

    /// Finds a layer by its name, or a channel by its whole name, which is read alone.
    std::optional<Chosen> find_layer(size_t part, const std::string& name) const {
        for (const Layer& layer : parts_[part].layers)
            if (!layer.name.empty() && layer.name == name) return take(part, layer);
        for (const Layer& layer : parts_[part].layers)
            for (const std::string& channel : layer.channels)
                if (get_full_name(layer.name, channel) == name) return Chosen{part, layer.name, {channel}};
        return std::nullopt;
    }

    std::optional<Chosen> take_usual(size_t part) const {
        if (parts_[part].layers.empty()) return std::nullopt;
        return take(part, find_usual_layer(parts_[part]));
    }

    std::optional<Chosen> find_in_part(const std::string& part_name, const std::string& layer) const {
        const std::optional<size_t> part = find_part(part_name);
        if (!part) return std::nullopt;
        return layer.empty() ? take_usual(*part) : find_layer(*part, layer);
    }

    /// Finds a layer of any part, or a part.
    std::optional<Chosen> find_anywhere(const std::string& name) const {
        for (size_t part = 0; part < parts_.size(); ++part)
            if (const auto found = find_layer(part, name)) return found;
        const std::optional<size_t> part = find_part(name);
        return part ? take_usual(*part) : std::nullopt;
    }

    /// Tries the colons behind the first one, which may belong to a name, as the end of the part.
    std::optional<Chosen> find_with_colons() const {
        const std::string whole = choice_.part + ":" + choice_.layer;
        for (size_t colon = whole.find(':', choice_.part.size() + 1); colon != std::string::npos;
             colon = whole.find(':', colon + 1))
            if (const auto found = find_in_part(whole.substr(0, colon), whole.substr(colon + 1)))
                return found;
        return find_anywhere(whole);
    }

    Chosen choose_usual() const {
        for (size_t part = 0; part < parts_.size(); ++part) {
            if (parts_[part].is_deep || parts_[part].layers.empty()) continue;
            const Layer& layer = find_usual_layer(parts_[part]);
            if (has_chroma(layer) || choose_channels(layer).size() >= 3) return take(part, layer);
        }
        if (parts_.empty() || parts_[0].layers.empty()) fail_damaged(choice_.file, "has no channels");
        return take(0, find_usual_layer(parts_[0]));
    }

    [[noreturn]] void refuse(const char* what, const std::string& name) const {
        std::vector<std::string> all;
        for (size_t part = 0; part < parts_.size(); ++part)
            for (const Layer& layer : parts_[part].layers)
                all.push_back(describe(part, layer.name, layer.channels));
        throw Error(ErrorKind::bad_input, {fmt::format("has no {} '{}'", what, name), choice_.file,
                                           fmt::format("there are: {}", fmt::join(all, ", "))});
    }

    const std::vector<PicturePart>& parts_;
    const PictureName& choice_;
};

bool is_exr(std::istream& stream) {
    std::array<char, 4> head{};
    const bool is_exr = stream.read(head.data(), 4) && head[0] == '\x76' && head[1] == '\x2f' &&
                        head[2] == '\x31' && head[3] == '\x01';
    stream.clear();
    stream.seekg(0);
    return is_exr;
}

template <class Work> auto with_damage(const std::string& name, const Work& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail_damaged(name, fmt::format("cannot be opened: {}", error.what()));
    }
}

void add_remarks(const Chooser& chooser, const Chosen& chosen, const PictureName& choice,
                 PictureRemarks& remarks) {
    if (!choice.part.empty() || !choice.layer.empty()) return;
    const std::vector<std::string> rest = chooser.list_rest(chosen);
    if (rest.empty()) return;
    remarks.warnings.push_back(fmt::format("{}: Relief reads {} and leaves out {}: name another layer as {}, "
                                           "or by the keys \"layer\" and \"part\" "
                                           "of a scene file",
                                           choice.file,
                                           chooser.describe(chosen.part, chosen.layer, chosen.channels),
                                           fmt::join(rest, ", "), chooser.name_another(chosen)));
}

} // namespace

std::vector<std::string> order_layer(std::vector<std::string> channels, size_t& known) {
    static const std::array<std::vector<std::string>, 4> kFamilies = {
        {{"r", "g", "b", "a"}, {"x", "y", "z"}, {"t", "b", "n"}, {"u", "v", "w"}}};
    const auto find = [&](const std::string& wanted) {
        return std::ranges::find_if(channels,
                                    [&](const std::string& name) { return to_lower(name) == wanted; });
    };
    const auto count = [&](const std::vector<std::string>& family) {
        return std::ranges::count_if(family,
                                     [&](const std::string& name) { return find(name) != channels.end(); });
    };
    // Alpha is no sign of colours.
    const auto& family = *std::ranges::max_element(kFamilies, {}, [&](const auto& names) {
        return count({names.begin(), names.begin() + 3});
    });
    std::vector<std::string> ordered;
    for (const std::string& name : family)
        if (const auto found = find(name); found != channels.end()) {
            ordered.push_back(*found);
            channels.erase(found);
        }
    known = ordered.size();
    std::ranges::sort(channels);
    ordered.insert(ordered.end(), channels.begin(), channels.end());
    return ordered;
}

std::vector<PicturePart> list_exr_parts(std::unique_ptr<std::istream> stream, const std::string& name) {
    return with_damage(name, [&] {
        ExrInputStream input(std::move(stream), name);
        std::vector<PicturePart> parts = list_parts(Imf::MultiPartInputFile(input, 0));
        for (PicturePart& part : parts) {
            part.name = make_printable(part.name);
            for (Layer& layer : part.layers) {
                layer.name = make_printable(layer.name);
                for (std::string& channel : layer.channels) channel = make_printable(channel);
            }
        }
        return parts;
    });
}

std::unique_ptr<PixelSource> open_exr_layer(const std::function<std::unique_ptr<std::istream>()>& open,
                                            const PictureName& choice, PictureRemarks& remarks) {
    std::unique_ptr<std::istream> stream = open();
    if (!is_exr(*stream)) return nullptr;
    return with_damage(choice.file, [&]() -> std::unique_ptr<PixelSource> {
        auto file = std::make_unique<ExrParts>(std::move(stream), choice.file);
        const std::vector<PicturePart> parts = list_parts(file->file());
        const Chooser chooser(parts, choice);
        const Chosen chosen = chooser.run();
        const PicturePart& part = parts[chosen.part];
        const auto layer = std::ranges::find(part.layers, chosen.layer, &Layer::name);
        if (part.is_deep)
            throw Error(ErrorKind::bad_input, {"is a deep image", choice.file, "flatten it first"});
        add_remarks(chooser, chosen, choice, remarks);
        const bool is_whole_layer =
            chosen.layer == choice.layer || choice.layer.empty() || chosen.channels.size() > 1;
        if (has_chroma(*layer) && is_whole_layer) {
            if (parts.size() > 1)
                throw Error(ErrorKind::bad_input,
                            {"has luminance and chroma in one of several parts", choice.file,
                             "save it as R, G, B, or as a file of one part"});
            return open_exr_chroma(open(), choice.file, chosen.layer);
        }
        std::vector<std::string> names;
        for (const std::string& channel : chosen.channels)
            names.push_back(get_full_name(chosen.layer, channel));
        return ExrParts::open(std::move(file), int(chosen.part), std::move(names));
    });
}

} // namespace relief
