// Memory of the device: copies, formats, accounts and what is refused.
#include <array>
#include <bit>
#include <numeric>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/half.h"
#include "vulkan/device/commands.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/test_shaders.h"

namespace relief::vulkan::tests {
namespace {

class Buffers : public GpuTest {};

std::vector<uint32_t> make_numbers(size_t count) {
    std::vector<uint32_t> values(count);
    std::iota(values.begin(), values.end(), 1000u);
    return values;
}

TEST_F(Buffers, give_back_what_was_uploaded) {
    const std::vector<uint32_t> values = make_numbers(3000);
    Buffer buffer(device(), {.name = "values", .bytes = 12000});
    buffer.upload(values);
    EXPECT_EQ(buffer.download<uint32_t>(3000), values);
    buffer.upload(std::vector<uint32_t>{1, 2}, 40);
    EXPECT_EQ(buffer.download<uint32_t>(4, 36), (std::vector<uint32_t>{1009, 1, 2, 1012}));
    EXPECT_EQ(buffer.byte_count(), 12000u);
}

TEST_F(Buffers, are_copied_through_staging_memory_in_parts) {
    const Device staged({.index = get_test_device_index(), .is_validated = true, .is_staged = true});
    const std::vector<uint32_t> values = make_numbers(10'000'000);
    Buffer buffer(staged, {.name = "values", .bytes = values.size() * 4});
    buffer.upload(values);
    EXPECT_TRUE(buffer.download<uint32_t>(values.size()) == values);
    EXPECT_GT(staged.allocated_bytes(Purpose::staging), 0u);
    EXPECT_LT(staged.allocated_bytes(Purpose::staging), values.size() * 4) << "not in parts";
    EXPECT_TRUE(staged.validation_messages().empty());
}

TEST_F(Buffers, of_no_bytes_exist) {
    Buffer buffer(device(), {.name = "nothing"});
    EXPECT_TRUE(bool(buffer));
    EXPECT_EQ(buffer.byte_count(), 0u);
    buffer.upload(std::vector<uint32_t>{});
    EXPECT_TRUE(buffer.download<uint32_t>(0).empty());
    EXPECT_FALSE(bool(Buffer()));
}

TEST_F(Buffers, that_the_host_sees_are_mapped) {
    const Buffer buffer(device(), {.name = "counter", .bytes = 16, .is_host_visible = true});
    BindingTable bindings(device());
    vulkan::Commands commands(device(), bindings);
    commands.fill(buffer, 4, 8, 42);
    commands.run();
    EXPECT_EQ(static_cast<const uint32_t*>(buffer.mapped())[2], 42u);
}

TEST_F(Buffers, are_counted_by_purpose) {
    const uint64_t before = device().allocated_bytes(Purpose::geometry);
    {
        const Buffer one(device(), {.name = "one", .bytes = 100'000, .purpose = Purpose::geometry});
        const Buffer two(device(), {.name = "two", .bytes = 2'000'000, .purpose = Purpose::geometry});
        EXPECT_GE(device().allocated_bytes(Purpose::geometry), before + 2'100'000);
        EXPECT_LE(device().allocated_bytes(Purpose::geometry), before + 2'110'000);
    }
    EXPECT_EQ(device().allocated_bytes(Purpose::geometry), before);
    EXPECT_GE(device().peak_bytes(Purpose::geometry), before + 2'100'000);
}

TEST_F(Buffers, give_their_memory_back) {
    // Other processes may use the device: what is available is theirs too.
    const uint64_t before = device().held_bytes(), all = device().description().memory_bytes;
    for (int round = 0; round < 3; ++round) {
        std::vector<Buffer> buffers;
        // More than one block, of which other tests may keep one.
        for (uint64_t i = 0; i < 40; ++i)
            buffers.emplace_back(device(), BufferConfig{.name = "part", .bytes = 1 + i * i * 5000});
        for (size_t i = 0; i < buffers.size(); i += 2) buffers[i] = Buffer();
        for (uint64_t i = 0; i < 40; ++i)
            buffers.emplace_back(device(), BufferConfig{.name = "part", .bytes = 50'000});
        EXPECT_GT(device().held_bytes(), before);
        EXPECT_LE(device().available_bytes(), all - device().held_bytes());
    }
    EXPECT_EQ(device().held_bytes(), before);
}

/// What does not fit into the device's memory is held against the small heap of the fault layer: nobody else
/// takes or gives back parts of that.
TEST_F(Buffers, larger_than_any_are_refused_with_their_size) {
    const uint64_t bytes = device().max_buffer_bytes() + 16;
    try {
        const Buffer buffer(device(), {.name = "huge", .bytes = bytes});
        FAIL() << "made a buffer of " << bytes << " bytes";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        EXPECT_NE(error.message().find("huge"), std::string::npos) << error.what();
        EXPECT_NE(error.message().find(std::to_string(bytes)), std::string::npos) << error.what();
    }
}

template <class T>
Buffer make_texels(const Device& device, TexelFormat format, const std::vector<T>& values) {
    Buffer buffer(device, {.name = "texels", .bytes = values.size() * sizeof(T), .format = format});
    buffer.upload(values);
    return buffer;
}

using Texel = std::array<uint32_t, 4>;

/// Missing channels are 0, and 1 for alpha.
template <class T> Texel pad(const T* values, size_t count, uint32_t one) {
    Texel result = {0, 0, 0, one};
    for (size_t i = 0; i < count; ++i) result[i] = std::bit_cast<uint32_t>(values[i]);
    return result;
}

TEST_F(Buffers, are_read_as_texels_of_every_format) {
    constexpr uint32_t kCount = 100;
    const std::vector<uint32_t> words = make_numbers(kCount * 4);
    const std::vector<float> floats(words.begin(), words.end());
    std::vector<uint16_t> halves(kCount * 4);
    std::iota(halves.begin(), halves.end(), uint16_t(0x3c00));
    std::vector<float> from_halves;
    for (const uint16_t half : halves) from_halves.push_back(half_to_float(half));
    const std::vector<Buffer> texels = [&] {
        std::vector<Buffer> all;
        all.push_back(make_texels(device(), TexelFormat::rgba32_uint, words));
        all.push_back(make_texels(device(), TexelFormat::r32_float, floats));
        all.push_back(make_texels(device(), TexelFormat::rg32_float, floats));
        all.push_back(make_texels(device(), TexelFormat::rg32_uint, words));
        all.push_back(make_texels(device(), TexelFormat::r32_uint, words));
        all.push_back(make_texels(device(), TexelFormat::rgba32_float, floats));
        all.push_back(make_texels(device(), TexelFormat::rgba16_float, halves));
        return all;
    }();
    const uint32_t places[] = {scalar::kBindNodes,     scalar::kBindPositions, scalar::kBindUvs,
                               scalar::kBindFrames,    scalar::kBindDominants, scalar::kBindFloatTexels,
                               scalar::kBindHalfTexels};
    BindingTable bindings(device());
    for (size_t i = 0; i < texels.size(); ++i) bindings.bind(places[i], texels[i]);
    const Buffer results(device(), {.name = "results", .bytes = kCount * 7 * sizeof(Texel)});
    bindings.bind(scalar::kBindFilm, results);
    const Kernel kernel = make_test_kernel(device(), "read_texels");
    vulkan::Commands commands(device(), bindings);
    commands.dispatch(kernel, kCount, kCount);
    commands.run();
    const std::vector<Texel> read = results.download<Texel>(kCount * 7);
    const uint32_t one = std::bit_cast<uint32_t>(1.0f);
    for (uint32_t i = 0; i < kCount; ++i) {
        ASSERT_EQ(read[i * 7], pad(&words[i * 4], 4, 1));
        ASSERT_EQ(read[i * 7 + 1], pad(&floats[i], 1, one));
        ASSERT_EQ(read[i * 7 + 2], pad(&floats[i * 2], 2, one));
        ASSERT_EQ(read[i * 7 + 3], pad(&words[i * 2], 2, 1));
        ASSERT_EQ(read[i * 7 + 4], pad(&words[i], 1, 1));
        ASSERT_EQ(read[i * 7 + 5], pad(&floats[i * 4], 4, one));
        ASSERT_EQ(read[i * 7 + 6], pad(&from_halves[i * 4], 4, one));
    }
}

TEST_F(Buffers, of_another_format_than_the_binding_are_refused) {
    const Buffer buffer(device(), {.name = "words", .bytes = 16, .format = TexelFormat::r32_uint});
    BindingTable bindings(device());
    EXPECT_THROW(bindings.bind(scalar::kBindNodes, buffer), Error);
    EXPECT_THROW(bindings.bind(scalar::kFirstTexelBinding + scalar::kTexelBindingCount, buffer), Error);
}

} // namespace
} // namespace relief::vulkan::tests
