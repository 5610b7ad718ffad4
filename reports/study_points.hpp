// Finished points of a study in its folder, so that a run that was interrupted or killed is continued.
//
// A file points/KEY.json for each series at a point; the key is a hash of everything that decides its numbers: build,
// texts of the study, scene, GPU, programs. Several processes may share a folder: each point is computed by one of
// them, which holds a lock on points/KEY.lock that ends with the process.
#pragma once

#include "reports/study.hpp"

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace reports {

/// Makes the keys; reads every scene file once. May be used by several threads.
class StudyKeys {
  public:
    std::string key_of(const Study& study, const StudySeries& series, const StudyPoint& point,
                       const std::vector<std::string>& gpus, Fidelity fidelity);

  private:
    std::string scene_hash(const std::string& scene);

    std::mutex mutex_;
    std::map<std::string, std::string> scenes_;
};

/// The right to compute a point; no other process has it meanwhile.
class PointLock {
  public:
    PointLock() = default;
    explicit PointLock(const std::filesystem::path& file);
    ~PointLock();
    PointLock(PointLock&& other) noexcept;
    PointLock& operator=(PointLock&& other) = delete;

    bool held() const { return descriptor_ >= 0; }

  private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

class StudyPoints {
  public:
    /// Makes `folder`/points. Without `resume` what is there counts as not finished.
    StudyPoints(const std::filesystem::path& folder, bool resume);

    /// The values of a finished point; nothing where there is none, or its file is damaged.
    std::optional<std::vector<StudyValue>> find(const std::string& key) const;
    /// Not held where another process is computing the point.
    PointLock lock(const std::string& key) const;
    /// From now on find() finds it.
    void keep(const std::string& key, const std::vector<StudyValue>& values);
    /// Removes all points but these: they are of another study, or of other inputs.
    void forget_others(const std::set<std::string>& keys) const;

  private:
    std::filesystem::path file_of(const std::string& key) const { return folder_ / (key + ".json"); }

    std::filesystem::path folder_;
    bool resume_;
    mutable std::mutex mutex_;
    std::set<std::string> kept_; ///< by this process
};

} // namespace reports
