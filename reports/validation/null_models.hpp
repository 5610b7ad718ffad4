// Null models: what somebody would predict who knows the calibrated rows and no hardware. The model has to beat them.
#pragma once

#include "reports/validation/validation_row.hpp"

#include <string_view>
#include <vector>

namespace reports {

inline constexpr std::string_view geometry_null_model =
    "Every row of a card is the geometric mean of the card's calibrated rows.";
inline constexpr std::string_view peeling_null_model =
    "One number a mesh, the time of a geometry pass, from its calibrated rows alone: MP takes k passes, SP one, and "
    "SPwH 12.6 us a batch of 32 triangles.";

inline constexpr std::string_view constant_null_model = "Every frame takes the time of the calibrated row.";

/// What the null model of geometry feed says of every row that was measured in frames/s: sets `null_model`. Needs the
/// status of the rows, and nothing of the model.
void apply_geometry_null_model(std::vector<ValidationRow>& rows);

/// A printed number of the table of depth peeling.
struct PeelingCell {
    std::string_view mesh;
    double passes = 1;  ///< geometry passes of a frame: k of MP, 1 of SP; 0: batches decide
    double batches = 0; ///< of 32 triangles, of SPwH
};
/// The same of depth peeling; `cells` says what each row is, one of passes and batches being 0, or both where the null
/// model says nothing of the row.
void apply_peeling_null_model(std::vector<ValidationRow>& rows, const std::vector<PeelingCell>& cells);

/// The same number of frames/s for every one that was measured.
void apply_constant_null_model(std::vector<ValidationRow>& rows, double frames_per_second);

} // namespace reports
