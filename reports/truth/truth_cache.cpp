#include "reports/truth/truth_cache.hpp"

#include "reports/atomic_file.hpp"
#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "traces/hash.hpp"

#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <string_view>
#include <type_traits>

namespace reports {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view magic = "ropsim truth 2\n"; // the number is that of the format
constexpr std::size_t checksum_digits = 16;

/// Every part of a truth, in the order of the file.
template <class T, class Take>
void for_each_part(T& truth, Take take) {
    take(truth.surfaces);
    take(truth.depths);
    take(truth.colours);
    take(truth.visibility);
    take(truth.marks);
    for (auto& channel : truth.channels) {
        take(channel.name);
        take(channel.quantity);
        take(channel.values);
        take(channel.known);
    }
}

std::string hash_of(std::string_view text) {
    traces::ContentHash hash;
    hash.add(std::as_bytes(std::span(text)));
    return hash.hex();
}

template <class T>
void append(std::string& text, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    text.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string content_of(const std::string& key, const Truth& truth) {
    std::string content = key;
    append(content, truth.width);
    append(content, truth.height);
    append(content, truth.layers);
    append(content, std::uint64_t{truth.channels.size()});
    append(content, truth.counts);
    for_each_part(truth, [&](const auto& part) {
        append(content, std::uint64_t{part.size()});
        content.append(reinterpret_cast<const char*>(part.data()), part.size() * sizeof(part[0]));
    });
    return content;
}

/// Reads what append() wrote; every length is compared with what is there.
class Reader {
  public:
    explicit Reader(std::string_view content) : content_(content) {}

    template <class T>
    void read(T& value) {
        take(&value, sizeof(T));
    }
    template <class Sequence>
    void read_sequence(Sequence& part) {
        const std::uint64_t count = read_count(sizeof(part[0]));
        part.resize(count);
        take(part.data(), count * sizeof(part[0]));
    }
    /// Of things that take so many bytes each at least; 0 where there cannot be so many.
    std::uint64_t read_count(std::size_t bytes) {
        std::uint64_t count = 0;
        read(count);
        good_ = good_ && count <= content_.size() / bytes;
        return good_ ? count : 0;
    }
    bool expect(std::string_view text) {
        good_ = good_ && content_.starts_with(text);
        if (good_) content_.remove_prefix(text.size());
        return good_;
    }
    bool good() const { return good_; }
    bool finished() const { return good_ && content_.empty(); }

  private:
    void take(void* target, std::size_t bytes) {
        good_ = good_ && bytes <= content_.size();
        if (!good_ || bytes == 0) return;
        std::memcpy(target, content_.data(), bytes);
        content_.remove_prefix(bytes);
    }

    std::string_view content_;
    bool good_ = true;
};

std::optional<Truth> truth_of(std::string_view file, const std::string& key) {
    if (!file.starts_with(magic) || file.size() < magic.size() + checksum_digits) return std::nullopt;
    file.remove_prefix(magic.size());
    const std::string_view checksum = file.substr(0, checksum_digits);
    file.remove_prefix(checksum_digits);
    if (hash_of(file) != checksum) return std::nullopt;
    Truth truth;
    Reader reader(file);
    if (!reader.expect(key)) return std::nullopt;
    reader.read(truth.width);
    reader.read(truth.height);
    reader.read(truth.layers);
    truth.channels.resize(reader.read_count(sizeof(std::uint64_t)));
    reader.read(truth.counts);
    for_each_part(truth, [&](auto& part) { reader.read_sequence(part); });
    for (traces::TruthChannel& channel : truth.channels) channel.everywhere = channel.known.empty();
    return reader.finished() ? std::optional(std::move(truth)) : std::nullopt;
}

} // namespace

std::string truth_key(const std::string& scene_hash, const pipeline::Frame& frame, const std::string& method_key,
                      const TruthPlan& plan) {
    std::string content(magic);
    content += fmt::format("{} {}\n{}\n{}\n{}\n", ropsim_build::version, ropsim_build::git_describe, scene_hash,
                           frame.workload, method_key);
    append(content, frame.view.view);
    append(content, frame.view.projection);
    for (const std::uint32_t number : {frame.view.width, frame.view.height, plan.layers}) append(content, number);
    if (plan.light) {
        for (const glm::dvec3& vector : {plan.light->centre, plan.light->u, plan.light->v}) append(content, vector);
        append(content, plan.sampling.rays);
        append(content, plan.sampling.seed);
        append(content, plan.sampling.first_point);
    }
    return hash_of(content);
}

std::optional<fs::path> TruthCache::usual_folder() {
    const auto variable = [](const char* name) -> std::optional<fs::path> {
        const char* value = std::getenv(name);
        if (value == nullptr || *value != '/') return std::nullopt; // relative ones are to be ignored
        return fs::path(value);
    };
    if (const auto caches = variable("XDG_CACHE_HOME")) return *caches / "ropsim";
    if (const auto home = variable("HOME")) return *home / ".cache" / "ropsim";
    return std::nullopt;
}

TruthCache::Found TruthCache::find(const std::string& key) const {
    std::ifstream stream(file_of(key), std::ios::binary);
    if (!stream) return {};
    std::ostringstream text;
    text << stream.rdbuf();
    Found found{truth_of(text.view(), key), ""};
    if (!found.truth) found.note = fmt::format("{} is damaged; the truth is computed again", file_of(key).string());
    return found;
}

std::string TruthCache::keep(const std::string& key, const Truth& truth) const {
    const std::string content = content_of(key, truth);
    try {
        make_directory(folder_);
        write_file(file_of(key), std::string(magic) + hash_of(content) + content);
    } catch (const sim::InputError& error) {
        return fmt::format("the truth is not kept: {}", error.what());
    }
    return {};
}

} // namespace reports
