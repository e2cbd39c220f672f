#include "io/picture/exr_source.h"

#include <algorithm>
#include <array>
#include <exception>
#include <initializer_list>
#include <limits>
#include <new>
#include <optional>
#include <set>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include "io/picture/exr_names.h"
#include "io/picture/exr_pixels.h"
#include "io/picture/exr_reading.h"
#include "io/picture/exr_stream.h"
#include "io/picture/exr_threads.h"
#include "io/picture/picture_error.h"

namespace relief {

namespace {

/// Whether the first eight bytes are those of an EXR file of one part and flat pixels.
bool is_flat_exr(std::istream& stream) {
    constexpr unsigned kDeepOrManyParts = 0x18;
    std::array<char, 8> head{};
    const bool is_exr = stream.read(head.data(), 8) && head[0] == '\x76' && head[1] == '\x2f' &&
                        head[2] == '\x31' && head[3] == '\x01';
    stream.clear();
    stream.seekg(0);
    return is_exr && (unsigned(head[5]) & kDeepOrManyParts) == 0;
}

/// Names in the order of PixelHeader::channels; nothing where another reader must decide.
std::optional<std::vector<std::string>> order_channels(const Imf::ChannelList& channels) {
    std::map<std::string, std::set<std::string>> layers; // with its dot, and what follows
    const Imf::PixelType type =
        channels.begin() == channels.end() ? Imf::HALF : channels.begin().channel().type;
    if (type != Imf::HALF && type != Imf::FLOAT) return std::nullopt;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.type != type || channel.xSampling != 1 || channel.ySampling != 1) return std::nullopt;
        const std::string name = it.name();
        const size_t suffix = name.rfind('.') + 1; // 0 without a dot
        layers[name.substr(0, suffix)].insert(name.substr(suffix));
    }
    std::vector<std::string> names;
    for (const auto& entry : layers) {
        const std::set<std::string>& suffixes = entry.second;
        const auto take = [&](std::initializer_list<std::string> known) {
            size_t taken = 0;
            for (const std::string& suffix : known)
                if (suffixes.contains(suffix)) names.push_back(entry.first + suffix), ++taken;
            return taken;
        };
        const size_t capitals = take({"R", "G", "B", "A", "X", "Y", "Z"});
        const size_t small = take({"r", "g", "b", "a"}); // of Cryptomatte
        const bool is_mixed = (suffixes.contains("X") || suffixes.contains("Y") || suffixes.contains("Z")) &&
                              (suffixes.contains("R") || suffixes.contains("A"));
        size_t count = capitals + small;
        if (count == 0 && suffixes.size() == 1) names.push_back(entry.first + *suffixes.begin()), ++count;
        if (count != suffixes.size() || is_mixed || (capitals > 0 && small > 0)) return std::nullopt;
    }
    return names;
}

PixelHeader make_header(const Imf::Header& exr, std::vector<std::string> channels) {
    PixelHeader header;
    set_exr_windows(exr, header);
    const bool is_half = !channels.empty() && exr.channels()[channels.front()].type == Imf::HALF;
    header.type = is_half ? SampleType::float16 : SampleType::float32;
    header.pixel_bytes = channels.size() * (is_half ? 2 : 4);
    header.channels = std::move(channels);
    for (auto it = exr.begin(); it != exr.end(); ++it)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
            if (const std::string name = get_metadata_name(it.name()); !name.empty())
                header.metadata[name] = text->value();
    return header;
}

class ExrSource final : public ExrPixelSource<Imf::InputFile> {
  public:
    ExrSource(std::unique_ptr<std::istream> stream, const std::string& name)
        : name_(name), stream_(std::move(stream), name), file_(stream_, prepare_exr_threads()) {
        if (auto channels = order_channels(file_.header().channels())) {
            header_ = make_header(file_.header(), std::move(*channels));
            is_plain_ = true;
        }
    }

    bool is_plain() const { return is_plain_; }

  private:
    Imf::InputFile& file() override { return file_; }
    const std::string& name() const override { return name_; }

    std::string name_;
    ExrInputStream stream_;
    Imf::InputFile file_;
    bool is_plain_ = false;
};

} // namespace

std::unique_ptr<PixelSource> open_plain_exr(std::unique_ptr<std::istream> stream, const std::string& name) {
    if (!is_flat_exr(*stream)) return nullptr;
    try {
        auto source = std::make_unique<ExrSource>(std::move(stream), name);
        if (source->is_plain()) return source;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail_damaged(name, fmt::format("cannot be opened: {}", error.what()));
    }
    return nullptr;
}

} // namespace relief
