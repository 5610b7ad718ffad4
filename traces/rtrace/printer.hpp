// Records as lines of text.
#pragma once

#include "traces/rtrace/fields.hpp"
#include "traces/trace_text.hpp"

namespace traces::rtrace {

class Printer final : public Fields {
  public:
    /// The following fields stand outside of lists.
    void begin(std::string place);
    std::vector<TraceLine> lines;

    void text(std::string_view name, std::string& value) override;
    void numbers(std::string_view name, std::span<float> values) override;
    void blob(std::string_view name, BlobName& value) override;
    void words(std::string_view name, std::vector<std::uint32_t>& values) override;
    void derived(std::string_view name, std::uint64_t value) override;

  private:
    void whole_number(std::string_view name, std::uint64_t& value, std::size_t bytes, std::uint64_t least,
                      std::uint64_t most) override;
    void integer_number(std::string_view name, std::int32_t& value, std::int32_t least, std::int32_t most) override;
    void code_number(std::string_view name, std::uint8_t& code, std::span<const std::string_view> names) override;
    std::size_t count(std::string_view kind, std::size_t records, std::size_t least_bytes, std::size_t most) override;
    void enter(std::string_view kind, std::size_t i) override;
    void leave() override { open_.pop_back(); }
    void enter_part(std::string_view name) override;
    void leave_part() override { open_.pop_back(); }
    void add(std::string_view name, std::string value);

    /// What may still get fields.
    struct Open {
        std::size_t line = 0;
        std::string part; ///< in front of their names
    };
    std::vector<Open> open_;
};

} // namespace traces::rtrace
