#include "sim/counted.hpp"

namespace sim {

namespace {

std::string plural_of(std::string_view noun) {
    const auto with = [noun](std::size_t cut, std::string_view end) {
        return std::string(noun.substr(0, noun.size() - cut)).append(end);
    };
    if (noun.ends_with("ex")) return with(2, "ices");
    if (noun.ends_with("hedron")) return with(2, "a");
    if (noun.ends_with("s") || noun.ends_with("x") || noun.ends_with("ch")) return with(0, "es");
    if (noun.ends_with("y") && !noun.ends_with("ay")) return with(1, "ies");
    return with(0, "s");
}

} // namespace

std::string with_commas(std::uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
    return text;
}

std::string counted(std::uint64_t number, std::string_view noun) {
    return with_commas(number) + " " + (number == 1 ? std::string(noun) : plural_of(noun));
}

} // namespace sim
