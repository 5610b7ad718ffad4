#include "models/programs/library.hpp"

#include "models/programs/depth_partition.hpp"
#include "models/programs/isosurface.hpp"
#include "models/programs/language/user_program.hpp"
#include "models/programs/mlab.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/order_and_blend.hpp"
#include "models/programs/pictures.hpp"
#include "models/programs/program_file.hpp"
#include "models/programs/stencil.hpp"
#include "models/programs/volume.hpp"
#include "models/programs/z_buffer.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace models {

namespace {

std::vector<std::string> names_of(const std::vector<Program>& list) {
    std::vector<std::string> names;
    for (const Program& program : list) names.push_back(program.id);
    return names;
}

std::string pick(std::string_view word, const std::vector<std::string>& known, std::string_view what) {
    const auto found = std::find(known.begin(), known.end(), word);
    if (found != known.end()) return *found;
    throw sim::InputError(fmt::format("{}: expected one of {}, got '{}'{}", what, fmt::join(known, ", "), word,
                                      sim::did_you_mean(word, known)));
}

ProgramChoice nearest_k(const ProgramOptions& options) {
    const auto& names = sim::EnumNames<EntryKind>::names;
    const auto kind = std::find(names.begin(), names.end(), options.entry) - names.begin();
    return {make_nearest_k(static_cast<EntryKind>(kind), options.k), nullptr};
}

ProgramChoice order_and_blend(const ProgramOptions& options) {
    return {make_order_and_blend(options.k, options.opacity), state_picture({0, 1, 2, 3})};
}

ProgramChoice mlab(const ProgramOptions& options) {
    return {make_mlab(options.k, options.opacity), node_picture({0, 1, 2, 3})};
}

ProgramChoice depth_partition(const ProgramOptions& options) {
    std::vector<float> bounds;
    for (std::uint32_t i = 0; i <= options.k; ++i)
        bounds.push_back(static_cast<float>(i) / static_cast<float>(options.k));
    return {make_depth_partition(std::move(bounds)), nullptr};
}

ProgramChoice isosurface(const ProgramOptions& options) {
    IsosurfaceSetup setup;
    setup.k = options.k;
    return {make_isosurface(setup), nullptr};
}

ProgramChoice volume(const ProgramOptions& options) {
    VolumeSetup setup;
    setup.k = options.k;
    setup.transfer = {{0.0F, glm::vec3(0.0F), 0.0F}, {1.0F, glm::vec3(1.0F), 1.0F}};
    return {make_volume(setup), nullptr};
}

ProgramChoice z_buffer(const ProgramOptions&) { return {make_z_buffer(), nullptr}; }

ProgramChoice stencil(const ProgramOptions&) { return {make_stencil({}), nullptr}; }

} // namespace

const std::vector<Program>& programs() {
    static const std::vector<Program> list = {
        {"nearest-k",
         "keeps the k fragments nearest to the eye, sorted (A6)",
         {"rgbz", "z", "zo", "zor"},
         64,
         nearest_k},
        {"order-and-blend", "sorts a nearly sorted stream and composites it (A7)", {"rgbz"}, 63, order_and_blend},
        {"mlab", "k nodes; what overflows is blended into the last", {"rgbtz"}, most_mlab_nodes, mlab},
        {"depth-partition", "keeps the nearest fragment of each range of depths (A14)", {"rgbz"}, 64, depth_partition},
        {"isosurface", "finds the nearest crossing of iso-values along the ray (A15)", {"zs"}, 64, isosurface},
        {"volume", "composites pre-integrated gaps between samples (A16)", {"zs"}, 64, volume},
        {"z-buffer", "keeps the nearest fragment", {"rgbz"}, 1, z_buffer},
        {"stencil", "counts the fragments that pass a compare", {"zn"}, 1, stencil},
    };
    return list;
}

ProgramChoice choose_program(std::string_view name, const ProgramOptions& options) {
    if (is_user_program(name)) {
        refuse_entry_kind(name, options.entry);
        return load_user_program(name, options.k, {{"opacity", options.opacity}});
    }
    const std::string id = pick(name, names_of(programs()), "program");
    const Program& program =
        *std::find_if(programs().begin(), programs().end(), [&](const Program& one) { return one.id == id; });
    ProgramOptions known = options;
    known.entry = options.entry.empty() ? program.entries.front()
                                        : pick(options.entry, program.entries, fmt::format("program {}: entry", id));
    if (options.k < 1 || options.k > program.most_k)
        throw sim::InputError(program.most_k == 1 ? fmt::format("program {}: k: expected 1, got {}", id, options.k)
                                                  : fmt::format("program {}: k: expected 1 to {}, got {}", id,
                                                                program.most_k, options.k));
    return program.make(known);
}

std::shared_ptr<const pipeline::ModifyProgram> make_program(std::string_view id, std::string_view entry,
                                                            std::uint32_t k) {
    return choose_program(id, {std::string(entry), k, 0.5F}).program;
}

} // namespace models
