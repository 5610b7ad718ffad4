// Everything that can be chosen or read: GPUs, designs, programs, workloads, generators, parameters, counters.
#pragma once

#include "sim/described.hpp"

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

struct CatalogueEntry {
    std::string topic;                   ///< "designs"
    std::string name;                    ///< "scoreboard", "rop.queue"
    std::string summary;                 ///< one line
    std::vector<sim::FieldInfo> details; ///< its parameters or counters
    std::string note = {};               ///< more, for when it is described alone
};

struct CatalogueTopic {
    std::string_view name; ///< "designs"
    std::string_view summary;
    bool short_list = true; ///< short enough for an overview
    std::vector<CatalogueEntry> (*entries)();
    /// The names of the entries, without making them: a shell asks for them at each TAB.
    std::vector<std::string> (*names)();
};

const std::vector<CatalogueTopic>& catalogue_topics();

/// Entries called `name`, of any topic; else all parameters and counters whose path lies below it ("rop.").
std::vector<CatalogueEntry> catalogue_find(std::string_view name);

nlohmann::ordered_json catalogue_json(const std::vector<CatalogueEntry>& entries);

/// "Places of the queue [quads]; 1 to 64; default 8".
std::string detail_text(const sim::FieldInfo& field);

} // namespace reports
