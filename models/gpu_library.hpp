// The GPUs that come with the program: files in models/gpus, one per GPU, every number with its origin and source.
#pragma once

#include "sim/config.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace models {

/// Names of the GPUs on hand, sorted: the stems of the files in the `models/gpus` folders of ropsim_build::data_dirs().
std::vector<std::string> gpu_names();

/// The configuration of a GPU, by name ("g71") or by the path of a file (anything with a '/' or ending in ".toml").
/// A file whose first key is `base = "NAME"` states only what differs from that GPU.
/// Throws sim::InputError: unknown name, listing the known ones; unreadable or malformed file.
sim::Config load_gpu(std::string_view name_or_path);

/// The GPU that the file names as its base; "" when it has none. Throws as load_gpu() does.
std::string base_of(std::string_view name_or_path);

} // namespace models
