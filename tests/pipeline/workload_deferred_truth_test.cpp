// Deferred shading beside its ray-traced truth (specification 003, sections 4 and 6.8, check 14).
#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "reports/truth/truth.hpp"
#include "tests/support/box_ray.hpp"
#include "tests/support/frame_surfaces.hpp"
#include "tests/support/ray_kit.hpp"
#include "traces/generators/solids.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <utility>

namespace workload_deferred_truth_test {

using reports::Truth;
using support::Replay;
using Settings = std::vector<std::string>;
using Distance = std::optional<double>;

class DeferredTruth : public support::RayTest {};

constexpr const char* showroom = "gen:showroom?triangles=9000&transparent=3000";
constexpr const char* one_sheet = "gen:showroom?triangles=6000&transparent=300"; // the pane, and no ball of glass
constexpr const char* before_the_pane = "0,2.2,5.5,0,0.4,0,50";
enum Channel : std::size_t { opaque, transparent, total_reflection };

Replay drawn(Settings settings, std::uint32_t width = 160, std::uint32_t height = 120) {
    support::ReplayOptions options;
    options.width = width;
    options.height = height;
    options.workload = "deferred";
    options.camera = before_the_pane;
    options.knobs = std::move(settings);
    return Replay(showroom, options);
}

traces::TruthMethod method_of(const traces::Scene& scene, const pipeline::View& view, const Settings& settings) {
    const auto options = traces::WorkloadOptions::of(settings);
    return traces::truth_method(scene, traces::build_frame(scene, view, "deferred", options), "deferred", options);
}

Truth truth_of(const traces::Scene& scene, const pipeline::View& view, const Settings& settings) {
    const traces::TruthMethod method = method_of(scene, view, settings);
    return reports::trace_truth(*method.frame, reports::RayScene(method.frame->resources, method.frame->draws), method);
}

Truth truth_of(const Replay& replay) { return truth_of(replay.scene, replay.frame.view, replay.options.knobs); }

Truth truth_of(const char* generated, const Settings& settings) {
    const traces::Scene scene = traces::load_scene(generated);
    return truth_of(scene, traces::make_view(scene, before_the_pane, 160, 120), settings);
}

bool sees_pane(const Truth& truth, std::size_t pixel) { return truth.channels[transparent].has(pixel); }

/// Mean difference of red, green and blue, over the pixels that rays are sure of and that `counts` takes.
template <class Counts>
double error_of(const Replay& replay, const Truth& truth, Counts counts) {
    double sum = 0.0;
    std::size_t compared = 0;
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        if (truth.doubtful(pixel) || !counts(pixel)) continue;
        for (std::size_t i = pixel * 4; i < pixel * 4 + 3; ++i)
            sum += std::abs(static_cast<double>(replay.reference.colour[i]) - static_cast<double>(truth.colours[i]));
        compared += 3;
    }
    EXPECT_GT(compared, 600U);
    return sum / static_cast<double>(std::max<std::size_t>(compared, 1));
}

double error_of(const Replay& replay, const Truth& truth) {
    return error_of(replay, truth, [](std::size_t) { return true; });
}

Distance expected(const Truth& truth, std::size_t pixel, Channel channel) {
    if (!truth.channels[channel].has(pixel)) return std::nullopt;
    return truth.channels[channel].values[pixel];
}
Distance opaque_at(const Truth& truth, std::size_t pixel) { return expected(truth, pixel, opaque); }
Distance transparent_at(const Truth& truth, std::size_t pixel) { return expected(truth, pixel, transparent); }
Distance nearest_at(const Truth& truth, std::size_t pixel) {
    return expected(truth, pixel, sees_pane(truth, pixel) ? transparent : opaque);
}

/// Window depths that a method keeps, by pixel, in every second row from `first_row` on or in each, and what they are.
struct Kept {
    const char* method;
    std::string surface;
    std::size_t first_row, rows;
    Distance (*expected)(const Truth&, std::size_t);
    bool behind_panes_only;
    std::size_t stride = 4, place = 0; ///< floats of a texel, and where among them the depth is
};

/// Of a colour surface, or of a k-buffer.
std::vector<float> floats_of(const Replay& replay, const std::string& name) {
    const pipeline::SurfaceStore surfaces = surfaces_of(replay);
    return name == "kbuffer" ? entries_of(surfaces, replay.frame.main_kbuffer())
                             : colours_named(replay, surfaces, name);
}

// Predicted: nothing but rounding. Rows of pm hold what the parity says; dp holds the nearest of all and, behind panes,
// what is opaque; kg holds both classes everywhere.
TEST_F(DeferredTruth, S003_D14_DepthsAreThoseOfRays) {
    for (const Kept& kept :
         {Kept{"method=pm", "depths", 0, 2, opaque_at, false}, Kept{"method=pm", "depths", 1, 2, nearest_at, false},
          Kept{"method=dp", "depths", 0, 1, nearest_at, false},
          Kept{"method=dp", "depths behind", 0, 1, opaque_at, true},
          Kept{"method=kg", "kbuffer", 0, 1, opaque_at, false, 8, 7},
          Kept{"method=kg", "kbuffer", 0, 1, transparent_at, false, 8, 3}}) {
        SCOPED_TRACE(testing::Message() << kept.method << ' ' << kept.surface << " from row " << kept.first_row);
        const Replay replay = drawn({"lights=0", kept.method}, 320, 240);
        const Truth truth = truth_of(replay);
        const pipeline::EyeDepth eye(replay.frame.view.projection);
        const std::vector<float> texels = floats_of(replay, kept.surface);
        std::size_t compared = 0, right = 0;
        for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
            const std::size_t row = pixel / truth.width;
            if (row % kept.rows != kept.first_row || truth.doubtful(pixel)) continue;
            if (kept.behind_panes_only && !sees_pane(truth, pixel)) continue;
            const Distance known = kept.expected(truth, pixel);
            const float depth = texels[pixel * kept.stride + kept.place];
            const bool has = depth < 1.0F;
            if (!known && !has) continue;
            ++compared;
            const double distance = eye.distance(depth);
            right += known && has && std::abs(distance - *known) <= 1e-4 * *known ? 1 : 0;
        }
        EXPECT_GT(compared, 3000U);
        EXPECT_GE(static_cast<double>(right), 0.995 * static_cast<double>(compared));
    }
}

// Without maps and rows only bits are left: colours and light have steps of 1/255, of which two roundings are seen;
// normals have steps of 1/1023, which turns a highlight of power 32 by some more.
TEST_F(DeferredTruth, PeeledPictureWithoutMapsIsTheTruthButForRounding) {
    const Replay replay = drawn({"method=dp", "lights=4", "shadows=none", "refraction=false"});
    const Truth truth = truth_of(replay);
    EXPECT_LT(error_of(replay, truth), 1.0 / 255.0);
    EXPECT_LT(error_of(replay, truth, [&](std::size_t pixel) { return sees_pane(truth, pixel); }), 1.0 / 255.0);
    std::size_t far = 0;
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel)
        for (std::size_t i = pixel * 4; i < pixel * 4 + 3 && !truth.doubtful(pixel); ++i)
            far += std::abs(replay.reference.colour[i] - truth.colours[i]) > 8.0F / 255.0F ? 1 : 0;
    EXPECT_LE(far, truth.pixels() / 1000); // silhouettes that rays just miss
}

// pm has a pane at every second row, and there what lies behind it a row above. Away from panes both are one picture.
TEST_F(DeferredTruth, PeelingIsNearerThanRowsOnPanesAndEqualElsewhere) {
    for (const char* refraction : {"refraction=false", "refraction=true"}) {
        SCOPED_TRACE(refraction);
        const Replay pm = drawn({"method=pm", "shadows=none", refraction});
        const Replay dp = drawn({"method=dp", "shadows=none", refraction});
        const Truth truth = truth_of(dp);
        const auto on_pane = [&](std::size_t pixel) { return sees_pane(truth, pixel); };
        EXPECT_LT(2.0 * error_of(dp, truth, on_pane), error_of(pm, truth, on_pane));
        const auto elsewhere = [&](std::size_t pixel) {
            return !on_pane(pixel) && !(pixel >= truth.width && on_pane(pixel - truth.width)) &&
                   !(pixel + truth.width < truth.pixels() && on_pane(pixel + truth.width));
        };
        EXPECT_NEAR(error_of(dp, truth, elsewhere), error_of(pm, truth, elsewhere), 1e-3);
    }
}

// An edge of a shadow is off by up to a texel: with three times as many along a side, a third of the area is wrong, on
// top of the rounding that is there without shadows. So it is with dp; pm has the same maps, and its rows in addition.
TEST_F(DeferredTruth, LargerShadowMapsComeNearer) {
    const auto errors_with = [](const char* method) {
        std::vector<double> errors;
        for (const char* shadows : {"map_size=64", "map_size=192", "map_size=576", "shadows=none"}) {
            const Replay replay = drawn({method, shadows, "refraction=false", "lights=2"});
            errors.push_back(error_of(replay, truth_of(replay)));
        }
        return errors;
    };
    const std::vector<double> dp = errors_with("method=dp"), pm = errors_with("method=pm");
    for (const std::vector<double>& errors : {dp, pm}) {
        EXPECT_LT(errors[1], errors[0]);
        EXPECT_LT(errors[2], errors[1]);
        EXPECT_LT(errors[3], errors[2]);
    }
    EXPECT_NEAR((dp[1] - dp[3]) / (dp[0] - dp[3]), 1.0 / 3.0, 0.12);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(dp[i], pm[i]);
}

// What a method leaves out is error: shadows that are missing, or black where glass should colour them.
TEST_F(DeferredTruth, ShadowsOfTheRightKindComeNearest) {
    const Settings common{"method=dp", "refraction=false", "lights=2", "map_size=512"};
    Settings transparent_shadows = common;
    transparent_shadows.emplace_back("shadows=transparent");
    const Truth truth = truth_of(drawn(transparent_shadows));
    const double right = error_of(drawn(transparent_shadows), truth);
    for (const char* kind : {"shadows=none", "shadows=opaque"}) {
        Settings settings = common;
        settings.emplace_back(kind);
        const Replay replay = drawn(settings);
        EXPECT_GT(error_of(replay, truth), 2.0 * right) << kind;
        EXPECT_LT(error_of(replay, truth_of(replay)), 2.0 * right) << kind; // each has a truth of its own
    }
}

// A sheet of glass lies between the lights and what they reach once at most; a ball of glass is two sheets.
TEST_F(DeferredTruth, AllPanesFilterAsTheNearestDoesWhereThereIsButOne) {
    const Settings common{"refraction=false", "lights=3"};
    Settings all = common;
    all.emplace_back("truth_filter=product");
    EXPECT_EQ(truth_of(one_sheet, common).colours, truth_of(one_sheet, all).colours);
    const Truth nearest = truth_of(showroom, common), product = truth_of(showroom, all);
    std::size_t darker = 0;
    for (std::size_t i = 0; i < nearest.colours.size(); ++i) {
        EXPECT_LE(product.colours[i], nearest.colours[i]);
        darker += product.colours[i] < nearest.colours[i] ? 1 : 0;
    }
    EXPECT_GT(darker, 500U);
}

/// A rectangle across the z axis, whose diagonal passes aside of it.
void add_sheet(traces::Scene& scene, double z, double half, const glm::vec4& colour) {
    traces::Mesh mesh;
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.5, -1.0}, {1.5, 1.25}, {-1.0, 1.25}})
        mesh.positions.emplace_back(x * half, y * half, z);
    mesh.normals.assign(4, glm::vec3(0.0F, 0.0F, 1.0F));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    add_object(scene, std::move(mesh), "sheet", colour, "test");
    if (colour.a < 1.0F) scene.resources->materials.back().alpha_mode = pipeline::AlphaMode::blend;
}

constexpr glm::vec4 pane_colour{0.2F, 0.8F, 1.0F, 0.5F};

struct Sheet {
    double z;
    glm::vec4 colour;
};

/// A grey wall in z = 0, a light two units before it that shines on it, and sheets between them.
traces::Scene wall(const std::vector<Sheet>& sheets, const glm::vec3& light = glm::vec3(1.0F)) {
    traces::Scene scene = traces::empty_scene();
    scene.name = "wall";
    add_sheet(scene, 0.0, 2.0, {0.5F, 0.5F, 0.5F, 1.0F});
    for (const Sheet& sheet : sheets) add_sheet(scene, sheet.z, 0.3, sheet.colour);
    traces::Light spot;
    spot.kind = traces::LightKind::spot;
    spot.to_world[3] = {0.0F, 0.0F, 2.0F, 1.0F};
    spot.colour = light;
    spot.range = 10.0F;
    spot.inner_cone = 0.3F;
    spot.outer_cone = 0.6F;
    scene.lights = {spot};
    finish_scene(scene);
    return scene;
}

/// Of the pixel that sees the origin.
glm::dvec3 middle(const traces::Scene& scene, const Settings& more, const char* camera = "3,0,1.5,0,0,0,40",
                  const char* specular = "specular=0") {
    Settings settings{"lights=1", "ambient=0.1", specular};
    settings.insert(settings.end(), more.begin(), more.end());
    const Truth truth = truth_of(scene, traces::make_view(scene, camera, 33, 33), settings);
    const float* colour = truth.colours.data() + truth.pixel(16, 16) * 4;
    return {colour[0], colour[1], colour[2]};
}

void expect_colour(const glm::dvec3& seen, const glm::dvec3& known) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], known[i], 1e-6) << i;
}

// At the origin a light of 1 arrives with (1 - 2/10)^2 = 0.64, straight on; the ambient light is 0.1, the wall 0.5.
TEST_F(DeferredTruth, OneLightOnePaneOneWall) {
    const Sheet pane{1.0, pane_colour}, dim{0.5, {0.5F, 0.5F, 0.5F, 0.25F}}, lid{1.5, {1.0F, 1.0F, 1.0F, 1.0F}};
    expect_colour(middle(wall({}), {}), glm::dvec3(0.5 * 0.74));
    // Equation 3.1: min(1, C) (1 - a) = (0.1, 0.4, 0.5), of that 0.64.
    const glm::dvec3 filtered(0.082, 0.178, 0.21);
    expect_colour(middle(wall({pane}), {}), filtered);
    expect_colour(middle(wall({pane}), {"truth_filter=product"}), filtered);
    expect_colour(middle(wall({pane}), {"shadows=none"}), glm::dvec3(0.37));
    expect_colour(middle(wall({pane}), {"shadows=opaque"}), glm::dvec3(0.05));
    expect_colour(middle(wall({pane, lid}), {}), glm::dvec3(0.05));
    expect_colour(middle(wall({pane, dim}), {}), filtered);
    expect_colour(middle(wall({dim, pane}), {}), filtered); // in whatever order they are drawn
    // Each lets its share pass: another min(1, 0.5) 0.75 = 0.375.
    expect_colour(middle(wall({pane, dim}), {"truth_filter=product"}), {0.062, 0.098, 0.11});
    // A light of (0.5, 1, 1): min(0.5, 0.2) 0.5 of red is as before; the second pane lets 0.75 of 0.5 pass there.
    const glm::vec3 cyan(0.5F, 1.0F, 1.0F);
    expect_colour(middle(wall({pane}, cyan), {}), filtered);
    expect_colour(middle(wall({pane}, cyan), {"truth_filter=product"}), filtered);
    expect_colour(middle(wall({pane, dim}, cyan), {"truth_filter=product"}), {0.074, 0.098, 0.11});
}

// Equation 3.3: the pane gets 0.1 + (1 - 1/10)^2 of light, and the wall shows through half of it. Its normal points to
// the eye, so refraction moves nothing.
TEST_F(DeferredTruth, APaneLiesOverItsWall) {
    const glm::dvec3 behind(0.082, 0.178, 0.21), front = 0.91 * glm::dvec3(0.2, 0.8, 1.0);
    for (const char* refraction : {"refraction=false", "refraction=true"})
        expect_colour(middle(wall({{1.0, pane_colour}}), {refraction}, "0,0,5,0,0,0,40"), 0.5 * (behind + front));
}

TEST_F(DeferredTruth, SpecularLightIsWhiteAndAsStrongAsTheStrongestChannel) {
    // The eye is where the light is mirrored to: (R.V) = 1 at the origin, whatever the power.
    const glm::dvec3 colour =
        middle(wall({}, {0.5F, 1.0F, 0.25F}), {"specular_power=7"}, "0,0,4,0,0,0,40", "specular=0.25");
    expect_colour(colour, glm::dvec3(0.05) + 0.5 * 0.64 * glm::dvec3(0.5, 1.0, 0.25) + 0.25 * 0.64);
}

// In a cube of index 1.5 a ray leaves by the face opposite to where it entered, at the angle at which it came, or by
// one of the others, to whose normal it has more than acos(sin 41.8) = 48.2 degrees: then it is always reflected.
TEST_F(DeferredTruth, S003_G17_TotalReflectionIsMarkedWhereACubeHasIt) {
    traces::Scene scene = traces::empty_scene();
    scene.name = "cube";
    add_object(scene, traces::box_mesh(glm::dvec3(-1.0), glm::dvec3(1.0)), "cube", {0.5F, 0.5F, 0.5F, 0.4F}, "test");
    scene.resources->materials.back().alpha_mode = pipeline::AlphaMode::blend;
    finish_scene(scene);
    const pipeline::View view = traces::make_view(scene, "3,2,4,0,0,0,45", 64, 64);
    const Truth truth = truth_of(scene, view, {"lights=0"});
    std::size_t marked = 0, passing = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const std::size_t pixel = truth.pixel(x, y);
            if (!truth.channels[total_reflection].has(pixel) || truth.doubtful(pixel)) continue;
            const support::PixelRay ray(view, x, y);
            const glm::dvec3 enters = ray.at(ray.in_box(glm::dvec3(-1.0), glm::dvec3(1.0)).enter);
            const glm::dvec3 way = glm::normalize(ray.step());
            const auto face = [](const glm::dvec3& at) {
                const glm::dvec3 size = glm::abs(at);
                return size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
            };
            const int entry = face(enters);
            glm::dvec3 inside = way / 1.5; // along the face; Snell
            inside[entry] = 0.0;
            inside[entry] = std::copysign(std::sqrt(1.0 - glm::dot(inside, inside)), way[entry]);
            std::array<double, 3> until{};
            for (int axis = 0; axis < 3; ++axis)
                until[static_cast<std::size_t>(axis)] =
                    ((inside[axis] > 0.0 ? 1.0 : -1.0) - enters[axis]) / inside[axis];
            std::array<double, 3> sorted = until;
            std::sort(sorted.begin(), sorted.end());
            if (sorted[1] - sorted[0] < 0.02) continue; // at an edge
            const bool opposite = until[static_cast<std::size_t>(entry)] == sorted[0];
            EXPECT_EQ(truth.channels[total_reflection].values[pixel] == 0.0F, opposite) << x << ' ' << y;
            (opposite ? passing : marked) += 1;
        }
    EXPECT_GT(marked, 100U);
    EXPECT_GT(passing, 100U);
}

TEST_F(DeferredTruth, OnlyWhatRaysUseIsInTheKey) {
    const traces::Scene scene = traces::load_scene(showroom);
    const pipeline::View view = traces::make_view(scene, before_the_pane, 16, 16);
    const auto key = [&](const Settings& settings) { return *method_of(scene, view, settings).key; };
    const std::string usual = key({});
    for (const char* other : {"method=dp", "map_size=64", "bias=0.1", "slope_bias=0"}) EXPECT_EQ(key({other}), usual);
    for (const char* other : {"lights=1", "shadows=none", "refraction=false", "refraction_coefficient=0.1",
                              "intensity=2", "ambient=0", "specular=0", "specular_power=1", "truth_filter=product"})
        EXPECT_NE(key({other}), usual) << other;
}

} // namespace workload_deferred_truth_test
