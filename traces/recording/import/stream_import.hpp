// Records, one after the other, to the parts of a recording.
#pragma once

#include "traces/recording/import/geometry.hpp"
#include "traces/recording/import/import.hpp"
#include "traces/recording/import/programs.hpp"
#include "traces/recording/import/stream_reader.hpp"
#include "traces/recording/import/surfaces.hpp"

#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace traces::recorded {

/// Parts of a recording by what they were made of.
template <class Part>
class Pool {
  public:
    explicit Pool(std::vector<Part>& parts) : parts_(parts) {}
    template <class Make>
    std::uint32_t number(std::string key, Make make) {
        const auto [place, is_new] = known_.try_emplace(std::move(key), static_cast<std::uint32_t>(parts_.size()));
        if (is_new) parts_.push_back(make());
        return place->second;
    }

  private:
    std::vector<Part>& parts_;
    std::unordered_map<std::string, std::uint32_t> known_;
};

/// Takes a stream from its first record to the last.
class StreamImport {
  public:
    explicit StreamImport(std::span<const std::byte> bytes) : bytes_(bytes) {}

    ImportedStream run();

  private:
    /// As a record has it, and as the recording does.
    struct KnownSurface {
        std::int32_t number = -1; ///< of Recording::surfaces
        ImportedSurface imported;
        record_stream::Surface record;
    };
    /// The shaders of a draw, with what they are fed.
    struct Shading {
        std::uint32_t program = 0, vertex_values = 0, fragment_values = 0;
        std::map<std::uint32_t, std::string> variables; ///< by slot of the attribute
        GeometryRequest request;
        bool sizes_points = false;
    };

    /// Copies turn no rows over, so that windows then lie as textures do.
    bool copies_touch_the_window() const;
    void take(record_stream::Tag tag, const StreamReader& reader);
    void take_surface(const record_stream::Surface& record);
    /// Null: there is none, or it cannot be recorded.
    const KnownSurface* surface(std::int32_t record) const;
    std::optional<TargetSet::Target> target_of(const record_stream::Target& target) const;
    /// Nothing where there is nothing to draw to.
    std::optional<std::uint32_t> targets_of(const record_stream::Targets& targets);
    bool lacks_alpha(const record_stream::Target& target) const;
    void end_frame(const record_stream::Frame& frame);
    bool top_row_first(const record_stream::Targets& targets) const { return targets.window && window_top_first_; }

    std::uint32_t state_of(const record_stream::Draw& draw, bool sizes_points);
    std::uint32_t values_of(std::vector<UniformValue> values);
    std::uint32_t bindings_of(const record_stream::Draw& draw);
    FixedFunctionProgram fixed_function_of(const record_stream::Draw& draw);
    Shading without_program(const record_stream::Draw& draw);
    std::optional<Shading> with_program(const record_stream::Draw& draw);
    void take_draw(const record_stream::Draw& draw);
    void take_clear(const record_stream::Clear& clear);
    /// As much of it as lies within both surfaces.
    void take_copy(const record_stream::Copy& copy);
    void take_blit(const record_stream::Blit& blit);

    static Recording empty_recording() {
        Recording recording;
        recording.resources = std::make_shared<pipeline::Resources>();
        return recording;
    }

    std::span<const std::byte> bytes_;
    bool window_top_first_ = true, finished_ = false;
    std::string context_;
    Recording recording_ = empty_recording();
    std::map<std::string, std::uint64_t> not_recorded_;
    Count count_ = [this](const std::string& call) { ++not_recorded_[call]; };
    Blobs blobs_;
    std::vector<KnownSurface> surfaces_;
    std::vector<record_stream::Program> programs_;
    ProgramImport programs_import_{recording_};
    GeometryImport geometries_{*recording_.resources, blobs_, count_};
    Pool<std::vector<UniformValue>> values_{recording_.values};
    Pool<std::vector<TextureBinding>> bindings_{recording_.bindings};
    Pool<RecordedSampler> samplers_{recording_.samplers};
    Pool<pipeline::RasterState> states_{recording_.states};
    Pool<TargetSet> targets_{recording_.targets};
    RecordedFrame frame_;
    std::uint32_t draws_ = 0; ///< of this frame
};

} // namespace traces::recorded
