// A frame of a recording drawn by the pipeline's functional path, one draw after the other, with what can be asked of
// each: the frame is lowered as ropsim replay lowers it, its passes are then taken apart into their draws.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/surface.hpp"
#include "tests/replay_oracle/picture.hpp"
#include "traces/recording/recording.hpp"

#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

namespace replay_oracle {

class OwnFrame {
  public:
    /// `frame` of Recording::frames. Throws sim::InputError where it cannot be drawn.
    OwnFrame(const traces::Recording& recording, std::uint32_t frame);

    std::size_t draws() const { return recorded_.size(); }
    const traces::RecordedDraw& recorded(std::size_t draw) const { return *recorded_[draw]; }
    const pipeline::Geometry& geometry(std::size_t draw) const;
    /// Indices and primitives of all instances.
    std::uint64_t vertices(std::size_t draw) const;
    std::uint64_t primitives(std::size_t draw) const;

    /// Draws all up to this one, which comes behind those drawn before. Returns the samples of it that passed; nothing
    /// where the frame leaves it out, as nobody reads what it draws to.
    std::optional<std::uint64_t> execute(std::size_t draw);
    /// Of the draw that was executed last, had its primitives been clipped at the sides of the view volume, too.
    std::uint64_t samples_clipped_at_sides() const;
    /// What it has left in its first colour; nothing where the frame does not keep it.
    std::optional<Picture> picture() const;
    /// Draws what is left; what the frame shows.
    Picture shown();

    /// In clip space, one for each index, of one instance after the other.
    std::vector<glm::vec4> positions(std::size_t draw) const;

  private:
    void add_step(const pipeline::Pass& pass);
    std::uint64_t run(std::size_t step);
    const pipeline::Draw& lowered(std::size_t draw) const { return frame_.draws[lowered_[draw]]; }

    const traces::Recording& recording_;
    std::uint32_t number_;
    pipeline::Frame frame_;
    std::vector<const traces::RecordedDraw*> recorded_; ///< draws of the frame
    std::vector<std::uint32_t> lowered_;                ///< each of them in Frame::draws
    std::vector<pipeline::Pass> steps_;                 ///< passes of one draw each, and clears
    std::vector<std::size_t> step_of_draw_;             ///< of Frame::draws; beyond the last step: left out
    std::size_t next_ = 0;                              ///< step
    std::size_t executed_ = 0;                          ///< draw
    pipeline::SurfaceStore surfaces_, before_;          ///< now, and before the last step
};

} // namespace replay_oracle
