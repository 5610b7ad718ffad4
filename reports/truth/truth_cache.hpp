// Truth kept from run to run: computed once for a content, a file after that.
//
// The name of a file is a hash of everything that the truth follows from: what the scene was read from, view, workload
// with what its truth follows from, what is asked of the rays, and the build of ropsim. Files are complete or not
// there, carry a checksum, and are never needed: what cannot be read is computed again.
#pragma once

#include "reports/truth/truth.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace reports {

/// 16 hexadecimal digits. `method_key`: traces::TruthMethod::key.
std::string truth_key(const std::string& scene_hash, const pipeline::Frame& frame, const std::string& method_key,
                      const TruthPlan& plan);

class TruthCache {
  public:
    explicit TruthCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// $XDG_CACHE_HOME/ropsim, else ~/.cache/ropsim; nothing where neither is known.
    static std::optional<std::filesystem::path> usual_folder();

    std::filesystem::path file_of(const std::string& key) const { return folder_ / ("truth-" + key); }

    /// What a call found, or could not do: one line for the user.
    struct Found {
        std::optional<Truth> truth;
        std::string note;
    };
    Found find(const std::string& key) const;
    /// Returns the note, empty when the truth is kept.
    std::string keep(const std::string& key, const Truth& truth) const;

  private:
    std::filesystem::path folder_;
};

} // namespace reports
