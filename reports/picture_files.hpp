// All pictures of a comparison as files below its folder.
//
//   overlap.png overlap.exr               fragments per pixel
//   reference/  composite, layers         in submission order, without time
//   DESIGN/     composite, layers, hazards, difference to the reference
//
// PNG is for looking (sRGB; legends below the picture), EXR for measuring (linear, no legends): composite.exr with R,
// G, B, A; layers.exr with layer0.R ... layer0.Z, or layer0.Z alone; overlap.exr with "fragments".
#pragma once

#include "reports/comparison_result.hpp"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace reports {

struct PictureFile {
    std::filesystem::path file; ///< relative to the folder of the report
    std::string subject;        ///< design, "reference", or "" for what concerns all
    std::string title;          ///< one line
    bool layer = false;
};

/// Writes all pictures below `directory` and returns the PNG files, in the order in which a report shows them. Throws
/// sim::InputError when one cannot be written and sim::Interrupted when `stop` becomes true.
std::vector<PictureFile> write_pictures(const Comparison& comparison, const std::filesystem::path& directory,
                                        const std::atomic<bool>* stop = nullptr);

} // namespace reports
