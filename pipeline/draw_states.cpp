#include "pipeline/draw_states.hpp"

#include "sim/check.hpp"

#include <algorithm>

namespace pipeline {

DrawStates::DrawStates(const Pass& pass, std::size_t draws) : states_(pass.states) {
    CHECK_MSG(!states_.empty(), "a draw pass has at least one raster state");
    if (pass.state_of_draw.empty()) return;
    constexpr std::uint32_t none = ~std::uint32_t{0};
    CHECK_MSG(pass.state_of_draw.size() == pass.draws.size(), "each draw of the pass has one state, or none has");
    of_draw_.assign(draws, none);
    for (std::size_t i = 0; i < pass.draws.size(); ++i) {
        CHECK(pass.state_of_draw[i] < states_.size());
        std::uint32_t& state = of_draw_[pass.draws[i]];
        CHECK_MSG(state == none || state == pass.state_of_draw[i], "a draw comes into a pass with one state only");
        state = pass.state_of_draw[i];
    }
    std::replace(of_draw_.begin(), of_draw_.end(), none, 0U);
}

} // namespace pipeline
