// The records of a .rtrace file, declared once: whoever visits their fields writes, reads or prints them.
#pragma once

#include "traces/rtrace/chunk.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace traces::rtrace {

/// A blob that a record names.
struct BlobName {
    ContentName content;
    std::uint64_t bytes = 0;
};

/// What a code of the file stands for: the place in a list is the code.
template <class E>
struct Code {
    E value;
    std::string_view name;
};

class Fields {
  public:
    Fields() = default;
    virtual ~Fields() = default;
    Fields(const Fields&) = delete;
    Fields& operator=(const Fields&) = delete;

    virtual void text(std::string_view name, std::string& value) = 0;
    /// Finite, 32 bits each.
    virtual void numbers(std::string_view name, std::span<float> values) = 0;
    virtual void blob(std::string_view name, BlobName& value) = 0;
    /// Of 32 bits that may be anything, their number in front.
    virtual void words(std::string_view name, std::vector<std::uint32_t>& values) = 0;
    /// What follows from other fields: not in the file, but printed.
    virtual void derived(std::string_view /*name*/, std::uint64_t /*value*/) {}
    void number(std::string_view name, float& value) { numbers(name, {&value, 1}); }

    template <std::unsigned_integral T>
    void whole(std::string_view name, T& value, T least = 0, T most = std::numeric_limits<T>::max()) {
        std::uint64_t wide = value;
        whole_number(name, wide, sizeof(T), least, most);
        value = static_cast<T>(wide);
    }
    /// Two's complement of 32 bits.
    void integer(std::string_view name, std::int32_t& value, std::int32_t least = INT32_MIN,
                 std::int32_t most = INT32_MAX) {
        integer_number(name, value, least, most);
    }
    /// 0 or 1.
    void flag(std::string_view name, bool& value) {
        constexpr std::array<Code<bool>, 2> codes{{{false, "no"}, {true, "yes"}}};
        choice(name, value, codes);
    }
    template <class E, std::size_t n>
    void choice(std::string_view name, E& value, const std::array<Code<E>, n>& codes) {
        std::array<std::string_view, n> names;
        std::uint8_t code = n;
        for (std::size_t i = 0; i < n; ++i) {
            names[i] = codes[i].name;
            if (codes[i].value == value) code = static_cast<std::uint8_t>(i);
        }
        code_number(name, code, names);
        value = codes[code].value;
    }
    template <glm::length_t length>
    void vector(std::string_view name, glm::vec<length, float>& value) {
        numbers(name, {&value[0], static_cast<std::size_t>(length)});
    }
    /// Column by column.
    template <glm::length_t side>
    void matrix(std::string_view name, glm::mat<side, side, float>& value) {
        numbers(name, {&value[0][0], static_cast<std::size_t>(side) * side});
    }
    /// Fields that belong together, so that their names begin with its.
    template <class Visit>
    void part(std::string_view name, Visit visit) {
        enter_part(name);
        visit();
        leave_part();
    }
    /// Whether it is there, then what it is.
    template <class T, class Visit>
    void optional(std::string_view name, std::optional<T>& value, Visit visit) {
        bool there = value.has_value();
        flag(name, there);
        if (there != value.has_value()) value = there ? std::optional<T>(T{}) : std::nullopt;
        if (there) part(name, [&] { visit(*value); });
    }
    /// One of several kinds, then what it is. A kind's place in `Kinds` and `names` is its code.
    template <class... Kinds, class Visit>
    void variant(std::string_view name, std::variant<Kinds...>& value,
                 const std::array<std::string_view, sizeof...(Kinds)>& names, Visit visit) {
        auto code = static_cast<std::uint8_t>(value.index());
        code_number(name, code, names);
        if (code != value.index()) become<Kinds...>(value, code);
        std::visit(visit, value);
    }
    /// Records of one kind, their number in front. They stand behind all other fields of the record that has them.
    template <class T, class Visit>
    void list(std::string_view kind, std::vector<T>& records, std::size_t least_bytes, Visit visit,
              std::size_t most = std::numeric_limits<std::uint32_t>::max()) {
        records.resize(count(kind, records.size(), least_bytes, most));
        each(kind, std::span(records), visit);
    }
    /// A list without those at the end that are as `usual`.
    template <class T, std::size_t n, class Visit>
    void leading(std::string_view kind, std::array<T, n>& records, const T& usual, std::size_t least_bytes,
                 Visit visit) {
        std::size_t used = n;
        while (used > 0 && records[used - 1] == usual) --used;
        used = count(kind, used, least_bytes, n);
        std::fill(records.begin() + used, records.end(), usual);
        each(kind, std::span(records).first(used), visit);
    }

  protected:
    virtual void whole_number(std::string_view name, std::uint64_t& value, std::size_t bytes, std::uint64_t least,
                              std::uint64_t most) = 0;
    virtual void integer_number(std::string_view name, std::int32_t& value, std::int32_t least, std::int32_t most) = 0;
    virtual void code_number(std::string_view name, std::uint8_t& code, std::span<const std::string_view> names) = 0;
    /// @param least_bytes of a record: no more of them can follow than there is room for
    virtual std::size_t count(std::string_view kind, std::size_t records, std::size_t least_bytes,
                              std::size_t most) = 0;
    virtual void enter(std::string_view kind, std::size_t i) = 0;
    virtual void leave() = 0;
    virtual void enter_part(std::string_view name) = 0;
    virtual void leave_part() = 0;

  private:
    template <class T, class Visit>
    void each(std::string_view kind, std::span<T> records, Visit visit) {
        for (std::size_t i = 0; i < records.size(); ++i) {
            enter(kind, i);
            visit(records[i], i);
            leave();
        }
    }
    template <class... Kinds>
    static void become(std::variant<Kinds...>& value, std::size_t code) {
        std::size_t i = 0;
        ((i++ == code ? static_cast<void>(value.template emplace<Kinds>()) : static_cast<void>(0)), ...);
    }
};

} // namespace traces::rtrace
