// Moves between registers, uniforms and arrays; what does not fit the component-wise tables.
#include "traces/spirv/component_wise.hpp"

#include <algorithm>

namespace traces::spirv {

namespace {

template <Slot count>
void copy(Run& run, const Operation& operation) {
    for (Slot i = 0; i < count; ++i) run.file[operation.result + i] = run.file[operation.a + i];
}

void copy_many(Run& run, const Operation& operation) {
    std::copy_n(run.file + operation.a, operation.count, run.file + operation.result);
}

template <Slot count>
void gather(Run& run, const Operation& operation) {
    const Slot from[] = {operation.a, operation.b, operation.c, operation.d};
    for (Slot i = 0; i < count; ++i) run.file[operation.result + i] = run.file[from[i]];
}

/// Of a list: how far behind its base the indices lead, lane by lane.
struct Address {
    const std::uint32_t* list;
    Words base;
    const std::uint32_t* rest; ///< behind the indices
};

Address address(const Run& run, Slot place) {
    const std::uint32_t* list = run.program->lists.data() + place;
    Address result{list, same(list[1]), list + 2};
    for (std::uint32_t i = 0; i < list[0]; ++i, result.rest += 3) {
        const Wholes index = wholes(run.file[static_cast<Slot>(result.rest[0])]);
        const auto last = static_cast<std::int32_t>(result.rest[2] - 1);
        for (int lane = 0; lane < 4; ++lane)
            result.base[lane] += static_cast<std::uint32_t>(std::clamp(index[lane], 0, last)) * result.rest[1];
    }
    return result;
}

} // namespace

Handler copy_of(std::uint32_t count) {
    constexpr std::array<Handler, 4> handlers{copy<1>, copy<2>, copy<3>, copy<4>};
    return count <= 4 ? handlers[count - 1] : copy_many;
}

Handler gather_of(std::uint32_t count) {
    constexpr std::array<Handler, 4> handlers{gather<1>, gather<2>, gather<3>, gather<4>};
    return handlers.at(count - 1);
}

void load_indexed(Run& run, const Operation& operation) {
    const Address from = address(run, operation.a);
    for (std::uint32_t i = 0; i < operation.count; ++i) {
        Words loaded{};
        for (int lane = 0; lane < 4; ++lane) loaded[lane] = run.file[static_cast<Slot>(from.base[lane] + i)][lane];
        run.file[operation.result + static_cast<Slot>(i)] = loaded;
    }
}

void store_indexed(Run& run, const Operation& operation) {
    const Address to = address(run, operation.a);
    for (int lane = 0; lane < 4; ++lane) {
        if ((run.lanes >> lane & 1U) == 0) continue;
        for (Slot i = 0; i < operation.c; ++i)
            run.file[static_cast<Slot>(to.base[lane]) + i][lane] = run.file[operation.b + i][lane];
    }
}

void load_uniform_indexed(Run& run, const Operation& operation) {
    const Address from = address(run, operation.a);
    for (std::uint32_t i = 0; i < operation.count; ++i) {
        Words loaded{};
        for (int lane = 0; lane < 4; ++lane) loaded[lane] = run.uniforms[from.base[lane] + from.rest[i]];
        run.file[operation.result + static_cast<Slot>(i)] = loaded;
    }
}

void choose_many(Run& run, const Operation& operation) {
    const Words mask = run.file[operation.a];
    for (Slot i = 0; i < static_cast<Slot>(operation.count); ++i)
        run.file[operation.result + i] = pick(mask, run.file[operation.b + i], run.file[operation.c + i]);
}

void extract_component(Run& run, const Operation& operation) {
    const Wholes index = wholes(run.file[operation.b]);
    Words result{};
    for (int lane = 0; lane < 4; ++lane)
        result[lane] = run.file[operation.a + std::clamp(index[lane], 0, operation.c - 1)][lane];
    run.file[operation.result] = result;
}

void insert_component(Run& run, const Operation& operation) {
    copy_many(run, operation);
    const Wholes index = wholes(run.file[operation.b]);
    for (int lane = 0; lane < 4; ++lane)
        run.file[operation.result + std::clamp(index[lane], 0, operation.c - 1)][lane] = run.file[operation.d][lane];
}

void any_of(Run& run, const Operation& operation) {
    Words result = run.file[operation.a];
    for (Slot i = 1; i < operation.b; ++i) result |= run.file[operation.a + i];
    run.file[operation.result] = result;
}

void all_of(Run& run, const Operation& operation) {
    Words result = run.file[operation.a];
    for (Slot i = 1; i < operation.b; ++i) result &= run.file[operation.a + i];
    run.file[operation.result] = result;
}

void to_truth(Run& run, const Operation& operation) {
    run.file[operation.result] = words(run.file[operation.a] != same(0U));
}

void demote(Run& run, const Operation& /*operation*/) { run.alive &= ~run.mask; }

void is_helper(Run& run, const Operation& operation) { run.file[operation.result] = ~run.alive; }

} // namespace traces::spirv
