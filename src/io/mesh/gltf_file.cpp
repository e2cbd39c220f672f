#include "io/mesh/gltf_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "io/mesh/gltf_compression.h"
#include "io/mesh/gltf_uri.h"

namespace relief {

namespace {

static_assert(std::endian::native == std::endian::little, "values of glTF are copied as they are");

const char* const kDamagedFileHint = "the file is damaged or incomplete: export it again";
constexpr int64_t kMostFileBytes = int64_t(1) << 48;

template <class T> T load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// The integer, or its part of the greatest one (glTF 2.0 specification, 3.6.2.2).
template <class T> float load_float(const char* bytes, bool is_normalized) {
    const float value = float(load<T>(bytes));
    if (std::is_floating_point_v<T> || !is_normalized) return value;
    return std::max(value / float(std::numeric_limits<T>::max()), -1.0f);
}

template <class T> uint32_t load_index(const char* bytes) { return load<T>(bytes); }

struct Component {
    size_t bytes;
    float (*load_float)(const char* bytes, bool is_normalized);
    uint32_t (*load_index)(const char* bytes); ///< null: of a type that indices must not have
};

/// By componentType, from 5120 on; glTF knows no 5124.
constexpr int64_t kFirstComponent = 5120, kNoComponent = 5124, kLastComponent = 5126;
constexpr std::array<Component, 7> kComponents = {{{1, load_float<int8_t>, nullptr},
                                                   {1, load_float<uint8_t>, load_index<uint8_t>},
                                                   {2, load_float<int16_t>, nullptr},
                                                   {2, load_float<uint16_t>, load_index<uint16_t>},
                                                   {},
                                                   {4, load_float<uint32_t>, load_index<uint32_t>},
                                                   {4, load_float<float>, nullptr}}};

/// Of an optional key; 0 where it is missing.
size_t read_offset(const JsonNode& node) {
    const auto offset = node.find("byteOffset");
    return size_t(offset ? offset->as_integer(0, kMostFileBytes) : 0);
}

size_t read_count(const JsonNode& node) {
    constexpr int64_t kMostValues = int64_t(std::numeric_limits<uint32_t>::max()) - 1;
    return size_t(node.get("count").as_integer(0, kMostValues));
}

std::string_view get_type_name(size_t width) {
    constexpr std::array<std::string_view, 5> kNames = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return kNames[width];
}

} // namespace

/// Where the values of an accessor lie; all of them are inside of their buffer.
struct GltfFile::Values {
    const char* begin = nullptr;
    size_t count = 0, stride = 0, width = 0;
    const Component* component = nullptr;
    bool is_normalized = false;
};

GltfFile::GltfFile(std::string_view bytes, const std::string& name, ReadBeside read_beside)
    : name_(name), read_beside_(std::move(read_beside)), text_(bytes) {
    if (bytes.starts_with("glTF")) open_glb(bytes);
    document_ = parse_json(text_, name);
    const std::string version = root().get("asset").get("version").as_string();
    if (!version.starts_with("2."))
        throw Error(ErrorKind::bad_input,
                    {fmt::format("is glTF of version {}", version), name, "export it as glTF 2.0"});
    accessors_ = list("accessors"), views_ = list("bufferViews"), buffers_ = list("buffers");
}

/// The chunks of a GLB file: JSON first, then at most one with bytes (specification, 4.4).
void GltfFile::open_glb(std::string_view bytes) {
    constexpr uint32_t kJson = 0x4e4f534a, kBytes = 0x004e4942;
    constexpr size_t kHeaderBytes = 12, kChunkBytes = 8;
    const auto fail = [this](const std::string& message) {
        throw Error(ErrorKind::bad_input, {message, name_, kDamagedFileHint});
    };
    if (bytes.size() < kHeaderBytes + kChunkBytes) fail("the GLB file ends in its header");
    if (const uint32_t version = load<uint32_t>(bytes.data() + 4); version != 2)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("is GLB of version {}", version), name_, "export it as glTF 2.0"});
    const size_t length = load<uint32_t>(bytes.data() + 8);
    if (length > bytes.size())
        fail(fmt::format("the GLB file has {} bytes of the {} that it says", bytes.size(), length));
    text_ = {};
    for (size_t at = kHeaderBytes; at + kChunkBytes <= length;) {
        const size_t size = load<uint32_t>(bytes.data() + at);
        const uint32_t kind = load<uint32_t>(bytes.data() + at + 4);
        if (size > length - at - kChunkBytes) fail(fmt::format("the chunk at byte {} is cut off", at));
        const std::string_view chunk = bytes.substr(at + kChunkBytes, size);
        if (kind == kJson && text_.empty()) text_ = chunk;
        if (kind == kBytes && !has_glb_buffer_) glb_buffer_ = chunk, has_glb_buffer_ = true;
        at += kChunkBytes + size;
    }
    while (text_.ends_with('\0')) text_.remove_suffix(1); // padding that some writers make in place of spaces
    if (text_.empty()) fail("the GLB file has no JSON");
}

std::vector<JsonNode> GltfFile::list(std::string_view key) const {
    const std::optional<JsonNode> node = root().find(key);
    return node ? node->elements() : std::vector<JsonNode>();
}

const JsonNode& GltfFile::resolve(const JsonNode& index, const std::vector<JsonNode>& list,
                                  const char* what) {
    const int64_t place = index.as_integer(0, std::numeric_limits<int32_t>::max());
    if (place >= int64_t(list.size()))
        index.fail(fmt::format("there is no {} {}: the file has {}", what, place, list.size()),
                   kDamagedFileHint);
    return list[size_t(place)];
}

std::string GltfFile::load_buffer(const JsonNode& buffer) const {
    const std::optional<JsonNode> uri = buffer.find("uri");
    if (!uri) buffer.fail("has neither a 'uri' nor bytes in a GLB file", kDamagedFileHint);
    const std::string text = uri->as_string();
    // The text may be megabytes of data, which no message should hold.
    if (is_data_uri(text)) return uri->with_place([&] { return decode_data_uri(text); });
    const std::string path = uri->with_place([&] { return decode_path_uri(text); });
    return uri->with_place([&] { return read_beside_(path); });
}

std::string_view GltfFile::find_buffer(const JsonNode& index) {
    const JsonNode& buffer = resolve(index, buffers_, "buffer");
    const auto size = size_t(buffer.get("byteLength").as_integer(0, kMostFileBytes));
    std::string_view bytes;
    if (&buffer == &buffers_.front() && has_glb_buffer_ && !buffer.find("uri")) {
        bytes = glb_buffer_;
    } else {
        const auto [found, is_new] = loaded_.try_emplace(&buffer);
        if (is_new) found->second = load_buffer(buffer);
        bytes = found->second;
    }
    if (bytes.size() < size)
        buffer.fail(fmt::format("has {} bytes of the {} that it says", bytes.size(), size), kDamagedFileHint);
    return bytes.substr(0, size);
}

/// Returns the bytes of a bufferView or of its compressed form.
std::string_view GltfFile::find_bytes(const JsonNode& place) {
    const std::string_view buffer = find_buffer(place.get("buffer"));
    const size_t offset = read_offset(place);
    const auto size = size_t(place.get("byteLength").as_integer(0, kMostFileBytes));
    if (offset > buffer.size() || size > buffer.size() - offset)
        place.fail(fmt::format("goes to byte {} of a buffer of {} bytes", offset + size, buffer.size()),
                   kDamagedFileHint);
    return buffer.substr(offset, size);
}

/// The compressed form counts where this build can read it: the other one may be a buffer without bytes.
std::string_view GltfFile::find_view(const JsonNode& view) {
    const auto extensions = view.find("extensions");
    for (const std::string_view name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const auto compressed = extensions ? extensions->find(name) : std::nullopt;
        if (!compressed || !can_decompress_gltf(name)) continue;
        const auto [found, is_new] = decompressed_.try_emplace(&view);
        if (is_new) found->second = decode_meshopt(find_bytes(*compressed), *compressed);
        return found->second;
    }
    return find_bytes(view);
}

std::string_view GltfFile::read_view(const JsonNode& view_index) {
    return find_view(resolve(view_index, views_, "bufferView"));
}

std::span<const float> GltfFile::keep(std::vector<float> values) {
    return kept_.emplace_back(std::move(values));
}

bool GltfFile::has_whole_numbers(const JsonNode& accessor_index) const {
    const JsonNode& accessor = resolve(accessor_index, accessors_, "accessor");
    const auto normalized = accessor.find("normalized");
    const bool is_part = normalized && normalized->as_bool();
    return !is_part &&
           accessor.get("componentType").as_integer(kFirstComponent, kLastComponent) != kLastComponent;
}

std::optional<float> GltfFile::find_largest(const JsonNode& accessor_index) const {
    constexpr std::array<float, 4> kLargest = {127, 255, 32767, 65535}; // by componentType, from 5120 on
    const JsonNode& accessor = resolve(accessor_index, accessors_, "accessor");
    const auto normalized = accessor.find("normalized");
    if (!normalized || !normalized->as_bool()) return std::nullopt;
    const int64_t component = accessor.get("componentType").as_integer(kFirstComponent, kLastComponent);
    if (component - kFirstComponent >= int64_t(kLargest.size())) return std::nullopt;
    return kLargest[size_t(component - kFirstComponent)];
}

GltfFile::Values GltfFile::find_values(const JsonNode& accessor, size_t width) {
    if (const std::string type = accessor.get("type").as_string(); type != get_type_name(width))
        accessor.fail(fmt::format("is of type {}, not {}", type, get_type_name(width)), kDamagedFileHint);
    Values values = locate(accessor, accessor.get("componentType"), read_count(accessor), width);
    if (const auto normalized = accessor.find("normalized")) values.is_normalized = normalized->as_bool();
    return values;
}

GltfFile::Values GltfFile::locate(const JsonNode& place, const JsonNode& component_type, size_t count,
                                  size_t width) {
    const std::optional<JsonNode> view_index = place.find("bufferView");
    if (!view_index)
        place.fail("has no 'bufferView'", "export it without compression, such as that of Draco");
    Values values;
    values.width = width, values.count = count;
    const int64_t component = component_type.as_integer(kFirstComponent, kLastComponent);
    if (component == kNoComponent) component_type.fail("is 5124, which glTF does not know", kDamagedFileHint);
    values.component = &kComponents[size_t(component - kFirstComponent)];
    const JsonNode& view = resolve(*view_index, views_, "bufferView");
    const std::string_view bytes = find_view(view);
    const size_t element_bytes = width * values.component->bytes;
    constexpr int64_t kLongestStride = 252; // specification, 5.11.4
    const auto stride = view.find("byteStride");
    values.stride =
        stride ? size_t(stride->as_integer(int64_t(element_bytes), kLongestStride)) : element_bytes;
    const size_t offset = read_offset(place);
    const size_t end = values.count == 0 ? 0 : offset + (values.count - 1) * values.stride + element_bytes;
    if (end > bytes.size())
        place.fail(fmt::format("goes to byte {} of a bufferView of {} bytes", end, bytes.size()),
                   kDamagedFileHint);
    if (values.count > 0) values.begin = bytes.data() + offset;
    return values;
}

std::vector<float> GltfFile::load_floats(const Values& values) {
    std::vector<float> result;
    result.reserve(values.count * values.width);
    for (size_t i = 0; i < values.count; ++i)
        for (size_t k = 0; k < values.width; ++k)
            result.push_back(values.component->load_float(
                values.begin + i * values.stride + k * values.component->bytes, values.is_normalized));
    return result;
}

std::vector<uint32_t> GltfFile::load_indices(const Values& values, const JsonNode& place) {
    if (!values.component->load_index && values.count > 0)
        place.fail("indices must be unsigned integers", kDamagedFileHint);
    std::vector<uint32_t> result;
    result.reserve(values.count);
    for (size_t i = 0; i < values.count; ++i)
        result.push_back(values.component->load_index(values.begin + i * values.stride));
    return result;
}

/// Replaces some of the values (specification, 3.6.2.3).
void GltfFile::apply_sparse(const JsonNode& accessor, const JsonNode& sparse, size_t width,
                            std::vector<float>& floats) {
    const size_t count = read_count(sparse);
    const JsonNode index_place = sparse.get("indices"), value_place = sparse.get("values");
    const std::vector<uint32_t> indices =
        load_indices(locate(index_place, index_place.get("componentType"), count, 1), index_place);
    Values values = locate(value_place, accessor.get("componentType"), count, width);
    if (const auto normalized = accessor.find("normalized")) values.is_normalized = normalized->as_bool();
    const std::vector<float> replacements = load_floats(values);
    for (size_t i = 0; i < count; ++i) {
        if (indices[i] >= floats.size() / width)
            index_place.fail(fmt::format("index {} is {}, out of range: there are {} values", i, indices[i],
                                         floats.size() / width),
                             kDamagedFileHint);
        for (size_t k = 0; k < width; ++k) floats[indices[i] * width + k] = replacements[i * width + k];
    }
}

std::span<const float> GltfFile::read_floats(const JsonNode& accessor_index, size_t width) {
    const JsonNode& accessor = resolve(accessor_index, accessors_, "accessor");
    const auto sparse = accessor.find("sparse");
    const bool is_zero = sparse && !accessor.find("bufferView");
    const Values values = is_zero ? Values{} : find_values(accessor, width);
    const auto [found, is_new] = floats_.try_emplace(&accessor);
    if (!is_new) return found->second;
    if (!is_zero) {
        found->second = load_floats(values);
    } else {
        constexpr size_t kMostZeros = size_t(1) << 26; // no bytes of the file bound them
        if (read_count(accessor) > kMostZeros / width) accessor.fail("has too many values", kDamagedFileHint);
        found->second.assign(read_count(accessor) * width, 0);
    }
    if (sparse) apply_sparse(accessor, *sparse, width, found->second);
    return found->second;
}

std::vector<uint32_t> GltfFile::read_indices(const JsonNode& accessor_index) {
    const JsonNode& accessor = resolve(accessor_index, accessors_, "accessor");
    if (accessor.find("sparse")) accessor.fail("is sparse", "export it without sparse indices of faces");
    return load_indices(find_values(accessor, 1), accessor_index);
}

} // namespace relief
