#include "models/programs/library.hpp"

#include "models/programs/nearest_k.hpp"
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

EntryKind entry_kind(std::string_view name) {
    const auto& names = sim::EnumNames<EntryKind>::names;
    return static_cast<EntryKind>(std::find(names.begin(), names.end(), name) - names.begin());
}

} // namespace

const std::vector<Program>& programs() {
    static const std::vector<Program> list = {
        {"nearest-k", "keeps the k fragments nearest to the eye, sorted (A6)", {"rgbz", "z", "zo", "zor"}},
    };
    return list;
}

std::shared_ptr<const pipeline::ModifyProgram> make_program(std::string_view id, std::string_view entry,
                                                            std::uint32_t k) {
    const std::string name = pick(id, names_of(programs()), "program");
    const Program& program =
        *std::find_if(programs().begin(), programs().end(), [&](const Program& one) { return one.id == name; });
    const std::string kind = pick(entry, program.entries, fmt::format("program {}: entry", name));
    if (k < 1 || k > 64) throw sim::InputError(fmt::format("program {}: k: expected 1 to 64, got {}", name, k));
    return make_nearest_k(entry_kind(kind), k);
}

} // namespace models
