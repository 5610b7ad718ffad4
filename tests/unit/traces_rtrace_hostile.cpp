// Draw traces that nobody wrote: cut off, with flipped bits, or whole and lying. Each is one line that says where what
// was expected, or the identical trace.
#include "sim/check.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/trace_files.hpp"
#include "traces/rtrace/chunk_reader.hpp"
#include "traces/rtrace/little_endian.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <limits>
#include <sys/resource.h>
#include <zstd.h>

namespace rtrace_hostile_test {

namespace rtrace = traces::rtrace;
using ropsim_test::TemporaryFolder;
using support::Bytes;
using support::Chunk;

traces::Trace recorded() { return support::recorded_trace(support::rich_recording()); }

Bytes good_file(const traces::Trace& trace = support::rich_trace()) {
    const TemporaryFolder folder;
    traces::write_trace(trace, folder.path() / "x.rtrace");
    return support::bytes_in(folder.path() / "x.rtrace");
}

std::vector<Chunk> good_chunks(const traces::Trace& trace = support::rich_trace()) {
    const TemporaryFolder folder;
    traces::write_trace(trace, folder.path() / "x.rtrace");
    return support::chunks_in(folder.path() / "x.rtrace");
}

std::string text_of(const std::filesystem::path& file) {
    std::string text;
    for (const traces::TraceLine& line : traces::dump_trace(file)) text += line.text() + "\n";
    return text;
}

/// One line with the file, or the same as ever.
void expect_refusal_or(const std::string& good, const Bytes& bytes, const std::filesystem::path& file) {
    support::write_bytes(file, bytes);
    try {
        EXPECT_EQ(text_of(file), good);
    } catch (const sim::InputError& error) {
        const std::string line = error.what();
        EXPECT_TRUE(line.starts_with(file.string() + ": byte ") && line.find("expected") != std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
}

void cut_everywhere(const Bytes& file, std::size_t step) {
    const TemporaryFolder folder;
    for (std::size_t bytes = 0; bytes < file.size(); bytes += step) {
        const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(bytes));
        const std::string refusal = support::refusal_of(cut);
        ASSERT_NE(refusal, "") << bytes;
        ASSERT_NE(refusal.find("x.rtrace: byte "), std::string::npos) << refusal;
    }
}

void flip_everywhere(const Bytes& file, std::size_t step) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "x.rtrace";
    support::write_bytes(path, file);
    const std::string good = text_of(path);
    for (std::size_t bit = 0; bit < file.size() * 8; bit += step) {
        Bytes flipped = file;
        flipped[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
        expect_refusal_or(good, flipped, path);
    }
}

TEST(RtraceHostile, CutOffAnywhereItIsRefused) { cut_everywhere(good_file(), tests::sanitized ? 97 : 7); }
TEST(RtraceHostile, LongCutOffAtEveryByte) { cut_everywhere(good_file(), 1); }
TEST(RtraceHostile, AFlippedBitIsFoundOrChangesNothing) { flip_everywhere(good_file(), tests::sanitized ? 1009 : 101); }
TEST(RtraceHostile, LongEveryBitFlipped) { flip_everywhere(good_file(), 1); }

TEST(RtraceHostile, RecordedCutOffAnywhereItIsRefused) {
    cut_everywhere(good_file(recorded()), tests::sanitized ? 503 : 37);
}
TEST(RtraceHostile, LongRecordedCutOffAtEveryByte) { cut_everywhere(good_file(recorded()), 1); }
TEST(RtraceHostile, RecordedAFlippedBitIsFoundOrChangesNothing) {
    flip_everywhere(good_file(recorded()), tests::sanitized ? 5003 : 503);
}
TEST(RtraceHostile, LongRecordedEveryBitFlipped) { flip_everywhere(good_file(recorded()), 1); }

TEST(RtraceHostile, HeadsThatLieAreRefusedByPlace) {
    const Bytes file = good_file();
    const auto with = [&file](std::size_t at, std::uint8_t value) {
        Bytes other = file;
        other[at] = std::byte{value};
        return support::refusal_of(other);
    };
    EXPECT_NE(with(0, 0x09).find("byte 0: expected the magic"), std::string::npos);
    EXPECT_NE(with(8, 2).find("byte 8: expected version 1, got 2"), std::string::npos);
    EXPECT_NE(with(12, 1).find("byte 12: expected 4 bytes of 0"), std::string::npos);
    EXPECT_NE(with(16, 'N').find("byte 16: expected the head of a chunk whose check holds"), std::string::npos);
    Bytes longer = file;
    longer.push_back(std::byte{0});
    EXPECT_NE(support::refusal_of(longer).find("expected the end of the file"), std::string::npos);
}

/// `file_of` with sizes of our own in the head of the first chunk.
Bytes with_sizes(std::uint64_t content, std::uint64_t stored, std::uint32_t flags, const Bytes& bytes) {
    Bytes file = support::file_of({});
    file.resize(rtrace::file_head_bytes);
    rtrace::ChunkHead head;
    head.type = rtrace::chunk::metadata;
    head.flags = flags;
    head.content_bytes = content;
    head.stored_bytes = stored;
    const auto lies = rtrace::bytes_of(head);
    file.insert(file.end(), lies.begin(), lies.end());
    file.insert(file.end(), bytes.begin(), bytes.end());
    return file;
}

TEST(RtraceHostile, SizesAreHeldAgainstTheFileBeforeMemoryIsAskedFor) {
    rusage before{};
    ::getrusage(RUSAGE_SELF, &before);
    constexpr std::uint64_t huge = std::uint64_t{1} << 62U;
    EXPECT_NE(support::refusal_of(with_sizes(huge, huge, 1, Bytes(10))).find("at most the 10 bytes that are left"),
              std::string::npos);
    EXPECT_NE(support::refusal_of(with_sizes(huge, 10, 1, Bytes(10))).find("10 bytes of content"), std::string::npos);
    EXPECT_NE(support::refusal_of(with_sizes(huge, 10, 3, Bytes(10))).find("at most 268440"), std::string::npos);
    // A bomb: 1 GiB of zeros in some 33 kB.
    const std::size_t most = std::size_t{1} << 30U;
    Bytes bomb(ZSTD_compressBound(1U << 20U));
    const Bytes zeros(1U << 20U);
    const auto cctx = std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)>(ZSTD_createCCtx(), ZSTD_freeCCtx);
    ZSTD_outBuffer out{bomb.data(), bomb.size(), 0};
    for (std::size_t i = 0; i < most / zeros.size(); ++i) {
        ZSTD_inBuffer in{zeros.data(), zeros.size(), 0};
        while (in.pos < in.size) ZSTD_compressStream2(cctx.get(), &out, &in, ZSTD_e_continue);
    }
    ZSTD_inBuffer nothing{nullptr, 0, 0};
    ASSERT_EQ(ZSTD_compressStream2(cctx.get(), &out, &nothing, ZSTD_e_end), 0U);
    bomb.resize(out.pos);
    EXPECT_LT(bomb.size(), 100'000U);
    EXPECT_NE(support::refusal_of(with_sizes(most, bomb.size(), 3, bomb)).find("bytes of content in the first"),
              std::string::npos);
    // A frame that holds more than it is said to is not read to its end, one that holds less is not waited for.
    EXPECT_NE(support::refusal_of(with_sizes(1000, bomb.size(), 3, bomb)).find("one zstd frame of 1000 bytes"),
              std::string::npos);
    Bytes small(1000);
    small.resize(ZSTD_compress(small.data(), small.size(), zeros.data(), 500, 3));
    EXPECT_NE(
        support::refusal_of(with_sizes(200'000'000, small.size(), 3, small)).find("one zstd frame of 200000000 bytes"),
        std::string::npos);
    rusage after{};
    ::getrusage(RUSAGE_SELF, &after);
    constexpr long most_kib = tests::sanitized ? 1024 * 1024 : 32 * 1024;
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, most_kib);
}

TEST(RtraceHostile, CountsThatCannotBeAreRefused) {
    // The count of each list at the beginning of its chunk.
    const auto expect_refusals = [](const std::vector<Chunk>& good, std::initializer_list<rtrace::ChunkType> types) {
        for (const rtrace::ChunkType type : types) {
            std::vector<Chunk> chunks = good;
            const auto chunk =
                std::find_if(chunks.begin(), chunks.end(), [&](const Chunk& one) { return one.type == type; });
            rtrace::put_little<std::uint32_t>(chunk->content.data(), 0xFFFFFFFF);
            const std::string refusal = support::refusal_of(support::file_of(chunks));
            EXPECT_NE(refusal.find("records in the bytes that are left, got 4294967295"), std::string::npos)
                << type.text() << refusal;
        }
    };
    using namespace rtrace::chunk;
    expect_refusals(good_chunks(), {buffers, geometries, textures, materials, draws, cameras, lights});
    expect_refusals(good_chunks(recorded()), {buffers, geometries, surfaces, samplers, programs, values, bindings,
                                              states, targets, frames, not_recorded});
}

void words_anywhere(const std::vector<Chunk>& good, std::size_t step) {
    constexpr std::array<std::uint32_t, 6> words{0,      1,          0x7F,
                                                 0xFFFF, 0x7FC00000, 0xFFFFFFFF}; // the fifth as a float: not a number
    std::size_t refused = 0, read = 0;
    for (std::size_t i = 0; i < good.size(); ++i)
        for (std::size_t at = 0; good[i].type != rtrace::chunk::blob && at + 4 <= good[i].content.size(); at += step)
            for (const std::uint32_t word : words) {
                std::vector<Chunk> chunks = good;
                rtrace::put_little(&chunks[i].content[at], word);
                const std::string refusal = support::refusal_of(support::file_of(chunks));
                EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
                ++(refusal.empty() ? read : refused);
            }
    EXPECT_GT(refused, 50U);
    EXPECT_GT(read, 5U); // a colour may be any
}

TEST(RtraceHostile, AnyWordOfATableMayBeAnything) { words_anywhere(good_chunks(), tests::sanitized ? 97 : 19); }
TEST(RtraceHostile, LongEveryWordOfEveryTableMayBeAnything) { words_anywhere(good_chunks(), 1); }
TEST(RtraceHostile, RecordedAnyWordOfATableMayBeAnything) {
    words_anywhere(good_chunks(recorded()), tests::sanitized ? 997 : 199);
}
TEST(RtraceHostile, LongRecordedManyWordsOfEveryTableMayBeAnything) { words_anywhere(good_chunks(recorded()), 5); }

class Lie : public ::testing::Test {
  protected:
    static std::string refusal(void (*change)(traces::Trace&)) {
        const TemporaryFolder folder;
        traces::Trace trace = support::rich_trace();
        change(trace);
        traces::write_trace(trace, folder.path() / "x.rtrace");
        return support::refusal_of(support::bytes_in(folder.path() / "x.rtrace"));
    }
    static void expect(const std::string& refusal, const std::string& part) {
        EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
    }
};

TEST_F(Lie, OfOnePartAboutAnother) {
    expect(refusal([](traces::Trace& t) { t.scene.resources->geometries[0].index_buffer = 9; }),
           "geometry 0 \"strip\": expected an index buffer below 5, not 9");
    expect(refusal([](traces::Trace& t) { t.scene.resources->geometries[1].vertex_count = 1'000'000'000; }),
           "within 80 bytes");
    expect(refusal([](traces::Trace& t) { t.scene.resources->materials[0].base_texture = 7; }), "a base texture of -1");
    expect(refusal([](traces::Trace& t) { t.scene.resources->textures[0].levels[1].width = 3; }),
           "expected 12 bytes for 3x1 texels in level 1");
    expect(refusal([](traces::Trace& t) { t.frame.workload = "transparncy"; }), "expected one of");
    expect(refusal([](traces::Trace& t) { t.frame.parameters = R"({"kk":3})"; }), "unknown key 'kk'");
    expect(refusal([](traces::Trace& t) { t.frame.parameters = "[1"; }), "expected a JSON object");
    expect(refusal([](traces::Trace& t) { t.frame.parameters = R"({"program":"secret.kb"})"; }),
           "expected a program's text, got the name of a file, 'secret.kb'");
}

TEST_F(Lie, OfInstances) {
    std::vector<Chunk> chunks = good_chunks();
    const auto geometries = std::find_if(chunks.begin(), chunks.end(),
                                         [](const Chunk& one) { return one.type == rtrace::chunk::geometries; });
    // The last attribute's divisor ends the chunk; six instances, four elements.
    rtrace::put_little<std::uint32_t>(&geometries->content[geometries->content.size() - 4], 1);
    expect(support::refusal_of(support::file_of(chunks)), "draw 1: expected 6 elements of an attribute with divisor 1");
    // Of the position, whose buffer would not bound the vertices any more.
    rtrace::put_little<std::uint32_t>(&geometries->content[geometries->content.size() - 4 - 2 * 24], 1);
    expect(support::refusal_of(support::file_of(chunks)), "geometry 1: expected a position of every vertex");
}

TEST_F(Lie, OfBlobs) {
    std::vector<Chunk> chunks = good_chunks();
    const Chunk last = chunks.back();
    chunks.pop_back();
    expect(support::refusal_of(support::file_of(chunks)),
           "which the matrices of draw 1 names, got the end of the file");
    chunks.push_back(last);
    chunks.push_back(last);
    expect(support::refusal_of(support::file_of(chunks)), "each blob once");
    chunks.pop_back();
    chunks.insert(chunks.begin(), last);
    expect(support::refusal_of(support::file_of(chunks)), "behind this chunk");
    chunks = good_chunks();
    chunks.push_back(chunks[0]);
    expect(support::refusal_of(support::file_of(chunks)), "expected one chunk META, got a second");
    chunks = good_chunks();
    chunks.erase(chunks.begin() + 3);
    expect(support::refusal_of(support::file_of(chunks)), "expected a chunk GEOM");
    // Not a number in a matrix.
    chunks = good_chunks();
    const auto old = rtrace::name_of(chunks.back().content);
    rtrace::put_little(&chunks.back().content[64],
                       std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()));
    const auto renamed = rtrace::name_of(chunks.back().content);
    const auto draws =
        std::find_if(chunks.begin(), chunks.end(), [](const Chunk& one) { return one.type == rtrace::chunk::draws; });
    const auto named =
        std::search(draws->content.begin(), draws->content.end(), std::as_bytes(std::span(old.bytes)).begin(),
                    std::as_bytes(std::span(old.bytes)).end());
    ASSERT_NE(named, draws->content.end());
    std::ranges::copy(std::as_bytes(std::span(renamed.bytes)), named);
    expect(support::refusal_of(support::file_of(chunks)), "expected finite numbers in matrix 1 of draw 1");
}

TEST_F(Lie, ABlobThatIsNamedAgainAndAgainIsBounded) {
    // Refused by the table alone: 20 buffers without name, all of the same 100 MB.
    Bytes table(4 + 20 * 28);
    rtrace::put_little<std::uint32_t>(table.data(), 20);
    for (std::size_t i = 0; i < 20; ++i) rtrace::put_little<std::uint64_t>(&table[4 + i * 28 + 20], 100'000'000);
    std::vector<Chunk> chunks = good_chunks();
    std::find_if(chunks.begin(), chunks.end(), [](const Chunk& one) {
        return one.type == rtrace::chunk::buffers;
    })->content = table;
    expect(support::refusal_of(support::file_of(chunks)), "bytes in blobs that are used again, got 100000000 more");
}

TEST_F(Lie, LongWhatCouldNotBeReadIsNotWritten) {
    traces::Trace trace = support::rich_trace();
    auto& buffers = trace.scene.resources->buffers;
    buffers[4].bytes.resize(40U << 20U); // zeros: a few kB in the file
    for (int i = 0; i < 8; ++i) buffers.push_back(buffers[4]);
    const TemporaryFolder folder;
    try {
        traces::write_trace(trace, folder.path() / "x.rtrace");
        ADD_FAILURE();
    } catch (const sim::InputError& error) {
        expect(error.what(), "bytes of equal buffers, textures and matrices");
    }
}

TEST(RtraceHostile, ValidationNamesEveryFault) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "x.rtrace";
    traces::write_trace(support::rich_trace(), path);
    Bytes file = support::bytes_in(path);
    rtrace::ChunkReader reader(path);
    std::vector<rtrace::ChunkHead> heads;
    while (const auto head = reader.next()) heads.push_back(*head);
    for (const std::size_t i : {std::size_t{3}, heads.size() - 2})
        file[heads[i].offset + rtrace::chunk_head_bytes + 5] ^= std::byte{0x10};
    support::write_bytes(path, file);
    const std::vector<std::string> faults = traces::trace_faults(path);
    ASSERT_EQ(faults.size(), 2U) << ::testing::PrintToString(faults);
    EXPECT_NE(faults[0].find(fmt::format("byte {}", heads[3].offset + rtrace::chunk_head_bytes)), std::string::npos);
    EXPECT_NE(faults[1].find(fmt::format("byte {}", heads[heads.size() - 2].offset + rtrace::chunk_head_bytes)),
              std::string::npos);
}

} // namespace rtrace_hostile_test
