#include "traces/tetrahedra/vtk_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace traces {

namespace {

double f32(std::uint64_t bits) {
    const auto low = static_cast<std::uint32_t>(bits);
    float value = 0.0F;
    std::memcpy(&value, &low, sizeof(value));
    return static_cast<double>(value);
}

double f64(std::uint64_t bits) {
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

template <class Integer>
double whole(std::uint64_t bits) {
    return static_cast<double>(static_cast<Integer>(bits));
}

struct Type {
    std::string_view name;
    std::size_t bytes; ///< 0: eight values share one
    double (*value)(std::uint64_t bits);
};

constexpr auto types = std::to_array<Type>({{"float", 4, f32},
                                            {"double", 8, f64},
                                            {"char", 1, whole<std::int8_t>},
                                            {"unsigned_char", 1, whole<std::uint8_t>},
                                            {"short", 2, whole<std::int16_t>},
                                            {"unsigned_short", 2, whole<std::uint16_t>},
                                            {"int", 4, whole<std::int32_t>},
                                            {"unsigned_int", 4, whole<std::uint32_t>},
                                            {"long", 8, whole<std::int64_t>},
                                            {"unsigned_long", 8, whole<std::uint64_t>},
                                            {"signed_char", 1, whole<std::int8_t>},
                                            {"vtktypeint8", 1, whole<std::int8_t>},
                                            {"vtktypeuint8", 1, whole<std::uint8_t>},
                                            {"vtktypeint16", 2, whole<std::int16_t>},
                                            {"vtktypeuint16", 2, whole<std::uint16_t>},
                                            {"vtktypeint32", 4, whole<std::int32_t>},
                                            {"vtktypeuint32", 4, whole<std::uint32_t>},
                                            {"vtktypeint64", 8, whole<std::int64_t>},
                                            {"vtktypeuint64", 8, whole<std::uint64_t>},
                                            {"vtktypefloat32", 4, f32},
                                            {"vtktypefloat64", 8, f64},
                                            {"vtkidtype", 4, whole<std::int32_t>}, // VTK writes its own as int
                                            {"bit", 0, whole<std::uint8_t>}});

const Type& type_named(const InputBytes& file, std::string_view name) {
    std::string lower(name);
    for (char& letter : lower)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    const auto found = std::find_if(types.begin(), types.end(), [&](const Type& type) { return type.name == lower; });
    file.require_at_line(found != types.end(), "a numeric type such as float, got {}", in_quotes(name));
    return *found;
}

double read_word(InputBytes& file, std::string_view what) {
    const std::string_view word = file.word();
    std::string_view digits = word;
    if (digits.starts_with('+') && !digits.starts_with("+-"))
        digits.remove_prefix(1); // as streams write it with showpos
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool tiny = error == std::errc::result_out_of_range && digits.find_first_of("eE") + 1 == digits.find('-', 1);
    file.require_at_line((error == std::errc() || tiny) && end == digits.data() + digits.size() && std::isfinite(value),
                         "a finite number for {}, got {}", what, in_quotes(word));
    return tiny ? 0.0 : value;
}

} // namespace

std::vector<double> VtkValues::read(std::uint64_t count, std::string_view type_name, std::string_view what) {
    const Type& type = type_named(file_, type_name);
    if (!binary_) return read_words(count, what);
    const std::string_view bytes = take_binary(count, type_name, what);
    std::vector<double> values(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (type.bytes == 0) {
            values[i] = static_cast<unsigned char>(bytes[i / 8]) >> (7 - i % 8) & 1;
            continue;
        }
        std::uint64_t bits = 0;
        for (std::size_t byte = 0; byte < type.bytes; ++byte)
            bits = bits << 8U | static_cast<unsigned char>(bytes[i * type.bytes + byte]);
        values[i] = type.value(bits);
        file_.require_at_byte(std::isfinite(values[i]), "finite numbers for {}, got {} as number {}", what, values[i],
                              i);
    }
    return values;
}

void VtkValues::skip(std::uint64_t count, std::string_view type, std::string_view what) {
    type_named(file_, type);
    if (binary_) {
        take_binary(count, type, what);
        return;
    }
    for (std::uint64_t i = 0; i < count; ++i) // what nobody reads may be no number
        file_.require_at_line(!file_.word().empty(), "{} values for {}, got {}", count, what, i);
}

void VtkValues::skip_strings(std::uint64_t count) {
    file_.line();
    for (std::uint64_t i = 0; i < count && file_.left() > 0; ++i) {
        if (!binary_) {
            file_.line();
            continue;
        }
        // The two high bits of the first byte say how many bytes the length has: 8, 4, 2 or 1.
        const auto first = static_cast<unsigned char>(file_.take(1, "string length")[0]);
        std::uint64_t length = first & 0x3fU;
        for (const char byte : file_.take((8U >> (first >> 6U)) - 1, "string length"))
            length = length << 8U | static_cast<unsigned char>(byte);
        file_.require_at_byte(length <= file_.left(), "{} bytes of a string, got {}", length, file_.left());
        file_.take(static_cast<std::size_t>(length), "string");
    }
}

std::vector<double> VtkValues::read_words(std::uint64_t count, std::string_view what) {
    // A number takes a digit and a blank, so a count that cannot be is found before memory is asked for.
    file_.require_at_line(count <= file_.left() / 2 + 1, "{} numbers for {}, got {} bytes", count, what, file_.left());
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    while (values.size() < count) values.push_back(read_word(file_, what));
    return values;
}

std::string_view VtkValues::take_binary(std::uint64_t count, std::string_view type, std::string_view what) {
    file_.line(); // values begin behind the end of the line that announces them
    std::size_t bytes = type_named(file_, type).bytes;
    if (bytes == 0) {
        count = (count + 7) / 8;
        bytes = 1;
    }
    file_.require_at_byte(count <= file_.left() / bytes, "{} numbers of {} bytes for {}, got {} bytes", count, bytes,
                          what, file_.left());
    return file_.take(static_cast<std::size_t>(count) * bytes, what);
}

std::uint64_t read_count(InputBytes& file, std::uint64_t most, std::string_view what) {
    const std::string_view word = file.word();
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    file.require_at_line(error == std::errc() && end == word.data() + word.size() && count <= most,
                         "{} from 0 to {}, got {}", what, most, in_quotes(word));
    return count;
}

} // namespace traces
