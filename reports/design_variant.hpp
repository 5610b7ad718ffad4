// A design as a comparison names it: its id, and settings of its own behind it.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace reports {

/// "design?key=value&key=value". A key whose first section is one of the GPU's ("rop.queue") is the GPU's, any other
/// one the design's. The settings win over those of the whole comparison.
struct DesignVariant {
    std::string text;                                          ///< as the user wrote it
    std::string design;                                        ///< id, not checked
    std::vector<std::pair<std::string, std::string>> settings; ///< full path and value: "existing.visibility", "x"

    /// The same for two variants with the same settings in any order.
    std::string canonical() const;
    /// "existing rop_cache": values alone where they are words; the text itself where there are no settings.
    std::string label() const;
    /// What became of a setting that the variant has; nothing where it has none of this path.
    void replace(const std::string& path, const std::string& value);
};

/// Throws sim::InputError for a setting that is none, is named twice, or belongs to the frame or to another design.
DesignVariant parse_variant(std::string_view text);

/// The parts of a list; commas inside brackets do not separate. Throws sim::InputError, beginning with `option`, for an
/// empty part.
std::vector<std::string> split_variants(std::string_view list, std::string_view option);

/// Names of rows, columns and folders: the design, and "-1", "-2" ... behind it where it has settings or occurs more
/// than once. Throws sim::InputError when two variants are the same.
std::vector<std::string> variant_names(const std::vector<DesignVariant>& variants);

} // namespace reports
