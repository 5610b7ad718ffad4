#include "traces/trace_text.hpp"

#include "sim/check.hpp"
#include "traces/recording/recording_check.hpp"
#include "traces/rtrace/printer.hpp"
#include "traces/rtrace/trace_reader.hpp"

#include <algorithm>
#include <map>

namespace traces {

namespace {

using rtrace::TraceReader;

void compare_fields(const TraceLine& a, const TraceLine& b, std::vector<std::string>& lines) {
    const std::map<std::string, std::string> other(b.fields.begin(), b.fields.end());
    std::map<std::string, std::string> left = other;
    for (const auto& [name, value] : a.fields) {
        const auto found = other.find(name);
        left.erase(name);
        if (found == other.end())
            lines.push_back(fmt::format("{}: {}: {} | nothing", a.place, name, value));
        else if (found->second != value)
            lines.push_back(fmt::format("{}: {}: {} | {}", a.place, name, value, found->second));
    }
    for (const auto& [name, value] : left) lines.push_back(fmt::format("{}: {}: nothing | {}", a.place, name, value));
}

} // namespace

std::vector<TraceLine> dump_trace(const std::filesystem::path& path) {
    TraceReader reader(path);
    while (reader.next()) reader.read();
    rtrace::Document& document = reader.document(); // printed as the file has it, before anything is derived
    rtrace::Printer printer;
    for (const rtrace::Record& record : rtrace::records()) {
        if (!belongs(record, document)) continue;
        printer.begin(record.type.text());
        record.visit(printer, document);
    }
    reader.finish();
    return std::move(printer.lines);
}

std::vector<std::string> trace_faults(const std::filesystem::path& path) {
    std::vector<std::string> faults;
    const auto holds = [&faults](auto&& action) {
        try {
            action();
            return true;
        } catch (const sim::InputError& error) {
            faults.emplace_back(error.what());
            return false;
        }
    };
    std::optional<TraceReader> reader;
    if (!holds([&] { reader.emplace(path); })) return faults;
    bool more = true, whole = true;
    while (more && whole) {
        whole = holds([&] { more = reader->next(); });
        if (more && whole) holds([&] { reader->read(); });
    }
    if (whole)
        for (std::string& line : reader->missing()) faults.push_back(std::move(line));
    if (!faults.empty()) return faults;
    holds([&] {
        const Trace trace = reader->finish();
        if (trace.recording)
            faults = module_faults(*trace.recording, trace.scene.name);
        else
            frame_of(trace);
    });
    return faults;
}

std::vector<std::string> trace_differences(const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::vector<TraceLine> one = dump_trace(a), two = dump_trace(b);
    std::map<std::string, const TraceLine*> others;
    for (const TraceLine& line : two) others.emplace(line.place, &line);
    std::vector<std::string> lines;
    for (const TraceLine& line : one) {
        const auto found = others.find(line.place);
        if (found == others.end()) {
            lines.push_back(fmt::format("{}: only in {}", line.place, a.string()));
            continue;
        }
        compare_fields(line, *found->second, lines);
        others.erase(found);
    }
    for (const TraceLine& line : two)
        if (others.contains(line.place)) lines.push_back(fmt::format("{}: only in {}", line.place, b.string()));
    return lines;
}

std::vector<TraceChunks> trace_chunks(const std::filesystem::path& path) {
    std::vector<TraceChunks> kinds;
    rtrace::ChunkReader file(path);
    while (const auto head = file.next()) {
        const std::string type = head->type.text();
        auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const TraceChunks& one) { return one.type == type; });
        if (kind == kinds.end()) kind = kinds.insert(kind, TraceChunks{type});
        ++kind->count;
        kind->compressed += head->compressed() ? 1 : 0;
        kind->content_bytes += head->content_bytes;
        kind->stored_bytes += rtrace::chunk_head_bytes + head->stored_bytes;
    }
    return kinds;
}

} // namespace traces
