// Files that are being written under a temporary name, so that whoever ends the program can remove them.
#pragma once

#include <filesystem>

namespace sim {

/// A name in the folder of `path` under which nothing exists. What is written there gets its name with commit();
/// without, the destructor removes it.
class UnfinishedFile {
  public:
    /// Throws sim::InputError for a name that something else than a file has: commit() would replace a device, too.
    explicit UnfinishedFile(std::filesystem::path path);
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

    const std::filesystem::path& path() const { return path_; } ///< under which it will be known
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Gives the file its name; returns 0 or errno.
    int commit();

  private:
    std::filesystem::path path_;
    std::filesystem::path temporary_;
    int slot_;
    bool done_ = false;
};

/// To be asked before a long run. Throws sim::InputError where no file of that name can be begun: "PATH: cannot be
/// written: REASON".
void check_writable(const std::filesystem::path& path);

/// Removes all files that are unfinished, and keeps others from being begun: the program is about to end. May be called
/// by a signal handler.
void remove_unfinished_files();

} // namespace sim
