#include "reports/truth/alpha_masks.hpp"

#include "pipeline/functional/shader.hpp"

namespace reports {

struct AlphaMasks::Mask {
    pipeline::FragmentShader shader;
    pipeline::PrimitiveReader read;
};

AlphaMasks::AlphaMasks(const pipeline::Resources& resources, const std::vector<pipeline::Draw>& draws) {
    for (const pipeline::Draw& draw : draws) {
        const pipeline::Geometry& geometry = resources.geometries[draw.geometry];
        const pipeline::Material& material = resources.materials[draw.material];
        std::shared_ptr<const Mask> mask;
        if (material.alpha_mode == pipeline::AlphaMode::mask)
            mask = std::make_shared<const Mask>(
                Mask{pipeline::FragmentShader(resources, geometry, material, glm::mat4(1.0F), {.colours = false}),
                     pipeline::PrimitiveReader(resources, geometry)});
        masks_.insert(masks_.end(), draw.instances.size(), mask);
    }
}

AlphaMasks::~AlphaMasks() = default;

bool AlphaMasks::stands(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const {
    const Mask& mask = *masks_[mesh];
    pipeline::CornerWeights weights;
    weights.of1.fill(u); // four times the same place: no footprint
    weights.of2.fill(v);
    return mask.shader.shade(mask.shader.triangle(mask.read(triangle), nullptr), weights, 1U).alive != 0;
}

} // namespace reports
