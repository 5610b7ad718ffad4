// Recorded frames as a draw trace: what is written is read, as text it says everything, and what is wrong is named.
#include "sim/check.hpp"
#include "tests/support/recorded_file.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/recording/recording_check.hpp"
#include "traces/rtrace/chunk.hpp"
#include "traces/rtrace/little_endian.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace recording_test {

using support::Bytes;
using support::Chunk;
using traces::Recording;
namespace chunk = traces::rtrace::chunk;

class Recorded : public support::RecordedFile {};

void expect_equal(const pipeline::Resources& one, const pipeline::Resources& two) {
    ASSERT_EQ(one.buffers.size(), two.buffers.size());
    for (std::size_t i = 0; i < one.buffers.size(); ++i) {
        EXPECT_EQ(one.buffers[i].name, two.buffers[i].name);
        EXPECT_EQ(one.buffers[i].bytes, two.buffers[i].bytes);
    }
    ASSERT_EQ(one.geometries.size(), two.geometries.size());
    for (std::size_t i = 0; i < one.geometries.size(); ++i) {
        const pipeline::Geometry &a = one.geometries[i], &b = two.geometries[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.topology, b.topology);
        EXPECT_EQ(a.vertex_count, b.vertex_count);
        EXPECT_EQ(a.index_type, b.index_type);
        EXPECT_EQ(a.index_buffer, b.index_buffer);
        EXPECT_EQ(a.index_offset, b.index_offset);
        EXPECT_EQ(a.index_count, b.index_count);
        EXPECT_EQ(a.runs, b.runs);
        ASSERT_EQ(a.attributes.size(), b.attributes.size());
        for (std::size_t k = 0; k < a.attributes.size(); ++k) {
            EXPECT_EQ(a.attributes[k].semantic, b.attributes[k].semantic);
            EXPECT_EQ(a.attributes[k].type, b.attributes[k].type);
            EXPECT_EQ(a.attributes[k].components, b.attributes[k].components);
            EXPECT_EQ(a.attributes[k].normalized, b.attributes[k].normalized);
            EXPECT_EQ(a.attributes[k].buffer, b.attributes[k].buffer);
            EXPECT_EQ(a.attributes[k].offset, b.attributes[k].offset);
            EXPECT_EQ(a.attributes[k].stride, b.attributes[k].stride);
            EXPECT_EQ(a.attributes[k].divisor, b.attributes[k].divisor);
        }
    }
}

TEST_F(Recorded, IsReadAsItWasWritten) {
    const Recording recording = support::rich_recording();
    const traces::Trace trace = traces::read_trace(write(recording));
    ASSERT_TRUE(trace.recording);
    const Recording& read = *trace.recording;
    expect_equal(*recording.resources, *read.resources);
    EXPECT_EQ(read.surfaces, recording.surfaces);
    EXPECT_EQ(read.samplers, recording.samplers);
    EXPECT_EQ(read.programs, recording.programs);
    EXPECT_EQ(read.values, recording.values);
    EXPECT_EQ(read.bindings, recording.bindings);
    EXPECT_EQ(read.states, recording.states);
    EXPECT_EQ(read.targets, recording.targets);
    EXPECT_EQ(read.frames, recording.frames);
    EXPECT_EQ(read.not_recorded, recording.not_recorded);
    EXPECT_EQ(trace.metadata.scene, "a program");
    EXPECT_EQ(trace.scene.name, "x.rtrace");
    EXPECT_EQ(trace.scene.hash.size(), 16U);
}

TEST_F(Recorded, WrittenAgainItIsTheSameFile) {
    const auto first = write(support::rich_recording());
    const auto second = write(*traces::read_trace(first).recording, "y.rtrace");
    EXPECT_EQ(support::bytes_in(first), support::bytes_in(second));
    EXPECT_EQ(traces::trace_faults(first), std::vector<std::string>());
    EXPECT_EQ(traces::trace_differences(first, second), std::vector<std::string>());
}

TEST_F(Recorded, IsNoScene) {
    const auto file = write(support::quad_recording());
    EXPECT_THROW(traces::load_scene(file.string()), sim::InputError);
}

std::size_t blobs_in(const std::filesystem::path& file) {
    const std::vector<Chunk> chunks = support::chunks_in(file);
    return static_cast<std::size_t>(
        std::count_if(chunks.begin(), chunks.end(), [](const Chunk& one) { return one.type == chunk::blob; }));
}

TEST_F(Recorded, EqualBytesAreStoredOnce) {
    // Two buffers, three levels, two shaders.
    Recording recording = support::quad_recording();
    EXPECT_EQ(blobs_in(write(recording)), 2U + 3U + 2U);
    recording.resources->buffers.push_back(recording.resources->buffers[0]);
    recording.surfaces.push_back(recording.surfaces[2]);
    recording.programs.push_back(recording.programs[0]);
    const traces::RecordedCommand draw = recording.frames[0].commands.back();
    for (int i = 0; i < 100; ++i) {
        recording.values.push_back({{"bones", std::vector<std::uint32_t>(1000, 5)}});
        recording.frames[0].commands.push_back(draw);
    }
    EXPECT_EQ(blobs_in(write(recording)), 2U + 3U + 2U + 1U);
}

TEST_F(Recorded, AsTextItSaysEverything) {
    const std::string text = dump(write(support::rich_recording()));
    for (const char* line :
         {"\nsurface 0: name=\"window\" kind=plane format=rgba8 width=16 height=12 depth=1 samples=1 level records=1\n",
          "\nsurface 0 level 0: contents=no\n", "\nsurface 2 level 2: contents=yes contents bytes=",
          "\nprogram 1: name=\"depths alone\" vertex shader=yes vertex shader bytes=",
          " fragment shader=no fragment instructions=0 input records=28\n",
          "\nprogram 1 input 27: variable=\"input27\" first=generic 15\n",
          "\nvalues 1 uniform 0: name=\"tint\" blob=no words=1.0,0.5,0.25,1.0\n",
          "\nvalues 2 uniform 1: name=\"count\" blob=no words=3\n",
          "\nbindings 1 texture 0: variable=\"sky\" element=0 surface=4 sampler=3 red=0 green=1 blue=alpha alpha=red "
          "base "
          "level=1 last level=2\n",
          "\ntargets 1: width=8 height=8 top row first=no depth=yes depth surface=9 depth level=0 depth plane=0 "
          "colour "
          "records=0\n",
          "\ntargets 2 colour 1: target=no\n",
          "\nframe 0 command 0: kind=clear name=\"all\" targets=0 colours=1 colour=0,0,1,1 depth=yes depth value=1 "
          "stencil=yes stencil value=0 stencil mask=255 scissor=no write mask records=0\n",
          "\nframe 1 command 100: kind=draw name=\"again\"",
          "\ncall 1: name=\"glBeginTransformFeedback\" times=1000000000000\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\nin\n" << text;
}

TEST_F(Recorded, ADifferenceIsNamedByItsPlace) {
    const auto a = write(support::rich_recording());
    Recording other = support::rich_recording();
    other.states[3].stencil.back.passes = pipeline::StencilOperation::keep;
    std::get<traces::RecordedDraw>(other.frames[1].commands[4]).base_vertex = 5;
    other.targets[0].depth.reset();
    std::get<traces::RecordedClear>(other.frames[0].commands[0]).depth.reset();
    std::get<traces::RecordedClear>(other.frames[0].commands[0]).stencil.reset();
    std::get<traces::RecordedClear>(other.frames[1].commands[0]) =
        std::get<traces::RecordedClear>(other.frames[0].commands[0]);
    for (traces::RecordedCommand& command : other.frames[0].commands)
        if (auto* const clear = std::get_if<traces::RecordedClear>(&command)) clear->stencil.reset();
    const std::vector<std::string> differences = traces::trace_differences(a, write(other, "y.rtrace"));
    const auto contains = [&](const std::string& line) {
        return std::find(differences.begin(), differences.end(), line) != differences.end();
    };
    EXPECT_TRUE(contains("state 3: back passes: invert | keep")) << ::testing::PrintToString(differences);
    EXPECT_TRUE(contains("targets 0: depth surface: 1 | nothing"));
    EXPECT_TRUE(contains("frame 1 command 4: base vertex: 0 | 5"));
    EXPECT_TRUE(contains("frame 0 command 0: depth: yes | no"));
}

TEST_F(Recorded, ShadersThatCannotRunAreFaults) {
    Recording recording = support::quad_recording();
    recording.programs[0].fragment[0] = 1;
    const std::vector<std::string> faults = traces::trace_faults(write(recording));
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_NE(faults[0].find("program 0 \"tinted\": fragment shader: SPIR-V"), std::string::npos) << faults[0];
}

void expect_refused(const std::string& expected, void (*spoil)(Recording&)) {
    Recording recording = support::rich_recording();
    spoil(recording);
    try {
        traces::check_recording(recording, "x");
        ADD_FAILURE() << "accepted: " << expected;
    } catch (const sim::InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("x: ", 0), 0U) << error.what();
        EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
}

traces::RecordedDraw& some_draw(Recording& recording) {
    return std::get<traces::RecordedDraw>(recording.frames[1].commands[1]);
}
traces::RecordedClear& some_clear(Recording& recording) {
    return std::get<traces::RecordedClear>(recording.frames[0].commands[0]);
}
traces::RecordedCopy& some_copy(Recording& recording) {
    return std::get<traces::RecordedCopy>(recording.frames[0].commands.back());
}

TEST(RecordingCheck, GoodOnesAreAccepted) {
    EXPECT_NO_THROW(traces::check_recording(support::rich_recording(), "x"));
    EXPECT_NO_THROW(traces::check_recording(support::quad_recording(), "x"));
}

TEST(RecordingCheck, SurfacesAndSamplers) {
    expect_refused("surface 0: expected 1 to 16384 x 16384 x 1 texels, got 0 x 12 x 1",
                   [](Recording& r) { r.surfaces[0].width = 0; });
    expect_refused("got 16 x 16385 x 1", [](Recording& r) { r.surfaces[0].height = 16385; });
    expect_refused("1 to 16384 x 16384 x 2048 texels", [](Recording& r) { r.surfaces[3].depth = 2049; });
    expect_refused("surface 4: expected square faces", [](Recording& r) { r.surfaces[4].width = 5; });
    expect_refused("1 sample, or of planes and layers 4 or 8, got 2", [](Recording& r) { r.surfaces[0].samples = 2; });
    expect_refused("1 sample, or of planes and layers 4 or 8, got 4", [](Recording& r) { r.surfaces[4].samples = 4; });
    expect_refused("surface 2: expected 1 to 3 levels, got 4", [](Recording& r) { r.surfaces[2].levels.resize(4); });
    expect_refused("surface 0: expected 1 to 5 levels, got 0", [](Recording& r) { r.surfaces[0].levels.clear(); });
    expect_refused("surface 2: expected 8 bytes in level 1, got 7",
                   [](Recording& r) { r.surfaces[2].levels[1] = std::vector<std::byte>(7); });
    expect_refused("sampler 1: expected an anisotropy of 1", [](Recording& r) { r.samplers[1].anisotropy = 0.5F; });
    expect_refused("magnification that is",
                   [](Recording& r) { r.samplers[1].mag_filter = pipeline::Filter::linear_mip_linear; });
}

TEST(RecordingCheck, ProgramsBindingsStatesAndTargets) {
    expect_refused("program 0: expected 5 to 1048576 words of a vertex shader, got 0",
                   [](Recording& r) { r.programs[0].vertex.clear(); });
    expect_refused("words of a fragment shader, or none, got 4",
                   [](Recording& r) { r.programs[0].fragment.resize(4); });
    expect_refused("program 1: expected one of 28 attributes, got 28",
                   [](Recording& r) { r.programs[1].inputs[0].first = 28; });
    expect_refused("surfaces, got 99", [](Recording& r) { r.bindings[1][0].surface = 99; });
    expect_refused("bindings 1 texture 1: expected one of 9 samplers, got 9",
                   [](Recording& r) { r.bindings[1][1].sampler = 9; });
    expect_refused("a base level of 3 levels", [](Recording& r) { r.bindings[1][0].base_level = 3; });
    expect_refused("state 2: expected a viewport", [](Recording& r) {
        r.states[2].viewport = pipeline::PixelRectangle{0, 0, 0, 5};
    });
    expect_refused("state 2: expected a depth range within 0 to 1, got 0 to 1.5",
                   [](Recording& r) { r.states[2].depth.range_far = 1.5F; });
    expect_refused("state 2: expected a write mask below 16", [](Recording& r) { r.states[2].write_mask[7] = 16; });
    expect_refused("targets 2: expected one of 3 levels, got 3",
                   [](Recording& r) { r.targets[2].colours[0]->level = 3; });
    expect_refused("targets 2: expected one of 6 planes, got 6",
                   [](Recording& r) { r.targets[2].colours[2]->plane = 6; });
    expect_refused("targets 0: expected colours in surface 1, got d24s8",
                   [](Recording& r) { r.targets[0].colours[0]->surface = 1; });
    expect_refused("targets 0: expected depths or stencil in surface 0, got rgba8",
                   [](Recording& r) { r.targets[0].depth->surface = 0; });
    expect_refused("a surface that is no buffer", [](Recording& r) { r.targets[0].colours[0]->surface = 6; });
    expect_refused("targets 1: expected at most the 8 x 8 texels of surface 9, got 9 x 8",
                   [](Recording& r) { r.targets[1].width = 9; });
    expect_refused("1 to 16384 x 16384 pixels, got 0 x 12", [](Recording& r) { r.targets[0].width = 0; });
    expect_refused("at most 8 colours", [](Recording& r) { r.targets[0].colours.resize(9); });
    expect_refused("4 samples as in the others, got 1", [](Recording& r) { r.targets[0].colours[0]->surface = 8; });
}

TEST(RecordingCheck, FramesAndCommands) {
    expect_refused("frame 1: expected one of 3 targets, got 3", [](Recording& r) { r.frames[1].shown = 3; });
    expect_refused("a first colour in targets 1", [](Recording& r) { r.frames[1].shown = 1; });
    expect_refused("frame 1: expected numbers of frames that grow, got 7",
                   [](Recording& r) { r.frames[1].number = 7; });
    expect_refused("frame 1 command 1: expected one of 12 geometries, got 12",
                   [](Recording& r) { some_draw(r).geometry = 12; });
    expect_refused("one of 3 targets", [](Recording& r) { some_draw(r).targets = 3; });
    expect_refused("one of 2 programs", [](Recording& r) { some_draw(r).program = 2; });
    expect_refused("one of 5 sets of values", [](Recording& r) { some_draw(r).vertex_values = 5; });
    expect_refused("one of 5 sets of values", [](Recording& r) { some_draw(r).fragment_values = 5; });
    expect_refused("one of 3 sets of bindings", [](Recording& r) { some_draw(r).bindings = 3; });
    expect_refused("one of 17 states", [](Recording& r) { some_draw(r).state = 17; });
    expect_refused("1 to 1048576 instances, got 0", [](Recording& r) { some_draw(r).instances = 0; });
    expect_refused("4 elements of an attribute with divisor 1", [](Recording& r) {
        some_draw(r).geometry = 1;
        some_draw(r).instances = 4;
    });
    expect_refused("frame 0 command 0: expected a colour 1 in targets 0",
                   [](Recording& r) { some_clear(r).colours = 2; });
    expect_refused("a depth in targets 2", [](Recording& r) { some_clear(r).targets = 2; });
    expect_refused("a stencil in targets 1", [](Recording& r) {
        some_clear(r).targets = 1;
        some_clear(r).colours = 0;
    });
    expect_refused("a rectangle within 16 x 12 texels, got 4 x 3 at (13, 2)",
                   [](Recording& r) { some_copy(r).rectangle.x = 13; });
    expect_refused("a rectangle within 5 x 4 texels, got 4 x 3 at (-1, 1)",
                   [](Recording& r) { some_copy(r).to_x = -1; });
    expect_refused("colours to colours, or depths to depths, got d24s8 to rgba8",
                   [](Recording& r) { some_copy(r).from.surface = 1; });
    expect_refused("surfaces, got 99", [](Recording& r) { some_copy(r).to.surface = 99; });
}

TEST(RecordingCheck, Geometries) {
    expect_refused("geometry 2: expected at most 16777216 vertices without an attribute",
                   [](Recording& r) { r.resources->geometries[2].vertex_count = 1U << 30U; });
    expect_refused("within 48 bytes", [](Recording& r) { r.resources->geometries[0].vertex_count = 5; });
    expect_refused("index 0 below the vertex count",
                   [](Recording& r) { r.resources->buffers[1].bytes[0] = std::byte{200}; });
}

class RecordedFile : public Recorded {
  protected:
    void SetUp() override { chunks_ = support::chunks_in(write(support::quad_recording())); }
    Chunk& chunk_of(traces::rtrace::ChunkType type) {
        return *std::find_if(chunks_.begin(), chunks_.end(), [&](const Chunk& one) { return one.type == type; });
    }
    void expect(const std::string& part) const {
        const std::string refusal = support::refusal_of(support::file_of(chunks_));
        EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
        EXPECT_NE(refusal.find("x.rtrace: "), std::string::npos) << refusal;
    }
    std::vector<Chunk> chunks_;
};

TEST_F(RecordedFile, HasAllChunksAndNoneOfACapturedFrame) {
    const std::vector<Chunk> good = chunks_;
    EXPECT_EQ(support::refusal_of(support::file_of(chunks_)), "");
    for (const auto type : {chunk::buffers, chunk::surfaces, chunk::samplers, chunk::programs, chunk::values,
                            chunk::bindings, chunk::states, chunk::targets, chunk::frames, chunk::not_recorded}) {
        chunks_ = good;
        chunks_.erase(std::find_if(chunks_.begin(), chunks_.end(), [&](const Chunk& one) { return one.type == type; }));
        const std::string refusal = support::refusal_of(support::file_of(chunks_));
        EXPECT_NE(refusal, "") << type.text();
        if (type == chunk::frames) {
            EXPECT_NE(refusal.find("expected a chunk FRAM"), std::string::npos) << refusal;
        }
    }
    chunks_ = good;
    chunks_.insert(chunks_.begin(), {chunk::cameras, Bytes(4)});
    expect("expected chunks of a captured trace, as before, got SURF");
    chunks_ = good;
    chunks_.push_back({chunk::cameras, Bytes(4)});
    expect("expected chunks of a recorded trace, as before, got CAMS");
}

TEST_F(RecordedFile, SizesOfBlobsFit) {
    Chunk& surfaces = chunk_of(chunk::surfaces);
    // The last level of the last surface: a flag, a name of 16 bytes, a size.
    std::byte* const size = &surfaces.content[surfaces.content.size() - 8];
    traces::rtrace::put_little<std::uint64_t>(size, 5);
    expect("a blob of 5 bytes for surface 2 level 2, got 4");
    traces::rtrace::put_little<std::uint64_t>(size, 4);
    EXPECT_EQ(support::refusal_of(support::file_of(chunks_)), "");
}

TEST_F(RecordedFile, ShadersAreWholeWords) {
    Bytes& programs = chunk_of(chunk::programs).content;
    // A count, a name of six letters, a flag, a name of a blob.
    traces::rtrace::put_little<std::uint64_t>(&programs[4 + 4 + 6 + 1 + 16], 7);
    expect("whole words of 4 bytes for the vertex shader of program 0, got 7 bytes");
}

TEST_F(RecordedFile, CodesAndFlagsAreThoseThatThereAre) {
    Bytes& frames = chunk_of(chunk::frames).content;
    // A count, number, shown, a count, the kind.
    frames[4 + 4 + 4 + 4] = std::byte{4};
    expect("chunk FRAM: content byte 16: frame 0 command 0 kind: expected a code below 4 (draw, clear, copy, blit), "
           "got 4");
    Bytes& targets = chunk_of(chunk::targets).content;
    targets[4 + 8] = std::byte{2};
    expect("targets 0 top row first: expected a code below 2 (no, yes), got 2");
}

} // namespace recording_test
