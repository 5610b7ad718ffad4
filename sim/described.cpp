#include "sim/described.hpp"

#include "sim/number_type.hpp"

#include <fmt/format.h>

namespace sim {

std::string number_text(double number) { return fmt::format("{}", number); }

std::string number_text(float number) { return fmt::format("{}", number); }

std::string csv_line(const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i != 0) line += ',';
        if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
            line += cells[i];
            continue;
        }
        line += '"';
        for (const char c : cells[i]) line.append(c == '"' ? 2 : 1, c);
        line += '"';
    }
    return line + '\n';
}

namespace detail {

namespace {

std::string with_unit(std::string path, std::string_view unit) {
    return unit.empty() ? path : fmt::format("{} [{}]", path, unit);
}

std::string text_of(const ValueType& type, const void* value);

std::string number_text_of(const ValueType& type, const void* value) {
    return with_number_type(type, [value](auto number) {
        using T = decltype(number);
        if constexpr (std::floating_point<T>)
            return number_text(load<T>(value));
        else
            return std::to_string(load<T>(value));
    });
}

std::string list_text(const ValueType& type, const void* list) {
    std::string text;
    for (std::size_t i = 0; i < type.size(list); ++i)
        text += (text.empty() ? "" : " ") + text_of(*type.element, element_at(type, list, i));
    return text;
}

std::string table_text(const StructTable& table, const void* object) {
    std::string text;
    for (const FieldRow& field : table.fields)
        text +=
            fmt::format("{}{}={}", text.empty() ? "" : " ", field.name, text_of(*field.type, member_at(field, object)));
    return text;
}

std::string text_of(const ValueType& type, const void* value) {
    switch (type.kind) {
    case Kind::boolean:
        return *static_cast<const bool*>(value) ? "true" : "false";
    case Kind::integer:
    case Kind::real:
        return number_text_of(type, value);
    case Kind::choice:
        return std::string(choice_name(type, value));
    case Kind::text:
        return *static_cast<const std::string*>(value);
    case Kind::list:
        return list_text(type, value);
    case Kind::table:
        return table_text(*type.table, value);
    case Kind::counter:
        return std::to_string(static_cast<const Counter*>(value)->value);
    case Kind::high_water:
        return std::to_string(static_cast<const HighWater*>(value)->value);
    case Kind::histogram:
        return std::to_string(static_cast<const Histogram*>(value)->count());
    }
    return {};
}

void add_value(const ValueType& type, void* into, const void* from) {
    switch (type.kind) {
    case Kind::boolean:
    case Kind::choice:
    case Kind::text:
        break;
    case Kind::integer:
    case Kind::real:
        with_number_type(type, [into, from](auto number) {
            using T = decltype(number);
            store(into, static_cast<T>(load<T>(into) + load<T>(from)));
        });
        break;
    case Kind::list:
        if (type.resize != nullptr && type.size(into) < type.size(from)) type.resize(into, type.size(from));
        for (std::size_t i = 0; i < type.size(from); ++i)
            add_value(*type.element, element_at(type, into, i), element_at(type, from, i));
        break;
    case Kind::table:
        add(*type.table, into, from);
        break;
    case Kind::counter:
        *static_cast<Counter*>(into) += static_cast<const Counter*>(from)->value;
        break;
    case Kind::high_water:
        static_cast<HighWater*>(into)->note(static_cast<const HighWater*>(from)->value);
        break;
    case Kind::histogram:
        static_cast<Histogram*>(into)->merge(*static_cast<const Histogram*>(from));
        break;
    }
}

void subtract_counter(Counter& from, const Counter& earlier) {
    CHECK(from.value >= earlier.value);
    from.value -= earlier.value;
}

void subtract_value(const ValueType& type, void* from, const void* earlier) {
    switch (type.kind) {
    case Kind::boolean:
    case Kind::choice:
    case Kind::text:
    case Kind::high_water:
        break;
    case Kind::integer:
    case Kind::real:
        with_number_type(type, [from, earlier](auto number) {
            using T = decltype(number);
            store(from, static_cast<T>(load<T>(from) - load<T>(earlier)));
        });
        break;
    case Kind::list:
        for (std::size_t i = 0; i < std::min(type.size(from), type.size(earlier)); ++i)
            subtract_value(*type.element, element_at(type, from, i), element_at(type, earlier, i));
        break;
    case Kind::table:
        subtract(*type.table, from, earlier);
        break;
    case Kind::counter:
        subtract_counter(*static_cast<Counter*>(from), *static_cast<const Counter*>(earlier));
        break;
    case Kind::histogram: {
        Histogram& histogram = *static_cast<Histogram*>(from);
        histogram = histogram.since(*static_cast<const Histogram*>(earlier));
    }
    }
}

void describe_into(std::vector<FieldInfo>& list, const StructTable& table, const void* defaults,
                   std::string_view prefix) {
    for (const FieldRow& field : table.fields) {
        const void* member = member_at(field, defaults);
        std::string path = join_path(prefix, field.name);
        if (field.type->kind == Kind::table)
            describe_into(list, *field.type->table, member, path);
        else
            list.push_back({std::move(path), type_name(*field.type), std::string(field.unit), std::string(field.text),
                            text_of(*field.type, member), range_text(field)});
    }
}

bool has_fixed_size(const ValueType& type) { return type.kind == Kind::list && type.resize == nullptr; }

void csv_columns(std::vector<std::string>& columns, const ValueType& type, const void* value, const std::string& path,
                 std::string_view unit) {
    if (type.kind == Kind::table) {
        for (const FieldRow& field : type.table->fields)
            csv_columns(columns, *field.type, member_at(field, value), join_path(path, field.name), field.unit);
    } else if (has_fixed_size(type)) {
        for (std::size_t i = 0; i < type.size(value); ++i)
            csv_columns(columns, *type.element, element_at(type, value, i), join_path(path, std::to_string(i)), unit);
    } else if (type.kind == Kind::histogram) {
        columns.push_back(path + ".count");
        for (const char* part : {".mean", ".min", ".max"}) columns.push_back(with_unit(path + part, unit));
    } else {
        columns.push_back(with_unit(path, unit));
    }
}

void csv_cells(std::vector<std::string>& cells, const ValueType& type, const void* value) {
    if (type.kind == Kind::table) {
        for (const FieldRow& field : type.table->fields) csv_cells(cells, *field.type, member_at(field, value));
    } else if (has_fixed_size(type)) {
        for (std::size_t i = 0; i < type.size(value); ++i) csv_cells(cells, *type.element, element_at(type, value, i));
    } else if (type.kind == Kind::histogram) {
        const Histogram& histogram = *static_cast<const Histogram*>(value);
        cells.insert(cells.end(), {std::to_string(histogram.count()), number_text(histogram.mean()),
                                   std::to_string(histogram.min()), std::to_string(histogram.max())});
    } else {
        cells.push_back(text_of(type, value));
    }
}

} // namespace

std::string join_path(std::string_view prefix, std::string_view name) {
    return prefix.empty() ? std::string(name) : fmt::format("{}.{}", prefix, name);
}

std::string type_name(const ValueType& type) {
    switch (type.kind) {
    case Kind::boolean:
        return "true or false";
    case Kind::integer:
        return "whole number";
    case Kind::real:
        return "number";
    case Kind::choice:
        return "choice";
    case Kind::text:
        return "text";
    case Kind::list:
        return "list of " + type_name(*type.element);
    case Kind::table:
        return "table";
    case Kind::counter:
        return "counter";
    case Kind::high_water:
        return "high water";
    case Kind::histogram:
        return "histogram";
    }
    return {};
}

std::string range_text(const FieldRow& field) {
    const ValueType* inner = field.type;
    while (inner->kind == Kind::list) inner = inner->element;
    if (inner->kind == Kind::choice) return fmt::format("{}", fmt::join(inner->choices, " | "));
    if (field.low != nullptr && field.high != nullptr)
        return text_of(*inner, field.low) + " to " + text_of(*inner, field.high);
    if (field.low != nullptr) return "at least " + text_of(*inner, field.low);
    if (field.high != nullptr) return "at most " + text_of(*inner, field.high);
    return {};
}

void add(const StructTable& table, void* into, const void* from) {
    for (const FieldRow& field : table.fields) add_value(*field.type, member_at(field, into), member_at(field, from));
}

void subtract(const StructTable& table, void* from, const void* earlier) {
    for (const FieldRow& field : table.fields)
        subtract_value(*field.type, member_at(field, from), member_at(field, earlier));
}

std::vector<FieldInfo> describe(const StructTable& table, const void* defaults, std::string_view prefix) {
    std::vector<FieldInfo> list;
    describe_into(list, table, defaults, prefix);
    return list;
}

std::vector<std::string> csv_header(const StructTable& table, const void* object, std::string_view prefix) {
    std::vector<std::string> columns;
    csv_columns(columns, {.kind = Kind::table, .table = &table}, object, std::string(prefix), {});
    return columns;
}

std::vector<std::string> csv_row(const StructTable& table, const void* object) {
    std::vector<std::string> cells;
    csv_cells(cells, {.kind = Kind::table, .table = &table}, object);
    return cells;
}

} // namespace detail
} // namespace sim
