#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sim {

namespace {

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
}

} // namespace

InputError::InputError(const std::string& message) : std::runtime_error(one_line(message)) {}

CheckContext& check_context() {
    thread_local CheckContext context;
    return context;
}

void check_failed(const char* condition, const char* file, int line, std::string_view detail) {
    const CheckContext& context = check_context();
    std::string text = fmt::format("{}:{}: check failed: {}", file, line, condition);
    if (!detail.empty()) text += fmt::format(" ({})", detail);
    if (context.component != nullptr) text += fmt::format(", in {} at {} ps", *context.component, context.time_ps);
    throw InternalError(text);
}

} // namespace sim
