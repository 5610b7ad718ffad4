// A replay beside Mesa's: what has to be equal, what may differ by how much, and what did.
#pragma once

#include "tests/replay_oracle/mesa_replay.hpp"
#include "traces/recording/recording.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace replay_oracle {

namespace limits {

inline constexpr double samples = 0.01;       ///< of Mesa's, that a call may differ by
inline constexpr double clipped_calls = 0.02; ///< share of all calls that agree only when both sides clip alike
inline constexpr double position = 1e-4;      ///< of the largest component of the position
inline constexpr int codes = 8;               ///< of 255, that a channel of a pixel may differ by
inline constexpr double pixels = 0.99;        ///< share of those that may not differ by more

} // namespace limits

/// A number of both sides.
struct Pair {
    std::uint64_t mesa = 0, own = 0;

    bool equal() const { return mesa == own; }
    void operator+=(const Pair& other) {
        mesa += other.mesa;
        own += other.own;
    }
};

/// Pictures by the share of their pixels that agree.
struct Pictures {
    std::uint64_t count = 0;
    double least = 1.0, sum = 0.0;

    void add(double share) {
        ++count;
        least = share < least ? share : least;
        sum += share;
    }
    double mean() const { return count == 0 ? 1.0 : sum / static_cast<double>(count); }
};

/// Calls by how well their samples agree.
struct SampleAgreement {
    std::uint64_t equal = 0;
    std::uint64_t near = 0;    ///< within limits::samples
    std::uint64_t clipped = 0; ///< equal once clipped at the sides of the view volume, as Mesa clips
    std::uint64_t apart = 0;
    std::uint64_t not_drawn = 0; ///< left out of the frame, as nobody reads what they draw to

    std::uint64_t all() const { return equal + near + clipped + apart + not_drawn; }
};

struct Comparison {
    std::string name;
    std::uint64_t frames = 0;
    Pair draws, vertices, primitives;
    Pair samples; ///< of calls that both sides drew
    SampleAgreement agreement;
    double worst_position = 0.0; ///< share of the position's largest component
    std::uint64_t positions = 0; ///< compared
    std::uint64_t calls_without_positions = 0;
    Pictures of_frames, of_draws;
    std::vector<std::string> faults; ///< a line for each thing that is not as it has to be
    std::vector<std::string> notes;
};

struct ComparisonOptions {
    std::uint32_t first = 0, end = 3;        ///< frames of the program
    std::uint32_t pictures_of_frame = 40;    ///< at most, behind draws, evenly spaced
    std::filesystem::path folder_for_faults; ///< gets the pictures that differ; empty: nothing
};

/// Imports the file, replays the frames, lets glretrace replay them, and compares. Throws sim::InputError for what is
/// missing or cannot be played or drawn.
Comparison compare(const std::string& name, const std::filesystem::path& trace, const ComparisonOptions& options);

/// The faults of the whole: those of each program, and those of limits over all calls.
std::vector<std::string> faults_of(const std::vector<Comparison>& programs);

/// A row for each program.
std::string table_of(const std::vector<Comparison>& programs);

} // namespace replay_oracle
