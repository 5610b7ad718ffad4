// ropsim describe: what can be chosen, and what every number means.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "reports/catalogue.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

using reports::CatalogueEntry;
using reports::CatalogueTopic;

std::string entry_line(const CatalogueEntry& entry, std::size_t width, reports::TerminalStyle style) {
    return reports::wrap(fmt::format("  {:<{}}  {}", entry.name, width, entry.summary), style.columns, width + 4);
}

std::string list_text(const std::vector<CatalogueEntry>& entries, reports::TerminalStyle style) {
    std::size_t width = 0;
    for (const CatalogueEntry& entry : entries) width = std::max(width, entry.name.size());
    std::string text;
    for (const CatalogueEntry& entry : entries) text += entry_line(entry, width, style);
    return text;
}

std::string overview_text(reports::TerminalStyle style) {
    std::string text;
    for (const CatalogueTopic& topic : reports::catalogue_topics()) {
        text += fmt::format("{}: {}\n", topic.name, topic.summary);
        if (topic.short_list) text += list_text(topic.entries(), style);
        text += "\n";
    }
    return text + "ropsim describe NAME says more about any of these.\n";
}

std::string details_text(const CatalogueEntry& entry, reports::TerminalStyle style) {
    std::string text = reports::wrap(fmt::format("{}: {}", entry.name, entry.summary), style.columns, 2);
    if (!entry.note.empty()) text += reports::wrap("  " + entry.note, style.columns, 2);
    const auto& rows = entry.details;
    std::size_t width = 0;
    for (const auto& row : rows) width = std::max(width, row.path.size());
    for (const auto& row : rows)
        text += reports::wrap(fmt::format("  {:<{}}  {}", row.path, width, reports::detail_text(row)), style.columns,
                              width + 4);
    return text;
}

std::string names_text(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += name + "\n";
    return text;
}

const CatalogueTopic* find_topic(const std::string& name) {
    for (const CatalogueTopic& topic : reports::catalogue_topics())
        if (topic.name == name) return &topic;
    return nullptr;
}

[[noreturn]] void unknown(const std::string& name) {
    std::vector<std::string> known;
    for (const CatalogueTopic& topic : reports::catalogue_topics()) known.emplace_back(topic.name);
    for (const CatalogueTopic& topic : reports::catalogue_topics())
        for (const CatalogueEntry& entry : topic.entries()) known.push_back(entry.name);
    throw sim::InputError(
        fmt::format("describe: nothing is called '{}'{}; see ropsim describe", name, sim::did_you_mean(name, known)));
}

void describe_overview(const DescribeCommand& command) {
    if (!command.json && !command.names) return print(overview_text(terminal_style()));
    std::vector<std::string> names;
    for (const CatalogueTopic& topic : reports::catalogue_topics()) names.emplace_back(topic.name);
    if (command.names) return print(names_text(names));
    nlohmann::ordered_json all = nlohmann::ordered_json::object();
    for (const CatalogueTopic& topic : reports::catalogue_topics())
        all[std::string(topic.name)] = reports::catalogue_json(topic.entries());
    print(all.dump(2) + "\n");
}

void describe_topic(const DescribeCommand& command, const CatalogueTopic& topic) {
    if (command.names) return print(names_text(topic.names()));
    const auto entries = topic.entries();
    print(command.json ? reports::catalogue_json(entries).dump(2) + "\n" : list_text(entries, terminal_style()));
}

} // namespace

void describe(const DescribeCommand& command) {
    if (command.topic.empty()) return describe_overview(command);
    if (const CatalogueTopic* topic = find_topic(command.topic)) return describe_topic(command, *topic);
    const auto entries = reports::catalogue_find(command.topic);
    if (entries.empty()) unknown(command.topic);
    if (command.json) return print(reports::catalogue_json(entries).dump(2) + "\n");
    if (command.names) {
        std::vector<std::string> names;
        for (const CatalogueEntry& entry : entries) names.push_back(entry.name);
        return print(names_text(names));
    }
    // What lies below a path is a list; one thing is described in full.
    const bool list =
        std::all_of(entries.begin(), entries.end(), [](const auto& entry) { return entry.details.empty(); });
    if (entries.size() > 1 && list) return print(list_text(entries, terminal_style()));
    std::string text;
    for (const CatalogueEntry& entry : entries) text += details_text(entry, terminal_style());
    print(text);
}

} // namespace cli
