// Comparisons as text, and what is to be said of all of them.
#include "tests/replay_oracle/comparison.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace replay_oracle {

namespace {

std::string text_of(const Pair& pair) {
    return pair.equal() ? fmt::format("{}", pair.own) : fmt::format("{}!={}", pair.own, pair.mesa);
}

std::string text_of(const Pictures& pictures) {
    return pictures.count == 0
               ? "-"
               : fmt::format("{}: {:.2f}, {:.2f}", pictures.count, 100 * pictures.least, 100 * pictures.mean());
}

std::string row(const auto&... cells) {
    return fmt::format(
        "{:<22} {:>3} {:>6} {:>9} {:>9} {:>21}  {:>6} {:>5} {:>5} {:>5} {:>5}  {:>8} {:>9} {:>5}  {:>18} "
        "{:>20}\n",
        cells...);
}

std::string row_of(const Comparison& one) {
    const SampleAgreement& agreement = one.agreement;
    return row(one.name, one.frames, text_of(one.draws), text_of(one.vertices), text_of(one.primitives),
               fmt::format("{}/{}", one.samples.own, one.samples.mesa), agreement.equal, agreement.near,
               agreement.clipped, agreement.apart, agreement.not_drawn, fmt::format("{:.1e}", one.worst_position),
               one.positions, one.calls_without_positions, text_of(one.of_frames), text_of(one.of_draws));
}

/// As if all were one program.
Comparison sum_of(const std::vector<Comparison>& programs) {
    Comparison sum;
    sum.name = "all";
    const auto add_pictures = [](Pictures& to, const Pictures& from) {
        to.count += from.count;
        to.sum += from.sum;
        to.least = std::min(to.least, from.least);
    };
    for (const Comparison& one : programs) {
        sum.frames += one.frames;
        sum.draws += one.draws;
        sum.vertices += one.vertices;
        sum.primitives += one.primitives;
        sum.samples += one.samples;
        sum.agreement.equal += one.agreement.equal;
        sum.agreement.near += one.agreement.near;
        sum.agreement.clipped += one.agreement.clipped;
        sum.agreement.apart += one.agreement.apart;
        sum.agreement.not_drawn += one.agreement.not_drawn;
        sum.worst_position = std::max(sum.worst_position, one.worst_position);
        sum.positions += one.positions;
        sum.calls_without_positions += one.calls_without_positions;
        add_pictures(sum.of_frames, one.of_frames);
        add_pictures(sum.of_draws, one.of_draws);
    }
    return sum;
}

} // namespace

std::vector<std::string> faults_of(const std::vector<Comparison>& programs) {
    std::vector<std::string> faults;
    for (const Comparison& one : programs)
        for (const std::string& fault : one.faults) faults.push_back(fmt::format("{}: {}", one.name, fault));
    const SampleAgreement all = sum_of(programs).agreement;
    if (static_cast<double>(all.clipped) > limits::clipped_calls * static_cast<double>(all.all()))
        faults.push_back(fmt::format("{} of {} calls agree in samples only once they are clipped alike; expected {} % "
                                     "at most",
                                     all.clipped, all.all(), 100 * limits::clipped_calls));
    return faults;
}

std::string table_of(const std::vector<Comparison>& programs) {
    std::string text = fmt::format("{:<59}{:<24}{:<32}{:<26}{}\n", "", "samples passed", "calls by samples passed",
                                   "positions", "pixels within 8/255 [%]");
    text += row("program", "fr.", "draws", "vertices", "primit.", "own/Mesa", "equal", "1 %", "clip", "apart", "none",
                "worst", "compared", "none", "frames: worst,mean", "draws: worst,mean");
    for (const Comparison& one : programs) text += row_of(one);
    if (programs.size() > 1) text += row_of(sum_of(programs));
    return text;
}

} // namespace replay_oracle
