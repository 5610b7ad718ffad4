// Surfaces as a program's driver describes them, in the formats of a recording.
#pragma once

#include "traces/record_module/stream.hpp"
#include "traces/recording/import/gl_state.hpp"

#include <optional>
#include <vector>

namespace traces::recorded {

using Blobs = std::vector<std::vector<std::byte>>;

struct ImportedSurface {
    RecordedSurface surface;
    /// What a shader sees in red, green, blue and alpha, before the texture's own choice.
    std::array<Swizzle, 4> channels{Swizzle::red, Swizzle::green, Swizzle::blue, Swizzle::alpha};
    bool has_alpha = true; ///< else it is 1, whatever is drawn
    bool window = false;
};

/// Nothing for what a recording has no format or kind for, which is counted. `top_row_first`: rows are turned over.
std::optional<ImportedSurface> import_surface(const record_stream::Surface& surface, const Blobs& blobs,
                                              bool top_row_first, const Count& count);

/// What a shader sees of a surface through a binding.
std::array<Swizzle, 4> swizzle_of(const record_stream::Binding& binding, const ImportedSurface& surface);

} // namespace traces::recorded
