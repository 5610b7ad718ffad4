// Files that appear under their name only when they are complete: a run that fails or is stopped leaves nothing behind,
// and a folder that is used again nothing of the run before.
#pragma once

#include <filesystem>
#include <string_view>

namespace reports {

/// Writes a whole file; where its folder, or the one above, belongs to a run, it is noted there. Throws sim::InputError
/// "PATH: cannot be written: REASON".
/// @param noted false: the file outlives the runs, as what is kept to be continued
void write_file(const std::filesystem::path& path, std::string_view text, bool noted = true);

/// Makes `directory` ready for the files of one run: what an earlier run wrote there with write_file() is removed, and
/// what this one writes, there and one folder deeper, is noted in ".ropsim-files". Other files stay. Throws as
/// make_directory() does.
void begin_report_folder(const std::filesystem::path& directory);

/// Creates `directory` and its parents, and makes sure that files can be written there.
void make_directory(const std::filesystem::path& directory);

} // namespace reports
