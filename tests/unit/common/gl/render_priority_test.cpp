#include "common/gl/context/render_priority.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/sliced_drawing.h"

using namespace std::chrono_literals;

namespace vantage {
namespace {

TEST(RenderPriority, DoesNotWaitWithoutAClaim) {
    RenderPriority way;
    way.give_way(1h);
    { const RenderPriority::Claim claim(way); }
    way.give_way(1h);
}

TEST(RenderPriority, WaitsForEveryClaim) {
    RenderPriority way;
    auto first = std::make_unique<RenderPriority::Claim>(way);
    auto second = std::make_unique<RenderPriority::Claim>(way);
    std::atomic<bool> is_freed = false;
    std::thread yielding([&] {
        way.give_way(1h);
        EXPECT_TRUE(is_freed);
    });
    first.reset();
    way.give_way(1ms);  // The second one holds: only the time ends this.
    is_freed = true;
    second.reset();
    yielding.join();
}

TEST(RenderPriority, BandsContinueDespiteAnEndlessClaim) {
    const EglContext context;
    RenderPriority way;
    const RenderPriority::Claim claim(way);
    const SlicedDrawing slices(1ns, &way);
    int rows = 0, drawn = 0;
    slices.draw({20, 40}, rows, [&] { ++drawn; });
    EXPECT_EQ(drawn, 2) << "a band of 32 rows and one of 8";
}

TEST(RenderPriority, BandsWaitForAClaim) {
    const EglContext context;
    RenderPriority way;
    auto claim = std::make_unique<RenderPriority::Claim>(way);
    std::atomic<bool> is_freed = false;
    std::thread renderer([&] {
        is_freed = true;
        claim.reset();
    });
    const SlicedDrawing slices(1ns, &way);
    int rows = 0;
    slices.draw({20, 8}, rows, [&] { EXPECT_TRUE(is_freed); });
    renderer.join();
}

}  // namespace
}  // namespace vantage
