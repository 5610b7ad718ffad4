// The preparations, one row each, and those that others are made of.
#pragma once

#include "traces/parameters.hpp"
#include "traces/preparation.hpp"
#include "traces/preparation/triangle_mesh.hpp"

#include <string>
#include <utility>

namespace traces {

Preparation batch_preparation();
Preparation reorder_preparation();
Preparation quantise_preparation();
Preparation strips_preparation();
Preparation interleave_preparation();
Preparation recommended_preparation();
Preparation weld_preparation();
Preparation unindex_preparation();
Preparation shuffle_preparation();

/// "id?key=value&...", with every parameter.
std::string spec_text(const std::string& id, sim::DescribedRef parameters);

/// A row of the table; `change` makes an Applied (all but its spec) of a scene and the parameters.
template <sim::Described P>
Preparation make_preparation(std::string id, std::string summary, Applied (*change)(Scene, const P&)) {
    return {id, std::move(summary), sim::describe<P>(),
            [id, change](Scene scene, const nlohmann::ordered_json& values) {
                const P parameters = read_parameters<P>(values, id);
                Applied applied = change(std::move(scene), parameters);
                applied.spec = spec_text(id, sim::DescribedRef(parameters));
                return applied;
            }};
}

} // namespace traces
