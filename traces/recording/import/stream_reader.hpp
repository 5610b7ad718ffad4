// Records from bytes. The process that wrote them may have ended anywhere.
#pragma once

#include "sim/check.hpp"
#include "traces/record_module/stream.hpp"

#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

namespace traces::recorded {

/// The fields of one record.
class FieldReader {
  public:
    explicit FieldReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    void operator()(auto&... fields) { (take(fields), ...); }

  private:
    void raw(void* to, std::size_t size) {
        if (size > bytes_.size())
            throw sim::InputError("the recorded stream: expected records of this version of ropsim");
        std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }
    std::size_t count(std::size_t least_bytes) {
        std::uint32_t number = 0;
        raw(&number, sizeof number);
        if (number > bytes_.size() / least_bytes)
            throw sim::InputError("the recorded stream: expected records of this version of ropsim");
        return number;
    }
    template <class T>
    void take(std::vector<T>& values) {
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>) {
            values.resize(count(sizeof(T)));
            if (!values.empty()) raw(values.data(), values.size() * sizeof(T));
        } else {
            values.resize(count(1));
            for (T& value : values) take(value);
        }
    }
    template <class T, std::size_t n>
    void take(std::array<T, n>& values) {
        for (T& value : values) take(value);
    }
    void take(std::string& text) {
        text.resize(count(1));
        if (!text.empty()) raw(text.data(), text.size());
    }
    template <class T>
    void take(T& value) {
        if constexpr (std::is_same_v<T, bool>) {
            std::uint8_t byte = 0;
            raw(&byte, 1);
            value = byte != 0;
        } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
            raw(&value, sizeof value);
        } else {
            value.fields(*this);
        }
    }

    std::span<const std::byte> bytes_;
};

class StreamReader {
  public:
    explicit StreamReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// Goes to the next record that is whole; nothing: there is none.
    std::optional<record_stream::Tag> next() {
        constexpr std::size_t head = sizeof(record_stream::Tag) + sizeof(std::uint64_t);
        if (bytes_.size() < head) return std::nullopt;
        record_stream::Tag tag{};
        std::uint64_t length = 0;
        std::memcpy(&tag, bytes_.data(), sizeof tag);
        std::memcpy(&length, bytes_.data() + sizeof tag, sizeof length);
        if (length > bytes_.size() - head) return std::nullopt;
        record_ = bytes_.subspan(head, length);
        bytes_ = bytes_.subspan(head + length);
        return tag;
    }

    template <class Record>
    Record record() const {
        Record result;
        FieldReader reader(record_);
        result.fields(reader);
        return result;
    }

  private:
    std::span<const std::byte> bytes_, record_;
};

} // namespace traces::recorded
