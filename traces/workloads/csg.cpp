// Constructive solid geometry: per pixel, the first point inside a Boolean expression of the drawn objects.
//
// Source: Bavoil 2007, section 6.1.3 (specification 004, A13). Each draw is an object with a closed surface. A pixel
// with more than k fragments loses those behind, exits among them; reports count such pixels.
#include "models/programs/nearest_k.hpp"
#include "traces/workloads/csg_picture.hpp"
#include "traces/workloads/methods.hpp"

namespace traces {

namespace {

struct CsgParams {
    std::string expression;
    std::uint32_t k = 8;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};

    static constexpr auto fields() {
        using P = CsgParams;
        return std::tuple(
            sim::field<&P::expression>("which points belong to the solid: draws as letters (A is the first) or numbers "
                                       "(from 0), ! - & ^ | that bind as in C, parentheses; nothing: A|B|C...; as in "
                                       "'A & !B'"),
            sim::field<&P::k>("fragments kept per pixel; all of a pixel must fit").unit("fragments").range(1, 64),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F));
    }
};
static_assert(sim::fully_described<CsgParams>);

std::string expression_of(const CsgParams& params, std::size_t draws) {
    if (params.expression.find_first_not_of(" \t") != std::string::npos) return params.expression;
    std::string all = "0";
    for (std::size_t draw = 1; draw < draws; ++draw) all += fmt::format("|{}", draw);
    return all;
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const CsgParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    const auto objects = static_cast<std::uint32_t>(frame.draws.size());
    frame.resolve =
        std::make_shared<const CsgPicture>(CsgExpression(expression_of(params, frame.draws.size()), objects));
    frame.program = models::make_nearest_k(models::EntryKind::zo, params.k);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return kbuffer_frame(std::move(frame));
}

} // namespace

Workload csg_workload() {
    // An expression that is one number reads as such.
    return taking(
        make_workload<CsgParams>(
            "csg", "constructive solid geometry: the first point inside a Boolean expression of the draws", build),
        as_text, "expression");
}

} // namespace traces
