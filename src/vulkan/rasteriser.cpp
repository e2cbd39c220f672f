#include "vulkan/rasteriser.h"

#include <algorithm>

#include "base/check.h"
#include "formulas/levels.h"
#include "formulas/pixel_order.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_raster.h"

namespace relief::vulkan {

namespace {

/// A draw has less than 2^32 vertices, and triangle ranks need one bit more than cell indices.
constexpr uint32_t kMostCells = 1u << 26;

static_assert(sizeof(scalar::RasterItem) == 24);
static_assert(sizeof(scalar::RasterPush) <= scalar::kMaxPushBytes);

/// Rows of the window touched by a range of pixels in place_pixel order.
void set_rows(const scalar::CameraPush& camera, scalar::RasterPush& push) {
    const uint64_t band_pixels = uint64_t(scalar::kPixelSquare) * camera.width;
    const uint32_t last_pixel = camera.first_pixel + camera.count - 1;
    push.first_row = uint32_t(camera.first_pixel / band_pixels) * scalar::kPixelSquare;
    const uint32_t end = uint32_t(last_pixel / band_pixels + 1) * scalar::kPixelSquare;
    push.row_count = std::min(end, camera.height) - push.first_row;
}

} // namespace

Rasteriser::Rasteriser(Tracer& tracer, const RasterBuffers& buffers)
    : tracer_(tracer),
      buffers_(buffers),
      start_(make_kernel(tracer.device(), "raster_start")),
      vertices_(tracer.device(), {"raster_vertices", tracer.device_scene().add_filter({kGroupSize})}),
      cells_(tracer.device(), {"raster_rays", {kGroupSize}, {}, "raster_cells"}),
      resolve_(make_kernel(tracer.device(), "raster_resolve")) {
    DCHECK(buffers.vertices->byte_count() >= RasterBuffers::kLeastVertexBytes);
    DCHECK(buffers.items->byte_count() >= RasterBuffers::kLeastItemBytes);
}

CastStatistics Rasteriser::first_hits(const scalar::CameraPush& camera) {
    Commands& commands = tracer_.commands();
    scalar::RasterPush push{};
    push.origin = camera.camera.origin, push.corner = camera.camera.corner;
    push.step_x = camera.camera.step_x, push.step_y = camera.camera.step_y;
    push.x0 = camera.x0, push.y0 = camera.y0, push.width = camera.width, push.height = camera.height;
    push.first_pixel = camera.first_pixel, push.count = camera.count;
    set_rows(camera, push);
    commands.begin_stage(Stage::top_traversal);
    commands.run();
    CastStatistics result;
    result.rays = camera.count;
    const double before = commands.stage_seconds()[size_t(Stage::top_traversal)];
    commands.dispatch(start_, push.count, push);
    Cursor cursor;
    for (Wave wave = take_wave(cursor); !wave.items.empty(); wave = take_wave(cursor)) draw_wave(wave, push);
    commands.run();
    result.top_traversal_s = commands.stage_seconds()[size_t(Stage::top_traversal)] - before;
    return result;
}

void Rasteriser::draw_wave(const Wave& wave, scalar::RasterPush push) {
    Commands& commands = tracer_.commands();
    commands.run(); // finishes the readers of the previous wave's items
    buffers_.items->upload(wave.items);
    push.item_count = uint32_t(wave.items.size());
    push.vertex_count = wave.vertex_count;
    commands.dispatch(vertices_, push.vertex_count, push);
    commands.draw(cells_, {push.width, push.row_count}, wave.cell_count * scalar::kRasterVertices, push);
    commands.dispatch(resolve_, push.count, push);
}

/// As many items from the cursor on as fit; none after the last one.
Rasteriser::Wave Rasteriser::take_wave(Cursor& cursor) const {
    const PreparedScene& scene = tracer_.scene();
    Wave wave;
    while (cursor.instance < scene.instances.size()) {
        const Surface& surface = scene.surfaces[scene.instances[cursor.instance].surface];
        if (cursor.patch == surface.patch_count())
            cursor = {cursor.instance + 1, 0, 0};
        else if (!append_item(cursor, wave))
            break;
    }
    return wave;
}

/// Adds as many rows of the patch as fit; false if none does.
bool Rasteriser::append_item(Cursor& cursor, Wave& wave) const {
    const Instance& instance = tracer_.scene().instances[cursor.instance];
    const bool is_displaced = tracer_.scene().surfaces[instance.surface].has_displacement;
    const uint32_t levels = is_displaced ? instance.levels->packed_at(cursor.patch) : 0;
    const uint32_t side = 1u << scalar::packed_patch_level(levels);
    const uint64_t vertex_room = buffers_.vertices->byte_count() / sizeof(Vec3f) - wave.vertex_count;
    const uint64_t vertex_rows = vertex_room / (side + 1);
    const uint32_t rows = uint32_t(std::min<uint64_t>(
        {side - cursor.row, std::max<uint64_t>(vertex_rows, 1) - 1, (kMostCells - wave.cell_count) / side}));
    if (rows == 0 || (wave.items.size() + 1) * sizeof(scalar::RasterItem) > buffers_.items->byte_count())
        return false;
    wave.items.push_back(
        {cursor.instance, cursor.patch, levels, cursor.row, wave.vertex_count, wave.cell_count});
    wave.vertex_count += (rows + 1) * (side + 1);
    wave.cell_count += rows * side;
    cursor.row += rows;
    if (cursor.row == side) cursor = {cursor.instance, cursor.patch + 1, 0};
    return true;
}

} // namespace relief::vulkan
