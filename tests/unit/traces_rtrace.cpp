// The draw trace format: what is written is read, each thing once, and nothing that was not written.
#include "sim/check.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/rtrace/chunk_reader.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace rtrace_test {

namespace rtrace = traces::rtrace;
using ropsim_test::TemporaryFolder;
using support::Bytes;

class Rtrace : public ::testing::Test {
  protected:
    std::filesystem::path write(const traces::Trace& trace, const std::string& name = "x.rtrace") {
        traces::write_trace(trace, folder_.path() / name);
        return folder_.path() / name;
    }
    TemporaryFolder folder_;
};

void expect_equal(const traces::Scene& a, const traces::Scene& b) {
    const pipeline::Resources &one = *a.resources, &two = *b.resources;
    ASSERT_EQ(one.buffers.size(), two.buffers.size());
    for (std::size_t i = 0; i < one.buffers.size(); ++i) {
        EXPECT_EQ(one.buffers[i].name, two.buffers[i].name);
        EXPECT_EQ(one.buffers[i].bytes, two.buffers[i].bytes);
        EXPECT_EQ(one.buffers[i].address, two.buffers[i].address);
    }
    ASSERT_EQ(one.geometries.size(), two.geometries.size());
    for (std::size_t i = 0; i < one.geometries.size(); ++i) {
        EXPECT_EQ(one.geometries[i].runs, two.geometries[i].runs);
        EXPECT_EQ(one.geometries[i].triangle_count(), two.geometries[i].triangle_count());
        EXPECT_EQ(one.geometries[i].attributes.size(), two.geometries[i].attributes.size());
    }
    ASSERT_EQ(one.textures.size(), two.textures.size());
    for (std::size_t i = 0; i < one.textures.size(); ++i) {
        ASSERT_EQ(one.textures[i].levels.size(), two.textures[i].levels.size());
        EXPECT_EQ(one.textures[i].border, two.textures[i].border);
        for (std::size_t k = 0; k < one.textures[i].levels.size(); ++k) {
            EXPECT_EQ(one.textures[i].levels[k].rgba, two.textures[i].levels[k].rgba);
            EXPECT_EQ(one.textures[i].levels[k].address, two.textures[i].levels[k].address);
        }
    }
    ASSERT_EQ(a.draws.size(), b.draws.size());
    for (std::size_t i = 0; i < a.draws.size(); ++i) EXPECT_EQ(a.draws[i].instances, b.draws[i].instances);
    EXPECT_EQ(a.lo, b.lo);
    EXPECT_EQ(a.hi, b.hi);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.triangles_drawn, b.triangles_drawn);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.notes, b.notes);
}

TEST_F(Rtrace, IsReadAsItWasWritten) {
    const traces::Trace trace = support::rich_trace();
    const traces::Trace read = traces::read_trace(write(trace));
    expect_equal(trace.scene, read.scene);
    EXPECT_EQ(read.frame.view.view, trace.frame.view.view);
    EXPECT_EQ(read.frame.view.projection, trace.frame.view.projection);
    EXPECT_EQ(read.frame.parameters, trace.frame.parameters);
    EXPECT_EQ(read.metadata.scene_hash, trace.scene.hash);
    EXPECT_EQ(read.scene.name, "x.rtrace");
    EXPECT_EQ(read.scene.hash.size(), 16U);
    EXPECT_EQ(traces::frame_of(read).program->k(), 3U);
}

TEST_F(Rtrace, WrittenAgainItIsTheSameFile) {
    const auto first = write(support::rich_trace());
    const auto second = write(traces::read_trace(first), "y.rtrace");
    EXPECT_EQ(support::bytes_in(first), support::bytes_in(second));
    EXPECT_TRUE(traces::trace_faults(first).empty());
    EXPECT_TRUE(traces::trace_differences(first, second).empty());
}

TEST_F(Rtrace, EqualBytesAreStoredOnce) {
    const auto file = write(support::rich_trace());
    std::size_t blobs = 0;
    for (const support::Chunk& chunk : support::chunks_in(file)) blobs += chunk.type == rtrace::chunk::blob ? 1 : 0;
    // Of five buffers two are equal; three levels; the matrices of one draw.
    EXPECT_EQ(blobs, 4U + 3U + 1U);
    traces::Trace more = support::rich_trace();
    const auto before = std::filesystem::file_size(file);
    more.scene.resources->buffers.push_back(more.scene.resources->buffers.front());
    EXPECT_LT(std::filesystem::file_size(write(more)), before + 40); // a name and a hash, compressed
}

TEST_F(Rtrace, EqualContentsOfSurfacesAreHeldOnce) {
    traces::Recording recording = support::quad_recording();
    traces::RecordedSurface surface;
    surface.width = surface.height = 8;
    surface.levels[0] = Bytes(256, std::byte{5});
    recording.surfaces.insert(recording.surfaces.end(), 2, surface);
    surface.levels[0] = Bytes(256, std::byte{6});
    recording.surfaces.push_back(surface);
    const traces::Trace trace = traces::read_trace(write(support::recorded_trace(std::move(recording))));
    const std::vector<traces::RecordedSurface>& surfaces = trace.recording->surfaces;
    const auto contents = [&](std::size_t from_last) -> const pipeline::SharedBytes& {
        return surfaces[surfaces.size() - from_last].levels[0];
    };
    EXPECT_EQ(contents(1), surface.levels[0]);
    EXPECT_EQ(contents(2).data(), contents(3).data());
    EXPECT_EQ(contents(2)[255], std::byte{5});
}

TEST_F(Rtrace, ALargeBufferIsWrittenInFewerBytesAndReadBack) {
    traces::Trace trace = support::rich_trace();
    Bytes& bytes = trace.scene.resources->buffers[4].bytes;
    bytes.resize(3'000'001);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * i >> 7U);
    const auto file = write(trace);
    EXPECT_LT(std::filesystem::file_size(file), bytes.size() / 2);
    EXPECT_EQ(traces::read_trace(file).scene.resources->buffers[4].bytes, bytes);
}

TEST_F(Rtrace, ADifferenceIsNamedByItsPlace) {
    const auto a = write(support::rich_trace());
    traces::Trace other = support::rich_trace();
    other.scene.resources->geometries[1].attributes[2].stride = 0x14;
    other.scene.resources->geometries[1].attributes[2].buffer = 0;
    other.scene.draws.push_back(other.scene.draws[0]);
    const auto b = write(other, "y.rtrace");
    EXPECT_EQ(
        traces::trace_differences(a, b),
        (std::vector<std::string>{"geometry 1 attribute 2: buffer: 1 | 0", "geometry 1 attribute 2: stride: 4 | 20",
                                  "DRAW: draw records: 2 | 3", "draw 2: only in " + b.string()}));
}

TEST_F(Rtrace, ChunksInAnotherOrderSayTheSame) {
    const auto file = write(support::rich_trace());
    std::vector<support::Chunk> chunks = support::chunks_in(file);
    std::stable_partition(chunks.begin(), chunks.end(),
                          [](const support::Chunk& one) { return one.type != rtrace::chunk::blob; });
    const auto blobs = std::find_if(chunks.begin(), chunks.end(),
                                    [](const support::Chunk& one) { return one.type == rtrace::chunk::blob; });
    std::reverse(chunks.begin(), blobs);
    std::reverse(blobs, chunks.end());
    support::write_bytes(folder_.path() / "y.rtrace", support::file_of(chunks));
    EXPECT_EQ(support::refusal_of(support::file_of(chunks)), "");
    EXPECT_TRUE(traces::trace_differences(file, folder_.path() / "y.rtrace").empty());
}

TEST_F(Rtrace, UnknownChunksAreSkippedOrRefusedByName) {
    std::vector<support::Chunk> chunks = support::chunks_in(write(support::rich_trace()));
    chunks.push_back({"INFO", Bytes(5), 0});
    EXPECT_EQ(support::refusal_of(support::file_of(chunks)), "");
    chunks.back() = {"LATE", Bytes(5)};
    const std::string refusal = support::refusal_of(support::file_of(chunks));
    EXPECT_NE(refusal.find("expected chunks that version 1 has, got a required 'LATE'"), std::string::npos) << refusal;
}

TEST_F(Rtrace, WhatIsNotUtf8OrNotFiniteIsNotWritten) {
    const auto says = [&](const traces::Trace& trace, const std::string& part) {
        try {
            write(trace, "bad.rtrace");
            ADD_FAILURE() << part;
        } catch (const sim::InputError& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(folder_.path() / "bad.rtrace"));
    };
    traces::Trace trace = support::rich_trace();
    trace.metadata.name = "\xC3(";
    says(trace, "name: expected UTF-8");
    trace = support::rich_trace();
    trace.scene.lights[0].range = INFINITY;
    says(trace, "range: expected finite numbers");
    trace = support::rich_trace();
    trace.scene.cameras[0].near = 0.0F;
    says(trace, "camera 0: expected 0 < near < far");
}

} // namespace rtrace_test
