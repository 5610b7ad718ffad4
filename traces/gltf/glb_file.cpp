#include "traces/gltf/glb_file.hpp"

#include "sim/check.hpp"
#include "sim/unfinished_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <limits>
#include <unistd.h>

namespace traces::gltf {

namespace fs = std::filesystem;

namespace {

/// A file that appears under its name only when it is complete.
class CompleteFile {
  public:
    explicit CompleteFile(const fs::path& path) : file_(path) {
        descriptor_ = ::open(file_.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        if (descriptor_ < 0) fail();
    }
    ~CompleteFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    CompleteFile(const CompleteFile&) = delete;
    CompleteFile& operator=(const CompleteFile&) = delete;

    void write(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail();
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
    }
    void finish() {
        const int descriptor = descriptor_;
        descriptor_ = -1;
        if (::close(descriptor) != 0) fail(); // some file systems notice only here that the disk is full
        if (const int error = file_.commit(); error != 0) fail(error);
    }

  private:
    [[noreturn]] void fail(int error = errno) const {
        throw sim::InputError(fmt::format("{}: cannot be written: {}", file_.path().string(), std::strerror(error)));
    }

    sim::UnfinishedFile file_;
    int descriptor_ = -1;
};

constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

} // namespace

GlbFile::GlbFile() { json["asset"] = {{"version", "2.0"}, {"generator", "ropsim"}}; }

std::size_t GlbFile::add(const char* list, nlohmann::ordered_json element) {
    json[list].push_back(std::move(element));
    return json[list].size() - 1;
}

std::size_t GlbFile::add_view(std::span<const std::byte> bytes, std::uint32_t stride, std::uint32_t target) {
    nlohmann::ordered_json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    if (target != 0) view["target"] = target;
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    return add("bufferViews", std::move(view));
}

void GlbFile::use_extension(const char* name, bool required) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!required && std::string_view(list) == "extensionsRequired") continue;
        nlohmann::ordered_json& names = json[list];
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
}

void GlbFile::write(const fs::path& path) const {
    nlohmann::ordered_json document = json;
    if (!buffer_.empty()) document["buffers"].push_back({{"byteLength", buffer_.size()}});
    // Names may come from anywhere; JSON has to be UTF-8.
    std::string text = document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::uint64_t size = 12 + 8 + text.size() + (buffer_.empty() ? 0 : 8 + buffer_.size());
    if (size > std::numeric_limits<std::uint32_t>::max())
        throw sim::InputError(fmt::format("{}: expected at most 4 GiB to write, got {} bytes", path.string(), size));

    CompleteFile file(path);
    const auto numbers = [&](const auto&... values) {
        const std::array list{static_cast<std::uint32_t>(values)...};
        file.write(std::as_bytes(std::span(list)));
    };
    numbers(magic, 2U, size);
    numbers(text.size(), json_chunk);
    file.write(std::as_bytes(std::span(text)));
    if (!buffer_.empty()) {
        numbers(buffer_.size(), binary_chunk);
        file.write(buffer_);
    }
    file.finish();
}

} // namespace traces::gltf
