// Judgement pass by pass: whoever finds other surfaces than the reference had is held against what the reference of
// that pass makes of those, so that the faults of one pass are not counted again in all behind it.
#include "pipeline/functional/compose_pass.hpp"
#include "pipeline/machine_units.hpp"

#include <algorithm>

namespace pipeline {

void Machine::judge(std::size_t number, const FragmentStream& stream, SurfaceStore& before,
                    const ReferenceImage& reference) {
    const Pass& pass = frame_->passes[number];
    const std::vector<SurfaceId> inputs = surfaces_behind(pass), written = written_surfaces(pass);
    const bool other_inputs =
        std::any_of(inputs.begin(), inputs.end(), [this](SurfaceId surface) { return diverged_[surface]; });
    bool equal = true;
    for (std::size_t i = 0; i < written.size(); ++i) {
        const bool same = units_->surfaces.digest(written[i]) == reference.digests[number][i];
        diverged_[written[i]] = !same;
        equal &= same;
    }
    const bool settled = equal && !other_inputs;
    if (!settled) run_reference_pass(*frame_, pass, stream, before, 1);
    for (const SurfaceId surface : written)
        judgements_.push_back({pass.name, frame_->surfaces[surface].name,
                               settled ? 0 : units_->surfaces.differences(before, surface), other_inputs});
}

// A pass that nothing can break. From surfaces like the reference's it makes the reference's picture, which need not be
// made again.
void Machine::compose_and_judge(std::size_t number, const ReferenceImage& reference) {
    const Pass& pass = frame_->passes[number];
    const bool other_inputs =
        std::any_of(pass.reads.begin(), pass.reads.end(), [this](SurfaceId surface) { return diverged_[surface]; });
    const std::vector<SurfaceId> written = written_surfaces(pass);
    bool made = !other_inputs;
    for (std::size_t i = 0; i < written.size() && made; ++i) // unless a later pass wrote it
        made = reference.composed.digest(written[i]) == reference.digests[number][i];
    if (!made) compose(pass, units_->surfaces, 1);
    for (std::size_t i = 0; i < written.size(); ++i) {
        if (made) units_->surfaces.share(reference.composed, written[i]);
        diverged_[written[i]] = !made && units_->surfaces.digest(written[i]) != reference.digests[number][i];
        judgements_.push_back({pass.name, frame_->surfaces[written[i]].name, 0, other_inputs});
    }
}

void Machine::note_clear(std::size_t number, const ReferenceImage& reference) {
    const std::vector<SurfaceId>& cleared = frame_->passes[number].clears;
    for (std::size_t i = 0; i < cleared.size(); ++i)
        diverged_[cleared[i]] = units_->surfaces.digest(cleared[i]) != reference.digests[number][i];
}

} // namespace pipeline
