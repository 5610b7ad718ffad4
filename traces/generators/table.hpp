// The generators, one row each.
#pragma once

#include "traces/generators.hpp"
#include "traces/parameters.hpp"

#include <fmt/format.h>
#include <string>
#include <utility>

namespace traces {

Generator grass_generator();
Generator blob_generator();
Generator grid_soup_generator();
Generator stack_generator();
Generator quads_generator();
Generator random_quads_generator();
Generator discs_generator();
Generator tetrahedra_generator();
Generator particles_generator();
Generator csg_generator();
Generator slabs_generator();
Generator planes_generator();
Generator showroom_generator();

/// A row of the table; `build` makes the scene (all but its name, hash and counts) from the parameters.
template <sim::Described P>
Generator make_generator(std::string id, std::string summary, Scene (*build)(const P&)) {
    const std::string place = fmt::format("gen:{}", id);
    return {std::move(id), std::move(summary), sim::describe<P>(),
            [place, build](const nlohmann::ordered_json& values) { return build(read_parameters<P>(values, place)); }};
}

} // namespace traces
