#include "tests/replay_oracle/comparison.hpp"

#include "sim/check.hpp"
#include "tests/replay_oracle/own_replay.hpp"
#include "traces/recording/record_program.hpp"
#include "traces/recording/recording_check.hpp"

#include <GL/gl.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace replay_oracle {

namespace {

/// Indices as the program gave them, where they were made into lists of triangles.
std::uint64_t submitted_vertices(const OwnFrame& own, std::size_t draw, std::uint32_t mode) {
    const std::uint64_t vertices = own.vertices(draw);
    if (own.geometry(draw).topology != pipeline::Topology::triangles) return vertices;
    const std::uint64_t instances = own.recorded(draw).instances;
    if (mode == GL_QUADS) return vertices / 6 * 4;
    if (mode == GL_QUAD_STRIP) return vertices / 6 * 2 + 2 * instances;
    if (mode == GL_POLYGON) return vertices / 3 + 2 * instances;
    return vertices;
}

bool has_whole_primitives(std::uint32_t mode) {
    return mode == GL_QUADS || mode == GL_QUAD_STRIP || mode == GL_POLYGON;
}

/// Primitives of the vertices of a draw without restarts (OpenGL 2.1, section 2.6.1): quads and polygons as triangles,
/// or each for one.
std::uint64_t primitives_of_draw(const SubmittedDraw& draw, bool whole) {
    const auto vertices = static_cast<std::uint64_t>(std::max<std::int64_t>(draw.vertices, 0));
    const auto beyond = [vertices](std::uint64_t fewer) { return vertices > fewer ? vertices - fewer : 0; };
    switch (draw.mode) {
    case GL_POINTS:
        return vertices;
    case GL_LINES:
        return vertices / 2;
    case GL_LINE_STRIP:
        return beyond(1);
    case GL_LINE_LOOP:
        return vertices < 2 ? 0 : vertices;
    case GL_TRIANGLES:
        return vertices / 3;
    case GL_QUADS:
        return vertices / 4 * (whole ? 1 : 2);
    case GL_QUAD_STRIP:
        return beyond(2) / 2 * (whole ? 1 : 2);
    case GL_POLYGON:
        return whole ? std::min<std::uint64_t>(beyond(2), 1) : beyond(2);
    default:
        return beyond(2);
    }
}

/// Distance as a share of the largest component.
double position_error(const glm::vec4& own, const glm::vec4& mesa) {
    double largest = std::numeric_limits<double>::min(), distance = 0.0;
    for (int c = 0; c < 4; ++c) {
        largest = std::max(largest, std::abs(static_cast<double>(mesa[c])));
        distance = std::max(distance, std::abs(static_cast<double>(own[c]) - static_cast<double>(mesa[c])));
    }
    return std::isfinite(distance) ? distance / largest : 1.0;
}

double worst_in_order(const std::vector<glm::vec4>& own, const std::vector<glm::vec4>& mesa) {
    double worst = 0.0;
    for (std::size_t i = 0; i < mesa.size(); ++i) worst = std::max(worst, position_error(own[i], mesa[i]));
    return worst;
}

/// Of the one that is farthest from the nearest own one.
double worst_to_nearest(const std::vector<glm::vec4>& own, const std::vector<glm::vec4>& mesa) {
    double worst = 0.0;
    for (const glm::vec4& position : mesa) {
        double nearest = std::numeric_limits<double>::max();
        for (const glm::vec4& one : own) nearest = std::min(nearest, position_error(one, position));
        worst = std::max(worst, nearest);
    }
    return worst;
}

constexpr std::size_t most_pairs = 100'000'000; ///< of positions, whose distances are worth their time

class FrameComparison {
  public:
    FrameComparison(const traces::Recording& recording, std::uint32_t frame, const MesaFrame& mesa,
                    const ComparisonOptions& options, Comparison& result)
        : number_(recording.frames[frame].number),
          own_(recording, frame),
          mesa_(mesa),
          options_(options),
          result_(result) {}

    void run() {
        std::size_t draws = 0;
        for (const MesaCall& call : mesa_.calls) draws += call.draws.size();
        in_step_ = draws == own_.draws();
        result_.draws += {draws, own_.draws()};
        if (!in_step_) fault(fmt::format("{} draws, Mesa {}", own_.draws(), draws));
        std::size_t next = 0;
        for (const MesaCall& call : mesa_.calls) {
            if (!matches(call, next)) {
                fault(fmt::format("{} of {} draws: not among the recorded ones", call.name, call.draws.size()));
                continue;
            }
            first_ = next;
            next += call.draws.size();
            compare(call);
        }
        ++result_.frames;
        if (!mesa_.shown) return;
        const double share = compare_pictures(own_.shown(), *mesa_.shown, fmt::format("frame{}", number_));
        result_.of_frames.add(share);
        if (share < limits::pixels) fault(fmt::format("{:.2f} % of its pixels agree", 100 * share));
    }

  private:
    void fault(const std::string& what) { result_.faults.push_back(fmt::format("frame {}: {}", number_, what)); }
    void fault_of_call(const MesaCall& call, const std::string& what) {
        const std::size_t last = first_ + call.draws.size() - 1;
        const std::string draws =
            last == first_ ? fmt::format("draw {}", first_) : fmt::format("draws {} to {}", first_, last);
        fault(fmt::format("{} ({}, program {}): {}", draws, call.name, own_.recorded(first_).program, what));
    }

    /// Where both sides have as many draws, they come in the same order; else vertices tell which one is missing.
    bool matches(const MesaCall& call, std::size_t next) const {
        if (next + call.draws.size() > own_.draws()) return false;
        for (std::size_t i = 0; i < call.draws.size() && !in_step_; ++i)
            if (static_cast<std::int64_t>(submitted_vertices(own_, next + i, call.draws[i].mode)) !=
                call.draws[i].vertices)
                return false;
        return true;
    }

    void compare(const MesaCall& call) {
        compare_vertices(call);
        compare_primitives(call);
        compare_positions(call);
        compare_samples(call);
        if (!call.picture) return;
        const auto own = own_.picture();
        if (!own) return;
        const double share = compare_pictures(*own, *call.picture,
                                              fmt::format("frame{}_draw{}", number_, first_ + call.draws.size() - 1));
        result_.of_draws.add(share);
        if (share < limits::pixels)
            fault_of_call(call, fmt::format("{:.2f} % of the pixels behind it agree", 100 * share));
    }

    void compare_vertices(const MesaCall& call) {
        Pair sum;
        for (std::size_t i = 0; i < call.draws.size(); ++i) {
            const std::int64_t known = call.draws[i].vertices;
            const std::uint64_t own = submitted_vertices(own_, first_ + i, call.draws[i].mode);
            const Pair pair{static_cast<std::uint64_t>(known < 0 ? call.vertices : known), own};
            if (known >= 0 && !pair.equal())
                fault_of_call(call, fmt::format("{} vertices, Mesa {}", pair.own, pair.mesa));
            sum += pair;
        }
        result_.vertices += sum;
        // Of lists Mesa makes other primitives.
        if (!call.is_list() && call.vertices != static_cast<std::int64_t>(sum.mesa))
            fault_of_call(call, fmt::format("{} vertices, Mesa's counter says {}", sum.own, call.vertices));
    }

    // What Mesa compiles into a list has primitives more.
    void compare_primitives(const MesaCall& call) {
        std::uint64_t own = 0, whole = 0, submitted = 0;
        bool has_whole = false;
        for (std::size_t i = 0; i < call.draws.size(); ++i) {
            const SubmittedDraw& draw = call.draws[i];
            const std::uint64_t triangles = own_.primitives(first_ + i);
            own += triangles;
            has_whole = has_whole || has_whole_primitives(draw.mode);
            whole += has_whole_primitives(draw.mode) ? primitives_of_draw(draw, true) : triangles;
            submitted += primitives_of_draw(draw, false);
        }
        auto mesa = static_cast<std::uint64_t>(std::max<std::int64_t>(call.primitives, 0));
        if (call.is_list() || (has_whole && mesa == whole)) mesa = submitted;
        result_.primitives += {mesa, own};
        if (own != mesa) fault_of_call(call, fmt::format("{} primitives, Mesa {}", own, mesa));
    }

    // Of lists, and of quads, both sides make triangles in their own ways: what can be compared is which positions
    // there are.
    void compare_positions(const MesaCall& call) {
        std::vector<glm::vec4> own;
        for (std::size_t i = 0; i < call.draws.size() && !call.positions.empty(); ++i) {
            const std::vector<glm::vec4> of_draw = own_.positions(first_ + i);
            own.insert(own.end(), of_draw.begin(), of_draw.end());
        }
        const bool ordered = !call.is_list() && !has_whole_primitives(call.draws.front().mode);
        if (call.positions.empty() || (!ordered && own.size() > most_pairs / call.positions.size())) {
            ++result_.calls_without_positions;
            return;
        }
        if (ordered && own.size() != call.positions.size()) {
            fault_of_call(call, fmt::format("{} positions, Mesa {}", own.size(), call.positions.size()));
            return;
        }
        const double worst = ordered ? worst_in_order(own, call.positions) : worst_to_nearest(own, call.positions);
        result_.positions += call.positions.size();
        result_.worst_position = std::max(result_.worst_position, worst);
        if (worst > limits::position) fault_of_call(call, fmt::format("a position is {:.1e} apart", worst));
    }

    void compare_samples(const MesaCall& call) {
        std::uint64_t samples = 0, clipped = 0;
        for (std::size_t i = 0; i < call.draws.size(); ++i) {
            const auto of_draw = own_.execute(first_ + i);
            if (!of_draw) {
                ++result_.agreement.not_drawn;
                return;
            }
            samples += *of_draw;
            if (call.draws.size() > 1) clipped += own_.samples_clipped_at_sides();
        }
        const Pair pair{static_cast<std::uint64_t>(std::max<std::int64_t>(call.samples, 0)), samples};
        result_.samples += pair;
        const double apart =
            std::abs(static_cast<double>(pair.own) - static_cast<double>(pair.mesa)) / static_cast<double>(pair.mesa);
        if (pair.equal()) {
            ++result_.agreement.equal;
        } else if (apart <= limits::samples) {
            ++result_.agreement.near;
        } else {
            if (call.draws.size() == 1) clipped = own_.samples_clipped_at_sides();
            ++(clipped == pair.mesa ? result_.agreement.clipped : result_.agreement.apart);
            if (clipped != pair.mesa)
                fault_of_call(call, fmt::format("{} samples passed, Mesa {}; clipped at the sides {}", pair.own,
                                                pair.mesa, clipped));
        }
    }

    double compare_pictures(const Picture& own, const Picture& mesa, const std::string& name) const {
        const double share = share_within(own, mesa, limits::codes);
        if (share < limits::pixels && !options_.folder_for_faults.empty()) {
            const auto file = [&](const char* side) {
                return options_.folder_for_faults / fmt::format("{}_{}_{}.ppm", result_.name, name, side);
            };
            write_picture(own, file("own"));
            write_picture(mesa, file("mesa"));
        }
        return share;
    }

    std::uint32_t number_; ///< of the program's frames
    OwnFrame own_;
    const MesaFrame& mesa_;
    const ComparisonOptions& options_;
    Comparison& result_;
    bool in_step_ = false;
    std::size_t first_ = 0; ///< draw of the call that is compared
};

std::uint32_t draws_of(const traces::RecordedFrame& frame) {
    return static_cast<std::uint32_t>(
        std::count_if(frame.commands.begin(), frame.commands.end(), [](const traces::RecordedCommand& command) {
            return std::holds_alternative<traces::RecordedDraw>(command);
        }));
}

} // namespace

Comparison compare(const std::string& name, const std::filesystem::path& trace, const ComparisonOptions& options) {
    const std::atomic<bool> stop{false};
    traces::RecordRequest request;
    request.first = options.first;
    request.end = options.end;
    request.isotropic = true;
    const traces::Recording recording = traces::record_apitrace(trace, request, stop).recording;
    traces::check_recording(recording, name);

    MesaRequest mesa;
    mesa.trace = trace;
    mesa.first = recording.frames.front().number;
    for (const traces::RecordedFrame& frame : recording.frames) {
        const std::uint32_t most = std::max(options.pictures_of_frame, 1U);
        mesa.strides.push_back(options.pictures_of_frame == 0 ? 0 : std::max(1U, (draws_of(frame) + most - 1) / most));
    }
    const std::vector<MesaFrame> frames = replay_by_mesa(mesa);

    Comparison result;
    result.name = name;
    for (const traces::NotRecorded& one : recording.not_recorded)
        result.notes.push_back(fmt::format("not recorded: {}, {} times", one.call, one.times));
    for (std::uint32_t i = 0; i < recording.frames.size(); ++i) {
        CHECK(recording.frames[i].number == mesa.first + i);
        try {
            FrameComparison(recording, i, frames[i], options, result).run();
        } catch (const sim::InputError& error) {
            result.faults.push_back(fmt::format("frame {}: {}", recording.frames[i].number, error.what()));
        }
    }
    return result;
}

} // namespace replay_oracle
