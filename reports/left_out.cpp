#include "reports/left_out.hpp"

#include <algorithm>

namespace reports {

std::vector<LeftOutEntry> left_out_entries(const Comparison& comparison) {
    std::vector<LeftOutEntry> entries;
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        for (const auto& [unit, reason] : comparison.runs[i].left_out) {
            const auto same = [&unit = unit, &reason = reason](const LeftOutEntry& entry) {
                return entry.unit == unit && entry.reason == reason;
            };
            auto known = std::find_if(entries.begin(), entries.end(), same);
            if (known == entries.end()) known = entries.insert(entries.end(), {unit, reason, {}});
            known->designs.push_back(comparison.variants.at(i).label);
            known->by_all = known->designs.size() == comparison.runs.size();
        }
    std::stable_partition(entries.begin(), entries.end(), [](const LeftOutEntry& entry) { return entry.by_all; });
    return entries;
}

} // namespace reports
