// Scenes for rays, stated by the test.
#pragma once

#include "reports/truth/ray_scene.hpp"
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <numbers>

namespace support {

/// Skipped where rays cannot be traced.
class RayTest : public ::testing::Test {
  protected:
    void SetUp() override {
        try {
            reports::require_rays();
        } catch (const sim::InputError& error) {
            GTEST_SKIP() << error.what();
        }
    }
};

inline std::unique_ptr<reports::RayScene> ray_scene(tests::FunctionalScene scene) {
    scene.resources.place();
    scene.resources.validate("test");
    return std::make_unique<reports::RayScene>(std::make_shared<const pipeline::Resources>(scene.resources),
                                               scene.draws);
}
inline std::unique_ptr<reports::RayScene> ray_scene(const tests::MeshData& mesh) {
    tests::FunctionalScene scene(16, 16);
    scene.add(mesh);
    return ray_scene(std::move(scene));
}

/// A horizontal rectangle, all of it or in two triangles of a list that grows.
inline void add_rectangle(tests::MeshData& mesh, double x0, double x1, double z0, double z1, double y) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, z] : {std::pair(x0, z0), std::pair(x1, z0), std::pair(x1, z1), std::pair(x0, z1)})
        mesh.positions.emplace_back(x, y, z);
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + i);
}

/// A horizontal regular polygon round the y axis.
inline tests::MeshData polygon(std::uint32_t corners, double radius, double y) {
    tests::MeshData mesh;
    mesh.positions.emplace_back(0.0, y, 0.0);
    for (std::uint32_t i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        mesh.positions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
        for (const std::uint32_t index : {0U, 1 + i, 1 + (i + 1) % corners}) mesh.indices.push_back(index);
    }
    return mesh;
}
inline double polygon_area(std::uint32_t corners, double radius) {
    return 0.5 * corners * radius * radius * std::sin(2.0 * std::numbers::pi / corners);
}

} // namespace support
