// k-buffer passes of designs that do not modify pixels in place: several geometry passes with fixed-function tests, and
// lists of fragments that a later pass puts into the entries.
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/list_sort.hpp"
#include "pipeline/machine_units.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace pipeline {

namespace {

/// The depths of a layer on its way to the k-buffer. Its colours are those of the fragments that won.
SurfaceInfo layer_depths(const SurfaceLayout& layout, SurfaceFormat depth) {
    SurfaceInfo depths{
        .name = "layer", .format = depth, .width = layout.width, .height = layout.height, .planes = layout.samples};
    pack_depth_stencil(depth, {farthest_depth(depth), 0}, depths.cleared.data());
    return depths;
}

std::vector<DepthCode> depth_codes_of(const SurfaceStore& surfaces, SurfaceId surface) {
    const SurfaceInfo& info = surfaces.info(surface);
    std::vector<DepthCode> codes;
    codes.reserve(surfaces.places(surface));
    for (std::uint32_t row = 0; row < surfaces.rows(surface); ++row)
        for (std::uint32_t x = 0; x < info.width; ++x)
            codes.push_back(unpack_depth_stencil(info.format, surfaces.read(surface, {x, row, 0})).depth);
    return codes;
}

} // namespace

std::uint32_t Machine::geometry_passes(const KBufferPlan& plan, const ModifyProgram& program) {
    if (plan.site == UpdateSite::lists) return plan.lists.passes;
    if (plan.site != UpdateSite::passes) return 1;
    return plan.passes.passes != 0 ? plan.passes.passes : program.k();
}

// W3: per layer clear, draw with the test against the layers before, copy the depth for the next one.
void Machine::draw_layers(const Pass& pass, const FragmentStream& stream) {
    PassContext& context = units_->pass;
    const ModifyProgram& program = *frame_->program;
    const std::size_t pixels = frame_->view_of_kbuffer().places();
    const std::uint64_t drawn = frame_->view_of_kbuffer().samples_drawn();
    const bool both_ends = plan_.passes.capture == PassCapture::nearest_farthest;
    const SurfaceInfo depths = layer_depths(context.layout, plan_.passes.depth_format);
    SurfaceStore layer(std::span(&depths, 1));
    ClearBits depth_clear, colour_clear;
    FixedSurfaces& fixed = units_->fixed;
    fixed = {};
    fixed.surfaces = &layer;
    fixed.depth = 0;
    fixed.depth_clear = {&depth_clear};
    fixed.colour_clear = {&colour_clear};
    context.end = FragmentEnd::depth_colour;
    RasterState nearest;
    nearest.depth.test = nearest.depth.write = true;
    context.states = DrawStates(nearest);
    context.depth_format = plan_.passes.depth_format;
    // From both ends: two depths, two colours, both blended with MAX.
    std::uint64_t free = own_address();
    const auto take = [&free, &context](std::uint32_t pixel_bytes) {
        const SurfaceBytes taken{free, pixel_bytes};
        free += std::uint64_t{context.layout.blocks()} * 4 * pixel_bytes;
        return taken;
    };
    context.depth = take(both_ends ? 8 : bytes_of(context.depth_format));
    const SurfaceBytes copy = take(context.depth.pixel_bytes);
    context.behind_address = copy.address;
    const std::uint64_t copy_end = free;
    context.targets.clear();
    context.colours.clear();
    if (program.needs_colour()) { // RGBA32F, as the k-buffer's entries
        context.targets = {SurfaceFormat::rgba32f};
        context.colours = {take(both_ends ? 32 : 16)};
    }
    context.farthest = both_ends;
    clear_layers();
    std::vector<PeeledLayer> near_layers, far_layers;
    const std::uint32_t passes = geometry_passes(plan_, program);
    near_layers.reserve(passes);
    far_layers.reserve(passes);
    for (std::uint32_t i = 0; i < passes; ++i) {
        begin(fmt::format("{} layer {}", pass.name, i));
        resolve_cleared(pass.reads);
        layer.clear(0);
        fixed.winner.assign(pixels, ~QuadId{0});
        if (both_ends) {
            fixed.far_depth.assign(pixels, 0);
            fixed.far_winner.assign(pixels, ~QuadId{0});
        }
        clear_surface(depth_clear, context.layout, drawn, context.depth);
        for (const SurfaceBytes& colour : context.colours) clear_surface(colour_clear, context.layout, drawn, colour);
        units_->simulation.run(options_.stop);
        if (plan_.passes.capture == PassCapture::range) {
            context.range = program.range(i);
        } else if (i > 0) {
            context.behind = &near_layers.back();
            context.before = both_ends ? &far_layers.back() : nullptr;
        }
        run_draw(stream, frame_->needs_of(pass));
        if (both_ends) {
            near_layers.push_back({depth_codes_of(layer, 0), fixed.winner});
            far_layers.push_back({fixed.far_depth, fixed.far_winner});
        } else {
            for (std::size_t pixel = 0; pixel < pixels; ++pixel) keep_entry(pixel, i, fixed.winner[pixel], stream);
            near_layers = {{depth_codes_of(layer, 0), fixed.winner}};
        }
        const bool read_again = i + 1 < passes && plan_.passes.capture != PassCapture::range;
        if (read_again) {
            resolve_cleared(depth_clear, context.depth);
            const std::uint64_t bytes = drawn * copy.pixel_bytes;
            stream_surface({bytes, bytes, context.depth.address, copy.address});
            units_->simulation.run(options_.stop);
            drop_texture_lines(copy.address, copy_end);
        }
        end();
    }
    for (std::size_t pixel = 0; both_ends && pixel < pixels; ++pixel)
        keep_both_ends(pixel, near_layers, far_layers, stream);
    context.behind = context.before = nullptr;
    context.range.reset();
    context.farthest = false;
    fixed = {};
}

void Machine::clear_layers() {
    const ModifyProgram& program = *frame_->program;
    const std::size_t floats = program.floats_per_pixel();
    layers_.resize(frame_->view_of_kbuffer().places() * floats);
    for (std::size_t at = 0; at < layers_.size(); at += floats) program.clear(layers_.data() + at);
}

// Fragments captured from both ends become a pixel's entries: those from the front, then those from behind, the nearest
// of them first. One that was captured from both ends counts once.
void Machine::keep_both_ends(std::size_t pixel, const std::vector<PeeledLayer>& near_layers,
                             const std::vector<PeeledLayer>& far_layers, const FragmentStream& stream) {
    std::vector<QuadId> order;
    const auto add = [&](QuadId quad) {
        if (quad != ~QuadId{0} && std::find(order.begin(), order.end(), quad) == order.end()) order.push_back(quad);
    };
    for (const PeeledLayer& layer : near_layers) add(layer.order[pixel]);
    for (auto layer = far_layers.rbegin(); layer != far_layers.rend(); ++layer) add(layer->order[pixel]);
    const std::size_t kept = std::min<std::size_t>(order.size(), frame_->program->k());
    for (std::size_t entry = 0; entry < kept; ++entry)
        keep_entry(pixel, static_cast<std::uint32_t>(entry), order[entry], stream);
}

// Without a fragment the entry stays empty.
void Machine::keep_entry(std::size_t pixel, std::uint32_t entry, QuadId id, const FragmentStream& stream) {
    if (id == ~QuadId{0}) return;
    const ModifyProgram& program = *frame_->program;
    const Quad& quad = stream.quads[id];
    const std::size_t width = frame_->view_of_kbuffer().width, x = pixel % width, y = pixel / width;
    program.make_entry(stream.fragment(id, (y - quad.y) * 2 + (x - quad.x)),
                       layers_.data() + pixel * program.floats_per_pixel() +
                           std::size_t{entry} * program.floats_per_entry());
}

// All fragments are kept in order of arrival, which is that of the primitives; then one pass over the screen sorts each
// pixel's list and runs the program on it. Where nothing was drawn there is no list, and no entry but cleared ones.
void Machine::draw_lists(const Pass& pass, const FragmentStream& stream) {
    PassContext& context = units_->pass;
    const ListsSite& site = plan_.lists;
    const std::uint64_t pixels = frame_->view_of_kbuffer().samples_drawn();
    const SurfaceBytes heads{context.kbuffer_address, site.head_bytes};
    context.end = FragmentEnd::kbuffer_list;
    for (std::uint32_t i = 0; i < site.passes; ++i) {
        begin(site.passes == 1 ? pass.name : fmt::format("{} pass {}", pass.name, i));
        context.first_kept = i * site.per_pixel;
        resolve_cleared(pass.reads);
        if (i > 0) clear_surface(units_->kbuffer_clear, context.layout, pixels, heads);
        units_->simulation.run(options_.stop);
        run_draw(stream, frame_->needs_of(pass));
        end();
    }
    clear_layers();
    run_lists(stream);
    if (stream.triangles.empty()) return;
    if (units_->kbuffer_clear.left() != 0) {
        begin(pass.name + " resolve of cleared heads");
        resolve_cleared(units_->kbuffer_clear, heads);
        end();
    }
    drop_texture_lines(heads.address, heads.address + std::uint64_t{context.layout.blocks()} * 4 * heads.pixel_bytes);
    const ScreenPass sort =
        list_sort_pass(pass.name + " sort", site, *frame_->program, *units_->lists, heads.address, stream);
    screen(sort, stream.triangles.front().draw, units_->surfaces.address(pass.kbuffer, {}));
}

void Machine::run_lists(const FragmentStream& stream) {
    const ModifyProgram& program = *frame_->program;
    const SurfaceLayout& layout = units_->pass.layout;
    std::array<float, largest_entry> entry;
    for (std::uint32_t y = 0; y < layout.rows(); ++y)
        for (std::uint32_t x = 0; x < layout.width; ++x) {
            const std::uint32_t lane = y % 2 * 2 + x % 2;
            float* pixel = layers_.data() + (std::size_t{y} * layout.width + x) * program.floats_per_pixel();
            for (const FragmentLists::Node& node : units_->lists->fragments(layout.block_of(x, y), lane)) {
                program.make_entry(stream.fragment(node.quad, lane), entry.data());
                program.insert(pixel, entry.data());
            }
        }
}

// Whether more fragments came to a pixel than the design can hold; what it shows there is not meant to be right.
bool Machine::overflowed(std::size_t place, std::uint32_t fragments) const {
    if (!frame_->needs.kbuffer) return false;
    const std::size_t width = frame_->view_of_kbuffer().width;
    const auto x = static_cast<std::uint32_t>(place % width), y = static_cast<std::uint32_t>(place / width);
    if (units_->lists) {
        const ListsSite& site = plan_.lists;
        return units_->lists->overflowed(units_->pass.layout.block_of(x, y), y % 2 * 2 + x % 2) ||
               (site.per_pixel != 0 && fragments > site.per_pixel * site.passes);
    }
    if (plan_.site != UpdateSite::passes || plan_.passes.capture == PassCapture::range) return false;
    const std::uint32_t passes = geometry_passes(plan_, *frame_->program);
    if (passes >= frame_->program->k()) return false;
    return fragments > passes * (plan_.passes.capture == PassCapture::nearest_farthest ? 2 : 1);
}

} // namespace pipeline
