// Tests that compare with OpenGL: one renderer for each suite; skipped where there is none.
#pragma once

#include "tests/support/mesa_renderer.hpp"
#include "tests/support/mesa_scenes.hpp"

#include <gtest/gtest.h>
#include <string>

namespace tests {

class MesaTest : public testing::Test {
  protected:
    static void SetUpTestSuite() { renderer_ = MesaRenderer::create(reason_).release(); }
    static void TearDownTestSuite() {
        delete renderer_;
        renderer_ = nullptr;
    }
    void SetUp() override {
        if (renderer_ == nullptr) GTEST_SKIP() << "no OpenGL to compare with: " << reason_;
    }

    static inline MesaRenderer* renderer_ = nullptr;
    static inline std::string reason_;
};

/// Of coverage and depths to the last bit.
class ExactMesaTest : public MesaTest {
  protected:
    void SetUp() override {
        MesaTest::SetUp();
        if (!IsSkipped() && !fuses_multiply_add())
            GTEST_SKIP() << "llvmpipe rounds otherwise on processors without fused multiply-add";
    }
};

} // namespace tests
