// What the library in a recorded program writes, as a recording: made by hand, record by record.
#include "sim/check.hpp"
#include "traces/glsl.hpp"
#include "traces/record_module/fixed_state_names.hpp"
#include "traces/record_module/writer.hpp"
#include "traces/recording/import/geometry.hpp"
#include "traces/recording/import/gl_state.hpp"
#include "traces/recording/import/import.hpp"
#include "traces/recording/import/surfaces.hpp"
#include "traces/recording/import/vertex_elements.hpp"

#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <map>

namespace recorded_stream_test {

using record_stream::Tag;
using record_stream::Writer;
using traces::recorded::Blobs;

namespace {

class Stream {
  public:
    template <class Record>
    Stream& add(Tag tag, const Record& record) {
        const std::vector<std::byte> more = Writer::record(tag, record);
        bytes.insert(bytes.end(), more.begin(), more.end());
        return *this;
    }
    std::vector<std::byte> bytes;
};

record_stream::State plain_state() {
    record_stream::State state;
    state.values.assign(record_stream::values_of(record_stream::state_names), 0.0);
    const auto set = [&](GLenum name, std::initializer_list<double> values) {
        std::size_t place = record_stream::place_of(record_stream::state_names, name);
        for (const double value : values) state.values.at(place++) = value;
    };
    set(GL_DEPTH_WRITEMASK, {1});
    set(GL_DEPTH_RANGE, {0, 1});
    set(GL_VIEWPORT, {0, 0, 4, 2});
    set(GL_STENCIL_WRITEMASK, {-1});
    set(GL_CLIP_ORIGIN, {GL_LOWER_LEFT});
    set(GL_CLIP_DEPTH_MODE, {GL_NEGATIVE_ONE_TO_ONE});
    set(GL_POLYGON_MODE, {GL_FILL, GL_FILL});
    return state;
}

/// A window of 4 x 2 pixels whose lower row is 1, 2, 3, 4 and whose upper row is 0.
Stream window_stream(bool alpha = true) {
    Stream stream;
    stream.add(Tag::context, record_stream::Context{record_stream::version, "4.5", "test"});
    record_stream::Blob pixels{std::vector<std::byte>(32)};
    for (std::size_t i = 0; i < 4; ++i) pixels.bytes[4 * i] = static_cast<std::byte>(i + 1);
    record_stream::Surface window;
    window.name = "window";
    window.target = GL_FRAMEBUFFER_DEFAULT;
    window.bits = {8, 8, 8, alpha ? 8U : 0U, 0, 0, 0, 0};
    window.format = GL_RGBA;
    window.type = GL_UNSIGNED_BYTE;
    window.levels = {{4, 2, 1, 0}};
    return stream.add(Tag::blob, pixels).add(Tag::surface, window);
}

record_stream::Targets window_targets() {
    record_stream::Targets targets;
    targets.colours[0].surface = 0;
    targets.width = 4;
    targets.height = 2;
    targets.window = true;
    return targets;
}

record_stream::Clear clear_of(const record_stream::Targets& targets) {
    record_stream::Clear clear;
    clear.call = "glClear";
    clear.targets = targets;
    clear.state = plain_state();
    clear.colours = 0xFF;
    return clear;
}

record_stream::Frame frame_of(std::uint32_t number) { return {number, window_targets()}; }

/// Counts by what was counted.
struct Counted {
    std::map<std::string, int> calls;
    traces::recorded::Count count = [this](const std::string& call) { ++calls[call]; };
};

record_stream::Geometry points_of(std::uint32_t mode, std::uint32_t count) {
    record_stream::Geometry geometry;
    geometry.mode = mode;
    geometry.count = count;
    record_stream::Array array;
    array.blob = 0;
    array.components = 1;
    array.type = GL_FLOAT;
    array.stride = 4;
    geometry.arrays.push_back(array);
    return geometry;
}

std::vector<std::uint32_t> u16_indices(const pipeline::Resources& resources, const pipeline::Geometry& geometry) {
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < geometry.index_count; ++i) {
        std::uint16_t index = 0;
        std::memcpy(&index, resources.buffers.at(geometry.index_buffer).bytes.data() + geometry.index_offset + 2 * i,
                    2);
        result.push_back(index);
    }
    return result;
}

} // namespace

TEST(RecordedStream, WindowsBeginAtTheTop) {
    Stream stream = window_stream();
    record_stream::Clear clear = clear_of(window_targets());
    const std::size_t box = record_stream::place_of(record_stream::state_names, GL_SCISSOR_BOX);
    clear.state.values[record_stream::place_of(record_stream::state_names, GL_SCISSOR_TEST)] = 1;
    for (std::size_t i = 0; i < 4; ++i) clear.state.values[box + i] = std::array{1.0, 0.0, 2.0, 1.0}.at(i);
    stream.add(Tag::clear, clear).add(Tag::frame, frame_of(5));
    const traces::Recording recording = traces::recorded::import_stream(stream.bytes).recording;
    ASSERT_EQ(recording.frames.size(), 1U);
    EXPECT_EQ(recording.frames[0].number, 5U);
    EXPECT_TRUE(recording.targets.at(0).top_row_first);
    EXPECT_EQ(recording.surfaces.at(0).levels[0][16], std::byte{1}); // the lower row is the second one now
    EXPECT_EQ(recording.surfaces.at(0).levels[0][0], std::byte{0});
    const auto& cleared = std::get<traces::RecordedClear>(recording.frames[0].commands.at(0));
    EXPECT_EQ(cleared.scissor, (pipeline::PixelRectangle{1, 1, 2, 1}));
    EXPECT_EQ(cleared.colours, 1);
}

TEST(RecordedStream, CopiesOfWindowsLeaveThemAsTheyLie) {
    Stream stream = window_stream();
    record_stream::Surface texture;
    texture.name = "texture";
    texture.target = GL_TEXTURE_2D;
    texture.bits = {8, 8, 8, 8, 0, 0, 0, 0};
    texture.format = GL_RGBA;
    texture.type = GL_UNSIGNED_BYTE;
    texture.levels = {{2, 2, 1, -1}};
    record_stream::Copy copy;
    copy.call = "glCopyTexSubImage2D";
    copy.from.surface = 0;
    copy.to.surface = 1;
    copy.x = 3; // of two columns, one lies in the window
    copy.width = 2;
    copy.height = 2;
    stream.add(Tag::surface, texture).add(Tag::copy, copy).add(Tag::frame, frame_of(0));
    const traces::Recording recording = traces::recorded::import_stream(stream.bytes).recording;
    EXPECT_FALSE(recording.targets.at(recording.frames.at(0).shown).top_row_first);
    const auto& copied = std::get<traces::RecordedCopy>(recording.frames[0].commands.at(0));
    EXPECT_EQ(copied.rectangle, (pipeline::PixelRectangle{3, 0, 1, 2}));
}

traces::RecordedBlit imported_blit(const record_stream::Blit& blit) {
    Stream stream = window_stream();
    record_stream::Surface texture;
    texture.name = "texture";
    texture.target = GL_TEXTURE_2D;
    texture.bits = {8, 8, 8, 8, 0, 0, 0, 0};
    texture.format = GL_RGBA;
    texture.type = GL_UNSIGNED_BYTE;
    texture.levels = {{8, 8, 1, -1}};
    stream.add(Tag::surface, texture).add(Tag::blit, blit).add(Tag::frame, frame_of(0));
    const traces::Recording recording = traces::recorded::import_stream(stream.bytes).recording;
    EXPECT_FALSE(recording.targets.at(recording.frames.at(0).shown).top_row_first);
    return std::get<traces::RecordedBlit>(recording.frames[0].commands.at(0));
}

TEST(RecordedStream, BlitsHaveRectanglesAndSayWhichWayTheyRun) {
    record_stream::Blit blit;
    blit.call = "glBlitFramebuffer";
    blit.from.surface = 1;
    blit.to.surface = 0;
    blit.source = {1, 7, 5, 3};
    blit.destination = {10, 2, -2, 0};
    const traces::RecordedBlit both = imported_blit(blit);
    EXPECT_EQ(both.from.surface, 1U);
    EXPECT_EQ(both.source, (pipeline::PixelRectangle{1, 3, 4, 4}));
    EXPECT_EQ(both.destination, (pipeline::PixelRectangle{-2, 0, 12, 2}));
    EXPECT_TRUE(both.mirrored_x);
    EXPECT_FALSE(both.mirrored_y); // both run downwards
    EXPECT_FALSE(both.linear);
    EXPECT_EQ(both.scissor, std::nullopt);
    blit.source = {1, 3, 5, 7};
    blit.linear = blit.scissor_test = true;
    blit.scissor = {1, 0, 2, 1};
    const traces::RecordedBlit cut = imported_blit(blit);
    EXPECT_TRUE(cut.mirrored_y);
    EXPECT_TRUE(cut.linear);
    EXPECT_EQ(cut.scissor, (pipeline::PixelRectangle{1, 0, 2, 1}));
}

TEST(RecordedStream, BlitsOfNothingAreNoneAndHugeOnesAreCounted) {
    const auto imported = [](const std::array<std::int32_t, 4>& destination) {
        Stream stream = window_stream();
        record_stream::Blit blit;
        blit.call = "glBlitFramebuffer";
        blit.from.surface = blit.to.surface = 0;
        blit.source = {0, 0, 4, 2};
        blit.destination = destination;
        stream.add(Tag::blit, blit).add(Tag::frame, frame_of(0));
        return traces::recorded::import_stream(stream.bytes).recording;
    };
    const traces::Recording none = imported({3, 1, 3, 5});
    EXPECT_TRUE(none.frames.at(0).commands.empty());
    EXPECT_TRUE(none.not_recorded.empty());
    const traces::Recording huge = imported({0, 0, 65537, 1});
    EXPECT_TRUE(huge.frames.at(0).commands.empty());
    ASSERT_EQ(huge.not_recorded.size(), 1U);
    EXPECT_EQ(huge.not_recorded[0], (traces::NotRecorded{"glBlitFramebuffer of more than 65536 pixels a side", 1}));
}

TEST(RecordedStream, DepthRangesAreStates) {
    record_stream::State state = plain_state();
    const std::size_t range = record_stream::place_of(record_stream::state_names, GL_DEPTH_RANGE);
    state.values[range] = 0.75;
    state.values[range + 1] = 0.25;
    Counted counted;
    const auto raster = traces::recorded::raster_state_of(state, {2, true, GL_TRIANGLES}, counted.count);
    EXPECT_EQ(raster.depth.range_near, 0.75F);
    EXPECT_EQ(raster.depth.range_far, 0.25F);
    EXPECT_TRUE(counted.calls.empty());
}

TEST(RecordedStream, AlphaThatIsNotThereIsNotWritten) {
    Stream stream = window_stream(false);
    stream.add(Tag::clear, clear_of(window_targets())).add(Tag::frame, frame_of(0));
    const traces::Recording recording = traces::recorded::import_stream(stream.bytes).recording;
    EXPECT_EQ(std::get<traces::RecordedClear>(recording.frames.at(0).commands.at(0)).write_mask[0], 7);
}

TEST(RecordedStream, WhatIsCutOffEndsWithTheLastWholeFrame) {
    Stream stream = window_stream();
    stream.add(Tag::clear, clear_of(window_targets())).add(Tag::frame, frame_of(0));
    const std::size_t whole = stream.bytes.size();
    stream.add(Tag::clear, clear_of(window_targets()))
        .add(Tag::frame, frame_of(1))
        .add(Tag::finished, record_stream::Finished{});
    EXPECT_EQ(traces::recorded::import_stream(stream.bytes).recording.frames.size(), 2U);
    EXPECT_TRUE(traces::recorded::import_stream(stream.bytes).finished);
    for (std::size_t size = whole; size < stream.bytes.size() - 12; size += 7) {
        const auto cut = traces::recorded::import_stream(std::span(stream.bytes).first(size));
        EXPECT_LE(cut.recording.frames.size(), 2U);
        EXPECT_GE(cut.recording.frames.size(), 1U);
        EXPECT_FALSE(cut.finished);
    }
    EXPECT_TRUE(traces::recorded::import_stream({}).recording.frames.empty());
}

TEST(RecordedStream, RecordsOfAnotherShapeAreRefused) {
    Stream stream;
    stream.add(Tag::surface, record_stream::NotRecorded{"x", 1});
    EXPECT_THROW(traces::recorded::import_stream(stream.bytes), sim::InputError);
    Stream other;
    other.add(Tag::context, record_stream::Context{record_stream::version + 1, "", ""});
    EXPECT_THROW(traces::recorded::import_stream(other.bytes), sim::InputError);
}

TEST(RecordedStream, QuadsAreTrianglesWithTheirLastVertexLast) {
    pipeline::Resources resources;
    const Blobs blobs{std::vector<std::byte>(64)};
    const Counted counted;
    traces::recorded::GeometryImport import(resources, blobs, counted.count);
    const auto quads = import.number_of(points_of(GL_QUADS, 9), {});
    ASSERT_TRUE(quads);
    EXPECT_EQ(resources.geometries.at(*quads).topology, pipeline::Topology::triangles);
    EXPECT_EQ(u16_indices(resources, resources.geometries[*quads]),
              (std::vector<std::uint32_t>{0, 1, 3, 1, 2, 3, 4, 5, 7, 5, 6, 7}));
    EXPECT_EQ(import.number_of(points_of(GL_QUADS, 9), {}), quads);
    const auto strip = import.number_of(points_of(GL_QUAD_STRIP, 6), {.flat = true});
    EXPECT_EQ(u16_indices(resources, resources.geometries.at(strip.value())),
              (std::vector<std::uint32_t>{0, 1, 3, 2, 0, 3, 2, 3, 5, 4, 2, 5}));
    const auto smooth = import.number_of(points_of(GL_QUAD_STRIP, 6), {});
    EXPECT_EQ(resources.geometries.at(smooth.value()).topology, pipeline::Topology::triangle_strip);
    const auto fan = import.number_of(points_of(GL_POLYGON, 4), {.flat = true});
    EXPECT_EQ(u16_indices(resources, resources.geometries.at(fan.value())),
              (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0}));
}

TEST(RecordedStream, VerticesBeyondABufferAreCounted) {
    pipeline::Resources resources;
    const Blobs blobs{std::vector<std::byte>(12)};
    Counted counted;
    traces::recorded::GeometryImport import(resources, blobs, counted.count);
    EXPECT_TRUE(import.number_of(points_of(GL_TRIANGLES, 3), {}));
    EXPECT_FALSE(import.number_of(points_of(GL_TRIANGLES, 4), {}));
    EXPECT_EQ(counted.calls, (std::map<std::string, int>{{"draws that read vertices beyond a buffer", 1}}));
}

TEST(RecordedStream, TypesThatThePipelineLacksBecomeFloats) {
    record_stream::Array array;
    array.components = GL_BGRA;
    array.type = GL_UNSIGNED_BYTE;
    array.normalized = true;
    array.stride = 4;
    const std::vector<std::byte> bytes{std::byte{255}, std::byte{51}, std::byte{0}, std::byte{102}};
    const auto floats_in = [](const std::vector<std::byte>& raw) {
        std::vector<float> values(raw.size() / 4);
        std::memcpy(values.data(), raw.data(), raw.size());
        return values;
    };
    EXPECT_FALSE(traces::recorded::component_type_of(array));
    EXPECT_EQ(floats_in(traces::recorded::as_floats(array, bytes, 1)), (std::vector<float>{0.0F, 0.2F, 1.0F, 0.4F}));
    array.components = 4;
    array.type = GL_INT_2_10_10_10_REV;
    array.normalized = false;
    const std::uint32_t packed = 1U | (0x3FFU << 10U) | (0x200U << 20U) | (3U << 30U);
    std::vector<std::byte> word(4);
    std::memcpy(word.data(), &packed, 4);
    EXPECT_EQ(floats_in(traces::recorded::as_floats(array, word, 1)),
              (std::vector<float>{1.0F, -1.0F, -512.0F, -1.0F}));
}

TEST(RecordedStream, DepthsAndStencilsChangePlaces) {
    const std::uint32_t packed = 0xABCDEF12; // depth ABCDEF, stencil 12
    Blobs blobs{std::vector<std::byte>(4)};
    std::memcpy(blobs[0].data(), &packed, 4);
    record_stream::Surface surface;
    surface.target = GL_RENDERBUFFER;
    surface.bits = {0, 0, 0, 0, 0, 0, 24, 8};
    surface.format = GL_DEPTH_STENCIL;
    surface.type = GL_UNSIGNED_INT_24_8;
    surface.levels = {{1, 1, 1, 0}};
    const Counted counted;
    const auto imported = traces::recorded::import_surface(surface, blobs, false, counted.count);
    ASSERT_TRUE(imported);
    EXPECT_EQ(imported->surface.format, pipeline::SurfaceFormat::d24s8);
    std::uint32_t value = 0;
    std::memcpy(&value, imported->surface.levels.at(0).data(), 4);
    EXPECT_EQ(value, 0x12ABCDEFU);
}

TEST(RecordedStream, SwizzlesAreThoseOfTheFormatThenThoseOfTheTexture) {
    using enum traces::Swizzle;
    traces::recorded::ImportedSurface luminance;
    luminance.channels = {red, red, red, one};
    record_stream::Binding binding;
    binding.swizzle = {GL_ALPHA, GL_RED, GL_ZERO, GL_ONE};
    EXPECT_EQ(traces::recorded::swizzle_of(binding, luminance), (std::array{one, red, zero, one}));
    traces::recorded::ImportedSurface depth;
    depth.surface.format = pipeline::SurfaceFormat::d24;
    binding.swizzle = {GL_RED, GL_GREEN, GL_BLUE, GL_ALPHA};
    binding.depth_mode = GL_LUMINANCE;
    EXPECT_EQ(traces::recorded::swizzle_of(binding, depth), (std::array{red, red, red, one}));
}

} // namespace recorded_stream_test
