#include "tests/support/fixed_function_scene.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace tests {

namespace by_chance {

using namespace traces;

namespace {

class StateByChance {
  public:
    explicit StateByChance(sim::Random& random) : random_(random) {}

    FixedFunctionState make() {
        place();
        colours();
        if (likely(2, 3)) light();
        points();
        for (std::uint32_t used = 0; used < 3; ++used)
            if (likely(2, 3)) texture(state_.units[random_.below(fixed_function_units)]);
        for (FixedTextureUnit& unit : state_.units)
            for (Combiner* combiner : {&unit.colour, &unit.alpha})
                for (CombineArgument& argument : combiner->arguments) // of a unit that is off: undefined
                    if (argument.source == CombineSource::texture_of_unit &&
                        state_.units[argument.unit].target == UnitTarget::none)
                        argument.source = CombineSource::texture;
        if (likely(1, 3)) fog();
        if (likely(1, 4)) {
            state_.alpha_test = static_cast<pipeline::Compare>(random_.below(8));
            state_.alpha_reference = between(0.2F, 0.8F);
        }
        // Mesa does not clamp the sum before it is fogged, as section 3.9 asks for.
        if (state_.fog.mode != FogMode::none) state_.colour_sum = state_.lighting.separate_specular = false;
        return state_;
    }

  private:
    bool likely(std::uint64_t times, std::uint64_t of) { return random_.below(of) < times; }
    float between(float least, float most) { return least + (most - least) * static_cast<float>(random_.uniform()); }
    glm::vec3 vector(float least, float most) {
        const float x = between(least, most), y = between(least, most);
        return {x, y, between(least, most)};
    }
    glm::vec4 colour(float most = 1.0F) {
        const glm::vec3 rgb = vector(0.0F, most);
        return {rgb, between(0.0F, 1.0F)};
    }
    template <class E>
    E any(std::uint32_t count, std::uint32_t first = 0) {
        return static_cast<E>(first + random_.below(count));
    }

    void place() {
        glm::mat4 matrix = glm::translate(glm::mat4(1.0F), centre);
        const float angle = between(-0.6F, 0.6F);
        matrix = glm::rotate(matrix, angle, glm::normalize(vector(-1.0F, 1.0F)));
        const glm::vec3 stretch = likely(1, 2) ? vector(0.7F, 1.2F) : glm::vec3(between(0.7F, 1.2F));
        state_.model_view = glm::scale(matrix, stretch);
        state_.projection = glm::perspective(0.9F, 1.0F, 0.5F, 10.0F);
        state_.normalize = likely(1, 2);
        state_.rescale_normal = likely(1, 2);
        if (!likely(1, 3)) return;
        for (std::uint32_t i = 0; i < pipeline::most_clip_distances; ++i)
            if (likely(1, 4)) {
                const glm::vec3 normal = glm::normalize(vector(-1.0F, 1.0F));
                state_.clip_planes |= static_cast<std::uint8_t>(1U << i);
                state_.clip_plane[i] = {normal, 0.5F - glm::dot(normal, centre)};
            }
    }

    void colours() {
        state_.flat = likely(1, 4);
        state_.colour_sum = likely(1, 2);
        state_.clamp_vertex_colours = likely(3, 4);
    }

    void light() {
        FixedLighting& lighting = state_.lighting;
        lighting.enabled = true;
        lighting.ambient = colour(0.5F);
        lighting.local_viewer = likely(1, 2);
        lighting.two_sided = likely(1, 2);
        lighting.separate_specular = likely(1, 2);
        for (FixedLight& light : lighting.lights)
            if (likely(1, 4)) light_of(light);
        for (FixedMaterial& material : lighting.materials) {
            material.ambient = colour();
            material.diffuse = colour();
            material.specular = colour();
            material.emission = colour(0.2F);
            material.shininess = between(0.0F, 60.0F); // of 0, Mesa makes other exponents when light is attenuated
        }
        // OpenGL has one mode for the faces that it is on for. Of the back alone Mesa takes red for all channels.
        const ColourMaterial tracked = any<ColourMaterial>(6);
        const std::uint64_t faces = random_.below(4);
        if (faces < 2) lighting.colour_material[0] = tracked;
        if (faces < 1) lighting.colour_material[1] = tracked;
    }

    void light_of(FixedLight& light) {
        light.enabled = true;
        light.ambient = colour(0.3F);
        light.diffuse = colour();
        light.specular = colour();
        light.position = {vector(-2.0F, 2.0F), likely(1, 2) ? 1.0F : 0.0F};
        if (light.position.w == 0.0F) light.position.z = 1.0F + std::abs(light.position.z);
        if (likely(1, 2)) light.attenuation = vector(0.1F, 0.5F);
        if (light.position.w == 0.0F || !likely(1, 2)) return;
        light.spot_direction = centre - glm::vec3(light.position) + vector(-0.3F, 0.3F);
        light.spot_cutoff = between(10.0F, 60.0F);
        light.spot_exponent = likely(1, 4) ? 0.0F : between(0.0F, 20.0F);
    }

    void points() {
        if (likely(3, 4)) return;
        FixedPoints& points = state_.points;
        points.drawn = true;
        points.size = between(3.0F, 12.0F);
        points.least = 1.0F;
        points.most = between(8.0F, 20.0F);
        points.sprites = likely(1, 2);
        if (likely(1, 2)) points.attenuation = {between(0.0F, 0.5F), between(0.0F, 0.1F), between(0.02F, 0.1F)};
    }

    void texture(FixedTextureUnit& unit) {
        unit.target = any<UnitTarget>(5, 1);
        unit.format = any<BaseFormat>(8);
        // In one dimension Mesa compares with t, where section 3.8.14 has r.
        const bool plane = unit.target == UnitTarget::two_dimensional || unit.target == UnitTarget::rectangle;
        unit.compares = plane && likely(1, 3);
        if (unit.compares) {
            constexpr std::array formats{BaseFormat::alpha, BaseFormat::luminance, BaseFormat::intensity};
            unit.format = formats[random_.below(formats.size())];
        }
        unit.environment = any<TextureEnvironment>(6);
        if (unit.environment == TextureEnvironment::decal) // undefined for others
            unit.format = likely(1, 2) || unit.compares ? BaseFormat::rgb : BaseFormat::rgba, unit.compares = false;
        unit.constant = colour();
        combiner(unit.colour, 8);
        combiner(unit.alpha, 6);
        if (likely(1, 2)) generation(unit);
        if (likely(1, 2)) {
            unit.matrix = glm::translate(glm::mat4(1.0F), vector(-0.2F, 0.2F));
            unit.matrix = glm::rotate(unit.matrix, between(-0.5F, 0.5F), glm::vec3(0.0F, 0.0F, 1.0F));
        }
        unit.replaced_in_sprites = likely(1, 2);
    }

    void combiner(Combiner& combiner, std::uint32_t functions) {
        combiner.function = any<CombineFunction>(functions);
        for (CombineArgument& argument : combiner.arguments) {
            argument.source = any<CombineSource>(5);
            argument.operand = functions == 8 ? any<CombineOperand>(4) : any<CombineOperand>(2, 2);
            argument.unit = static_cast<std::uint8_t>(random_.below(fixed_function_units));
        }
        combiner.scale = static_cast<std::uint8_t>(1U << random_.below(3));
    }

    void generation(FixedTextureUnit& unit) {
        for (std::uint32_t i = 0; i < 4; ++i) {
            // A sphere map is for s and t, the others for s, t and r; q stays far from 0.
            const std::uint32_t modes = i < 2 ? 6 : 3;
            unit.generation[i] = any<CoordinateGeneration>(modes);
            if (i == 2 && likely(1, 2)) unit.generation[i] = any<CoordinateGeneration>(2, 4);
            unit.object_planes[i] = glm::vec4(vector(-0.1F, 0.1F), 1.0F);
            unit.eye_planes[i] = glm::vec4(vector(-0.1F, 0.1F), 1.5F);
            if (i == 3) continue;
            unit.object_planes[i][static_cast<int>(i)] += 1.0F;
            unit.eye_planes[i][static_cast<int>(i)] += 1.0F;
        }
    }

    void fog() {
        FixedFog& fog = state_.fog;
        fog.mode = any<FogMode>(3, 1);
        fog.from_vertex = likely(1, 3);
        fog.colour = colour();
        fog.density = between(0.1F, 0.5F);
        fog.start = between(0.5F, 2.5F);
        fog.end = fog.start + between(0.5F, 3.0F);
    }

    static constexpr glm::vec3 centre{0.0F, 0.0F, -2.5F};
    sim::Random& random_;
    FixedFunctionState state_;
};

} // namespace

} // namespace by_chance

FixedFunctionMesh wavy_square(std::uint32_t side, sim::Random& random) {
    FixedFunctionMesh mesh;
    const auto between = [&](float least, float most) {
        return least + (most - least) * static_cast<float>(random.uniform());
    };
    const auto vector = [&](float least, float most) {
        const float x = between(least, most), y = between(least, most), z = between(least, most);
        return glm::vec4(x, y, z, between(least, most));
    };
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t column = 0; column < side; ++column) {
            const glm::vec2 place =
                glm::vec2(column, row) * 2.0F / static_cast<float>(side - 1) - 1.0F; // -1 to 1 both ways
            const glm::vec2 phase = place * 2.0F;
            mesh.positions.emplace_back(place, 0.1F * std::sin(phase.x) * std::cos(phase.y), 1.0F);
            mesh.normals.push_back(glm::normalize(glm::vec3(std::sin(2.0F * phase.x), std::sin(2.0F * phase.y), 1.2F)));
            mesh.colours.push_back(vector(0.0F, 1.0F));
            mesh.secondary_colours.emplace_back(vector(0.0F, 0.5F));
            mesh.fog_coordinates.push_back(between(1.0F, 4.0F));
            for (auto& texcoords : mesh.texcoords)
                texcoords.push_back(glm::vec4(place, 0.0F, 0.9F) + vector(0.0F, 0.3F));
        }
    for (std::uint32_t row = 0; row + 1 < side; ++row)
        for (std::uint32_t column = 0; column + 1 < side; ++column) {
            const std::uint32_t first = row * side + column;
            for (const std::uint32_t index :
                 {first, first + 1, first + side, first + side, first + side + 1, first + 1})
                mesh.indices.push_back(index);
        }
    return mesh;
}

traces::FixedFunctionState random_fixed_function(sim::Random& random) {
    return by_chance::StateByChance(random).make();
}

} // namespace tests
