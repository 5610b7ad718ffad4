#include "traces/preparation.hpp"

#include "sim/check.hpp"
#include "sim/suggest.hpp"
#include "traces/hash.hpp"
#include "traces/preparation/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>

namespace traces {

namespace {

const Preparation& find_preparation(const std::string& id) {
    std::vector<std::string> known;
    for (const Preparation& one : preparations()) {
        if (one.id == id) return one;
        known.push_back(one.id);
    }
    throw sim::InputError(fmt::format("preparation: expected one of {}, got '{}'{}", fmt::join(known, ", "), id,
                                      sim::did_you_mean(id, known)));
}

std::string hash_of(const Scene& scene, std::string_view spec) {
    ContentHash hash;
    hash.add_values(std::span(scene.hash));
    hash.add_values(std::span(spec));
    return hash.hex();
}

} // namespace

const std::vector<Preparation>& preparations() {
    static const std::vector<Preparation> list = {
        batch_preparation(),  reorder_preparation(),    quantise_preparation(),
        strips_preparation(), interleave_preparation(), recommended_preparation(),
        weld_preparation(),   unindex_preparation(),    shuffle_preparation()};
    return list;
}

PreparedScene prepare_scene(Scene scene, std::span<const std::string> specs, const pipeline::VertexReuseParams& reuse,
                            const pipeline::CacheParams& pre_transform) {
    PreparedScene prepared;
    prepared.scene = std::move(scene);
    MeshMeasure before = measure_meshes(prepared.scene, reuse, pre_transform);
    for (const std::string& spec : specs) {
        const std::string_view text = spec;
        const std::size_t question = text.find('?');
        const Preparation& preparation = find_preparation(std::string(text.substr(0, question)));
        const auto query = question == std::string_view::npos ? std::string_view() : text.substr(question + 1);
        Applied applied = preparation.apply(std::move(prepared.scene), values_of_query(query, preparation.id));
        prepared.scene = std::move(applied.scene);
        prepared.scene.hash = hash_of(prepared.scene, applied.spec);
        const MeshMeasure after = measure_meshes(prepared.scene, reuse, pre_transform);
        prepared.steps.push_back(
            {std::move(applied.spec), before, after, applied.position_error, std::move(applied.notes)});
        before = after;
    }
    return prepared;
}

} // namespace traces
