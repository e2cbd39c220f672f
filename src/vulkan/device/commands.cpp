#include "vulkan/device/commands.h"

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/check.h"
#include "vulkan/device/errors.h"
#include "vulkan/device/kernel_internals.h"
#include "vulkan/layout/bindings.h"

namespace relief::vulkan {
namespace {

/// Maximum stage changes per submission; one more submits the recorded commands.
constexpr uint32_t kMarkCount = 256;

constexpr DrawSize kScreen = {scalar::kScreenColumns * scalar::kFragmentSquare,
                              scalar::kScreenRows* scalar::kFragmentSquare};
static_assert(kFragmentGroup == scalar::kFragmentSquare * scalar::kFragmentSquare);

/// Rows [first, first + count) of `width` groups each, of a launch.
struct Rows {
    uint32_t width, first, count;
};

constexpr double kPartSeconds = 0.05; ///< a part of a launch is doubled while it takes less than half of this

vk::PipelineStageFlags2 find_pipeline_stages(vk::ShaderStageFlags shaders) {
    using Stage = vk::PipelineStageFlagBits2;
    if (!(shaders & vk::ShaderStageFlagBits::eFragment)) return Stage::eComputeShader;
    return Stage::eComputeShader | Stage::eVertexShader | Stage::eFragmentShader;
}

} // namespace

void record_barrier(const vk::raii::CommandBuffer& commands, vk::ShaderStageFlags shaders) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const vk::PipelineStageFlags2 work = find_pipeline_stages(shaders) | Stage::eAllTransfer;
    const vk::MemoryBarrier2 barrier(work, Access::eShaderWrite | Access::eTransferWrite,
                                     work | Stage::eDrawIndirect,
                                     Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                         Access::eTransferWrite | Access::eIndirectCommandRead);
    commands.pipelineBarrier2(vk::DependencyInfo({}, barrier));
}

void record_host_barrier(const vk::raii::CommandBuffer& commands, vk::ShaderStageFlags shaders) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const vk::MemoryBarrier2 barrier(find_pipeline_stages(shaders) | Stage::eAllTransfer,
                                     Access::eShaderWrite | Access::eTransferWrite, Stage::eHost,
                                     Access::eHostRead);
    commands.pipelineBarrier2(vk::DependencyInfo({}, barrier));
}

struct Commands::Implementation {
    Device::Implementation& device;
    const BindingTable::Implementation& bindings;
    vk::raii::CommandPool pool = nullptr;
    vk::raii::CommandBuffer buffer = nullptr;
    vk::raii::QueryPool queries = nullptr; ///< on non-CPU devices with timestamps
    std::optional<Stage> stage = {};
    std::vector<std::optional<Stage>> marks = {}; ///< stage after each timestamp of this submission
    std::set<std::string> kernel_names = {};      ///< of this submission
    bool is_recording = false;
    std::array<double, kStageCount> seconds{};
    uint64_t dispatch_count = 0;

    /// `command` writes to the buffer; dropped on a device that compiles only.
    template <class Command> void record(const char* what, const Command& command) {
        if (!device.compiles_only()) check_vulkan(what, command);
    }
    void start();
    void mark(std::optional<Stage> next);
    void prepare();
    void bind_kernel(const Kernel& kernel, std::span<const std::byte> push);
    void begin_drawing(DrawSize size);
    bool is_parted() const { return device.shared->description.is_cpu && device.is_stop_asked_for; }
    void launch(const Kernel& kernel, uint64_t groups, std::span<const std::byte> push);
    void launch_parts(const Kernel& kernel, Rows rows, std::span<const std::byte> push);
    void record_rows(const Kernel& kernel, const Rows& rows, std::span<const std::byte> push);
    [[noreturn]] void refuse_size(const Kernel& kernel, uint64_t groups) const;
    void read_marks();
    void run();
    std::string describe() const;
};

void Commands::Implementation::start() {
    pool.reset();
    if (*queries) queries.reset(0, kMarkCount);
    marks.clear();
    kernel_names.clear();
    buffer.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    const auto bind = [&](vk::PipelineBindPoint point) {
        buffer.bindDescriptorSets(point, *device.shared->pipeline_layout, 0, *bindings.set, {});
    };
    bind(vk::PipelineBindPoint::eCompute);
    if (device.shared->shader_stages & vk::ShaderStageFlagBits::eFragment)
        bind(vk::PipelineBindPoint::eGraphics);
    is_recording = true;
}

void Commands::Implementation::mark(std::optional<Stage> next) {
    buffer.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *queries, uint32_t(marks.size()));
    marks.push_back(next);
}

/// Before every command: begins the command buffer, marks a change of stage, records the memory barrier.
void Commands::Implementation::prepare() {
    // The last mark is reserved for the end of the submission.
    if (is_recording && marks.size() + 1 == kMarkCount && marks.back() != stage) run();
    if (!is_recording) start();
    record_barrier(buffer, device.shared->shader_stages);
    if (*queries && (marks.empty() || marks.back() != stage)) mark(stage);
}

void Commands::Implementation::bind_kernel(const Kernel& kernel, std::span<const std::byte> push) {
    DCHECK(push.size() <= scalar::kMaxPushBytes && push.size() % 4 == 0);
    const Kernel::Implementation& used = kernel.internals();
    buffer.bindPipeline(used.is_drawn ? vk::PipelineBindPoint::eGraphics : vk::PipelineBindPoint::eCompute,
                        **used.pipeline);
    (*buffer).pushConstants(*device.shared->pipeline_layout, device.shared->shader_stages, 0,
                            uint32_t(push.size()), push.data(), *buffer.getDispatcher());
    kernel_names.insert(used.name);
    ++dispatch_count;
}

void Commands::Implementation::begin_drawing(DrawSize size) {
    const vk::Rect2D area({}, {size.width, size.height});
    buffer.beginRendering(vk::RenderingInfo({}, area, 1));
    buffer.setViewport(0, vk::Viewport(0, 0, float(size.width), float(size.height), 0, 1));
    buffer.setScissor(0, area);
}

void Commands::Implementation::refuse_size(const Kernel& kernel, uint64_t groups) const {
    throw Error(ErrorKind::failed, {fmt::format("{} cannot run {} groups of {} invocations at once",
                                                kernel.internals().name, groups, kernel.group_size()),
                                    "Vulkan", kUseCpu});
}

void Commands::Implementation::record_rows(const Kernel& kernel, const Rows& rows,
                                           std::span<const std::byte> push) {
    prepare();
    bind_kernel(kernel, push);
    if (kernel.is_drawn()) {
        begin_drawing(kScreen);
        buffer.draw(rows.width * rows.count, 1, rows.width * rows.first, 0);
        buffer.endRendering();
    } else if (rows.first == 0) {
        buffer.dispatch(rows.width, rows.count, 1);
    } else {
        buffer.dispatchBase(0, rows.first, 0, rows.width, rows.count, 1);
    }
}

/// Groups in rows: the widest, or in parts rows that are short enough for one part each.
void Commands::Implementation::launch(const Kernel& kernel, uint64_t groups,
                                      std::span<const std::byte> push) {
    const bool is_drawn = kernel.is_drawn();
    const bool has_parts = is_parted() && groups > kPartGroups;
    const uint64_t most_rows = device.shared->limits.maxComputeWorkGroupCount[1];
    const uint64_t widest = is_drawn ? groups : device.shared->limits.maxComputeWorkGroupCount[0];
    const uint64_t columns =
        has_parts ? std::max<uint64_t>(kPartGroups, (groups + most_rows - 1) / most_rows) : widest;
    const uint64_t rows = (groups + columns - 1) / columns;
    if (is_drawn ? groups > uint64_t(scalar::kScreenColumns) * scalar::kScreenRows
                 : rows > most_rows || columns > widest)
        refuse_size(kernel, groups);
    if (has_parts) return launch_parts(kernel, {uint32_t(columns), 0, uint32_t(rows)}, push);
    record_rows(kernel, {uint32_t((groups + rows - 1) / rows), 0, uint32_t(rows)}, push);
}

/// Also asks for a stop between the parts: run() does.
void Commands::Implementation::launch_parts(const Kernel& kernel, Rows rows,
                                            std::span<const std::byte> push) {
    run();
    for (Rows part{rows.width, 0, 1}; part.first < rows.count;) {
        part.count = std::min(part.count, rows.count - part.first);
        const auto begin = std::chrono::steady_clock::now();
        record_rows(kernel, part, push);
        run();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        part.first += part.count;
        if (taken.count() < kPartSeconds / 2) part.count *= 2;
        if (taken.count() > kPartSeconds) part.count = std::max(1u, part.count / 2);
    }
}

void Commands::Implementation::read_marks() {
    const auto [result, ticks] = queries.getResults<uint64_t>(
        0, uint32_t(marks.size()), marks.size() * sizeof(uint64_t), sizeof(uint64_t),
        vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    static_cast<void>(result);
    for (size_t i = 0; i + 1 < marks.size(); ++i)
        if (marks[i])
            seconds[size_t(*marks[i])] += double((ticks[i + 1] - ticks[i]) & device.shared->timestamp_mask) *
                                          device.shared->timestamp_period_s;
}

std::string Commands::Implementation::describe() const {
    return kernel_names.empty() ? "copies" : fmt::format("running {}", fmt::join(kernel_names, ", "));
}

void Commands::Implementation::run() {
    if (!is_recording) return;
    is_recording = false;
    device.heed_stop();
    check_vulkan("running kernels", [&] {
        if (*queries) mark(std::nullopt);
        record_host_barrier(buffer, device.shared->shader_stages);
        buffer.end();
        const auto begin = std::chrono::steady_clock::now();
        device.submit_and_wait(buffer, [this] { return describe(); });
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        if (*queries)
            read_marks();
        else if (stage)
            seconds[size_t(*stage)] += taken.count();
    });
}

Commands::Commands(const Device& device, const BindingTable& bindings)
    : implementation_(new Implementation{device.internals(), bindings.internals()}) {
    Implementation& own = *implementation_;
    own.record("making a command buffer", [&] {
        const vk::raii::Device& handle = own.device.shared->device;
        own.pool = vk::raii::CommandPool(
            handle, {vk::CommandPoolCreateFlagBits::eTransient, own.device.shared->family});
        own.device.set_name(own.pool, "relief commands");
        own.buffer = std::move(
            vk::raii::CommandBuffers(handle, {*own.pool, vk::CommandBufferLevel::ePrimary, 1}).front());
        own.device.set_name(own.buffer, "relief commands");
        if (device.is_cpu() || own.device.shared->timestamp_period_s == 0.0f) return;
        own.queries = vk::raii::QueryPool(handle, {{}, vk::QueryType::eTimestamp, kMarkCount});
        own.device.set_name(own.queries, "relief stages");
    });
}
Commands::~Commands() = default;

void Commands::begin_stage(Stage stage) {
    if (implementation_->stage == stage) return;
    if (!*implementation_->queries) run();
    implementation_->stage = stage;
}

void Commands::dispatch_bytes(const Kernel& kernel, uint64_t invocations, std::span<const std::byte> push) {
    if (invocations == 0) return;
    Implementation& own = *implementation_;
    const uint64_t groups = (invocations + kernel.group_size() - 1) / kernel.group_size();
    own.record("recording a dispatch", [&] { own.launch(kernel, groups, push); });
}

void Commands::dispatch_indirect_bytes(const Kernel& kernel, const Buffer& arguments, uint64_t offset,
                                       std::span<const std::byte> push) {
    Implementation& own = *implementation_;
    DCHECK(arguments.internals().config.is_indirect && offset % 4 == 0);
    if (own.is_parted()) {
        own.run();
        std::array<uint32_t, 3> groups;
        arguments.download(std::as_writable_bytes(std::span(groups)), offset);
        return dispatch_bytes(kernel, uint64_t(groups[0]) * groups[1] * groups[2] * kernel.group_size(),
                              push);
    }
    own.record("recording a dispatch", [&] {
        own.prepare();
        own.bind_kernel(kernel, push);
        if (!kernel.is_drawn()) {
            own.buffer.dispatchIndirect(*arguments.internals().buffer, offset);
            return;
        }
        own.begin_drawing(kScreen);
        const uint64_t draw_offset = offset + scalar::kArgumentDrawWord * sizeof(uint32_t);
        own.buffer.drawIndirect(*arguments.internals().buffer, draw_offset, 1, 0);
        own.buffer.endRendering();
    });
}

void Commands::draw_bytes(const Kernel& kernel, DrawSize size, uint32_t vertex_count,
                          std::span<const std::byte> push) {
    if (vertex_count == 0) return;
    Implementation& own = *implementation_;
    DCHECK(kernel.is_drawn() && size.width > 0 && size.height > 0);
    own.record("recording a draw", [&] {
        own.prepare();
        own.bind_kernel(kernel, push);
        own.begin_drawing(size);
        own.buffer.draw(vertex_count, 1, 0, 0);
        own.buffer.endRendering();
    });
}

void Commands::fill(const Buffer& buffer, uint64_t offset, uint64_t bytes, uint32_t value) {
    DCHECK(offset % 4 == 0 && bytes % 4 == 0 && offset + bytes <= buffer.byte_count());
    if (bytes == 0) return;
    Implementation& own = *implementation_;
    own.record("recording a fill", [&] {
        own.prepare();
        own.buffer.fillBuffer(*buffer.internals().buffer, offset, bytes, value);
    });
}

void Commands::copy(const Buffer& from, uint64_t from_offset, const Buffer& to, uint64_t to_offset,
                    uint64_t bytes) {
    DCHECK(from_offset + bytes <= from.byte_count() && to_offset + bytes <= to.byte_count());
    if (bytes == 0) return;
    Implementation& own = *implementation_;
    own.record("recording a copy", [&] {
        own.prepare();
        own.buffer.copyBuffer(*from.internals().buffer, *to.internals().buffer,
                              vk::BufferCopy(from_offset, to_offset, bytes));
    });
}

void Commands::discard() { implementation_->is_recording = false; }
void Commands::run() { implementation_->run(); }
const std::array<double, kStageCount>& Commands::stage_seconds() const { return implementation_->seconds; }
uint64_t Commands::dispatch_count() const { return implementation_->dispatch_count; }

} // namespace relief::vulkan
