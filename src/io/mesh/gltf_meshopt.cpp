// EXT_meshopt_compression, by meshoptimizer.
#include <fmt/format.h>

#include "io/foreign_files.h"
#include "io/mesh/gltf_compression.h"
#include "io/mesh/gltf_primitive.h"

#ifdef RELIEF_MESHOPT
#include <meshoptimizer.h>
#endif

namespace relief {

#ifdef RELIEF_MESHOPT

namespace {

/// An empty or unaligned buffer would not do for the decoders.
class Decoder {
  public:
    Decoder(std::string_view bytes, const JsonNode& extension) : bytes_(bytes), extension_(extension) {
        constexpr int64_t kMostCount = UINT32_MAX, kMostStride = 256;
        count_ = size_t(extension.get("count").as_integer(0, kMostCount));
        stride_ = size_t(extension.get("byteStride").as_integer(1, kMostStride));
        // A group of 256 values that are all the same takes 4 bytes per byte of a value: less is no data.
        constexpr size_t kMostRatio = 64, kLeast = 1 << 16;
        if (count_ * stride_ > kMostRatio * bytes.size() + kLeast)
            extension.fail(fmt::format("{} bytes cannot hold {} values", bytes.size(), count_), kDamagedHint);
        words_.resize((count_ * stride_ + 3) / 4 + 1);
    }

    std::string decode() {
        const std::string mode = extension_.get("mode").as_string();
        if (mode == "ATTRIBUTES" && stride_ % 4 == 0)
            check(meshopt_decodeVertexBuffer(words_.data(), count_, stride_, data(), bytes_.size()));
        else if (mode == "TRIANGLES" && count_ % 3 == 0 && (stride_ == 2 || stride_ == 4))
            check(meshopt_decodeIndexBuffer(words_.data(), count_, stride_, data(), bytes_.size()));
        else if (mode == "INDICES" && (stride_ == 2 || stride_ == 4))
            check(meshopt_decodeIndexSequence(words_.data(), count_, stride_, data(), bytes_.size()));
        else
            extension_.fail(fmt::format("has mode {} with {} values of {} bytes", mode, count_, stride_),
                            kDamagedHint);
        const auto filter = extension_.find("filter");
        if (filter && mode == "ATTRIBUTES") apply(filter->as_string());
        return std::string(reinterpret_cast<const char*>(words_.data()), count_ * stride_);
    }

  private:
    const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(bytes_.data()); }

    void check(int code) const {
        if (code != 0) extension_.fail("cannot be decompressed", kDamagedHint);
    }

    void apply(const std::string& filter) {
        if (filter == "NONE") return;
        const bool is_octahedral = filter == "OCTAHEDRAL" && (stride_ == 4 || stride_ == 8);
        const bool is_rotation = filter == "QUATERNION" && stride_ == 8;
        // The filters work on groups of four values.
        words_.resize((((count_ + 3) & ~size_t(3)) * stride_ + 3) / 4 + 1);
        if (is_octahedral)
            meshopt_decodeFilterOct(words_.data(), count_, stride_);
        else if (is_rotation)
            meshopt_decodeFilterQuat(words_.data(), count_, stride_);
        else if (filter == "EXPONENTIAL" && stride_ % 4 == 0)
            meshopt_decodeFilterExp(words_.data(), count_, stride_);
        else
            extension_.fail(fmt::format("has filter {} for values of {} bytes", filter, stride_),
                            kDamagedHint);
    }

    std::string_view bytes_;
    const JsonNode& extension_;
    size_t count_ = 0, stride_ = 0;
    std::vector<uint32_t> words_;
};

} // namespace

std::string decode_meshopt(std::string_view bytes, const JsonNode& extension) {
    return Decoder(bytes, extension).decode();
}

#else

std::string decode_meshopt(std::string_view, const JsonNode& extension) {
    const std::optional<ForeignFile> foreign = find_foreign_gltf("EXT_meshopt_compression");
    extension.fail(foreign->message, foreign->hint);
}

#endif

} // namespace relief
