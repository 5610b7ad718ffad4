// Files that appear under their name only when they are complete: a run that fails or is stopped leaves nothing behind.
#pragma once

#include <filesystem>
#include <string_view>

namespace reports {

/// Write to temporary(), then commit(). Without commit() the destructor removes what was written.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// A name in the folder of the file, so that renaming does not copy. Nothing exists there yet.
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Gives the file its name; throws sim::InputError with the reason.
    void commit();

  private:
    std::filesystem::path path_;
    std::filesystem::path temporary_;
    bool done_ = false;
};

/// Writes a whole file; throws sim::InputError "PATH: cannot be written: REASON".
void write_file(const std::filesystem::path& path, std::string_view text);

/// Creates `directory` and its parents, and makes sure that files can be written there.
void make_directory(const std::filesystem::path& directory);

} // namespace reports
