#include "sim/check.hpp"

#include <fmt/format.h>

namespace sim {

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
