// Fields as bytes, both ways: whole numbers little-endian, floats by their bits, texts as UTF-8 behind their length.
#pragma once

#include "traces/rtrace/fields.hpp"

#include <utility>

namespace traces::rtrace {

class Encoder final : public Fields {
  public:
    /// @param place begins the message for a text that is not UTF-8, or a number that is not finite
    explicit Encoder(std::string place) : place_(std::move(place)) {}
    const std::vector<std::byte>& bytes() const { return bytes_; }

    void text(std::string_view name, std::string& value) override;
    void numbers(std::string_view name, std::span<float> values) override;
    void blob(std::string_view name, BlobName& value) override;
    void words(std::string_view name, std::vector<std::uint32_t>& values) override;

  private:
    void whole_number(std::string_view name, std::uint64_t& value, std::size_t bytes, std::uint64_t least,
                      std::uint64_t most) override;
    void integer_number(std::string_view name, std::int32_t& value, std::int32_t least, std::int32_t most) override;
    void code_number(std::string_view name, std::uint8_t& code, std::span<const std::string_view> names) override;
    std::size_t count(std::string_view kind, std::size_t records, std::size_t least_bytes, std::size_t most) override;
    void enter(std::string_view, std::size_t) override {}
    void leave() override {}
    void enter_part(std::string_view) override {}
    void leave_part() override {}
    void put(std::uint64_t value, std::size_t bytes);

    std::string place_;
    std::vector<std::byte> bytes_;
};

/// Trusts nothing: errors are sim::InputError "PLACE: content byte N: RECORD NAME: expected ...".
class Decoder final : public Fields {
  public:
    Decoder(std::span<const std::byte> bytes, std::string place) : bytes_(bytes), place_(std::move(place)) {}
    /// Throws where bytes are left.
    void finish();

    void text(std::string_view name, std::string& value) override;
    void numbers(std::string_view name, std::span<float> values) override;
    void blob(std::string_view name, BlobName& value) override;
    void words(std::string_view name, std::vector<std::uint32_t>& values) override;

  private:
    void whole_number(std::string_view name, std::uint64_t& value, std::size_t bytes, std::uint64_t least,
                      std::uint64_t most) override;
    void integer_number(std::string_view name, std::int32_t& value, std::int32_t least, std::int32_t most) override;
    void code_number(std::string_view name, std::uint8_t& code, std::span<const std::string_view> names) override;
    std::size_t count(std::string_view kind, std::size_t records, std::size_t least_bytes, std::size_t most) override;
    void enter(std::string_view kind, std::size_t i) override { path_.push_back({kind, i}); }
    void leave() override { path_.pop_back(); }
    void enter_part(std::string_view name) override { path_.push_back({name, std::nullopt}); }
    void leave_part() override { path_.pop_back(); }
    std::span<const std::byte> take(std::string_view name, std::uint64_t bytes);
    std::uint64_t get(std::string_view name, std::size_t bytes);
    [[noreturn]] void fail(std::string_view name, std::string_view expected) const;

    std::span<const std::byte> bytes_;
    std::string place_;
    std::size_t at_ = 0, field_ = 0; ///< and where the present field begins
    struct Step {
        std::string_view name;
        std::optional<std::size_t> number; ///< of a record; parts have none
    };
    std::vector<Step> path_;
};

/// Well-formed UTF-8 (Unicode 15, table 3-7).
bool is_utf8(std::string_view text);

} // namespace traces::rtrace
