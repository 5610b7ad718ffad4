#include "pipeline/fragment_stream.hpp"

namespace pipeline {

namespace {

template <class Element>
std::uint64_t held(const std::vector<Element>& vector) {
    return std::uint64_t{vector.capacity()} * sizeof(Element);
}

} // namespace

std::uint64_t FragmentStream::bytes() const {
    return held(draws) + held(primitives) + held(triangles) + held(quads) + held(depths) + held(colours) +
           held(texture_lines);
}

} // namespace pipeline
