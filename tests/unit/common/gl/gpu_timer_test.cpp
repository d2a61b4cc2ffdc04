#include "common/gl/objects/gpu_timer.h"

#include <chrono>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {
namespace {

TEST(GpuTimer, IsAboveZeroAndAtMostTheWallClockTime) {
    const EglContext context;
    const Texture texture(TextureFormat::rgba8, 1024, 1024);
    const Framebuffer target({&texture});
    GpuTimer timer;
    for (int span = 0; span < 2; ++span) {
        const auto before = std::chrono::steady_clock::now();
        timer.begin();
        target.bind();
        glClear(GL_COLOR_BUFFER_BIT);
        timer.end();
        const double gpu_ms = timer.wait_ms();
        const std::chrono::duration<double, std::milli> wall =
            std::chrono::steady_clock::now() - before;
        EXPECT_GT(gpu_ms, 0);
        EXPECT_LE(gpu_ms, wall.count());
    }
}

TEST(GpuTimer, ReturnsEachSpanOnce) {
    const EglContext context;
    GpuTimer timer;
    EXPECT_FALSE(timer.poll_ms());
    timer.begin();
    timer.end();
    glFinish();
    std::optional<double> ms;
    for (int look = 0; look < 1000 && !ms; ++look) ms = timer.poll_ms();
    ASSERT_TRUE(ms);
    EXPECT_GE(*ms, 0);
    EXPECT_FALSE(timer.poll_ms());
    EXPECT_EQ(timer.wait_ms(), *ms) << "the last span's stays";
}

}  // namespace
}  // namespace vantage
