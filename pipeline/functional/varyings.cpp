#include "pipeline/functional/varyings.hpp"

namespace pipeline {

namespace {

/// Weights on the screen of those in perspective: a corner's share in the latter is that on the screen over its w.
CornerWeights on_screen(const CornerWeights& weights, const std::array<float, 3>& w_of_corners, const Lanes& w) {
    CornerWeights result;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        result.of1[lane] = weights.of1[lane] * w_of_corners[1] / w[lane];
        result.of2[lane] = weights.of2[lane] * w_of_corners[2] / w[lane];
    }
    return result;
}

} // namespace

void VaryingPlanes::begin(const VertexProgramShape& shape, const std::array<std::span<const glm::vec4>, 3>& vertices,
                          const glm::vec3& w_of_vertices, const std::array<ScreenVertex, 3>& corners,
                          const std::array<glm::vec3, 3>* weights, std::size_t provoking) {
    shape_ = shape;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        w_[corner] = corners[corner].clip.w;
        corners_[corner].resize(shape.varyings);
        for (std::uint32_t i = 0; i < shape.varyings; ++i) {
            glm::vec4& varying = corners_[corner][i];
            if ((shape.flat >> i & 1U) != 0) {
                varying = vertices[provoking][i];
            } else if (weights == nullptr) {
                varying = vertices[corner][i];
            } else {
                glm::vec3 share = (*weights)[corner];
                if ((shape.linear >> i & 1U) != 0) share *= w_of_vertices / w_[corner];
                varying = vertices[0][i] * share.x + vertices[1][i] * share.y + vertices[2][i] * share.z;
            }
        }
    }
}

void VaryingPlanes::interpolate(const CornerWeights& weights, bool point, std::span<QuadTexels> varyings) const {
    const Lanes w = weights.interpolate(w_[0], w_[1], w_[2]);
    for (std::size_t lane = 0; lane < 4; ++lane)
        varyings[0][lane] = {w[lane], point ? weights.of1[lane] : 0.0F, point ? weights.of2[lane] : 0.0F, 0.0F};
    const CornerWeights linear = shape_.linear == 0 ? weights : on_screen(weights, w_, w);
    for (std::size_t i = 0; i < corners_[0].size(); ++i) {
        if ((shape_.flat >> i & 1U) != 0) { // any bits, those of whole numbers, too
            varyings[i + 1].fill(corners_[0][i]);
            continue;
        }
        const CornerWeights& own = (shape_.linear >> i & 1U) != 0 ? linear : weights;
        for (int channel = 0; channel < 4; ++channel) {
            const Lanes values =
                own.interpolate(corners_[0][i][channel], corners_[1][i][channel], corners_[2][i][channel]);
            for (std::size_t lane = 0; lane < 4; ++lane) varyings[i + 1][lane][channel] = values[lane];
        }
    }
}

} // namespace pipeline
