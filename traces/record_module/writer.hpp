// Records as bytes.
#pragma once

#include "traces/record_module/stream.hpp"

#include <type_traits>
#include <utility>

namespace record_stream {

class Writer {
  public:
    void operator()(auto&... fields) { (put(fields), ...); }

    /// A record of this tag, whole.
    template <class Record>
    static std::vector<std::byte> record(Tag tag, Record record) {
        Writer content, head;
        content.put(record);
        std::uint64_t length = content.bytes_.size();
        head(tag, length);
        head.bytes_.insert(head.bytes_.end(), content.bytes_.begin(), content.bytes_.end());
        return std::move(head.bytes_);
    }

    /// Fields without a head: equal for equal records.
    static std::string key(auto... fields) {
        Writer content;
        content(fields...);
        return {reinterpret_cast<const char*>(content.bytes_.data()), content.bytes_.size()};
    }

  private:
    void raw(const void* from, std::size_t size) {
        const auto* begin = static_cast<const std::byte*>(from);
        bytes_.insert(bytes_.end(), begin, begin + size);
    }
    template <class T>
    void list(std::vector<T>& values) {
        const auto count = static_cast<std::uint32_t>(values.size());
        raw(&count, sizeof count);
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>)
            raw(values.data(), values.size() * sizeof(T));
        else
            for (T& value : values) put(value);
    }
    template <class T>
    void put(std::vector<T>& values) {
        list(values);
    }
    template <class T, std::size_t n>
    void put(std::array<T, n>& values) {
        for (T& value : values) put(value);
    }
    void put(std::string& text) {
        const auto count = static_cast<std::uint32_t>(text.size());
        raw(&count, sizeof count);
        raw(text.data(), text.size());
    }
    template <class T>
    void put(T& value) {
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
            raw(&value, sizeof value);
        else
            value.fields(*this);
    }

    std::vector<std::byte> bytes_;
};

} // namespace record_stream
